//! Orders of errors that hold for every signal: where one span lies in another, its best fit is no better.

use super::{Entry, Fit};
use sh_math::hemisphere::Basis;

/// What rounding may add to an error of the size 1.
const ROUNDING: f64 = 1e-12;

/// One relation, and how it fared.
#[derive(Debug, Clone, PartialEq)]
pub struct Invariant {
    /// The basis with the smaller error.
    pub smaller: Entry,
    /// The basis with the larger error.
    pub larger: Entry,
    /// Whether the two errors must be equal.
    pub equal: bool,
    /// The most by which a signal broke it; 0 or rounding where it holds.
    pub worst: f64,
}

impl Invariant {
    /// The relations of the bases.
    pub(super) fn all() -> Vec<Self> {
        use Basis::{H4, H6, Hl2, Hsh4, Hsh9, Makhotkin4, Makhotkin9, ModifiedH1, ModifiedH4, ModifiedH6};
        use Basis::{Sh4, Sh9, Zernike3, Zernike6};
        let order = |(smaller, larger)| Self::new(Entry::fitted(smaller), Entry::fitted(larger), false);
        let equality = |(a, b)| Self::new(Entry::fitted(a), Entry::fitted(b), true);
        let orders = [(Sh9, H6), (H6, H4), (H4, Hl2), (Hsh9, Hsh4), (Makhotkin9, Makhotkin4), (Zernike6, Zernike3)];
        let equalities = [(H6, ModifiedH6), (H4, ModifiedH4), (H4, Sh4)];
        let mut all: Vec<Self> = orders.into_iter().chain([(ModifiedH4, ModifiedH1)]).map(order).collect();
        all.extend(equalities.into_iter().map(equality));
        all.push(Self::new(Entry::fitted(Sh4), Entry { basis: Sh4, fit: Fit::Cut }, false));
        all
    }

    pub(super) const fn new(smaller: Entry, larger: Entry, equal: bool) -> Self {
        Self { smaller, larger, equal, worst: 0.0 }
    }

    /// Looks at the errors of one signal.
    pub(super) fn check(&mut self, error: impl Fn(Entry) -> f64) {
        let excess = error(self.smaller) - error(self.larger);
        let broken = if self.equal { excess.abs() } else { excess };
        // a NaN is the worst and stays
        if broken.is_nan() || broken > self.worst {
            self.worst = broken;
        }
    }

    /// Whether it held for every signal, within rounding.
    #[must_use]
    pub fn holds(&self) -> bool {
        self.worst <= ROUNDING
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Errors that break the relation: too large a one, unequal ones, none.
    #[test]
    fn relations_can_fail() {
        let [fitted, cut] = [Fit::LeastSquares, Fit::Cut].map(|fit| Entry { basis: Basis::Sh4, fit });
        let after = |equal: bool, first: f64, second: f64| {
            let mut invariant = Invariant::new(fitted, cut, equal);
            invariant.check(|entry| if entry == fitted { first } else { second });
            invariant.check(|_| 0.5);
            invariant.holds()
        };
        assert!(after(false, 0.1, 0.2) && after(false, 0.2, 0.2) && after(true, 0.2, 0.2));
        assert!(!after(false, 0.2, 0.1), "the smaller is larger");
        assert!(!after(true, 0.1, 0.2), "the equal are not");
        assert!(!after(false, f64::NAN, 0.2), "a NaN is no error");
    }
}
