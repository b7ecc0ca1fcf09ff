//! Makhotkin's basis: shifted Jacobi polynomials times `sqrt(cos theta)` (eqs. 1.33 to 1.45).
//!
//! Printed wrong: the Cartesian forms of 1.33 (`sqrt z`, not `z`) and of 1.42 (8, not 16). The paper gives `m = -1` and
//! `m = -2` the cosine; here they have the sine, as in every other basis.
//!
//! At the border every function is 0, those with `sqrt z` with infinite slope: the basis can only be black there.

use crate::value::Root;
use std::f64::consts::PI;

/// `count` is 4 or 9.
#[inline(always)]
pub(super) fn visit<V: Root>(count: usize, [x, y, z]: [V; 3], mut put: impl FnMut(usize, V)) {
    let one = V::of(1.0);
    let (root, above) = (z.sqrt(), one + z);
    let lobe = V::of((3.0 / PI).sqrt()) * z / above.sqrt();
    put(0, V::of((1.0 / PI).sqrt()) * root);
    put(1, (lobe + lobe) * y);
    put(2, V::of((0.5 / PI).sqrt()) * root * (V::of(6.0) * z - V::of(4.0)));
    put(3, (lobe + lobe) * x);
    if count > 4 {
        let flat = V::of((60.0 / PI).sqrt()) * z * root / above;
        let tilted = lobe * (V::of(10.0) * z - V::of(6.0));
        // 1 + 8 (z - 1) + 10 (z - 1)^2
        let hollow = (V::of(10.0) * z - V::of(12.0)) * z + V::of(3.0);
        put(4, (flat + flat) * x * y);
        put(5, tilted * y);
        put(6, V::of((3.0 / PI).sqrt()) * root * hollow);
        put(7, tilted * x);
        put(8, flat * (x - y) * (x + y));
    }
}
