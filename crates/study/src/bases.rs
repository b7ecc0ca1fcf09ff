//! The bases of irradiance normal mapping compared: error over random signals (Table 3.1 of the third paper), time, bytes.
//!
//! The paper does not say how its signals are drawn. The model that meets ten of its eleven entries within 1 % has no free
//! number: radiance coefficients uniform in [-1, 1] over 3 bands of spherical harmonics, irradiance / pi
//! `E = sum a_l c_lm Y_lm`, every basis fitted by least squares on the hemisphere, the error integrated over solid angle.
//! Under it the eleventh, spherical harmonics with 9 coefficients, is exact; what its printed error can be instead is
//! [`Eleventh`].

mod entry;
mod invariant;
mod label;
mod plot;
pub mod scene;
mod table;
mod timing;

pub use entry::{Entry, Fit};
pub use invariant::Invariant;
pub use plot::{Picture, PlotError};

use entry::{Loss, NINE, TWENTY_FIVE};
use sampling::estimate::Replicates;
use sampling::rng::Rng;
use sh_math::hemisphere::Basis;

/// Signals that the paper averages over.
pub const SIGNALS: u32 = 10_000;

/// The choices of a study.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Settings {
    /// Random signals to average over, at least 2.
    pub signals: u32,
    /// Seed of the signals.
    pub seed: u64,
}

/// All that was found out.
#[derive(Debug, Clone, PartialEq)]
pub struct Study {
    /// What was asked for.
    pub settings: Settings,
    /// One row per basis, and the plain cut of spherical harmonics.
    pub rows: Vec<Row>,
    /// What is said of the eleventh entry of the table.
    pub eleventh: Eleventh,
    /// Orders that hold for every signal because one span lies in another.
    pub invariants: Vec<Invariant>,
}

/// One basis.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Row {
    /// The basis and how its coefficients are found.
    pub entry: Entry,
    /// Integrated mean square error of eq. 3.1, averaged over the signals.
    pub imse: Average,
    /// Its expectation under the model, by quadrature.
    pub expected: f64,
    /// What the paper prints.
    pub printed: Option<f64>,
    /// Time of one evaluation: the functions at a normal, times the coefficients of three channels, f32, one thread.
    pub nanoseconds: f64,
}

impl Row {
    /// Bytes of one texel of three channels with numbers of `bytes` bytes.
    #[must_use]
    pub const fn texel(&self, bytes: usize) -> usize {
        3 * bytes * self.entry.basis.count()
    }
}

/// A mean and its standard error.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Average {
    /// The mean over the signals.
    pub mean: f64,
    /// Its standard deviation, estimated from the spread of the signals.
    pub standard_error: f64,
}

/// Spherical harmonics with 9 coefficients when the signal goes on to degree 4, which irradiance does.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Eleventh {
    /// What the paper prints.
    pub printed: f64,
    /// Fitted on the hemisphere: average and expectation.
    pub fitted: (Average, f64),
    /// Cut from the coefficients of the sphere: average and expectation.
    pub cut: (Average, f64),
}

impl Study {
    /// The row of a basis with its least-squares coefficients.
    #[must_use]
    pub fn row(&self, basis: Basis) -> Option<&Row> {
        self.rows.iter().find(|row| row.entry == Entry::fitted(basis))
    }

    /// The two answers to the eleventh entry as rows: fitted and cut, under signals of 5 bands.
    #[must_use]
    pub fn eleventh_rows(&self) -> [Row; 2] {
        let Eleventh { printed, fitted, cut } = self.eleventh;
        let nanoseconds = self.row(Basis::Sh9).map_or(f64::NAN, |row| row.nanoseconds);
        [(Fit::LeastSquares, fitted), (Fit::Cut, cut)].map(|(fit, (imse, expected))| {
            let entry = Entry { basis: Basis::Sh9, fit };
            Row { entry, imse, expected, printed: Some(printed), nanoseconds }
        })
    }
}

/// Draws the signals, measures all errors and the time of every basis (about a second, on the calling thread).
///
/// # Panics
/// When fewer than 2 signals are asked for.
#[must_use]
pub fn study(settings: Settings) -> Study {
    assert!(settings.signals >= 2, "a spread needs two signals");
    let entries = Entry::all();
    let losses: Vec<Loss<NINE>> = entries.iter().map(|entry| entry.loss()).collect();
    let mut replicates = Replicates::default();
    let mut invariants = Invariant::all();
    let mut errors = vec![0.0; entries.len()];
    for number in 0..settings.signals {
        let signal = signal(settings.seed, number);
        errors.iter_mut().zip(&losses).for_each(|(error, loss)| *error = loss.of(&signal));
        replicates.add(&errors);
        let error = |entry| entries.iter().position(|e| *e == entry).map_or(f64::NAN, |i| errors[i]);
        invariants.iter_mut().for_each(|invariant| invariant.check(error));
    }
    let times = timing::nanoseconds();
    let row = |((entry, loss), imse): ((&Entry, &Loss<NINE>), Average)| Row {
        entry: *entry,
        imse,
        expected: loss.expectation(),
        printed: entry.printed(),
        nanoseconds: Basis::ALL.iter().position(|basis| *basis == entry.basis).map_or(f64::NAN, |i| times[i]),
    };
    let rows = entries.iter().zip(&losses).zip(averages(&replicates)).map(row).collect();
    Study { settings, rows, eleventh: eleventh(settings), invariants }
}

/// The eleventh entry under signals of 5 bands.
fn eleventh(settings: Settings) -> Eleventh {
    let measure = |fit| {
        let loss: Loss<TWENTY_FIVE> = Entry { basis: Basis::Sh9, fit }.loss();
        let mut replicates = Replicates::default();
        (0..settings.signals).for_each(|number| replicates.add(&[loss.of(&signal(settings.seed, number))]));
        (averages(&replicates)[0], loss.expectation())
    };
    Eleventh { printed: entry::PRINTED_SH_9, fitted: measure(Fit::LeastSquares), cut: measure(Fit::Cut) }
}

fn averages(replicates: &Replicates) -> Vec<Average> {
    let pairs = replicates.mean().iter().zip(replicates.std_error());
    pairs.map(|(&mean, standard_error)| Average { mean, standard_error }).collect()
}

/// Radiance coefficients of signal `number`: uniform in [-1, 1], a stream of its own for each.
fn signal<const N: usize>(seed: u64, number: u32) -> [f64; N] {
    let mut random = Rng::new(seed, u64::from(number));
    std::array::from_fn(|_| 2.0 * random.next_f64() - 1.0)
}
