//! All basis functions at many directions, structure of arrays.

use crate::Bands;
use crate::evaluate::visit;
use crate::value::{Block, LANES, Real};

/// Writes function `i` at direction `j` of the unit vectors `(xs[j], ys[j], zs[j])` into `out[i * xs.len() + j]`.
///
/// Works on blocks of directions that the compiler turns into vector instructions; every value equals the scalar
/// [`crate::evaluate`] bit for bit. At a row length of a multiple of 1024 f32 the rows share one set of the first-level
/// cache and writing them takes three times as long; pad such a table where its time matters.
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
        visit(bands, block, |i, value| {
            out[i * n + first..i * n + first + LANES].copy_from_slice(&value.0);
        });
    }
    if whole < n {
        let block = [xs, ys, zs].map(|component| load(&component[whole..]));
        visit(bands, block, |i, value| {
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
