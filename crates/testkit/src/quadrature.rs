//! Gauss-Legendre points and a product rule on the sphere: oracles for integrals of smooth functions; and a rule for those that
//! are not smooth at the rim of the hemisphere.

use std::f64::consts::{FRAC_PI_2, PI, TAU};

/// Nodes and weights of the `n`-point rule on [-1, 1], exact for polynomials of degree `2n - 1`.
#[must_use]
pub fn gauss_legendre(n: usize) -> Vec<(f64, f64)> {
    (1..=n).map(|i| node(n, i)).collect()
}

/// The `i`-th root of P_n, ascending, by Newton's method from Tricomi's guess, with its weight.
fn node(n: usize, i: usize) -> (f64, f64) {
    let mut x = -libm::cos(PI * (i as f64 - 0.25) / (n as f64 + 0.5));
    let mut slope = 1.0;
    for _ in 0..20 {
        let (value, derivative) = legendre(n, x);
        slope = derivative;
        let step = value / derivative;
        x -= step;
        if step.abs() < 1e-16 {
            break;
        }
    }
    (x, 2.0 / ((1.0 - x * x) * slope * slope))
}

/// P_n(x) and its derivative by the three-term recurrence.
fn legendre(n: usize, x: f64) -> (f64, f64) {
    let (mut previous, mut current) = (0.0, 1.0);
    for k in 1..=n {
        let k = k as f64;
        (previous, current) = (current, ((2.0 * k - 1.0) * x * current - (k - 1.0) * previous) / k);
    }
    (current, n as f64 * (x * current - previous) / (x * x - 1.0))
}

/// Unit directions of the hemisphere above `z = 0` with weights that sum to 2 pi, by the tanh-sinh rule in z times 16 equal steps in
/// longitude.
///
/// Roots at the ends of the interval do not trouble it, as they do Gauss points in z, and it shares nothing with them.
#[must_use]
pub fn hemisphere_tanh_sinh() -> Vec<([f64; 3], f64)> {
    let step = 1.0 / 16.0;
    let mut points = Vec::new();
    for k in -60..=60 {
        let s = step * f64::from(k);
        let inner = FRAC_PI_2 * libm::sinh(s);
        // z = (1 + tanh) / 2, written so that it stays exact next to 0
        let z = 1.0 / (1.0 + libm::exp(-2.0 * inner));
        let weight = step * 0.5 * FRAC_PI_2 * libm::cosh(s) / libm::cosh(inner).powi(2) * TAU / 16.0;
        let r = (1.0 - z * z).max(0.0).sqrt();
        points.extend((0..16).map(|j| {
            let (sin, cos) = libm::sincos(TAU * f64::from(j) / 16.0);
            ([r * cos, r * sin, z], weight)
        }));
    }
    points
}

/// Unit directions with weights that sum to 4 pi; exact for spherical harmonics of degree `2n - 1`.
///
/// Gauss points in z times `2n` equal steps in longitude.
#[must_use]
pub fn sphere_quadrature(n: usize) -> Vec<([f64; 3], f64)> {
    band_quadrature(-1.0, 1.0, n)
}

/// The same for the part of the sphere with `z` in `low..high`: hemispheres and cones without an edge error.
#[must_use]
pub fn band_quadrature(low: f64, high: f64, n: usize) -> Vec<([f64; 3], f64)> {
    let n_phi = 2 * n;
    let mut points = Vec::with_capacity(n * n_phi);
    for (node, weight) in gauss_legendre(n) {
        let z = low + (high - low) * 0.5 * (node + 1.0);
        let r = (1.0 - z * z).max(0.0).sqrt();
        let weight = weight * 0.5 * (high - low) * TAU / n_phi as f64;
        for j in 0..n_phi {
            let (sin, cos) = libm::sincos(TAU * (j as f64 + 0.5) / n_phi as f64);
            points.push(([r * cos, r * sin, z], weight));
        }
    }
    points
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::assert_close;

    fn moment(n: usize, power: i32) -> f64 {
        gauss_legendre(n).iter().map(|(x, w)| w * x.powi(power)).sum()
    }

    #[test]
    fn gauss_integrates_monomials() {
        for n in [1, 2, 5, 16, 64] {
            for k in 0..n as i32 {
                assert_close!(moment(n, 2 * k), 2.0 / (2 * k + 1) as f64, 1e-13, 0.0, "x^{} with {n} points", 2 * k);
                assert_close!(moment(n, 2 * k + 1), 0.0, 1e-13, 0.0);
            }
        }
    }

    #[test]
    fn gauss_beyond_its_degree_can_fail() {
        assert!((moment(3, 6) - 2.0 / 7.0).abs() > 1e-2, "three points end at degree 5");
    }

    #[test]
    fn sphere_integrates_products() {
        let integral = |f: fn([f64; 3]) -> f64| sphere_quadrature(8).iter().map(|&(d, w)| w * f(d)).sum::<f64>();
        assert_close!(integral(|_| 1.0), 4.0 * PI, 1e-12, 0.0);
        assert_close!(integral(|d| d[0] * d[0] * d[1] * d[1]), 4.0 * PI / 15.0, 1e-12, 0.0);
        assert_close!(integral(|d| d[2].powi(4)), 4.0 * PI / 5.0, 1e-12, 0.0);
        let cosine: f64 = band_quadrature(0.0, 1.0, 4).iter().map(|&(d, w)| w * d[2]).sum();
        assert_close!(cosine, PI, 1e-12, 0.0);
    }
}
