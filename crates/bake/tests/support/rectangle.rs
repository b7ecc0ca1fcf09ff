//! A rectangle as tests build their rooms of.

use glam::Vec3;
use scene::Mesh;

/// A rectangle of quads from a corner along two sides, seen from where their cross product points.
pub(crate) fn rectangle(corner: Vec3, along: Vec3, across: Vec3, [columns, rows]: [u32; 2]) -> Mesh {
    let n = columns + 1;
    let at = |i: u32| corner + along * ((i % n) as f32 / columns as f32) + across * ((i / n) as f32 / rows as f32);
    let quads = (0..columns * rows).map(|k| (k % columns) + (k / columns) * n);
    Mesh {
        positions: (0..n * (rows + 1)).map(at).collect(),
        normals: vec![along.cross(across).normalize(); (n * (rows + 1)) as usize],
        triangles: quads.flat_map(|a| [[a, a + 1, a + n + 1], [a, a + n + 1, a + n]]).collect(),
        ..Mesh::default()
    }
}
