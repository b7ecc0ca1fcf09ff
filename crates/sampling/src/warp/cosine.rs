//! Directions on the upper hemisphere in proportion to the cosine, by a polar and by a concentric map.

use super::{BELOW_ONE, sincos_turn, turn_of};
use glam::Vec3;
use std::f32::consts::{FRAC_1_PI, FRAC_PI_2, FRAC_PI_4};

/// Cosine-weighted, polar: a uniform disc by area and longitude, lifted to the hemisphere. Suits the Fibonacci lattice.
#[inline]
#[must_use]
pub fn square_to_cosine_hemisphere([x, y]: [f32; 2]) -> Vec3 {
    let (sin, cos) = sincos_turn(y);
    let r = x.sqrt();
    Vec3::new(r * cos, r * sin, (1.0 - x).max(0.0).sqrt())
}

/// Density of [`square_to_cosine_hemisphere`] per solid angle: `cos / pi`, 0 below the horizon.
#[inline]
#[must_use]
pub fn cosine_hemisphere_pdf(direction: Vec3) -> f32 {
    direction.z.max(0.0) * FRAC_1_PI
}

/// Inverse of [`square_to_cosine_hemisphere`].
#[inline]
#[must_use]
pub fn cosine_hemisphere_to_square(direction: Vec3) -> [f32; 2] {
    let Vec3 { x, y, .. } = direction;
    [(x * x + y * y).min(BELOW_ONE), turn_of(x, y)]
}

/// Cosine-weighted, concentric: squares around the centre become circles (Shirley and Chiu 1997), lifted.
#[inline]
#[must_use]
pub fn square_to_cosine_concentric([x, y]: [f32; 2]) -> Vec3 {
    let (a, b) = (2.0 * x - 1.0, 2.0 * y - 1.0);
    // The radius is the larger coordinate; the smaller runs along an eighth of the circle.
    let (radius, angle) = if a.abs() > b.abs() {
        (a, FRAC_PI_4 * (b / a))
    } else if b != 0.0 {
        (b, FRAC_PI_2 - FRAC_PI_4 * (a / b))
    } else {
        (0.0, 0.0)
    };
    let (sin, cos) = libm::sincosf(angle);
    Vec3::new(radius * cos, radius * sin, (1.0 - radius * radius).max(0.0).sqrt())
}

/// Density of [`square_to_cosine_concentric`] per solid angle: `cos / pi`, 0 below the horizon.
#[inline]
#[must_use]
pub fn cosine_concentric_pdf(direction: Vec3) -> f32 {
    cosine_hemisphere_pdf(direction)
}

/// Inverse of [`square_to_cosine_concentric`].
#[inline]
#[must_use]
pub fn cosine_concentric_to_square(direction: Vec3) -> [f32; 2] {
    let Vec3 { x, y, .. } = direction;
    let radius = (x * x + y * y).sqrt();
    let (a, b) = if x.abs() > y.abs() {
        let a = radius.copysign(x);
        (a, a * libm::atan2f(y * x.signum(), x.abs()) / FRAC_PI_4)
    } else if y != 0.0 {
        let b = radius.copysign(y);
        (b * libm::atan2f(x * y.signum(), y.abs()) / FRAC_PI_4, b)
    } else {
        (0.0, 0.0)
    };
    [a, b].map(|v| (0.5 * (v + 1.0)).clamp(0.0, BELOW_ONE))
}
