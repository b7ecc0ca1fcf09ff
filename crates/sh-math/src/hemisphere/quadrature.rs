//! A rule for integrals over the hemisphere that is exact for the products of these bases.

use crate::legendre;
use glam::DVec3;
use std::f64::consts::TAU;

/// Points in `t = sqrt z`; more than enough for 16 digits.
const HEIGHTS: usize = 28;
/// Equal steps in longitude: exact for products of frequencies 4 and 4.
const LONGITUDES: usize = 12;

/// Unit directions of the upper hemisphere with weights that sum to 2 pi.
///
/// Exact to rounding for products of any two functions of [`super::Basis`] and of spherical harmonics of 5 bands. The Gauss
/// points lie in `t = sqrt z`: `sqrt z` is a polynomial there and `sqrt(1 + z)` is analytic with its singularity far away.
#[must_use]
pub fn quadrature() -> Vec<(DVec3, f64)> {
    let mut points = Vec::with_capacity(HEIGHTS * LONGITUDES);
    for (node, weight) in legendre::gauss_rule(HEIGHTS) {
        let t = 0.5 * (node + 1.0);
        let z = t * t;
        let radius = ((1.0 - z) * (1.0 + z)).sqrt();
        // half of the interval, dz = 2 t dt
        let weight = weight * t * TAU / LONGITUDES as f64;
        for step in 0..LONGITUDES {
            let (sine, cosine) = libm::sincos(TAU * (step as f64 + 0.5) / LONGITUDES as f64);
            points.push((DVec3::new(radius * cosine, radius * sine, z), weight));
        }
    }
    points
}
