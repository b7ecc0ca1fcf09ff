//! Real spherical harmonics: evaluation, projection, rotation, windows; and the bases of the hemisphere.
//!
//! This crate is the only place that knows the sign, the index and the normalisation of a basis function:
//!
//! - real and orthonormal over the sphere, **without** the Condon-Shortley phase;
//! - function `(l, m)` has the index `l (l + 1) + m`; `m < 0` goes with `sin(|m| phi)`, `m > 0` with `cos(m phi)`;
//! - so the second band is `sqrt(3 / (4 pi)) (y, z, x)`;
//! - the axes are those of the world; `n` bands are the degrees `0..n` and hold `n^2` coefficients.
//!
//! `docs/conventions.md` states the same in words and numbers, `docs/math.md` names the function that holds each equation.
//! Everything is deterministic: square roots and the four operations, `libm` where an angle is needed, no fused
//! multiply-add, sums in a fixed order.

mod bands;
mod batch;
pub mod brdf;
mod double_double;
mod euler;
mod evaluate;
mod heading;
pub mod hemisphere;
mod legendre;
mod light;
pub mod light_matrix;
pub mod lobe;
pub mod product;
mod project;
mod quarter_turn;
pub mod recurrence;
pub mod rotate;
mod straight;
mod value;
pub mod window;
pub mod zonal;

pub use bands::{Bands, index};
pub use batch::evaluate_batch;
pub use evaluate::{evaluate, evaluate_f64};
pub use heading::{LUMINANCE, heading};
pub use light::Rgb;
pub use project::{project, project_scalar};
pub use value::Real;

/// Id of the convention above; files carry it so that coefficients are never read with another meaning.
pub const CONVENTION: &str = "real-orthonormal-nophase-yzx-1";
