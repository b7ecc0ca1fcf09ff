//! All basis functions at one direction.

use crate::value::Value;
use crate::{Bands, recurrence, straight};
use glam::{DVec3, Vec3};

/// Writes the basis functions at the unit vector `direction` (world axes) into `out[0..bands^2]`.
///
/// Straight-line code to 8 bands, the recurrence above. Values are those of the polynomial: a vector that is `d` too long
/// errs by about `l (l + 1) / 2 * d`.
///
/// # Panics
/// When `out` is shorter than `bands.coefficients()`.
#[inline]
pub fn evaluate(bands: Bands, direction: Vec3, out: &mut [f32]) {
    let out = &mut out[..bands.coefficients()];
    visit(bands, direction.to_array(), |i, value| out[i] = value);
}

/// [`evaluate`] in f64.
///
/// # Panics
/// When `out` is shorter than `bands.coefficients()`.
#[inline]
pub fn evaluate_f64(bands: Bands, direction: DVec3, out: &mut [f64]) {
    let out = &mut out[..bands.coefficients()];
    visit(bands, direction.to_array(), |i, value| out[i] = value);
}

/// Hands every function at `direction` to `put` with its index, in no particular order of the indices.
#[inline(always)]
pub(crate) fn visit<V: Value>(bands: Bands, direction: [V; 3], mut put: impl FnMut(usize, V)) {
    if !straight::evaluate_into(bands.count(), direction, &mut put) {
        recurrence::evaluate_into(bands.count(), direction, put);
    }
}
