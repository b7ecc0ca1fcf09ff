//! Maps from the unit square to directions, each with its density and its inverse.
//!
//! Each set holds `square_to_x`, `x_pdf` (per solid angle) and `x_to_square`, in a local frame with `z` up. All maps
//! but the concentric one are polar: the first coordinate is the share of the (weighted) area from the pole down, the
//! second the longitude; a lattice in the square stays a spiral on the sphere.

mod cone;
mod cosine;
mod sphere;

pub use cone::{cone_height, cone_pdf, cone_to_square, square_to_cone};
pub use cosine::{
    cosine_concentric_pdf, cosine_concentric_to_square, cosine_hemisphere_pdf, cosine_hemisphere_to_square,
    square_to_cosine_concentric, square_to_cosine_hemisphere,
};
pub use sphere::{
    square_to_uniform_hemisphere, square_to_uniform_sphere, uniform_hemisphere_pdf, uniform_hemisphere_to_square,
    uniform_sphere_pdf, uniform_sphere_to_square,
};

use std::f32::consts::TAU;

/// Largest f32 below 1: squares are half open.
const BELOW_ONE: f32 = 1.0 - f32::EPSILON / 2.0;

/// Sine and cosine of a longitude in turns.
#[inline]
fn sincos_turn(turn: f32) -> (f32, f32) {
    libm::sincosf(TAU * turn)
}

/// Longitude in turns, `[0, 1)`.
#[inline]
fn turn_of(x: f32, y: f32) -> f32 {
    let turn = libm::atan2f(y, x) * (1.0 / TAU);
    (if turn < 0.0 { turn + 1.0 } else { turn }).min(BELOW_ONE)
}
