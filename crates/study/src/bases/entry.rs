//! A basis, a way to find its coefficients, and what that loses of a signal.

use glam::DVec3;
use sh_math::hemisphere::{Basis, quadrature};
use sh_math::{Bands, evaluate_f64, zonal};

/// Coefficients of 3 bands.
pub(super) const NINE: usize = 9;
/// Coefficients of 5 bands.
pub(super) const TWENTY_FIVE: usize = 25;
/// What Table 3.1 prints for spherical harmonics with 9 coefficients.
pub(super) const PRINTED_SH_9: f64 = 0.002_31;

/// How coefficients are found.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Fit {
    /// The least square error over the hemisphere.
    LeastSquares,
    /// The first spherical harmonics coefficients of the sphere, the rest left out.
    Cut,
}

/// One line of the comparison.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Entry {
    /// The functions.
    pub basis: Basis,
    /// How their coefficients are found.
    pub fit: Fit,
}

impl Entry {
    /// A basis with its least-squares coefficients.
    #[must_use]
    pub const fn fitted(basis: Basis) -> Self {
        Self { basis, fit: Fit::LeastSquares }
    }

    /// Every basis fitted, and behind the fitted harmonics those that a cut leaves.
    #[must_use]
    pub fn all() -> Vec<Self> {
        let mut all: Vec<Self> = Basis::ALL.into_iter().map(Self::fitted).collect();
        all.insert(1, Self { basis: Basis::Sh4, fit: Fit::Cut });
        all
    }

    /// The name that people read.
    #[must_use]
    pub fn name(self) -> String {
        match self.fit {
            Fit::LeastSquares => self.basis.name().to_owned(),
            Fit::Cut => format!("{}, cut", self.basis.name()),
        }
    }

    /// What Table 3.1 prints; the modified H-basis has the entries of the H-basis there.
    ///
    /// The entry of spherical harmonics with 9 coefficients belongs to other signals and is not among them.
    pub(super) fn printed(self) -> Option<f64> {
        if self.fit == Fit::Cut {
            return None;
        }
        match self.basis {
            Basis::Sh4 => Some(0.027_48),
            Basis::Hl2 => Some(0.077_18),
            Basis::Hsh4 => Some(0.037_05),
            Basis::Hsh9 => Some(0.011_14),
            Basis::Makhotkin4 => Some(0.065_77),
            Basis::Makhotkin9 => Some(0.030_30),
            Basis::Zernike3 => Some(0.058_71),
            Basis::Zernike6 => Some(0.010_10),
            Basis::H4 | Basis::ModifiedH4 => Some(0.027_79),
            Basis::H6 | Basis::ModifiedH6 => Some(0.006_78),
            Basis::Sh9 | Basis::ModifiedH1 => None,
        }
    }

    /// What is lost of signals with N radiance coefficients.
    pub(super) fn loss<const N: usize>(self) -> Loss<N> {
        let coefficients = self.coefficients::<N>();
        let mut values = [0.0; Basis::MAX_COUNT];
        let mut form = [[0.0; N]; N];
        for (normal, weight) in quadrature() {
            self.basis.evaluate_f64(normal, &mut values);
            let mut rest = irradiance::<N>(normal);
            for (row, value) in coefficients.iter().zip(&values) {
                rest.iter_mut().zip(row).for_each(|(rest, coefficient)| *rest -= coefficient * value);
            }
            for (row, a) in form.iter_mut().zip(rest) {
                row.iter_mut().zip(rest).for_each(|(sum, b)| *sum += weight * a * b);
            }
        }
        Loss { form }
    }

    /// Coefficients of the basis for each of N radiance coefficients of 1.
    fn coefficients<const N: usize>(self) -> Vec<[f64; N]> {
        match self.fit {
            Fit::LeastSquares => self.basis.fit(irradiance::<N>),
            Fit::Cut => {
                let row = |i: usize| std::array::from_fn(|j| if i == j { factor(j) } else { 0.0 });
                (0..self.basis.count()).map(row).collect()
            }
        }
    }
}

/// Irradiance / pi at a normal for each of N radiance coefficients of 1: `a_l Y_lm` (eqs. 2.3 and 2.4).
fn irradiance<const N: usize>(normal: DVec3) -> [f64; N] {
    let bands = Bands::new(N.isqrt() as u32).expect("a few bands exist");
    let mut values = [0.0; N];
    evaluate_f64(bands, normal, &mut values);
    std::array::from_fn(|i| factor(i) * values[i])
}

/// The factor of the clamped cosine on coefficient `i`.
fn factor(i: usize) -> f64 {
    zonal::clamped_cosine(i.isqrt())
}

/// The integrated square error of eq. 3.1 as a quadratic form in the radiance coefficients.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Loss<const N: usize> {
    form: [[f64; N]; N],
}

impl<const N: usize> Loss<N> {
    /// The error of the signal with the coefficients `c`.
    pub(super) fn of(&self, c: &[f64; N]) -> f64 {
        let row = |(row, c_i): (&[f64; N], &f64)| c_i * row.iter().zip(c).map(|(value, c_j)| value * c_j).sum::<f64>();
        self.form.iter().zip(c).map(row).sum()
    }

    /// The expectation for independent coefficients uniform in [-1, 1], whose variance is 1/3.
    pub(super) fn expectation(&self) -> f64 {
        (0..N).map(|i| self.form[i][i]).sum::<f64>() / 3.0
    }
}
