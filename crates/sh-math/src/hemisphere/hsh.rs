//! Hemispherical harmonics: spherical harmonics with `cos theta` replaced by `2 cos theta - 1` (eqs. 1.22 to 1.32).
//!
//! Printed wrong: the sign of the Cartesian form of 1.23, those of the angular forms of 1.26 and 1.32, and 1.30, whose
//! `sin phi` must be `cos phi`. All functions here have the sign of the harmonic that they come from.
//!
//! At the border only `m = 0` is left: `sqrt(1/2pi)`, `-sqrt(3/2pi)` and `sqrt(5/2pi)`, one colour for all of it. The
//! functions of odd `m` arrive there with infinite slope in `z`.

use crate::value::Root;
use std::f64::consts::PI;

/// `count` is 4 or 9.
#[inline(always)]
pub(super) fn visit<V: Root>(count: usize, [x, y, z]: [V; 3], mut put: impl FnMut(usize, V)) {
    let one = V::of(1.0);
    let ratio = z / (one + z);
    let root = ratio.sqrt();
    let shifted = z + z - one;
    let linear = V::of((6.0 / PI).sqrt()) * root;
    put(0, V::of((0.5 / PI).sqrt()));
    put(1, linear * y);
    put(2, V::of((1.5 / PI).sqrt()) * shifted);
    put(3, linear * x);
    if count > 4 {
        let quadratic = V::of((30.0 / PI).sqrt());
        let (tilted, flat) = (quadratic * shifted * root, quadratic * ratio);
        put(4, (flat + flat) * x * y);
        put(5, tilted * y);
        put(6, V::of((2.5 / PI).sqrt()) * (V::of(6.0) * z * (z - one) + one));
        put(7, tilted * x);
        put(8, flat * (x - y) * (x + y));
    }
}
