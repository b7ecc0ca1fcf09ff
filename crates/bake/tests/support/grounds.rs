//! Flat ground, cut into slivers or into compact triangles.

use glam::{Vec3, vec3};
use scene::Mesh;
use std::f32::consts::TAU;

/// Ground by its number of triangles.
pub(crate) type Kind = (&'static str, fn(u32) -> Mesh);

fn rim(n: u32, radius: impl Fn(u32) -> f32) -> Vec<Vec3> {
    let at = |k: u32| (radius(k), k as f32 / n as f32 * TAU);
    (0..n).map(at).map(|(r, a)| vec3(r * a.sin(), 0.0, r * a.cos())).collect()
}

fn around_middle(mut positions: Vec<Vec3>) -> Mesh {
    let n = positions.len() as u32;
    positions.push(Vec3::ZERO);
    Mesh { positions, triangles: (0..n).map(|k| [n, k, (k + 1) % n]).collect(), ..Mesh::default() }
}

pub(crate) fn disc(n: u32) -> Mesh {
    around_middle(rim(n, |_| 3.0))
}

pub(crate) fn star(n: u32) -> Mesh {
    around_middle(rim(n, |k| if k % 2 == 0 { 3.0 } else { 2.1 }))
}

/// A convex n-gon, cut from one of its corners.
pub(crate) fn polygon(n: u32) -> Mesh {
    Mesh { positions: rim(n, |_| 3.0), triangles: (1..n - 1).map(|k| [0, k, k + 1]).collect(), ..Mesh::default() }
}

pub(crate) fn compact(n: u32) -> Mesh {
    let side = (n as f32 / 2.0).sqrt() as u32;
    let (at, m) = (|k: u32| 6.0 * k as f32 / side as f32 - 3.0, side + 1);
    let cells = (0..side * side).map(|k| k % side + k / side * m);
    let triangles = cells.flat_map(|i| [[i, i + m, i + 1], [i + 1, i + m, i + m + 1]]).collect();
    Mesh { positions: (0..m * m).map(|k| vec3(at(k % m), 0.0, at(k / m))).collect(), triangles, ..Mesh::default() }
}
