//! The basis of Half-Life 2: three cosine lobes around directions at right angles (eqs. 1.18 to 1.21).
//!
//! Orthonormal on the hemisphere. On the whole sphere, where the paper calls it orthonormal too, its Gram matrix is 2.
//! It holds no constant, so that its error grows with the mean of the signal.
//!
//! At the border nothing happens: the functions are linear.

use crate::value::Value;
use std::f64::consts::PI;

/// The three directions in tangent space, in the order of the coefficients.
#[must_use]
pub fn directions() -> [[f64; 3]; 3] {
    let up = (1.0_f64 / 3.0).sqrt();
    let (side, across) = ((1.0_f64 / 6.0).sqrt(), 0.5_f64.sqrt());
    [[-side, -across, up], [-side, across, up], [2.0 * side, 0.0, up]]
}

/// `sqrt(3 / 2 pi) n . h_i`.
#[inline(always)]
pub(super) fn visit<V: Value>([x, y, z]: [V; 3], mut put: impl FnMut(usize, V)) {
    let scale = (1.5 / PI).sqrt();
    let [along_x, along_y, along_z] =
        [(1.0_f64 / 6.0).sqrt(), 0.5_f64.sqrt(), (1.0_f64 / 3.0).sqrt()].map(|c| V::of(scale * c));
    let up = along_z * z;
    let (side, across) = (along_x * x, along_y * y);
    put(0, up - side - across);
    put(1, up - side + across);
    put(2, up + side + side);
}
