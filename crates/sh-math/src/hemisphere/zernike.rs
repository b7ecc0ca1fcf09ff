//! Zernike polynomials, carried from the disc to the hemisphere without changing areas (eqs. 1.46 to 1.51).
//!
//! The order is `Z00, Z1-1, Z11, Z2-2, Z20, Z22`. Printed wrong: the sign of the Cartesian form of 1.48. Z1-1 and Z2-2
//! keep the minus that both of their printed forms have.
//!
//! At the border they vary as `1, -y, x, -xy, 1, x^2 - y^2` (times constants): no special value, finite slope.

use crate::value::Root;
use std::f64::consts::PI;

/// `count` is 3 or 6.
#[inline(always)]
pub(super) fn visit<V: Root>(count: usize, [x, y, z]: [V; 3], mut put: impl FnMut(usize, V)) {
    let one = V::of(1.0);
    let above = one + z;
    let radial = V::of((2.0 / PI).sqrt()) / above.sqrt();
    put(0, V::of((0.5 / PI).sqrt()));
    put(1, V::of(-1.0) * radial * y);
    put(2, radial * x);
    if count > 3 {
        let flat = V::of((3.0 / PI).sqrt()) / above;
        put(3, V::of(-2.0) * flat * x * y);
        put(4, V::of((1.5 / PI).sqrt()) * (one - z - z));
        put(5, flat * (x - y) * (x + y));
    }
}
