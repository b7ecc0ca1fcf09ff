//! The H-basis of Habel and Wimmer: six polynomials, orthonormal on the hemisphere (eqs. 1.52 to 1.57).
//!
//! The order is that of the paper: `1, y, 2z - 1, x, xy, x^2 - y^2` (times constants). The last two are orthogonal to the
//! first four, so that leaving them out is the best that four functions can do.
//!
//! At the border nothing happens: they are polynomials.

use crate::value::Value;
use std::f64::consts::PI;

/// `count` is 4 or 6.
#[inline(always)]
pub(super) fn visit<V: Value>(count: usize, [x, y, z]: [V; 3], mut put: impl FnMut(usize, V)) {
    let linear = V::of((1.5 / PI).sqrt());
    put(0, V::of((0.5 / PI).sqrt()));
    put(1, linear * y);
    put(2, linear * (z + z - V::of(1.0)));
    put(3, linear * x);
    if count > 4 {
        quadratic([x, y], put);
    }
}

/// The functions 5 and 6, which the modified basis shares.
#[inline(always)]
pub(super) fn quadratic<V: Value>([x, y]: [V; 2], mut put: impl FnMut(usize, V)) {
    put(4, V::of((7.5 / PI).sqrt()) * x * y);
    put(5, V::of((1.875 / PI).sqrt()) * (x - y) * (x + y));
}
