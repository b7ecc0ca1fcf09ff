//! What to type, from what was measured.

use super::report::Run;

/// What the user wants.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Goal {
    /// An error of the transfer that 95 of 100 receivers keep.
    Error(f64),
    /// Seconds of baking.
    Seconds(f64),
    /// Bytes of coefficients.
    Bytes(u64),
}

/// A run that serves a goal best.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Advice {
    /// The goal.
    pub goal: Goal,
    /// Index of the run.
    pub run: usize,
    /// Whether it meets the goal; else it is the one that comes nearest.
    pub met: bool,
}

/// The best run for a goal among those that can be typed; `None` where there is none.
///
/// For an error: the fastest run of the bands asked for that keeps it. For a time: the closest such run within it. For a
/// size: the run of any number of bands that errs least in radiance and fits. Where no run meets the goal: the one that
/// comes nearest.
#[must_use]
pub fn advise(runs: &[Run], bands: u32, goal: Goal) -> Option<Advice> {
    let error = |run: &Run| run.transfer.p95;
    let radiance = |run: &Run| run.radiance_all_bands.unwrap_or(f64::INFINITY);
    let same = |run: &Run| run.bands == bands;
    match goal {
        Goal::Error(most) => choose(runs, same, |run| [run.seconds, error(run)], |run| error(run) / most),
        Goal::Seconds(most) => choose(runs, same, |run| [error(run), run.seconds], |run| run.seconds / most),
        Goal::Bytes(most) => {
            choose(runs, |_| true, |run| [radiance(run), run.seconds], |run| run.bytes as f64 / most.max(1) as f64)
        }
    }
    .map(|(run, met)| Advice { goal, run, met })
}

/// The allowed run with the least `price` whose `load` is at most 1, else the one with the least load.
fn choose(
    runs: &[Run],
    allowed: impl Fn(&Run) -> bool,
    price: impl Fn(&Run) -> [f64; 2],
    load: impl Fn(&Run) -> f64,
) -> Option<(usize, bool)> {
    let candidates = || runs.iter().enumerate().filter(|(_, run)| run.can_be_typed && allowed(run));
    let meets = candidates().filter(|(_, run)| load(run) <= 1.0);
    let by = |a: [f64; 2], b: [f64; 2]| a[0].total_cmp(&b[0]).then(a[1].total_cmp(&b[1]));
    let best = meets.min_by(|(_, a), (_, b)| by(price(a), price(b)));
    let nearest = || candidates().min_by(|(_, a), (_, b)| load(a).total_cmp(&load(b)).then(by(price(a), price(b))));
    best.map(|(i, _)| (i, true)).or_else(|| nearest().map(|(i, _)| (i, false)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cost::Spread;
    use crate::cost::report::Knob;

    fn run(bands: u32, seconds: f64, p95: f64, radiance: f64, can_be_typed: bool) -> Run {
        Run {
            knob: Knob::Rays,
            setting: String::new(),
            can_be_typed,
            bands,
            receivers: 10,
            channels: 3,
            bounces: 1,
            rays: [0; 2],
            seconds,
            bytes: u64::from(bands * bands) * 120,
            transfer: Spread { p95, ..Spread::default() },
            radiance,
            radiance_all_bands: Some(radiance),
        }
    }

    /// 0 is quick and coarse, 1 is slower and close, 2 as close but slower still, 3 is small, 4 cannot be typed.
    fn runs() -> Vec<Run> {
        vec![
            run(5, 1.0, 0.05, 0.10, true),
            run(5, 4.0, 0.01, 0.06, true),
            run(5, 9.0, 0.009, 0.05, true),
            run(3, 2.0, 0.008, 0.20, true),
            run(5, 0.1, 0.001, 0.01, false),
        ]
    }

    fn chosen(goal: Goal) -> (usize, bool) {
        let advice = advise(&runs(), 5, goal).unwrap();
        (advice.run, advice.met)
    }

    #[test]
    fn each_goal_finds_its_run() {
        assert_eq!(chosen(Goal::Error(0.05)), (0, true));
        assert_eq!(chosen(Goal::Error(0.02)), (1, true), "the faster of the two that keep it");
        assert_eq!(chosen(Goal::Error(0.0095)), (2, true), "fewer bands are no answer");
        assert_eq!(chosen(Goal::Error(0.0001)), (2, false), "nearest where none keeps it");
        assert_eq!(chosen(Goal::Seconds(5.0)), (1, true));
        assert_eq!(chosen(Goal::Seconds(0.5)), (0, false));
        assert_eq!(chosen(Goal::Bytes(3000)), (2, true));
        assert_eq!(chosen(Goal::Bytes(1100)), (3, true), "only three bands fit");
        assert_eq!(chosen(Goal::Bytes(10)), (3, false));
    }

    /// The run that cannot be typed would win every goal: leaving the rule out is seen.
    #[test]
    fn each_goal_finds_its_run_can_fail() {
        let mut runs = runs();
        runs.iter_mut().for_each(|run| run.can_be_typed = true);
        assert_eq!(advise(&runs, 5, Goal::Error(0.05)).unwrap().run, 4);
        assert!(advise(&[], 5, Goal::Error(0.05)).is_none());
    }
}
