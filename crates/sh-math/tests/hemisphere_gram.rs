//! The bases of the hemisphere against their Gram matrices, and every printed formula that breaks one.

use glam::DVec3;
use sh_math::hemisphere::{Basis, hl2};
use std::f64::consts::PI;
use testkit::assert_close;
use testkit::quadrature::{band_quadrature, sphere_quadrature};

/// A function of the paper at a unit vector.
type Function = fn(DVec3) -> f64;

fn values(basis: Basis, direction: DVec3) -> Vec<f64> {
    let mut out = vec![0.0; basis.count()];
    basis.evaluate_f64(direction, &mut out);
    out
}

/// The Gram matrix over the upper hemisphere by Gauss points in `z`: all products of two functions are polynomials there.
fn gram(count: usize, functions: impl Fn(DVec3) -> Vec<f64>) -> Vec<f64> {
    let mut gram = vec![0.0; count * count];
    for (direction, weight) in band_quadrature(0.0, 1.0, 12) {
        let values = functions(DVec3::from_array(direction));
        for (row, a) in gram.chunks_exact_mut(count).zip(&values) {
            row.iter_mut().zip(&values).for_each(|(sum, b)| *sum += weight * a * b);
        }
    }
    gram
}

/// Largest entry of `Gram - 1`; a NaN counts as the worst.
fn defect(gram: &[f64], count: usize) -> f64 {
    let off = |(i, value): (usize, &f64)| (value - f64::from(u8::from(i / count == i % count))).abs();
    gram.iter().enumerate().map(off).fold(0.0, |worst, d| if d <= worst { worst } else { d })
}

/// The defect of `basis` with function `index` taken from the print.
fn defect_with(basis: Basis, index: usize, printed: Function) -> f64 {
    let with = |direction: DVec3| {
        let mut values = values(basis, direction);
        values[index] = printed(direction);
        values
    };
    defect(&gram(basis.count(), with), basis.count())
}

#[test]
fn orthonormal_bases_have_the_unit_gram() {
    for basis in Basis::ALL.into_iter().filter(|basis| basis.is_orthonormal()) {
        let defect = defect(&gram(basis.count(), |d| values(basis, d)), basis.count());
        assert!(defect <= 1e-12, "{}: the Gram matrix is {defect:e} from 1", basis.name());
    }
}

/// The library's own rule, with its points in `sqrt z`, gives the same matrices.
#[test]
fn both_rules_give_one_gram() {
    for basis in Basis::ALL {
        for (own, other) in basis.gram().into_iter().zip(gram(basis.count(), |d| values(basis, d))) {
            assert_close!(own, other, 1e-14, 0.0, "{}", basis.name());
        }
    }
}

/// What is not orthonormal has the Gram matrix that it must have.
#[test]
fn the_other_bases_have_their_known_gram() {
    let modified = Basis::ModifiedH6.gram();
    for (i, value) in modified.iter().enumerate() {
        let known = match (i / 6, i % 6) {
            (0, 2) | (2, 0) => 0.75_f64.sqrt(),
            (a, b) => f64::from(u8::from(a == b)),
        };
        assert_close!(*value, known, 1e-12, 0.0, "modified H, entry {i}");
    }
    let harmonics = Basis::Sh9.gram();
    for (i, value) in harmonics.iter().enumerate() {
        let known = match (i / 9, i % 9) {
            (a, b) if a == b => 0.5,
            (0, 2) | (2, 0) => 3.0_f64.sqrt() / 4.0,
            (1, 5) | (5, 1) | (3, 7) | (7, 3) => 45.0_f64.sqrt() / 16.0,
            (2, 6) | (6, 2) => 15.0_f64.sqrt() / 16.0,
            _ => 0.0,
        };
        assert_close!(*value, known, 1e-12, 0.0, "SH, entry {i}");
    }
}

/// Eqs. 1.12, 1.13, 1.30, 1.33 and 1.42 as they are printed: each is seen.
#[test]
fn gram_of_printed_formulas_can_fail() {
    let printed: [(&str, Basis, usize, Function, f64); 3] = [
        ("1.30", Basis::Hsh9, 7, |d| (30.0 / PI).sqrt() * (2.0 * d.z - 1.0) * (d.z / (1.0 + d.z)).sqrt() * d.y, 1.0),
        ("1.33", Basis::Makhotkin9, 0, |d| d.z / PI.sqrt(), 1.0 / 3.0),
        (
            "1.42",
            Basis::Makhotkin9,
            6,
            |d| (3.0 / PI * d.z).sqrt() * (1.0 + 16.0 * (d.z - 1.0) + 10.0 * (d.z - 1.0).powi(2)),
            32.0,
        ),
    ];
    for (equation, basis, index, function, known) in printed {
        let defect = defect_with(basis, index, function);
        assert_close!(defect, known, 1e-9, 0.0, "eq. {equation} as printed");
    }
    // The harmonics' own norm is 1/2, so theirs are looked at alone.
    let norm = |f: Function| gram(1, |d| vec![f(d)])[0];
    assert_close!(norm(|_| 0.5 * (3.0 / PI).sqrt()), 1.5, 1e-12, 0.0, "eq. 1.12 as printed, without x");
    let printed = norm(|d| 0.5 * (15.0 / PI).sqrt() * (2.0 * d.y.atan2(d.x)).sin() * (d.x * d.x + d.y * d.y));
    assert_close!(printed, 2.0, 1e-12, 0.0, "eq. 1.13 as printed, angular");
    let harmonics = Basis::Sh9.gram();
    assert_close!(harmonics[3 * 9 + 3], 0.5, 1e-12, 0.0);
    assert_close!(harmonics[4 * 9 + 4], 0.5, 1e-12, 0.0);
}

/// The text calls HL2 orthonormal on the whole sphere as well; there its Gram matrix is twice the unit matrix.
#[test]
fn hl2_on_the_whole_sphere_can_fail() {
    let lobe = |d: DVec3, i: usize| (1.5 / PI).sqrt() * d.dot(DVec3::from_array(hl2::directions()[i]));
    for (i, j) in [(0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2)] {
        let product = |rule: Vec<([f64; 3], f64)>| -> f64 {
            rule.into_iter().map(|(d, w)| (DVec3::from_array(d), w)).map(|(d, w)| w * lobe(d, i) * lobe(d, j)).sum()
        };
        let unit = f64::from(u8::from(i == j));
        assert_close!(product(band_quadrature(0.0, 1.0, 4)), unit, 1e-13, 0.0, "hemisphere {i} {j}");
        assert_close!(product(sphere_quadrature(4)), 2.0 * unit, 1e-13, 0.0, "sphere {i} {j}");
    }
    let d = DVec3::new(2.0, -3.0, 6.0) / 7.0;
    for (i, value) in values(Basis::Hl2, d).into_iter().enumerate() {
        assert_close!(value, lobe(d, i), 1e-15, 0.0, "function {i} is the cosine to its direction");
    }
}
