//! Least squares on the hemisphere: Gram matrices and the matrices from spherical harmonics.

use super::{Basis, quadrature};
use crate::{Bands, Rgb, evaluate_f64};
use glam::DVec3;

/// Spherical harmonics coefficients per channel that a conversion reads: 3 bands.
const SH_COUNT: usize = 9;

/// The matrix from 9 spherical harmonics coefficients of a signal to those of a basis.
#[derive(Debug, Clone, PartialEq)]
pub struct Conversion {
    /// The basis converted to.
    pub basis: Basis,
    /// One row per function of the basis.
    pub rows: Vec<[f64; SH_COUNT]>,
}

impl Conversion {
    /// The basis coefficients (`[function][channel]`) of the signal with the coefficients `signal` in tangent space.
    ///
    /// For irradiance / pi these are radiance's times [`crate::zonal::clamped_cosine`]. Bands beyond 3 are left out, missing
    /// ones are 0.
    #[must_use]
    pub fn apply(&self, signal: &Rgb) -> Vec<[f32; 3]> {
        let entry = |row: &[f64; SH_COUNT], channel: usize| {
            row.iter().zip(&signal.values).map(|(factor, value)| factor * f64::from(value[channel])).sum::<f64>() as f32
        };
        self.rows.iter().map(|row| [0, 1, 2].map(|channel| entry(row, channel))).collect()
    }
}

impl Basis {
    /// Integrals over the hemisphere of the products of any two functions, row by row, `count * count` numbers.
    #[must_use]
    pub fn gram(self) -> Vec<f64> {
        let n = self.count();
        let mut gram = vec![0.0; n * n];
        let mut values = [0.0; Self::MAX_COUNT];
        for (direction, weight) in quadrature() {
            self.evaluate_f64(direction, &mut values);
            for (row, value) in gram.chunks_exact_mut(n).zip(&values) {
                row.iter_mut().zip(&values).for_each(|(sum, other)| *sum += weight * value * other);
            }
        }
        gram
    }

    /// The matrix that takes 9 spherical harmonics coefficients of a signal to the coefficients with the least square
    /// error over the hemisphere: [`Basis::fit`] of each harmonic.
    ///
    /// Costs some tens of microseconds; keep it.
    #[must_use]
    pub fn conversion(self) -> Conversion {
        let bands = Bands::new(3).expect("3 bands exist");
        let harmonics = |direction| {
            let mut values = [0.0; SH_COUNT];
            evaluate_f64(bands, direction, &mut values);
            values
        };
        Conversion { basis: self, rows: self.fit(harmonics) }
    }

    /// Coefficients (one row per function) with the least square error over the hemisphere for N signals at once:
    /// `G^-1 p` with `p_i` the integral of function `i` times the signal, by [`quadrature`].
    ///
    /// Signals must be smooth: polynomials of degree 4 are exact. The modified H-basis of one function is the cut one of
    /// four: exact at the surface's own normal, not the least error.
    pub fn fit<const N: usize>(self, signals: impl Fn(DVec3) -> [f64; N]) -> Vec<[f64; N]> {
        self.least_squares(
            quadrature().into_iter().map(|(normal, weight)| (normal, signals(normal).map(|s| weight * s))),
        )
    }

    /// Least-squares coefficients from samples `(normal, value * solid angle)`; what is not fitted is cut off.
    pub(super) fn least_squares<const N: usize>(
        self,
        samples: impl IntoIterator<Item = (DVec3, [f64; N])>,
    ) -> Vec<[f64; N]> {
        let fitted = self.fitted();
        let mut values = [0.0; Self::MAX_COUNT];
        let mut sums = vec![[0.0; N]; fitted.count()];
        for (normal, weighted) in samples {
            fitted.evaluate_f64(normal, &mut values);
            for (sum, value) in sums.iter_mut().zip(values) {
                sum.iter_mut().zip(weighted).for_each(|(entry, weighted)| *entry += weighted * value);
            }
        }
        fitted.solve(&mut sums);
        sums.truncate(self.count());
        sums
    }

    /// The basis that least squares are done in before coefficients are cut off.
    const fn fitted(self) -> Self {
        match self {
            Self::ModifiedH1 => Self::ModifiedH4,
            _ => self,
        }
    }

    /// Turns inner products with the functions (one row each) into least-squares coefficients, by Cholesky's factors.
    fn solve<const N: usize>(self, rows: &mut [[f64; N]]) {
        if self.is_orthonormal() {
            return;
        }
        let factor = cholesky(self.gram(), self.count());
        let n = self.count();
        for i in 0..n {
            for k in 0..i {
                take(rows, i, k, factor[i * n + k]);
            }
            rows[i] = rows[i].map(|value| value / factor[i * n + i]);
        }
        for i in (0..n).rev() {
            for k in i + 1..n {
                take(rows, i, k, factor[k * n + i]);
            }
            rows[i] = rows[i].map(|value| value / factor[i * n + i]);
        }
    }
}

/// Takes `factor` times row `source` from row `target`.
fn take<const N: usize>(rows: &mut [[f64; N]], target: usize, source: usize, factor: f64) {
    let taken = rows[source];
    rows[target].iter_mut().zip(taken).for_each(|(value, other)| *value -= factor * other);
}

/// The lower factor `L` of a positive matrix `L L^T`, in place of its lower half.
fn cholesky(mut matrix: Vec<f64>, n: usize) -> Vec<f64> {
    for i in 0..n {
        for j in 0..=i {
            let sum: f64 = (0..j).map(|k| matrix[i * n + k] * matrix[j * n + k]).sum();
            let rest = matrix[i * n + j] - sum;
            matrix[i * n + j] = if i == j { rest.sqrt() } else { rest / matrix[j * n + j] };
        }
    }
    matrix
}
