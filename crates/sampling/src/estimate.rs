//! How large is the error of what was sampled: the doubling rule and independent replicates.

/// Power of the count by which changes are taken to fall: what Owen-scrambled Sobol points do where shadows have very many edges
/// (measured -0.65 under leaves, down to -0.8 beside houses).
const DECAY: f64 = 0.65;

/// The doubling rule: take twice the samples until the last doublings changed little enough.
///
/// With Owen-scrambled Sobol points `|Q_N - Q_(N/2)|` overestimates the error of `Q_N` by about 1.4 (root mean square), and
/// costs no accuracy, as every sample counts in the result. A single change is a noisy estimate, though: the root mean square of a few,
/// each brought to the present count, stops receivers that err alike at the same count.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Doubling {
    /// Samples before the first look; a power of two.
    pub first: u32,
    /// No look goes beyond this many samples.
    pub last: u32,
    /// Allowed error, in the unit of the estimates.
    pub tolerance: f64,
    /// The change before must have been within this multiple of the tolerance: infinity asks for no confirmation, 1 for
    /// two looks in a row. A change falls to about 0.6 of the one before, so 2 costs next to nothing and catches
    /// most of the lucky small changes, such as a small distant blocker that two looks both miss.
    pub confirmation: f64,
    /// Number of last changes whose root mean square, as `N^-0.65` brings them to the present count, is the error, at least the last
    /// over the square root of 2, so that what a look finds anew is not lost among changes of nothing; 1: the last alone.
    pub memory: usize,
}

/// What to do after a look.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Verdict {
    /// Go on to this many samples in total.
    Continue {
        /// Twice the present count, or the limit.
        count: u32,
    },
    /// Stop: the tolerance is met.
    Reached {
        /// The last changes, an upper estimate of the error.
        error: f64,
    },
    /// Stop: the limit is spent.
    Exhausted {
        /// The last changes; infinite after a single look.
        error: f64,
    },
}

/// The state of one receiver under a [`Doubling`] rule.
#[derive(Debug, Clone, Default)]
pub struct Progress {
    previous: Vec<f64>,
    count: u32,
    /// From the first on.
    changes: Vec<f64>,
}

impl Doubling {
    /// State before the first look.
    #[must_use]
    pub fn start(&self) -> Progress {
        Progress::default()
    }

    /// Judges the estimate after `count` samples; call with `first`, then with each count asked for.
    pub fn look(&self, progress: &mut Progress, count: u32, estimate: &[f64]) -> Verdict {
        let before = progress.changes.last().copied().unwrap_or(f64::INFINITY);
        if !progress.previous.is_empty() {
            let shrinks = libm::pow(f64::from(progress.count) / f64::from(count), DECAY);
            progress.changes.iter_mut().for_each(|change| *change *= shrinks);
            progress.changes.push(l2_distance(estimate, &progress.previous));
        }
        progress.previous.clear();
        progress.previous.extend_from_slice(estimate);
        progress.count = count;
        let error = self.error(&progress.changes);
        if error <= self.tolerance && before <= self.confirmation * self.tolerance {
            Verdict::Reached { error }
        } else if count >= self.last {
            Verdict::Exhausted { error }
        } else {
            Verdict::Continue { count: count.saturating_mul(2).min(self.last) }
        }
    }

    fn error(&self, changes: &[f64]) -> f64 {
        let remembered = &changes[changes.len().saturating_sub(self.memory.max(1))..];
        let Some(last) = remembered.last() else {
            return f64::INFINITY;
        };
        let mean = (remembered.iter().map(|change| change * change).sum::<f64>() / remembered.len() as f64).sqrt();
        // The comparison, unlike a maximum, lets through what is no number: that never passes.
        if mean < last * std::f64::consts::FRAC_1_SQRT_2 { last * std::f64::consts::FRAC_1_SQRT_2 } else { mean }
    }
}

/// L2 norm of the difference of two vectors of one length.
#[must_use]
pub fn l2_distance(a: &[f64], b: &[f64]) -> f64 {
    debug_assert_eq!(a.len(), b.len(), "vectors of one estimate");
    a.iter().zip(b).map(|(a, b)| (a - b) * (a - b)).sum::<f64>().sqrt()
}

/// Independent estimates of one vector (other seeds, same count): their mean with an unbiased error.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Replicates {
    n: u32,
    mean: Vec<f64>,
    /// Sums of squared deviations from the mean.
    squares: Vec<f64>,
}

impl Replicates {
    /// Adds one estimate; all have the length of the first (Welford's update: no cancellation).
    pub fn add(&mut self, estimate: &[f64]) {
        if self.n == 0 {
            self.mean = vec![0.0; estimate.len()];
            self.squares = vec![0.0; estimate.len()];
        }
        debug_assert_eq!(estimate.len(), self.mean.len(), "replicates of one vector");
        self.n += 1;
        for ((mean, square), &value) in self.mean.iter_mut().zip(&mut self.squares).zip(estimate) {
            let before = value - *mean;
            *mean += before / f64::from(self.n);
            *square += before * (value - *mean);
        }
    }

    /// Mean of the estimates.
    #[must_use]
    pub fn mean(&self) -> &[f64] {
        &self.mean
    }

    /// Standard error of each entry of the mean; infinite below two replicates.
    #[must_use]
    pub fn std_error(&self) -> Vec<f64> {
        self.squares.iter().map(|s| self.variance_of_mean(*s).sqrt()).collect()
    }

    /// Expected L2 error of the mean; infinite below two replicates.
    #[must_use]
    pub fn l2_error(&self) -> f64 {
        self.variance_of_mean(self.squares.iter().sum()).sqrt()
    }

    fn variance_of_mean(&self, squares: f64) -> f64 {
        if self.n < 2 {
            return f64::INFINITY;
        }
        squares / (f64::from(self.n) * f64::from(self.n - 1))
    }
}
