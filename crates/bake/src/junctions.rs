//! Cuts edges at the ends of shorter ones that lie along them, so that edges along one line are split alike.
//!
//! Where the edge of a wall runs along those of two floors, halves of it end where the floors have no vertex: pictures have pinholes there.

use crate::split::{Edge, EdgePlace, Place, cut, edge_place, edges, length, place_of};
use glam::{Vec3, Vec3Swizzles};
use rayon::prelude::*;
use scene::{Mesh, Scene};
use std::borrow::Cow;
use std::collections::HashMap;

/// Distance from an edge up to which a vertex lies on it, in steps of its largest coordinate: rounding and no more.
const STEPS: f32 = 8.0;
/// Distance from an edge's ends and from other cuts at which it is cut at least, in that distance.
const APART: f32 = 16.0;
/// Points of a leaf.
const LEAF: usize = 8;
/// Cuts that any edge may have.
const FEW: usize = 64;
/// Cuts of all edges that have more, to a point of the scene, and as many more.
const MANY: [usize; 2] = [4, 20_000];

/// An edge that one triangle alone has.
struct Open {
    place: EdgePlace,
    ends: [Vec3; 2],
    /// The third corner of its triangle.
    opposite: Place,
    tolerance: f32,
}

/// Where edges are to be cut.
type Cuts = HashMap<EdgePlace, Vec<Vec3>>;

/// The scene with every open edge longer than `shortest` cut where an edge along it ends.
pub(crate) fn joined(scene: &Scene, shortest: f32) -> Cow<'_, Scene> {
    let open = open_edges(scene, shortest);
    if open.is_empty() {
        return Cow::Borrowed(scene);
    }
    let mut cuts = cuts(scene, &open);
    if cuts.is_empty() {
        return Cow::Borrowed(scene);
    }
    let mut joined = scene.clone();
    // Cuts are kept: the edge of another triangle, be it of another mesh, may lie at the place of one that is cut already.
    for mesh in &mut joined.meshes {
        while cut_once(mesh, &mut cuts) {}
    }
    Cow::Owned(joined)
}

/// The edges longer than `shortest` that one triangle alone has, by their places.
fn open_edges(scene: &Scene, shortest: f32) -> Vec<Open> {
    let mut all = Vec::new();
    for mesh in &scene.meshes {
        let of_triangle = |triangle: &[u32; 3]| {
            let third = |[a, b]: Edge| triangle.iter().copied().find(|&v| v != a && v != b);
            let long = edges(triangle).into_iter().filter(|&edge| length(mesh, edge) > shortest);
            let open =
                |edge| Some((edge_place(mesh, edge), edge.map(|v| at(mesh, v)), place_of(at(mesh, third(edge)?))));
            long.filter_map(open).collect::<Vec<_>>()
        };
        all.par_extend(mesh.triangles.par_iter().flat_map_iter(of_triangle));
    }
    all.par_sort_unstable_by_key(|(place, _, opposite)| (*place, *opposite));
    let alone = all.chunk_by(|a, b| a.0 == b.0).filter(|same| same.len() == 1);
    let open = alone.map(|same| {
        let (place, ends, opposite) = same[0];
        let largest = ends.map(|end| end.abs().max_element()).into_iter().fold(0.0, f32::max);
        Open { place, ends, opposite, tolerance: STEPS * f32::EPSILON * largest }
    });
    open.collect()
}

fn at(mesh: &Mesh, vertex: u32) -> Vec3 {
    mesh.positions[vertex as usize]
}

/// Where open edges are to be cut: at vertices on them from which an edge goes on along them.
fn cuts(scene: &Scene, open: &[Open]) -> Cuts {
    let points = Points::of(scene);
    let on = points.on_all(open);
    let mut edges_at: HashMap<Place, Vec<usize>> = HashMap::new();
    for (index, point) in on.iter().enumerate().flat_map(|(index, on)| on.iter().map(move |point| (index, point))) {
        edges_at.entry(place_of(*point)).or_default().push(index);
    }
    let mut cuts: HashMap<EdgePlace, Vec<Vec3>> = HashMap::new();
    for mesh in if edges_at.is_empty() { &[][..] } else { &scene.meshes } {
        let here: Vec<Option<&Vec<usize>>> = mesh.positions.iter().map(|&p| edges_at.get(&place_of(p))).collect();
        for [a, b] in mesh.triangles.iter().flat_map(edges) {
            for [from, to] in [[a, b], [b, a]] {
                for edge in here[from as usize].into_iter().flatten().map(|&index| &open[index]) {
                    let (from, to) = (at(mesh, from), at(mesh, to));
                    if edge.goes_along(from, to) {
                        cuts.entry(edge.place).or_default().push(from);
                    }
                }
            }
        }
    }
    for edge in open {
        if let Some(cuts) = cuts.get_mut(&edge.place) {
            edge.keep_apart(cuts);
        }
    }
    cuts
}

impl Open {
    /// Whether a point lies on the edge, between its ends.
    fn holds(&self, point: Vec3) -> bool {
        let [a, b] = self.ends;
        let share = share_of(self.ends, point);
        let margin = APART * self.tolerance / a.distance(b);
        share > margin
            && share < 1.0 - margin
            && (point - a - share * (b - a)).length() <= self.tolerance
            && place_of(point) != self.opposite
    }

    /// Whether a box may hold a point of the edge: neither the axes nor their cross products with the edge part them. The box around a
    /// slanting edge alone would hold a large part of all points.
    fn may_meet(&self, [min, max]: [Vec3; 2]) -> bool {
        let [a, b, min, max] = [self.ends[0], self.ends[1], min, max].map(Vec3::as_dvec3);
        let (half, way) = (0.5 * (b - a), 0.5 * (a + b) - 0.5 * (min + max));
        let extent = 0.5 * (max - min) + 2.0 * f64::from(self.tolerance);
        let across = extent.yzx() * half.zxy().abs() + extent.zxy() * half.yzx().abs();
        way.abs().cmple(extent + half.abs()).all() && half.cross(way).abs().cmple(across * (1.0 + 1e-9)).all()
    }

    /// Whether what leads from a point on the edge to another one runs along the edge.
    fn goes_along(&self, from: Vec3, to: Vec3) -> bool {
        let [a, b] = self.ends;
        let along = (b - a).normalize_or_zero();
        let way = to - from;
        let far = way.dot(along).abs();
        far > APART * self.tolerance
            && (way - way.dot(along) * along).length() <= 2.0 * self.tolerance * f32::max(1.0, far / a.distance(b))
    }

    /// Leaves of points that are as good as one the first along the edge.
    fn keep_apart(&self, points: &mut Vec<Vec3>) {
        points.sort_by(|p, q| share_of(self.ends, *p).total_cmp(&share_of(self.ends, *q)));
        points.dedup_by(|next, kept| kept.distance(*next) <= APART * self.tolerance);
    }
}

/// How far along a way a point lies.
fn share_of([a, b]: [Vec3; 2], point: Vec3) -> f32 {
    (point - a).dot(b - a) / (b - a).length_squared()
}

/// Cuts every edge that is to be cut at the point nearest its middle; whether there was one.
fn cut_once(mesh: &mut Mesh, cuts: &mut Cuts) -> bool {
    let chosen = |mesh: &Mesh, edge: Edge| {
        let place = edge_place(mesh, edge);
        // In the order of the place, so that all edges there are cut at the same point.
        let ends = place.map(|end| Vec3::from_array(end.map(f32::from_bits)));
        let off = |point: &Vec3| (share_of(ends, *point) - 0.5).abs();
        let point = cuts.get(&place)?.iter().copied().min_by(|p, q| off(p).total_cmp(&off(q)))?;
        Some((point, share_of(edge.map(|v| at(mesh, v)), point)))
    };
    let new = cut(mesh, |mesh, edge| chosen(mesh, edge).map(|(_, share)| share));
    let mut placed: Vec<(Edge, u32, Vec3, f32)> = new
        .into_iter()
        .filter_map(|(edge, vertex)| chosen(mesh, edge).map(|(point, share)| (edge, vertex, point, share)))
        .collect();
    placed.sort_unstable_by_key(|(_, vertex, ..)| *vertex);
    for &(edge, vertex, point, share) in &placed {
        let ends = edge.map(|v| at(mesh, v));
        let rest = cuts.get(&edge_place(mesh, edge)).cloned().unwrap_or_default();
        mesh.positions[vertex as usize] = point;
        for (end, is_here) in [(edge[0], true), (edge[1], false)] {
            let part: Vec<Vec3> = rest
                .iter()
                .copied()
                .filter(|other| *other != point && (share_of(ends, *other) < share) == is_here)
                .collect();
            if !part.is_empty() {
                cuts.entry(edge_place(mesh, [end, vertex])).or_insert(part);
            }
        }
    }
    !placed.is_empty()
}

/// The vertices of a scene in a tree of boxes.
struct Points {
    points: Vec<Vec3>,
    nodes: Vec<Node>,
}

/// A box around some points; its children are the next node and `second`.
struct Node {
    min: Vec3,
    max: Vec3,
    first: usize,
    count: usize,
    second: usize,
}

impl Points {
    fn of(scene: &Scene) -> Self {
        let mut points: Vec<Vec3> = scene.meshes.iter().flat_map(|mesh| mesh.positions.iter().copied()).collect();
        points.retain(|point| point.is_finite());
        points.par_sort_unstable_by_key(|point| place_of(*point));
        points.dedup_by_key(|point| place_of(*point));
        let mut nodes = Vec::new();
        let count = points.len();
        if count > 0 {
            build(&mut points, 0..count, &mut nodes);
        }
        Self { points, nodes }
    }

    /// The points on every edge. Thousands of edges along one line, of which each holds the ends of all others, would be cut into millions of
    /// parts: where many hold many points they are left alone.
    fn on_all(&self, open: &[Open]) -> Vec<Vec<Vec3>> {
        let mut on: Vec<Option<Vec<Vec3>>> = open.par_iter().map(|edge| self.on(edge, FEW)).collect();
        let long: Vec<usize> = (0..open.len()).filter(|&index| on[index].is_none()).collect();
        let most = (MANY[0] * self.points.len() + MANY[1]) / long.len().max(1);
        let found: Vec<Option<Vec<Vec3>>> = long.par_iter().map(|&index| self.on(&open[index], most)).collect();
        long.into_iter().zip(found).for_each(|(index, found)| on[index] = found);
        on.into_iter().map(Option::unwrap_or_default).collect()
    }

    /// The points on an edge; none where there are more than `most`.
    fn on(&self, edge: &Open, most: usize) -> Option<Vec<Vec3>> {
        let mut found = Vec::new();
        let mut stack = Vec::from_iter((!self.nodes.is_empty()).then_some(0));
        while let Some(index) = stack.pop() {
            let node = &self.nodes[index];
            if !edge.may_meet([node.min, node.max]) {
                continue;
            }
            if node.second == 0 {
                let own = &self.points[node.first..node.first + node.count];
                found.extend(own.iter().copied().filter(|&point| edge.holds(point)));
                if found.len() > most {
                    return None;
                }
            } else {
                stack.extend([node.second, index + 1]);
            }
        }
        Some(found)
    }
}

/// Appends the node of a range of points and those below it.
fn build(points: &mut [Vec3], range: std::ops::Range<usize>, nodes: &mut Vec<Node>) {
    let own = &mut points[range.clone()];
    let min = own.iter().copied().fold(Vec3::INFINITY, Vec3::min);
    let max = own.iter().copied().fold(Vec3::NEG_INFINITY, Vec3::max);
    let index = nodes.len();
    nodes.push(Node { min, max, first: range.start, count: range.len(), second: 0 });
    if range.len() <= LEAF {
        return;
    }
    let extent = (max - min).to_array();
    let axis = (0..3).fold(0, |best, axis| if extent[axis] > extent[best] { axis } else { best });
    let half = range.len() / 2;
    own.select_nth_unstable_by(half, |a, b| a[axis].total_cmp(&b[axis]));
    build(points, range.start..range.start + half, nodes);
    nodes[index].second = nodes.len();
    build(points, range.start + half..range.end, nodes);
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Slanting teeth side by side, each of a mesh of three vertices of its own.
    fn teeth(count: u32) -> Scene {
        let tooth = |k: u32| {
            let at = k as f32 / count as f32;
            let positions = [[at, 0.0, 0.0], [at + 0.9 / count as f32, 0.0, 0.0], [at + 1.0, 0.3, 1.0]];
            Mesh { positions: positions.map(Vec3::from).to_vec(), triangles: vec![[0, 1, 2]], ..Mesh::default() }
        };
        Scene { meshes: (0..count).map(tooth).collect(), ..Scene::default() }
    }

    /// Boxes of points that an edge may meet, on the mean, by a test.
    fn boxes(count: u32, test: impl Fn(&Open, [Vec3; 2]) -> bool) -> f64 {
        let scene = teeth(count);
        let (open, points) = (open_edges(&scene, 0.5), Points::of(&scene));
        let met = |edge: &Open| points.nodes.iter().filter(|node| test(edge, [node.min, node.max])).count();
        open.iter().map(met).sum::<usize>() as f64 / open.len() as f64
    }

    #[test]
    fn slanting_edges_look_at_few_points() {
        let [few, many] = [200, 1_600].map(|count| boxes(count, Open::may_meet));
        assert!(many < 2.0 * few, "{few} boxes of 200 teeth, {many} of 1,600");
    }

    /// By the boxes around edges each meets a part of all.
    #[test]
    fn slanting_edges_look_at_few_points_can_fail() {
        let overlap = |edge: &Open, [min, max]: [Vec3; 2]| {
            let [a, b] = edge.ends;
            a.max(b).cmpge(min).all() && a.min(b).cmple(max).all()
        };
        let [few, many] = [200, 1_600].map(|count| boxes(count, overlap));
        assert!(many > 5.0 * few, "{few} boxes of 200 teeth, {many} of 1,600");
    }

    /// What lies on an edge is found as by asking all points.
    #[test]
    fn points_on_edges_are_those_of_a_search_of_all() {
        let mut scene = teeth(60);
        let on_them: Vec<Vec3> = (0..300u32)
            .map(|k| {
                let [a, _, c] = scene.meshes[k as usize % 60].positions[..] else { unreachable!("a tooth") };
                a.lerp(c, (k as f32 * 0.618_034).fract()) + Vec3::Y * if k % 3 == 0 { 1e-4 } else { 0.0 }
            })
            .collect();
        scene.meshes.push(Mesh { positions: on_them, ..Mesh::default() });
        let points = Points::of(&scene);
        let mut found = 0;
        for edge in open_edges(&scene, 0.5) {
            let all: Vec<Vec3> = points.points.iter().copied().filter(|&point| edge.holds(point)).collect();
            let mut on = points.on(&edge, usize::MAX).expect("no bound");
            on.sort_by_key(|point| points.points.iter().position(|other| other == point));
            assert_eq!(on, all);
            found += all.len();
        }
        assert!(found > 100, "can fail: {found} points lie on edges");
    }
}
