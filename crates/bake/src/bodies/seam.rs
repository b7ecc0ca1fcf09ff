//! Edges by place: which of them join triangles to a surface without gaps.

use crate::world::World;
use glam::{DVec3, Vec3};
use rayon::prelude::*;

/// Distance from a common line, over the length of the edges, within which edges count as lying on it.
const ON_LINE: f64 = 1e-5;
/// Most open edges at one place among which those of one line are looked for: where more meet, blades or spokes do.
const MOST_MEETING: usize = 256;

/// One side of an edge as one triangle has it; ends are numbers of places.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct HalfEdge {
    pub(super) low: u32,
    pub(super) high: u32,
    /// Whether the triangle runs from `low` to `high`.
    pub(super) rising: bool,
    /// Traced triangle.
    pub(super) triangle: u32,
    /// Its corner at which the edge starts.
    pub(super) corner: u8,
}

impl HalfEdge {
    /// Start and end of the edge in the triangle's winding, and the third corner.
    pub(super) fn corners(&self, world: &World<'_>) -> [Vec3; 3] {
        let points = world.points(self.triangle);
        [0, 1, 2].map(|k| points[(self.corner as usize + k) % 3])
    }
}

/// The half edges of triangles, those of one place side by side.
pub(super) fn half_edges(world: &World<'_>, triangles: &[u32]) -> Vec<HalfEdge> {
    let place = places(world);
    let mut halves: Vec<HalfEdge> = triangles
        .par_iter()
        .flat_map_iter(|&triangle| {
            let corners = world.corners[triangle as usize].map(|v| place[v as usize]);
            (0..3u8).filter_map(move |corner| {
                let (a, b) = (corners[corner as usize], corners[(corner as usize + 1) % 3]);
                let half = HalfEdge { low: a.min(b), high: a.max(b), rising: a < b, triangle, corner };
                (a != b).then_some(half)
            })
        })
        .collect();
    halves.par_sort_unstable();
    halves
}

/// The half edges of one place after another.
pub(super) fn runs(halves: &[HalfEdge]) -> impl Iterator<Item = &[HalfEdge]> {
    halves.chunk_by(|a, b| (a.low, a.high) == (b.low, b.high))
}

/// Whether as many triangles run along an edge one way as the other.
pub(super) fn is_balanced(run: &[HalfEdge]) -> bool {
    2 * run.iter().filter(|half| half.rising).count() == run.len()
}

/// Of each vertex of the scene the number of its place: vertices that differ by rounding alone share it.
fn places(world: &World<'_>) -> Vec<u32> {
    let positions: Vec<Vec3> = world.scene.meshes.iter().flat_map(|mesh| mesh.positions.iter().copied()).collect();
    let grain = grain(world);
    let mut place: Vec<u32> = (0..positions.len() as u32).collect();
    // Two points nearer than a quarter of a cell share a cell of at least one of four grids, since each axis parts them in one at most.
    for shift in 0..4 {
        let cell = |p: Vec3| (p.as_dvec3() / grain + 0.25 * f64::from(shift)).floor().as_ivec3().to_array();
        let mut keyed: Vec<([i32; 3], u32)> =
            positions.par_iter().map(|&p| cell(p)).zip(0..positions.len() as u32).collect();
        keyed.par_sort_unstable();
        for run in keyed.chunk_by(|a, b| a.0 == b.0) {
            for pair in run.windows(2) {
                let (a, b) = (root(&mut place, pair[0].1), root(&mut place, pair[1].1));
                place[a.max(b) as usize] = a.min(b);
            }
        }
    }
    (0..place.len() as u32).map(|vertex| root(&mut place, vertex)).collect()
}

/// Size of a cell in which positions count as one: 32 steps of rounding at the farthest coordinate, metres.
fn grain(world: &World<'_>) -> f64 {
    let positions = world.scene.meshes.iter().flat_map(|mesh| &mesh.positions);
    let farthest = positions.map(|p| p.abs().max_element()).fold(f32::MIN_POSITIVE, f32::max);
    f64::from(farthest) / f64::from(1 << 19)
}

/// Takes out the edges that close each other on a common line although their vertices differ (three quads on one side, two on the
/// other), and joins their triangles. Returns the rest.
pub(super) fn close_lines(world: &World<'_>, open: Vec<HalfEdge>, join: &mut dyn FnMut(u32, u32)) -> Vec<HalfEdge> {
    let grain = grain(world);
    let mut line: Vec<u32> = (0..open.len() as u32).collect();
    for [a, b] in neighbours(world, &open, grain) {
        let (a, b) = (root(&mut line, a), root(&mut line, b));
        line[a.max(b) as usize] = a.min(b);
    }
    let mut groups: Vec<(u32, u32)> = (0..open.len() as u32).map(|i| (root(&mut line, i), i)).collect();
    groups.sort_unstable();
    let mut rest = Vec::new();
    for group in groups.chunk_by(|a, b| a.0 == b.0) {
        let edges: Vec<HalfEdge> = group.iter().map(|&(_, i)| open[i as usize]).collect();
        if edges.len() > 1 && cancels(world, &edges, grain) {
            edges.iter().for_each(|edge| join(edges[0].triangle, edge.triangle));
        } else {
            rest.extend(edges);
        }
    }
    rest
}

fn root(parent: &mut [u32], mut one: u32) -> u32 {
    while parent[one as usize] != one {
        parent[one as usize] = parent[parent[one as usize] as usize];
        one = parent[one as usize];
    }
    one
}

/// Pairs of open edges that meet at a place and lie on one line.
fn neighbours(world: &World<'_>, open: &[HalfEdge], grain: f64) -> Vec<[u32; 2]> {
    let mut at: Vec<(u32, u32)> = open.iter().zip(0..).flat_map(|(half, i)| [(half.low, i), (half.high, i)]).collect();
    at.sort_unstable();
    let way = |i: u32, place: u32| {
        let half = &open[i as usize];
        let [a, b, _] = half.corners(world);
        let starts = half.rising == (half.low == place);
        (if starts { b - a } else { a - b }).as_dvec3()
    };
    let mut pairs = Vec::new();
    for meeting in at.chunk_by(|a, b| a.0 == b.0).filter(|meeting| meeting.len() <= MOST_MEETING) {
        for (k, &(place, i)) in meeting.iter().enumerate() {
            let first = way(i, place);
            let on_line = |&&(_, j): &&(u32, u32)| is_parallel(first, way(j, place), grain);
            // The next on its line is enough: that one leads to the others.
            pairs.extend(meeting[k + 1..].iter().find(on_line).map(|&(_, j)| [i, j]));
        }
    }
    pairs
}

fn is_parallel(a: DVec3, b: DVec3, grain: f64) -> bool {
    let (long, short) = (a.length().max(b.length()), a.length().min(b.length()));
    a.cross(b).length() <= long * (ON_LINE * short + grain)
}

/// Whether edges of one line cover every part of it as often one way as the other.
fn cancels(world: &World<'_>, edges: &[HalfEdge], grain: f64) -> bool {
    let [start, end, _] = edges[0].corners(world).map(|p| p.as_dvec3());
    let along = (end - start).normalize_or_zero();
    let mut ends: Vec<(f64, i32)> = Vec::with_capacity(2 * edges.len());
    for edge in edges {
        let [a, b, _] = edge.corners(world).map(|p| (p.as_dvec3() - start).dot(along));
        let sign = if b > a { 1 } else { -1 };
        ends.extend([(a.min(b), sign), (a.max(b), -sign)]);
    }
    ends.sort_by(|a, b| a.0.total_cmp(&b.0));
    let extent = ends.last().map_or(0.0, |last| last.0) - ends[0].0;
    let (mut covered, mut bare) = (0, 0.0);
    for pair in ends.windows(2) {
        covered += pair[0].1;
        bare += if covered == 0 { 0.0 } else { pair[1].0 - pair[0].0 };
    }
    bare <= 10.0 * ON_LINE * extent + grain * edges.len() as f64
}
