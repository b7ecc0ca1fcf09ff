//! Splits edges of a mesh without changing its surface.

use glam::{Vec3, Vec4};
use scene::Mesh;
use std::collections::HashMap;

/// Most triangles that a mesh may be split into.
pub(crate) const MOST_TRIANGLES: usize = 1 << 23;

/// An edge by its vertices, the smaller first.
pub(crate) type Edge = [u32; 2];

/// A place by the bits of its coordinates.
pub(crate) type Place = [u32; 3];

/// The place of a point; zero and negative zero are one.
pub(crate) fn place_of(point: Vec3) -> Place {
    (point + 0.0).to_array().map(f32::to_bits)
}

/// An edge by the places of its ends: the same for all meshes that share it.
pub(crate) type EdgePlace = [Place; 2];

/// Where an edge lies.
pub(crate) fn edge_place(mesh: &Mesh, edge: Edge) -> EdgePlace {
    let [a, b] = edge.map(|v| place_of(mesh.positions[v as usize]));
    [a.min(b), a.max(b)]
}

/// The edges of a triangle, in its winding.
pub(crate) fn edges(&[a, b, c]: &[u32; 3]) -> [Edge; 3] {
    [[a, b], [b, c], [c, a]]
}

/// An edge with the smaller vertex first.
pub(crate) fn sorted([a, b]: Edge) -> Edge {
    [a.min(b), a.max(b)]
}

/// Length of an edge, metres.
pub(crate) fn length(mesh: &Mesh, [a, b]: Edge) -> f32 {
    mesh.positions[a as usize].distance(mesh.positions[b as usize])
}

/// Halves every edge that `wanted` names once, and returns the new vertices by the edges that they halve. Vertices keep
/// their indices, new ones follow.
pub(crate) fn halve(mesh: &mut Mesh, wanted: impl Fn(&Mesh, Edge) -> bool) -> HashMap<Edge, u32> {
    cut(mesh, |mesh, edge| wanted(mesh, edge).then_some(0.5))
}

/// [`halve`] at any share of the way from an edge's smaller vertex to its larger one.
pub(crate) fn cut(mesh: &mut Mesh, share: impl Fn(&Mesh, Edge) -> Option<f32>) -> HashMap<Edge, u32> {
    let mut cuts = HashMap::new();
    let mut triangles = Vec::with_capacity(mesh.triangles.len());
    for triangle in std::mem::take(&mut mesh.triangles) {
        let at = edges(&triangle).map(|edge| {
            let edge = sorted(edge);
            share(mesh, edge).map(|share| *cuts.entry(edge).or_insert_with(|| add_between(mesh, edge, share)))
        });
        triangles.extend(pieces(mesh, triangle, at));
    }
    mesh.triangles = triangles;
    cuts
}

/// The parts of a triangle whose edges ab, bc, ca are cut at the given vertices.
fn pieces(mesh: &Mesh, [a, b, c]: [u32; 3], cut: [Option<u32>; 3]) -> Vec<[u32; 3]> {
    match cut {
        [None, None, None] => vec![[a, b, c]],
        [Some(ab), None, None] => vec![[a, ab, c], [ab, b, c]],
        [None, Some(bc), None] => vec![[b, bc, a], [bc, c, a]],
        [None, None, Some(ca)] => vec![[c, ca, b], [ca, a, b]],
        [Some(ab), Some(bc), None] => corner_cut(mesh, [b, c, a], bc, ab),
        [None, Some(bc), Some(ca)] => corner_cut(mesh, [c, a, b], ca, bc),
        [Some(ab), None, Some(ca)] => corner_cut(mesh, [a, b, c], ab, ca),
        [Some(ab), Some(bc), Some(ca)] => vec![[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]],
    }
}

/// Cuts corner `a` off at `ab` and `ca`; the rest is halved along its shorter diagonal.
fn corner_cut(mesh: &Mesh, [a, b, c]: [u32; 3], ab: u32, ca: u32) -> Vec<[u32; 3]> {
    let mut parts = vec![[a, ab, ca]];
    if length(mesh, [ab, c]) <= length(mesh, [b, ca]) {
        parts.extend([[ab, b, c], [ab, c, ca]]);
    } else {
        parts.extend([[ab, b, ca], [b, c, ca]]);
    }
    parts
}

/// Adds the vertex at a share of the way along an edge.
pub(crate) fn add_between(mesh: &mut Mesh, [a, b]: Edge, share: f32) -> u32 {
    let (a, b) = (a as usize, b as usize);
    let index = mesh.positions.len() as u32;
    let (of_a, of_b) = (1.0 - share, share);
    mesh.positions.push(of_a * mesh.positions[a] + of_b * mesh.positions[b]);
    if !mesh.normals.is_empty() {
        let normal: Vec3 = of_a * mesh.normals[a] + of_b * mesh.normals[b];
        mesh.normals.push(normal.try_normalize().unwrap_or(mesh.normals[a]));
    }
    if !mesh.tangents.is_empty() {
        let (ta, tb): (Vec4, Vec4) = (mesh.tangents[a], mesh.tangents[b]);
        let tangent = (of_a * ta + of_b * tb).truncate().try_normalize().unwrap_or(ta.truncate());
        mesh.tangents.push(tangent.extend(ta.w));
    }
    if !mesh.uv0.is_empty() {
        mesh.uv0.push(of_a * mesh.uv0[a] + of_b * mesh.uv0[b]);
    }
    if !mesh.uv1.is_empty() {
        mesh.uv1.push(of_a * mesh.uv1[a] + of_b * mesh.uv1[b]);
    }
    if !mesh.colors.is_empty() {
        mesh.colors.push(of_a * mesh.colors[a] + of_b * mesh.colors[b]);
    }
    index
}
