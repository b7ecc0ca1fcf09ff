//! All basis functions at many directions, structure of arrays.

use crate::value::{Block, LANES, Real};
use crate::{Bands, recurrence, straight};

/// Writes function `i` at direction `j` of the unit vectors `(xs[j], ys[j], zs[j])` into `out[i * xs.len() + j]`.
///
/// Works on blocks of directions that the compiler turns into vector instructions; every value equals the scalar
/// [`crate::evaluate`] bit for bit.
///
/// # Panics
/// When `ys` or `zs` is not as long as `xs`, or `out` is shorter than `bands.coefficients() * xs.len()`.
pub fn evaluate_batch<T: Real>(bands: Bands, xs: &[T], ys: &[T], zs: &[T], out: &mut [T]) {
    let n = xs.len();
    assert!(ys.len() == n && zs.len() == n, "the three components need one length");
    let out = &mut out[..bands.coefficients() * n];
    let whole = n - n % LANES;
    for first in (0..whole).step_by(LANES) {
        let block = [xs, ys, zs].map(|component| load(&component[first..first + LANES]));
        evaluate_block(bands, block, |i, value| {
            out[i * n + first..i * n + first + LANES].copy_from_slice(&value.0);
        });
    }
    if whole < n {
        let block = [xs, ys, zs].map(|component| load(&component[whole..]));
        evaluate_block(bands, block, |i, value| {
            out[i * n + whole..(i + 1) * n].copy_from_slice(&value.0[..n - whole]);
        });
    }
}

/// Up to [`LANES`] numbers; what is missing is zero.
#[inline(always)]
fn load<T: Real>(source: &[T]) -> Block<T> {
    let mut block = Block([T::default(); LANES]);
    block.0[..source.len()].copy_from_slice(source);
    block
}

/// One block through the straight-line code or the recurrence.
#[inline(always)]
fn evaluate_block<T: Real>(bands: Bands, direction: [Block<T>; 3], mut put: impl FnMut(usize, Block<T>)) {
    if !straight::evaluate_into(bands.count(), direction, &mut put) {
        recurrence::evaluate_into(bands.count(), direction, put);
    }
}
