//! The bases of irradiance normal mapping: functions of a normal in tangent space.
//!
//! A direction here is a unit vector `(x, y, z)` of the tangent frame, `z` along the surface's own normal; the signal is
//! irradiance / pi as a function of the normal that a normal map asks for. Where a basis has bands, its functions stand
//! as spherical harmonics do: index `l (l + 1) + m`, `m < 0` with the sine.
//!
//! The hemisphere is closed. At its border (`z = 0`) every function is finite; below it `z` counts as 0, so that a normal
//! that interpolation or eight bits pushed under the horizon gets the value of the border and never a NaN.
//!
//! Source: the third paper, section 1.8; where its print is wrong the functions here are the corrected ones, as each
//! file says. Coefficients come from [`Basis::conversion`], [`Basis::project_irradiance`] or [`Basis::project_radiance`].

mod batch;
mod change;
mod fit;
mod h;
pub mod hl2;
mod hsh;
mod makhotkin;
mod modified_h;
mod project;
mod quadrature;
mod spherical;
mod zernike;

pub use change::HARMONICS;
pub use fit::Conversion;
pub use quadrature::quadrature;

use crate::value::Root;
use glam::{DVec3, Vec3};

/// A set of functions that carries irradiance over the hemisphere; the digit is the number of functions.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Basis {
    /// Spherical harmonics of 2 bands, fitted on the hemisphere.
    Sh4,
    /// Spherical harmonics of 3 bands.
    Sh9,
    /// The three directions of Half-Life 2.
    Hl2,
    /// Hemispherical harmonics of 2 bands.
    Hsh4,
    /// Hemispherical harmonics of 3 bands.
    Hsh9,
    /// Makhotkin's shifted Jacobi polynomials, 2 bands.
    Makhotkin4,
    /// Makhotkin's shifted Jacobi polynomials, 3 bands.
    Makhotkin9,
    /// Zernike polynomials on the hemisphere up to degree 1.
    Zernike3,
    /// Zernike polynomials on the hemisphere up to degree 2.
    Zernike6,
    /// The constant and linear functions of the H-basis.
    H4,
    /// The H-basis.
    H6,
    /// The first function of the modified H-basis alone: an ordinary light map.
    ModifiedH1,
    /// The first four functions of the modified H-basis.
    ModifiedH4,
    /// The modified H-basis: its first coefficient is the value at the surface's own normal.
    ModifiedH6,
}

impl Basis {
    /// Every basis, in the order of the paper.
    pub const ALL: [Self; 14] = [
        Self::Sh4,
        Self::Sh9,
        Self::Hl2,
        Self::Hsh4,
        Self::Hsh9,
        Self::Makhotkin4,
        Self::Makhotkin9,
        Self::Zernike3,
        Self::Zernike6,
        Self::H4,
        Self::H6,
        Self::ModifiedH1,
        Self::ModifiedH4,
        Self::ModifiedH6,
    ];

    /// The most functions that a basis has.
    pub const MAX_COUNT: usize = 9;

    /// Number of functions, and of coefficients per channel.
    #[must_use]
    pub const fn count(self) -> usize {
        match self {
            Self::ModifiedH1 => 1,
            Self::Hl2 | Self::Zernike3 => 3,
            Self::Sh4 | Self::Hsh4 | Self::Makhotkin4 | Self::H4 | Self::ModifiedH4 => 4,
            Self::Zernike6 | Self::H6 | Self::ModifiedH6 => 6,
            Self::Sh9 | Self::Hsh9 | Self::Makhotkin9 => 9,
        }
    }

    /// The name that people read.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Sh4 => "SH 4",
            Self::Sh9 => "SH 9",
            Self::Hl2 => "HL2 3",
            Self::Hsh4 => "HSH 4",
            Self::Hsh9 => "HSH 9",
            Self::Makhotkin4 => "Makhotkin 4",
            Self::Makhotkin9 => "Makhotkin 9",
            Self::Zernike3 => "Zernike 3",
            Self::Zernike6 => "Zernike 6",
            Self::H4 => "H 4",
            Self::H6 => "H 6",
            Self::ModifiedH1 => "modified H 1",
            Self::ModifiedH4 => "modified H 4",
            Self::ModifiedH6 => "modified H 6",
        }
    }

    /// Whether the integral of two functions over the hemisphere is 1 for the same and 0 for different ones.
    ///
    /// Where it is not, a coefficient is no inner product with one function: projections solve for all at once.
    #[must_use]
    pub const fn is_orthonormal(self) -> bool {
        !matches!(self, Self::Sh4 | Self::Sh9 | Self::ModifiedH4 | Self::ModifiedH6)
    }

    /// Writes the functions at the unit vector `direction` (tangent space) into `out[0..count]`.
    ///
    /// # Panics
    /// When `out` is shorter than `self.count()`.
    #[inline]
    pub fn evaluate(self, direction: Vec3, out: &mut [f32]) {
        let out = &mut out[..self.count()];
        self.visit(direction.to_array(), |i, value| out[i] = value);
    }

    /// [`Basis::evaluate`] in f64.
    ///
    /// # Panics
    /// When `out` is shorter than `self.count()`.
    #[inline]
    pub fn evaluate_f64(self, direction: DVec3, out: &mut [f64]) {
        let out = &mut out[..self.count()];
        self.visit(direction.to_array(), |i, value| out[i] = value);
    }

    /// The signal that `coefficients` (`[function][channel]`) describe at the unit vector `normal` (tangent space).
    ///
    /// # Panics
    /// When `coefficients` is shorter than `self.count()`.
    #[inline(always)]
    #[must_use]
    pub fn reconstruct(self, coefficients: &[[f32; 3]], normal: Vec3) -> [f32; 3] {
        let coefficients = &coefficients[..self.count()];
        let mut sum = [0.0; 3];
        self.visit(normal.to_array(), |i, value| {
            for (channel, coefficient) in sum.iter_mut().zip(coefficients[i]) {
                *channel += coefficient * value;
            }
        });
        sum
    }

    /// Hands every function at `direction` to `put`, in the order of the indices.
    #[inline(always)]
    fn visit<V: Root>(self, [x, y, z]: [V; 3], put: impl FnMut(usize, V)) {
        let direction = [x, y, z.at_least_zero()];
        match self {
            Self::Sh4 | Self::Sh9 => spherical::visit(self.count(), direction, put),
            Self::Hl2 => hl2::visit(direction, put),
            Self::Hsh4 | Self::Hsh9 => hsh::visit(self.count(), direction, put),
            Self::Makhotkin4 | Self::Makhotkin9 => makhotkin::visit(self.count(), direction, put),
            Self::Zernike3 | Self::Zernike6 => zernike::visit(self.count(), direction, put),
            Self::H4 | Self::H6 => h::visit(self.count(), direction, put),
            Self::ModifiedH1 | Self::ModifiedH4 | Self::ModifiedH6 => modified_h::visit(self.count(), direction, put),
        }
    }
}
