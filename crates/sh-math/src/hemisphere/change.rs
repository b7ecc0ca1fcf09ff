//! From one basis to another: fewer functions of the same, or the nearest signal that other functions can make.

use super::Basis;
use crate::{Bands, evaluate_f64};
use glam::DVec3;

/// Most spherical harmonics that [`Basis::of_harmonics`] takes: 5 bands.
pub const HARMONICS: usize = 25;

impl Basis {
    /// The basis of the first `functions` functions of this one, where leaving out the others is the right thing to do; none elsewhere.
    ///
    /// Right is the least square error over the hemisphere; for one function of the modified H-basis, the value at the surface's own
    /// normal (\[N\] section 1.8.6). The first 4 of 9 fitted spherical harmonics are neither: the functions overlap.
    #[must_use]
    pub const fn cut(self, functions: usize) -> Option<Self> {
        match (self, functions) {
            (Self::Hsh9, 4) => Some(Self::Hsh4),
            (Self::Makhotkin9, 4) => Some(Self::Makhotkin4),
            (Self::Zernike6, 3) => Some(Self::Zernike3),
            (Self::H6, 4) => Some(Self::H4),
            (Self::ModifiedH6, 4) => Some(Self::ModifiedH4),
            (Self::ModifiedH6 | Self::ModifiedH4, 1) => Some(Self::ModifiedH1),
            _ if functions == self.count() => Some(self),
            _ => None,
        }
    }

    /// The matrix that takes coefficients of `source` to those of this basis with the least square error over the hemisphere: one row
    /// per function of this basis, one column per function of `source` ([`Basis::fit`] of each).
    ///
    /// Exact where the span of this basis holds the functions of `source`. Costs some tens of microseconds; keep it.
    #[must_use]
    pub fn matrix_from(self, source: Self) -> Vec<[f64; Self::MAX_COUNT]> {
        self.fit(|normal| {
            let mut values = [0.0; Self::MAX_COUNT];
            source.evaluate_f64(normal, &mut values);
            values
        })
    }

    /// The matrix that takes the spherical harmonics coefficients of a signal over normals to those of this basis: one row per function,
    /// one column per harmonic of so many bands, 0 beyond them.
    ///
    /// The least square error over the hemisphere ([`Basis::fit`] of each harmonic). The modified H-basis of one function alone, an
    /// ordinary light map, is exact at the surface's own normal instead. Costs some tens of microseconds; keep it.
    ///
    /// # Panics
    /// With more than 5 bands.
    #[must_use]
    pub fn of_harmonics(self, bands: Bands) -> Vec<[f64; HARMONICS]> {
        let harmonics = |normal| {
            let mut values = [0.0; HARMONICS];
            evaluate_f64(bands, normal, &mut values);
            values
        };
        if self != Self::ModifiedH1 {
            return self.fit(harmonics);
        }
        let mut one = [0.0];
        self.evaluate_f64(DVec3::Z, &mut one);
        vec![harmonics(DVec3::Z).map(|value| value / one[0])]
    }

    /// The basis of a name as people type it: [`Basis::name`] with letters of either case, blanks and hyphens left out or not, such as
    /// `modified-h6`, `sh9` or `hl2`.
    #[must_use]
    pub fn named(text: &str) -> Option<Self> {
        let plain = |text: &str| -> String {
            text.chars().filter(|c| !matches!(c, ' ' | '-' | '_')).map(|c| c.to_ascii_lowercase()).collect()
        };
        let wanted = plain(text);
        // The name of HL2 ends in a digit of its own; nobody types the second.
        Self::ALL.into_iter().find(|basis| plain(basis.name()) == wanted || *basis == Self::Hl2 && wanted == "hl2")
    }
}
