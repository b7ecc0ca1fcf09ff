//! Uniform directions in a cone around +z; exact for the half degree of the sun.
//!
//! A cone is told by its height `1 - cos(half angle)`, made once by [`cone_height`]: the cosine itself would lose
//! half the digits of a small cone.

use super::{BELOW_ONE, sincos_turn, turn_of};
use glam::Vec3;
use std::f32::consts::TAU;

/// Height `1 - cos(half_angle)` of the cap that a cone cuts from the unit sphere; `half_angle` in radians.
#[must_use]
pub fn cone_height(half_angle: f32) -> f32 {
    let sin = libm::sin(0.5 * f64::from(half_angle));
    (2.0 * sin * sin) as f32
}

/// Uniform by solid angle in the cone of the given height, from its axis outwards.
#[inline]
#[must_use]
pub fn square_to_cone([x, y]: [f32; 2], height: f32) -> Vec3 {
    let (sin, cos) = sincos_turn(y);
    let h = x * height;
    let r = (h * (2.0 - h)).max(0.0).sqrt();
    Vec3::new(r * cos, r * sin, 1.0 - h)
}

/// Density of [`square_to_cone`] per solid angle: `1 / (2 pi height)` inside, 0 outside.
#[inline]
#[must_use]
pub fn cone_pdf(direction: Vec3, height: f32) -> f32 {
    // A few roundings beyond the rim still count: the samples on it must not get density 0.
    if height_of(direction) <= height * (1.0 + 4.0 * f32::EPSILON) { 1.0 / (TAU * height) } else { 0.0 }
}

/// Inverse of [`square_to_cone`].
#[inline]
#[must_use]
pub fn cone_to_square(direction: Vec3, height: f32) -> [f32; 2] {
    [(height_of(direction) / height).min(BELOW_ONE), turn_of(direction.x, direction.y)]
}

/// `1 - z` of a unit direction without cancellation near the axis.
#[inline]
fn height_of(Vec3 { x, y, z }: Vec3) -> f32 {
    if z > 0.0 { (x * x + y * y) / (1.0 + z) } else { 1.0 - z }
}
