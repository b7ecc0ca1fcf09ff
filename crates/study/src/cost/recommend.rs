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

/// What advice rests on beside the runs.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Ground {
    /// Bands asked for.
    pub bands: u32,
    /// Error of the reference itself that 95 of 100 receivers keep.
    pub own: f64,
    /// Index of the bake as asked, where it was made.
    pub asked: Option<usize>,
}

/// Share by which two times of the same work may differ, and the seconds by which they may in any case.
const NOISE: (f64, f64) = (0.2, 0.05);

/// The best run for a goal among those that can be typed; `None` where there is none.
///
/// For an error: the fastest run of the bands asked for that keeps it, the reference's own error taken out. For a time:
/// the closest such run within it. For a size: the run of any number of bands that errs least in radiance and fits. Where
/// no run meets the goal: the one that comes nearest. The bake as asked is taken where only the noise of the clock
/// separates it from the best.
#[must_use]
pub fn advise(runs: &[Run], ground: Ground, goal: Goal) -> Option<Advice> {
    let error = |run: &Run| without_own(run.transfer.p95, ground.own);
    let radiance = |run: &Run| run.radiance_all_bands.unwrap_or(f64::INFINITY);
    let same = |run: &Run| run.bands == ground.bands;
    let asked = ground.asked;
    match goal {
        Goal::Error(most) => choose(runs, asked, same, |run| [0.0, run.seconds], |run| error(run) / most),
        Goal::Seconds(most) => choose(runs, asked, same, |run| [error(run), run.seconds], |run| run.seconds / most),
        Goal::Bytes(most) => {
            let load = |run: &Run| run.bytes as f64 / most.max(1) as f64;
            choose(runs, asked, |_| true, |run| [radiance(run), run.seconds], load)
        }
    }
    .map(|(run, met)| Advice { goal, run, met })
}

/// A measured error without that of the reference: both err independently, so that their squares add up.
pub(super) fn without_own(measured: f64, own: f64) -> f64 {
    (measured * measured - own * own).max(0.0).sqrt()
}

/// The allowed run with the least `price`, an error and seconds, whose `load` is at most 1; else the one with the least
/// load. The run `asked` goes before where its error is no larger and its seconds are the same but for noise.
fn choose(
    runs: &[Run],
    asked: Option<usize>,
    allowed: impl Fn(&Run) -> bool,
    price: impl Fn(&Run) -> [f64; 2],
    load: impl Fn(&Run) -> f64,
) -> Option<(usize, bool)> {
    let candidates = || runs.iter().enumerate().filter(|(_, run)| run.can_be_typed && allowed(run));
    let meets = || candidates().filter(|(_, run)| load(run) <= 1.0);
    let by = |a: [f64; 2], b: [f64; 2]| a[0].total_cmp(&b[0]).then(a[1].total_cmp(&b[1]));
    let best = meets().min_by(|(_, a), (_, b)| by(price(a), price(b)));
    let as_good = |best: [f64; 2], [error, seconds]: [f64; 2]| {
        error <= best[0] && seconds <= (best[1] * (1.0 + NOISE.0)).max(best[1] + NOISE.1)
    };
    let nearest = || candidates().min_by(|(_, a), (_, b)| load(a).total_cmp(&load(b)).then(by(price(a), price(b))));
    match best {
        Some((best, run)) => {
            let asked = meets().find(|(i, other)| asked == Some(*i) && as_good(price(run), price(other)));
            Some((asked.map_or(best, |(i, _)| i), true))
        }
        None => nearest().map(|(i, _)| (i, false)),
    }
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

    fn ground(own: f64, asked: Option<usize>) -> Ground {
        Ground { bands: 5, own, asked }
    }

    fn chosen(goal: Goal) -> (usize, bool) {
        let advice = advise(&runs(), ground(0.0, None), goal).unwrap();
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
        assert_eq!(advise(&runs, ground(0.0, None), Goal::Error(0.05)).unwrap().run, 4);
        assert!(advise(&[], ground(0.0, None), Goal::Error(0.05)).is_none());
    }

    /// The Cornell box: 1.076 % measured, 0.428 % of it the reference's; the root of the difference of squares is 0.987 %.
    #[test]
    fn the_error_of_the_reference_is_taken_out() {
        let runs = [run(5, 1.0, 0.01076, 0.1, true)];
        assert!(advise(&runs, ground(0.00428, None), Goal::Error(0.01)).unwrap().met);
        assert!((without_own(0.01076, 0.00428) - 0.00987).abs() < 1e-5);
        assert_eq!(without_own(0.001, 0.002), 0.0, "less than the reference's own is no number below 0");
    }

    /// With an exact reference the same run errs too much, as does a larger error beside this reference.
    #[test]
    fn the_error_of_the_reference_is_taken_out_can_fail() {
        assert!(!advise(&[run(5, 1.0, 0.01076, 0.1, true)], ground(0.0, None), Goal::Error(0.01)).unwrap().met);
        assert!(!advise(&[run(5, 1.0, 0.0110, 0.1, true)], ground(0.00428, None), Goal::Error(0.01)).unwrap().met);
    }

    /// Runs of no error whose times differ by the clock alone: 0 is as asked, 1 a little faster.
    #[test]
    fn noise_does_not_speak_against_the_bake_as_asked() {
        for (asked, other) in [(0.03, 0.001), (11.9, 10.0)] {
            let runs = [run(5, asked, 0.0, 0.0, true), run(5, other, 0.0, 0.0, true)];
            for goal in [Goal::Error(0.01), Goal::Seconds(20.0), Goal::Bytes(1 << 20)] {
                assert_eq!(advise(&runs, ground(0.0, Some(0)), goal).unwrap().run, 0, "{asked} s, {goal:?}");
            }
        }
    }

    /// More than noise, an error too large, and a larger error where the least is wanted do.
    #[test]
    fn noise_does_not_speak_against_the_bake_as_asked_can_fail() {
        let chosen = |asked: Run, goal| {
            advise(&[asked, run(5, 10.0, 0.001, 0.1, true)], ground(0.0, Some(0)), goal).unwrap().run
        };
        assert_eq!(chosen(run(5, 12.1, 0.001, 0.1, true), Goal::Error(0.01)), 1);
        assert_eq!(chosen(run(5, 10.1, 0.02, 0.1, true), Goal::Error(0.01)), 1);
        assert_eq!(chosen(run(5, 10.1, 0.002, 0.1, true), Goal::Seconds(20.0)), 1);
        assert_eq!(chosen(run(5, 10.1, 0.001, 0.2, true), Goal::Bytes(1 << 20)), 1);
    }
}
