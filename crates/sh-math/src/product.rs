//! Triple products: integrals over the sphere of three spherical harmonics, of which most are 0.
//!
//! They turn the product of two functions into coefficients: `(f g)_k = sum_ij T_ijk f_i g_j` (\[T\] eqs. 2 and 3).

use crate::{Bands, evaluate_f64, legendre};
use glam::DVec3;
use std::f64::consts::{FRAC_1_SQRT_2, PI, TAU};

/// The integral of function `a` times function `b` times function `c`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Triple {
    /// Index of the first function.
    pub a: u32,
    /// Index of the second function.
    pub b: u32,
    /// Index of the third function.
    pub c: u32,
    /// The integral, never 0.
    pub value: f64,
}

/// Every integral of three functions, of so many bands each, that is not 0: by `a`, then `b`, then `c`.
///
/// With 5 bands each 1,158 of 15,625. Exact but for rounding: Gauss points for the Legendre functions, a closed form for the longitude.
#[must_use]
pub fn triples(a: Bands, b: Bands, c: Bands) -> Vec<Triple> {
    let most = a.count().max(b.count()).max(c.count());
    let degree = a.count() + b.count() + c.count() - 3;
    let heights: Vec<(Vec<f64>, f64)> =
        legendre::gauss_rule(degree / 2 + 1).into_iter().map(|(z, weight)| (meridian(most, z), weight)).collect();
    let integral = |functions: [(usize, isize); 3]| -> f64 {
        let longitude = longitudes(functions.map(|(_, m)| m));
        if longitude == 0.0 {
            return 0.0;
        }
        let slots = functions.map(|(l, m)| crate::index(l, m.abs()));
        let height = |(values, weight): &(Vec<f64>, f64)| weight * slots.iter().map(|&k| values[k]).product::<f64>();
        heights.iter().map(height).sum::<f64>() * longitude
    };
    let mut out = Vec::new();
    for (i, first) in functions(a).enumerate() {
        for (j, second) in functions(b).enumerate() {
            for (k, third) in functions(c).enumerate() {
                let all = [first, second, third];
                let value = if may_differ_from_zero(all.map(|(l, _)| l)) { integral(all) } else { 0.0 };
                // Symmetry makes some 0 that the rules for degrees allow: they come out as rounding.
                if value.abs() > 1e-12 {
                    out.push(Triple { a: i as u32, b: j as u32, c: k as u32, value });
                }
            }
        }
    }
    out
}

fn functions(bands: Bands) -> impl Iterator<Item = (usize, isize)> {
    bands.degrees().flat_map(|l| (-(l as isize)..=l as isize).map(move |m| (l, m)))
}

/// A triangle of degrees whose sum is even.
fn may_differ_from_zero([a, b, c]: [usize; 3]) -> bool {
    (a + b + c).is_multiple_of(2) && a <= b + c && b <= a + c && c <= a + b
}

/// The functions at longitude 0 without the root of 2 that those with a longitude have; where `m < 0`, 0.
fn meridian(bands: usize, z: f64) -> Vec<f64> {
    let bands = Bands::new(bands as u32).expect("the bands of one of the three");
    let mut values = vec![0.0; bands.coefficients()];
    evaluate_f64(bands, DVec3::new(((1.0 - z) * (1.0 + z)).sqrt(), 0.0, z), &mut values);
    for (value, (_, m)) in values.iter_mut().zip(functions(bands)) {
        if m != 0 {
            *value *= FRAC_1_SQRT_2;
        }
    }
    values
}

/// Integral over the longitude of `sqrt 2 cos(m phi)` for `m > 0`, `sqrt 2 sin(|m| phi)` for `m < 0`, 1 for 0, one for each order.
fn longitudes(orders: [isize; 3]) -> f64 {
    let sines = orders.iter().filter(|&&m| m < 0).count();
    if sines % 2 == 1 {
        return 0.0;
    }
    let scale = orders.iter().filter(|&&m| m != 0).fold(1.0, |scale, _| scale * std::f64::consts::SQRT_2);
    // The largest of the orders first; sums of two frequencies meet it or do not.
    let mut sorted = orders;
    sorted.sort_by_key(|m| std::cmp::Reverse(m.unsigned_abs()));
    let [large, middle, small] = sorted;
    if large.unsigned_abs() != middle.unsigned_abs() + small.unsigned_abs() {
        return 0.0;
    }
    let integral = match (middle, small) {
        (0, 0) => TAU,
        (_, 0) => PI,
        // cos p cos q = (cos(p + q) + ...) / 2, sin p sin q = -(cos(p + q) ...) / 2, sin p cos q = (sin(p + q) ...) / 2
        (p, q) if p < 0 && q < 0 => -0.5 * PI,
        _ => 0.5 * PI,
    };
    scale * integral
}

#[cfg(test)]
mod tests {
    use super::*;
    use testkit::quadrature::sphere_quadrature;

    fn bands(n: u32) -> Bands {
        Bands::new(n).unwrap()
    }

    /// The published number of terms: 83, 353, 1,158 and 2,907 for 3 to 6 bands; and two known values.
    #[test]
    fn known_counts_and_values() {
        for (n, count) in [(3, 83), (4, 353), (5, 1158), (6, 2907)] {
            assert_eq!(triples(bands(n), bands(n), bands(n)).len(), count, "{n} bands");
        }
        let all = triples(bands(3), bands(3), bands(3));
        let value = |a, b, c| all.iter().find(|t| (t.a, t.b, t.c) == (a, b, c)).map_or(0.0, |t| t.value);
        assert!((value(0, 0, 0) - 0.5 / PI.sqrt()).abs() < 1e-15);
        assert!((value(6, 6, 6) - (5.0 / PI).sqrt() / 7.0).abs() < 1e-15);
        assert_eq!(value(1, 2, 3), 0.0);
    }

    /// Largest difference between integrals and sums over points of the sphere.
    fn worst(points: usize, terms: &[Triple], [a, b, c]: [Bands; 3]) -> f64 {
        let mut dense = vec![0.0; a.coefficients() * b.coefficients() * c.coefficients()];
        let at = |i: usize, j: usize, k: usize| (i * b.coefficients() + j) * c.coefficients() + k;
        let mut values = [a, b, c].map(|n| vec![0.0; n.coefficients()]);
        for (direction, weight) in sphere_quadrature(points) {
            let direction = DVec3::from(direction);
            for (n, values) in [a, b, c].into_iter().zip(&mut values) {
                evaluate_f64(n, direction, values);
            }
            for (i, x) in values[0].iter().enumerate() {
                for (j, y) in values[1].iter().enumerate() {
                    for (k, z) in values[2].iter().enumerate() {
                        dense[at(i, j, k)] += weight * x * y * z;
                    }
                }
            }
        }
        for term in terms {
            dense[at(term.a as usize, term.b as usize, term.c as usize)] -= term.value;
        }
        dense.into_iter().fold(0.0, |worst: f64, rest| worst.max(rest.abs()))
    }

    #[test]
    fn every_integral_agrees_with_a_sum_over_the_sphere() {
        let shape = [bands(3), bands(4), bands(6)];
        let terms = triples(shape[0], shape[1], shape[2]);
        assert!(worst(8, &terms, shape) < 1e-13, "{:e}", worst(8, &terms, shape));
        assert!(worst(8, &terms[1..], shape) > 1e-2, "a missing term must show");
    }
}
