//! Orthonormality by quadrature, and the printed formulas that break it.

use glam::DVec3;
use sh_math::{Bands, evaluate_f64};
use std::f64::consts::PI;
use testkit::quadrature::sphere_quadrature;

/// Largest entry of `Gram - 1` of `basis` over a rule that is exact for products of its functions.
fn defect(n_bands: usize, basis: impl Fn(DVec3) -> Vec<f64>) -> f64 {
    let n = n_bands * n_bands;
    let mut gram = vec![0.0; n * n];
    for (direction, weight) in sphere_quadrature(n_bands) {
        let values = basis(DVec3::from_array(direction));
        for (row, a) in gram.chunks_exact_mut(n).zip(&values) {
            let a = weight * a;
            row.iter_mut().zip(&values).for_each(|(sum, b)| *sum += a * b);
        }
    }
    let off = |(i, value): (usize, &f64)| (value - f64::from(u8::from(i / n == i % n))).abs();
    // a NaN counts as the worst
    gram.iter().enumerate().map(off).fold(0.0, |worst, d| if d <= worst { worst } else { d })
}

#[test]
fn twenty_bands_are_orthonormal() {
    let bands = Bands::new(20).expect("in range");
    let defect = defect(20, |direction| {
        let mut out = vec![0.0; bands.coefficients()];
        evaluate_f64(bands, direction, &mut out);
        out
    });
    assert!(defect <= 1e-12, "the Gram matrix is {defect:e} from 1");
}

#[test]
fn straight_line_code_is_orthonormal() {
    for n in 1..=8 {
        let bands = Bands::new(n).expect("in range");
        let defect = defect(n as usize, |direction| {
            let mut out = vec![0.0; bands.coefficients()];
            evaluate_f64(bands, direction, &mut out);
            out
        });
        assert!(defect <= 1e-12, "{n} bands: the Gram matrix is {defect:e} from 1");
    }
}

/// The textbook formula: factorials times the unnormalised Legendre function, the power of `1 - z^2` from `exponent`.
fn textbook(n_bands: usize, direction: DVec3, exponent: fn(i32) -> f64, factorial: fn(u32) -> f64) -> Vec<f64> {
    let (z, phi) = (direction.z, direction.y.atan2(direction.x));
    let mut out = Vec::new();
    for l in 0..n_bands as i32 {
        for m in -l..=l {
            let order = m.abs();
            let norm = (f64::from(2 * l + 1) / (4.0 * PI) * factorial((l - order) as u32)
                / factorial((l + order) as u32))
            .sqrt();
            let double_factorial: f64 = (1..=order).map(|k| f64::from(2 * k - 1)).product();
            let (mut before, mut p) = (0.0, double_factorial * (1.0 - z * z).powf(exponent(order)));
            for k in order + 1..=l {
                let next = (f64::from(2 * k - 1) * z * p - f64::from(k + order - 1) * before) / f64::from(k - order);
                (before, p) = (p, next);
            }
            let angle = match m {
                0 => 1.0,
                1.. => 2.0_f64.sqrt() * (f64::from(m) * phi).cos(),
                _ => 2.0_f64.sqrt() * (f64::from(order) * phi).sin(),
            };
            out.push(norm * p * angle);
        }
    }
    out
}

fn half(m: i32) -> f64 {
    f64::from(m) / 2.0
}

fn exact_factorial(n: u32) -> f64 {
    (1..=n).map(f64::from).product()
}

#[test]
fn textbook_formula_agrees_at_few_bands() {
    let bands = Bands::new(5).expect("in range");
    let direction = DVec3::new(2.0, -3.0, 6.0) / 7.0;
    let mut out = vec![0.0; bands.coefficients()];
    evaluate_f64(bands, direction, &mut out);
    for (a, b) in out.iter().zip(textbook(5, direction, half, exact_factorial)) {
        testkit::assert_close!(*a, b, 1e-13, 0.0);
    }
}

/// G-E1: `m / 2` of integers.
#[test]
fn gram_with_integer_exponent_can_fail() {
    let defect = defect(5, |direction| textbook(5, direction, |m| f64::from(m / 2), exact_factorial));
    assert!((defect - 3.5).abs() < 0.1, "the printed exponent leaves the Gram matrix 3.5 from 1, not {defect}");
}

/// G-E13: factorials of 32-bit integers wrap at 13!, those of f32 overflow at 35!.
#[test]
fn gram_with_factorials_can_fail() {
    let wrapping = |n: u32| f64::from((1..=n as i32).fold(1_i32, i32::wrapping_mul));
    let short = |n: u32| f64::from((1..=n).map(|k| k as f32).product::<f32>());
    let right = defect(7, |direction| textbook(7, direction, half, wrapping));
    assert!(right < 1e-12, "12! still fits: {right:e}");
    let wrapped = defect(8, |direction| textbook(8, direction, half, wrapping));
    assert!(wrapped.is_nan() || wrapped >= 0.01, "13! must wrap and break 8 bands, the defect is {wrapped}");
    let overflown = defect(19, |direction| textbook(19, direction, half, short));
    assert!(
        overflown.is_nan() || overflown >= 0.01,
        "35! must overflow f32 and break 19 bands, the defect is {overflown}"
    );
}
