//! What a basis loses of a signal of 5 bands, as a quadratic form in its coefficients.

use glam::DVec3;
use sh_math::hemisphere::{Basis, HARMONICS, quadrature};
use sh_math::{Bands, evaluate_f64};
use std::f64::consts::TAU;

/// The integral over the hemisphere of products of what is lost of any two harmonics.
#[derive(Debug, Clone)]
pub(super) struct Residual {
    form: [[f64; HARMONICS]; HARMONICS],
}

impl Residual {
    pub(super) fn new(basis: Basis) -> Self {
        let rows = basis.of_harmonics(five());
        let mut values = [0.0; Basis::MAX_COUNT];
        let mut form = [[0.0; HARMONICS]; HARMONICS];
        for (normal, weight) in quadrature() {
            basis.evaluate_f64(normal, &mut values);
            let mut rest = harmonics(normal);
            for (row, value) in rows.iter().zip(&values) {
                rest.iter_mut().zip(row).for_each(|(rest, coefficient)| *rest -= coefficient * value);
            }
            for (row, a) in form.iter_mut().zip(rest) {
                row.iter_mut().zip(rest).for_each(|(sum, b)| *sum += weight * a * b);
            }
        }
        Self { form }
    }

    /// The integrated square error of a signal, mean of its channels (eq. 3.1 of \[N\]).
    pub(super) fn imse(&self, signal: &[[f32; 3]; HARMONICS]) -> f64 {
        let of_channel = |channel: usize| -> f64 {
            let value = |j: usize| f64::from(signal[j][channel]);
            let row = |(i, row): (usize, &[f64; HARMONICS])| {
                value(i) * row.iter().enumerate().map(|(j, entry)| entry * value(j)).sum::<f64>()
            };
            self.form.iter().enumerate().map(row).sum()
        };
        // Rounding can push a square below 0.
        ((0..3).map(of_channel).sum::<f64>() / 3.0).max(0.0)
    }
}

/// The bands over normals that signals are kept in.
pub(super) fn five() -> Bands {
    Bands::new(5).expect("a few bands exist")
}

/// The harmonics of 5 bands at a normal.
pub(super) fn harmonics(normal: DVec3) -> [f64; HARMONICS] {
    let mut values = [0.0; HARMONICS];
    evaluate_f64(five(), normal, &mut values);
    values
}

/// Mean of signals over the hemisphere and channels.
pub(super) fn mean<'a>(signals: impl Iterator<Item = &'a [[f32; 3]; HARMONICS]>) -> f64 {
    let mut means = [0.0; HARMONICS];
    for (normal, weight) in quadrature() {
        means.iter_mut().zip(harmonics(normal)).for_each(|(mean, value)| *mean += weight / TAU * value);
    }
    let (mut sum, mut count) = (0.0, 0_usize);
    for signal in signals {
        let of = |(mean, rgb): (&f64, &[f32; 3])| mean * rgb.iter().map(|&v| f64::from(v)).sum::<f64>();
        sum += means.iter().zip(signal).map(of).sum::<f64>();
        count += 3;
    }
    sum / count.max(1) as f64
}
