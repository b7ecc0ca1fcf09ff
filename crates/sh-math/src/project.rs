//! From samples of a function to its coefficients.

use crate::{Bands, Rgb, evaluate_f64};
use glam::DVec3;

/// Coefficients of a coloured function from samples `(unit direction, value * solid angle of the sample)`.
///
/// Monte Carlo over the whole sphere has the solid angle `4 pi / N`; texels have their own. Sums are in f64, in the order
/// of the samples.
pub fn project(bands: Bands, samples: impl IntoIterator<Item = (DVec3, [f64; 3])>) -> Rgb {
    let mut basis = vec![0.0; bands.coefficients()];
    let mut sums = vec![[0.0; 3]; bands.coefficients()];
    for (direction, weighted) in samples {
        evaluate_f64(bands, direction, &mut basis);
        for (sum, y) in sums.iter_mut().zip(&basis) {
            for channel in 0..3 {
                sum[channel] += weighted[channel] * y;
            }
        }
    }
    Rgb { bands, values: sums.into_iter().map(|sum| sum.map(|channel| channel as f32)).collect() }
}

/// Coefficients of a scalar function, as [`project`], kept in f64.
pub fn project_scalar(bands: Bands, samples: impl IntoIterator<Item = (DVec3, f64)>) -> Vec<f64> {
    let mut basis = vec![0.0; bands.coefficients()];
    let mut sums = vec![0.0; bands.coefficients()];
    for (direction, weighted) in samples {
        evaluate_f64(bands, direction, &mut basis);
        for (sum, y) in sums.iter_mut().zip(&basis) {
            *sum += weighted * y;
        }
    }
    sums
}
