//! Five-point Gauss-Legendre quadrature.

/// Abscissas and weights on [-1, 1]: zeros of P5, `0, +-(1/3) sqrt(5 -+ 2 sqrt(10/7))`, weights
/// `128/225, (322 +- 13 sqrt 70)/900`; exact for polynomials up to degree 9.
pub(crate) fn gauss5() -> [(f64, f64); 5] {
    let (s, t) = (libm::sqrt(10.0 / 7.0), libm::sqrt(70.0));
    let inner = libm::sqrt(5.0 - 2.0 * s) / 3.0;
    let outer = libm::sqrt(5.0 + 2.0 * s) / 3.0;
    let (wide, narrow) = ((322.0 + 13.0 * t) / 900.0, (322.0 - 13.0 * t) / 900.0);
    [(-outer, narrow), (-inner, wide), (0.0, 128.0 / 225.0), (inner, wide), (outer, narrow)]
}
