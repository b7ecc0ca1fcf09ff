//! The modified H-basis: the third function becomes `sqrt(3/2pi) (1 - z)` (eq. 1.58).
//!
//! All functions but the first are 0 at `z = 1`, so that the first coefficient alone is a light map and the level of
//! detail is cut after 6, 4 or 1 coefficients. From 6 to 4 the cut is the best that four functions can do. From 4 to 1 it
//! keeps the value at the surface's own normal; the constant with the least error over the hemisphere is another one.
//!
//! Not orthonormal: functions 1 and 3 have the inner product `sqrt(3)/2`. Coefficients come from least squares, which
//! here is `H3 = sqrt(3) H1 - 2 H3mod`. At the border nothing happens: they are polynomials.

use super::h;
use crate::value::Value;
use std::f64::consts::PI;

/// `count` is 1, 4 or 6.
#[inline(always)]
pub(super) fn visit<V: Value>(count: usize, [x, y, z]: [V; 3], mut put: impl FnMut(usize, V)) {
    put(0, V::of((0.5 / PI).sqrt()));
    if count > 1 {
        let linear = V::of((1.5 / PI).sqrt());
        put(1, linear * y);
        put(2, linear * (V::of(1.0) - z));
        put(3, linear * x);
    }
    if count > 4 {
        h::quadratic([x, y], put);
    }
}
