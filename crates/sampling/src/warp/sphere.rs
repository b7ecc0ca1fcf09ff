//! Uniform directions on the sphere and on the upper hemisphere.

use super::{BELOW_ONE, sincos_turn, turn_of};
use glam::Vec3;
use std::f32::consts::{FRAC_1_PI, PI};

/// Uniform on the sphere: `theta = 2 acos sqrt(1 - x)`, `phi = 2 pi y` (PRT paper, eq. 21), from +z down.
#[inline]
#[must_use]
pub fn square_to_uniform_sphere([x, y]: [f32; 2]) -> Vec3 {
    // cos(2 acos sqrt(1 - x)) = 1 - 2x, and sin = 2 sqrt(x (1 - x)): no arc cosine needed.
    let (sin, cos) = sincos_turn(y);
    let r = 2.0 * (x * (1.0 - x)).max(0.0).sqrt();
    Vec3::new(r * cos, r * sin, 1.0 - 2.0 * x)
}

/// Density of [`square_to_uniform_sphere`] per solid angle.
#[inline]
#[must_use]
pub fn uniform_sphere_pdf(_direction: Vec3) -> f32 {
    0.25 * FRAC_1_PI
}

/// Inverse of [`square_to_uniform_sphere`].
#[inline]
#[must_use]
pub fn uniform_sphere_to_square(direction: Vec3) -> [f32; 2] {
    [(0.5 * (1.0 - direction.z)).clamp(0.0, BELOW_ONE), turn_of(direction.x, direction.y)]
}

/// Uniform on the upper hemisphere, from +z down.
#[inline]
#[must_use]
pub fn square_to_uniform_hemisphere([x, y]: [f32; 2]) -> Vec3 {
    let (sin, cos) = sincos_turn(y);
    let r = (x * (2.0 - x)).max(0.0).sqrt();
    Vec3::new(r * cos, r * sin, 1.0 - x)
}

/// Density of [`square_to_uniform_hemisphere`] per solid angle; 0 below the horizon.
#[inline]
#[must_use]
pub fn uniform_hemisphere_pdf(direction: Vec3) -> f32 {
    if direction.z < 0.0 { 0.0 } else { 0.5 / PI }
}

/// Inverse of [`square_to_uniform_hemisphere`].
#[inline]
#[must_use]
pub fn uniform_hemisphere_to_square(direction: Vec3) -> [f32; 2] {
    [(1.0 - direction.z).clamp(0.0, BELOW_ONE), turn_of(direction.x, direction.y)]
}
