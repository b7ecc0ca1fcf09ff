//! A sphere from outside and half a sphere from inside.

use glam::Vec3;

use super::patch::{Patches, camera, matte, scene, turn};
use crate::{Mesh, Scene};

/// Albedo of the bowl: grey, so that one channel suffices.
const BOWL_ALBEDO: f64 = 0.8;

/// A unit sphere at the origin, 64 x 32 quads, closed; albedo 0.6.
///
/// Convex: transfer is the clamped cosine about the normal; radiance = a for any number of bounces (receivers
/// are the vertices, whose neighbours lie below their horizon).
pub(super) fn sphere() -> Scene {
    let ball = ball(Vec3::ZERO, 1.0, 64, 32).clone_as("sphere", 0);
    scene(
        "sphere",
        vec![matte("grey", Vec3::splat(0.6))],
        vec![ball],
        camera(Vec3::new(0.0, 1.0, 4.0), Vec3::ZERO, 40.0),
    )
}

/// The lower half of a unit sphere seen from inside, 96 x 24 quads, open at the top (y = 0); albedo 0.8.
///
/// Inside a sphere the form factor to any part is its share of the sphere's area, from every point, so half the
/// hemisphere sees the sky and half the bowl: [`bowl_radiance`].
pub(super) fn bowl() -> Scene {
    let inside = Patches::default()
        .grid(96, 24, |s, t| {
            // From the rim down to the bottom, so that the patch faces the centre.
            let outward = direction(s, 0.5 + 0.5 * t);
            (outward, -outward)
        })
        .finish("bowl", 0);
    scene(
        "bowl",
        vec![matte("grey", Vec3::splat(BOWL_ALBEDO as f32))],
        vec![inside],
        camera(Vec3::new(0.0, 2.2, 2.2), Vec3::new(0.0, -0.4, 0.0), 40.0),
    )
}

/// Radiance of every point of `bowl` under a sky of radiance 1 after `bounces` reflections between its parts
/// (0 = direct light only): a (1 - f) sum over j = 0..=bounces of (a f)^j with f = 1/2.
pub fn bowl_radiance(bounces: u32) -> f64 {
    let f = 0.5;
    let mut term = BOWL_ALBEDO * (1.0 - f);
    let mut sum = term;
    for _ in 0..bounces {
        term *= BOWL_ALBEDO * f;
        sum += term;
    }
    sum
}

/// A closed sphere with outward normals.
pub(super) fn ball(center: Vec3, radius: f32, around: u32, rows: u32) -> Mesh {
    Patches::default()
        .grid(around, rows, |s, t| {
            let outward = direction(s, 1.0 - t);
            (center + radius * outward, outward)
        })
        .finish("ball", 0)
}

/// Unit direction at the share `s` of a turn about y and the share `polar` of the way from +y to -y.
pub(super) fn direction(s: f32, polar: f32) -> Vec3 {
    let (sin_turn, cos_turn) = turn(s);
    let (sin_polar, cos_polar) = turn(0.5 * polar);
    Vec3::new(sin_polar * sin_turn, cos_polar, sin_polar * cos_turn)
}

impl Mesh {
    /// The same mesh under another name and material.
    pub(super) fn clone_as(&self, name: &str, material: u32) -> Self {
        Self { name: name.into(), material, ..self.clone() }
    }
}
