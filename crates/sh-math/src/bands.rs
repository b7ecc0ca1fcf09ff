//! How many bands, and where coefficient `(l, m)` stands.

/// A number of bands, 1 to [`Bands::MAX`]: the degrees `0..count`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Bands(u32);

impl Bands {
    /// The most bands (degree 128) for which evaluation in f32, rotation and windows are all within their bounds.
    ///
    /// [`crate::recurrence`] goes on beyond it.
    pub const MAX: u32 = 129;

    /// `count` bands, or `None` outside `1..=Bands::MAX`.
    #[must_use]
    pub const fn new(count: u32) -> Option<Self> {
        if count >= 1 && count <= Self::MAX { Some(Self(count)) } else { None }
    }

    /// Number of bands.
    #[must_use]
    pub const fn count(self) -> usize {
        self.0 as usize
    }

    /// Number of coefficients, `count^2`.
    #[must_use]
    pub const fn coefficients(self) -> usize {
        self.count() * self.count()
    }

    /// The degrees `l` from 0.
    pub fn degrees(self) -> std::ops::Range<usize> {
        0..self.count()
    }
}

/// Index `l (l + 1) + m` of the function of degree `l` and order `m`, `-l <= m <= l`.
///
/// # Panics
/// With debug assertions, when `|m| > l`.
#[must_use]
pub const fn index(l: usize, m: isize) -> usize {
    debug_assert!(m.unsigned_abs() <= l, "the order m must lie in -l..=l");
    (l * (l + 1)).wrapping_add_signed(m)
}

#[cfg(test)]
mod tests {
    use super::{Bands, index};

    #[test]
    fn indices_run_without_gap() {
        let bands = Bands::new(7).expect("7 bands exist");
        let all: Vec<usize> =
            bands.degrees().flat_map(|l| (-(l as isize)..=l as isize).map(move |m| index(l, m))).collect();
        assert_eq!(all, (0..bands.coefficients()).collect::<Vec<_>>(), "l(l+1)+m must count 0, 1, 2, ...");
    }

    #[test]
    fn bounds_are_kept() {
        assert!(Bands::new(0).is_none() && Bands::new(Bands::MAX + 1).is_none(), "outside 1..=MAX there is none");
        assert!(Bands::new(1).is_some() && Bands::new(Bands::MAX).is_some(), "the ends are inside");
    }
}
