//! Halves the long edges of slivers on a flat surface so that neighbours share the new vertices.
//!
//! Around the middle of a disc, or in a polygon of a thousand corners, a thousand long edges lie side by side. To halve each of them takes a thousand
//! vertices where one sees what all see. Here one is halved, and the edges beside it are turned towards its middle (C. L. Lawson, *Software
//! for C1 surface interpolation*, 1977) where that changes neither the surface nor what is interpolated on it.

use crate::split::{Edge, add_between, edges, halve, length, sorted};
use glam::{DVec3, Vec3};
use scene::Mesh;
use std::collections::{HashMap, HashSet};

/// Slivers that call for it; fewer are halved one by one.
const LEAST: usize = 128;
/// Height of a sliver over its long edge, in that edge, at most.
const THIN: f64 = 1.0 / 8.0;
/// Distance from a plane that counts as none, in steps of the largest coordinate.
const STEPS: f64 = 8.0;
/// How far interpolated texture coordinates, and other attributes, may be moved by turning an edge.
const MOVED: [f64; 2] = [1e-5, 1e-3];
/// Where an edge may be crossed at least, from its ends, in its length.
const WITHIN: f64 = 1e-4;
/// No triangle.
const NONE: u32 = u32::MAX;
/// More triangles than an edge of a plain surface has.
const MANY: u32 = u32::MAX - 1;

/// What became of a mesh whose edges were halved.
pub(crate) struct Halved {
    /// The new vertices by the edges that they halve.
    pub(crate) middles: HashMap<Edge, u32>,
    /// Whether slivers share some of them: edges that are turned get shorter, but not by half.
    pub(crate) is_shared: bool,
}

/// [`halve`] that lets slivers of a flat surface share vertices: of edges that `wanted` names some are turned instead, towards the middles of
/// others. A mesh of compact triangles is halved as there.
pub(crate) fn halve_shared(mesh: &mut Mesh, wanted: impl Fn(&Mesh, Edge) -> bool) -> Halved {
    let slivers = slivers(mesh, &wanted);
    if slivers.len() < LEAST {
        return Halved { middles: halve(mesh, wanted), is_shared: false };
    }
    let shared: HashSet<Edge> = slivers.iter().copied().collect();
    let mut middles = halve(mesh, |mesh, edge| !shared.contains(&sorted(edge)) && wanted(mesh, edge));
    let mut surface = Surface::of(mesh);
    for edge in slivers {
        if let Some(middle) = surface.halve(edge) {
            middles.insert(edge, middle);
        }
    }
    Halved { middles, is_shared: true }
}

/// The wanted edges inside of flat surfaces, the longest first, if many are long edges of slivers.
fn slivers(mesh: &Mesh, wanted: &impl Fn(&Mesh, Edge) -> bool) -> Vec<Edge> {
    let is_thin = |edge, third| height(mesh, edge, third) < THIN * f64::from(length(mesh, edge));
    let sides = || {
        let of_triangle = |triangle: &[u32; 3]| [0, 1, 2].map(|k| (edges(triangle)[k], triangle[(k + 2) % 3]));
        mesh.triangles.iter().flat_map(of_triangle).filter(|&(edge, _)| wanted(mesh, edge))
    };
    if sides().filter(|&(edge, third)| is_thin(edge, third)).count() < 2 * LEAST {
        return Vec::new();
    }
    let mut sides: Vec<(Edge, Edge, u32)> = sides().map(|(edge, third)| (sorted(edge), edge, third)).collect();
    sides.sort_unstable();
    let (mut found, mut thin) = (Vec::new(), 0);
    for same in sides.chunk_by(|a, b| a.0 == b.0) {
        if let &[(edge, one, c), (_, other, d)] = same
            && one != other
            && is_flat(mesh, one, [c, d])
        {
            found.push(edge);
            thin += usize::from(is_thin(edge, c) && is_thin(edge, d));
        }
    }
    if thin < LEAST {
        return Vec::new();
    }
    found.sort_by(|a, b| length(mesh, *b).total_cmp(&length(mesh, *a)).then(a.cmp(b)));
    found
}

fn at(mesh: &Mesh, vertex: u32) -> DVec3 {
    mesh.positions[vertex as usize].as_dvec3()
}

/// Height of a corner over the line of an edge; no number for an edge without length.
fn height(mesh: &Mesh, [a, b]: Edge, corner: u32) -> f64 {
    let [a, b, c] = [a, b, corner].map(|v| at(mesh, v));
    (b - a).cross(c - a).length() / a.distance(b)
}

/// Whether two triangles on an edge, by their third corners, lie in one plane.
fn is_flat(mesh: &Mesh, [a, b]: Edge, corners: [u32; 2]) -> bool {
    let [a, b, c, d] = [a, b, corners[0], corners[1]].map(|v| at(mesh, v));
    let off = |c: DVec3, d: DVec3| (b - a).cross(c - a).try_normalize().map_or(f64::INFINITY, |n| n.dot(d - a).abs());
    off(c, d).min(off(d, c)) <= tolerance([a, b, c, d])
}

fn tolerance(points: [DVec3; 4]) -> f64 {
    STEPS * f64::from(f32::EPSILON) * points.iter().fold(0.0, |most: f64, p| most.max(p.abs().max_element()))
}

/// A mesh with the triangles on each edge.
struct Surface<'a> {
    mesh: &'a mut Mesh,
    on: HashMap<Edge, [u32; 2]>,
}

impl<'a> Surface<'a> {
    fn of(mesh: &'a mut Mesh) -> Self {
        let mut surface = Self { on: HashMap::with_capacity(2 * mesh.triangles.len()), mesh };
        for triangle in 0..surface.mesh.triangles.len() as u32 {
            surface.attach(triangle);
        }
        surface
    }

    fn attach(&mut self, triangle: u32) {
        for edge in edges(&self.mesh.triangles[triangle as usize]).map(sorted) {
            let on = self.on.entry(edge).or_insert([NONE; 2]);
            match on.iter().position(|&one| one == NONE) {
                Some(free) => on[free] = triangle,
                None => *on = [MANY; 2],
            }
        }
    }

    fn detach(&mut self, triangle: u32) {
        for edge in edges(&self.mesh.triangles[triangle as usize]).map(sorted) {
            if let Some(on) = self.on.get_mut(&edge) {
                on.iter_mut().filter(|one| **one == triangle).for_each(|one| *one = NONE);
                if *on == [NONE; 2] {
                    self.on.remove(&edge);
                }
            }
        }
    }

    /// Puts other corners in the place of those of two triangles.
    fn replace(&mut self, both: [(u32, [u32; 3]); 2]) {
        // Not one after the other: an edge that passes from one to the other would have three in between.
        both.iter().for_each(|(triangle, _)| self.detach(*triangle));
        for (triangle, corners) in both {
            self.mesh.triangles[triangle as usize] = corners;
            self.attach(triangle);
        }
    }

    fn add(&mut self, corners: [u32; 3]) {
        self.mesh.triangles.push(corners);
        self.attach(self.mesh.triangles.len() as u32 - 1);
    }

    /// The two triangles on an edge, the first of which has it as given, with their third corners.
    fn around(&self, [a, b]: Edge) -> Option<[(u32, u32); 2]> {
        let on = self.on.get(&sorted([a, b])).filter(|on| !on.contains(&NONE) && !on.contains(&MANY))?;
        let third = |triangle: u32, way: Edge| {
            let corners = &self.mesh.triangles[triangle as usize];
            let k = edges(corners).iter().position(|edge| *edge == way)?;
            Some((triangle, corners[(k + 2) % 3]))
        };
        let [one, other] = *on;
        let found = third(one, [a, b]).zip(third(other, [b, a]));
        let (left, right) = found.or_else(|| third(other, [a, b]).zip(third(one, [b, a])))?;
        (left.1 != right.1).then_some([left, right])
    }

    /// Halves an edge, if it is still there, and turns edges around its middle; the new vertex.
    fn halve(&mut self, [a, b]: Edge) -> Option<u32> {
        let [(left, c), (right, d)] = self.around([a, b])?;
        let middle = add_between(self.mesh, [a, b], 0.5);
        self.replace([(left, [a, middle, c]), (right, [b, middle, d])]);
        self.add([middle, b, c]);
        self.add([middle, a, d]);
        let mut open = vec![[c, a], [b, c], [a, d], [d, b]];
        while let Some([p, q]) = open.pop() {
            // The first triangle is the one at the middle.
            let Some([(near, apex), (far, beyond)]) = self.around([p, q]) else { continue };
            debug_assert_eq!(apex, middle);
            if !self.on.contains_key(&sorted([middle, beyond])) && self.turns([p, q], [middle, beyond]) {
                self.replace([(near, [middle, p, beyond]), (far, [middle, beyond, q])]);
                open.extend([[p, beyond], [beyond, q]]);
            }
        }
        Some(middle)
    }

    /// Whether an edge is to be turned: the angles opposite to it are large together, and nothing changes but the edge.
    fn turns(&self, [p, q]: Edge, [m, d]: Edge) -> bool {
        let points = [p, q, m, d].map(|v| at(self.mesh, v));
        let angle = |corner: DVec3| {
            let (to_p, to_q) = (points[0] - corner, points[1] - corner);
            (to_p.dot(to_q), to_p.cross(to_q).length())
        };
        let ((cos_m, sin_m), (cos_d, sin_d)) = (angle(points[2]), angle(points[3]));
        let sine_of_sum = cos_m * sin_d + cos_d * sin_m;
        let scale = (cos_m.abs() + sin_m) * (cos_d.abs() + sin_d);
        sine_of_sum < -1e-9 * scale
            && crossing(points).is_some_and(|[along, across]| self.is_affine(([p, q], along), ([m, d], across)))
    }

    /// Whether attributes at a share of the way along one edge are those at a share along another.
    fn is_affine(&self, one: (Edge, f64), other: (Edge, f64)) -> bool {
        let mesh = &*self.mesh;
        let uv = |uv: &[glam::Vec2]| {
            let most = one.0.iter().chain(&other.0).map(|&v| uv[v as usize].abs().max_element()).fold(1.0, f32::max);
            agrees(|v| uv[v].extend(0.0).extend(0.0), one, other, MOVED[0] * f64::from(most))
        };
        let flat = |values: &[Vec3]| agrees(|v| values[v].extend(0.0), one, other, MOVED[1]);
        (mesh.normals.is_empty() || flat(&mesh.normals))
            && (mesh.tangents.is_empty() || agrees(|v| mesh.tangents[v], one, other, MOVED[1]))
            && (mesh.uv0.is_empty() || uv(&mesh.uv0))
            && (mesh.uv1.is_empty() || uv(&mesh.uv1))
            && (mesh.colors.is_empty() || agrees(|v| mesh.colors[v], one, other, MOVED[1]))
    }
}

fn agrees(of: impl Fn(usize) -> glam::Vec4, one: (Edge, f64), other: (Edge, f64), moved: f64) -> bool {
    let mix = |([a, b], share): (Edge, f64)| of(a as usize).as_dvec4().lerp(of(b as usize).as_dvec4(), share);
    (mix(one) - mix(other)).abs().max_element() <= moved
}

/// Where two edges of a flat surface cross, in shares of the way from their first ends; none where they miss each other.
fn crossing(points: [DVec3; 4]) -> Option<[f64; 2]> {
    let [p, q, m, d] = points;
    let (one, other, way) = (q - p, d - m, m - p);
    let normal = one.cross(other);
    let square = normal.length_squared();
    let shares = [way.cross(other).dot(normal) / square, way.cross(one).dot(normal) / square];
    let within = |share: &f64| *share > WITHIN && *share < 1.0 - WITHIN;
    let gap = way.dot(normal).abs() / square.sqrt();
    (shares.iter().all(within) && gap <= tolerance(points)).then_some(shares)
}
