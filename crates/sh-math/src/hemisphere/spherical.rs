//! Spherical harmonics as a basis of the hemisphere (eqs. 1.9 to 1.17).
//!
//! The functions are those of the sphere and so not orthonormal here: each has the square norm 1/2, neighbours in `l`
//! overlap, and 9 of them have the condition number 254. Coefficients for the hemisphere come from least squares; the
//! first 4 of 9 coefficients of the sphere have 1.88 times the error.
//!
//! Printed wrong: eq. 1.12 lacks its factor `x`, the angular form of eq. 1.13 is twice too large.
//!
//! At the border nothing happens: they are polynomials.

use crate::straight;
use crate::value::Value;

/// `count` is 4 or 9.
#[inline(always)]
pub(super) fn visit<V: Value>(count: usize, direction: [V; 3], mut put: impl FnMut(usize, V)) {
    let bands = if count > 4 { 3 } else { 2 };
    straight::evaluate_into(bands, direction, &mut put);
}
