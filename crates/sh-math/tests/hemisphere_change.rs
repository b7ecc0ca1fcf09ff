//! Changing the basis against least squares done by brute force, and cuts against refits.

use glam::DVec3;
use sh_math::hemisphere::{Basis, quadrature};

/// Coefficients without a pattern.
fn coefficients(count: usize) -> Vec<f64> {
    (0..count).map(|i| (1.0 + 2.7 * i as f64).sin()).collect()
}

fn value(basis: Basis, coefficients: &[f64], normal: DVec3) -> f64 {
    let mut functions = [0.0; Basis::MAX_COUNT];
    basis.evaluate_f64(normal, &mut functions);
    coefficients.iter().zip(functions).map(|(c, f)| c * f).sum()
}

fn changed(from: Basis, to: Basis, coefficients: &[f64]) -> Vec<f64> {
    to.matrix_from(from).iter().map(|row| row.iter().zip(coefficients).map(|(a, c)| a * c).sum()).collect()
}

/// Root of the integral of the squared difference over the hemisphere.
fn difference(a: (Basis, &[f64]), b: (Basis, &[f64])) -> f64 {
    let square = |n: DVec3| (value(a.0, a.1, n) - value(b.0, b.1, n)).powi(2);
    quadrature().into_iter().map(|(n, weight)| weight * square(n)).sum::<f64>().sqrt()
}

/// Pairs (smaller, larger) of which the second spans the first.
const SPANS: [(Basis, Basis); 14] = [
    (Basis::Hl2, Basis::Sh4),
    (Basis::Hl2, Basis::H6),
    (Basis::Sh4, Basis::H4),
    (Basis::H4, Basis::Sh4),
    (Basis::H4, Basis::H6),
    (Basis::H6, Basis::Sh9),
    (Basis::H6, Basis::ModifiedH6),
    (Basis::ModifiedH6, Basis::H6),
    (Basis::ModifiedH6, Basis::Sh9),
    (Basis::ModifiedH4, Basis::Sh4),
    (Basis::ModifiedH1, Basis::Zernike3),
    (Basis::Hsh4, Basis::Hsh9),
    (Basis::Makhotkin4, Basis::Makhotkin9),
    (Basis::Zernike3, Basis::Zernike6),
];

#[test]
fn a_basis_that_spans_another_holds_its_signals_exactly() {
    for (smaller, larger) in SPANS {
        let before = coefficients(smaller.count());
        let after = changed(smaller, larger, &before);
        let error = difference((smaller, &before), (larger, &after));
        // Nine harmonics have the condition number 254: a few hundred roundings of 2e-16.
        assert!(error < 1e-12, "{} in {}: {error}", smaller.name(), larger.name());
        let back = changed(larger, smaller, &after);
        let worst = before.iter().zip(&back).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        assert!(worst < 1e-12, "{} in {} and back: {worst}", smaller.name(), larger.name());
    }
}

#[test]
fn a_basis_that_does_not_span_another_can_fail() {
    for (from, to) in [(Basis::H6, Basis::Hl2), (Basis::Sh9, Basis::H6), (Basis::Hsh4, Basis::H4)] {
        let before = coefficients(from.count());
        let error = difference((from, &before), (to, &changed(from, to, &before)));
        assert!(error > 0.05, "{} cannot lie in {}, but differs by {error} only", from.name(), to.name());
    }
}

/// No change of one coefficient brings the new signal nearer to the old one.
#[test]
fn the_change_has_the_least_square_error() {
    for from in Basis::ALL {
        for to in Basis::ALL.into_iter().filter(|to| *to != Basis::ModifiedH1) {
            let before = coefficients(from.count());
            let after = changed(from, to, &before);
            let least = difference((from, &before), (to, &after)).powi(2);
            for i in 0..to.count() {
                for step in [-1e-3, 1e-3] {
                    let mut other = after.clone();
                    other[i] += step;
                    let error = difference((from, &before), (to, &other)).powi(2);
                    assert!(error > least, "{} to {}, {i}: {error} < {least}", from.name(), to.name());
                }
            }
        }
    }
}

#[test]
fn a_cut_is_the_refit() {
    for basis in Basis::ALL {
        let before = coefficients(basis.count());
        for cut in (1..=basis.count()).filter_map(|n| basis.cut(n)) {
            let refitted = changed(basis, cut, &before);
            let worst = refitted.iter().zip(&before).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
            assert!(worst < 1e-12, "{} cut to {}: {worst}", basis.name(), cut.name());
        }
    }
    let levels = |basis: Basis| (1..=9).filter(|&n| basis.cut(n).is_some()).collect::<Vec<_>>();
    assert_eq!(levels(Basis::ModifiedH6), [1, 4, 6]);
    assert_eq!(levels(Basis::Makhotkin9), [4, 9]);
    assert_eq!(levels(Basis::Zernike6), [3, 6]);
    assert_eq!((levels(Basis::Sh9), levels(Basis::Hl2)), (vec![9], vec![3]));
}

/// Why nine harmonics are not cut to four: the refit has other coefficients.
#[test]
fn a_cut_can_fail() {
    let before = coefficients(9);
    let refitted = changed(Basis::Sh9, Basis::Sh4, &before);
    let worst = refitted.iter().zip(&before).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    assert!(worst > 0.1, "{worst}");
}

#[test]
fn every_basis_is_found_by_its_name() {
    for basis in Basis::ALL {
        let hyphens = basis.name().replace(' ', "-");
        for text in [basis.name().to_owned(), basis.name().to_lowercase(), hyphens] {
            assert_eq!(Basis::named(&text), Some(basis), "{text}");
        }
    }
    assert_eq!(Basis::named("modified-h6"), Some(Basis::ModifiedH6));
    assert_eq!(Basis::named("HL2"), Some(Basis::Hl2));
    assert_eq!((Basis::named("h5"), Basis::named(""), Basis::named("6")), (None, None, None));
}
