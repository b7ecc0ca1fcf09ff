//! The least error within a time: bakes from coarse to fine, each result kept until a finer one is finished.

use crate::bake::{fault, watched};
use crate::console::Console;
use crate::interrupt;
use anyhow::Result;
use bake::Extras;
use coeff_io::{Prt, Quality, Refine, Settings};
use scene::Scene;
use std::time::{Duration, Instant};

/// Error of the first result: it takes hardly more rays than the two looks that any estimate needs.
const COARSEST: f32 = 0.1;
/// Errors are not asked below this.
const FINEST: f32 = 1e-4;
/// An error this much smaller than the last is worth another bake.
const WORTH: f32 = 0.8;
/// Most by which an error may shrink from one bake to the next: beyond, the prediction would guess.
const STEP: f32 = 4.0;
/// Share of the time left that a bake is planned to take.
const SHARE: f64 = 0.8;
/// Exponent of the time over the error before two results tell: rays grow with about this power.
const EXPONENT: f64 = 1.4;

/// A finished bake: the error that it kept, asked for or better, and the seconds that it took.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Rung {
    error: f32,
    seconds: f64,
}

/// Bakes with ever smaller errors while time lasts; `write` gets each result. The first is finished whatever it takes.
///
/// The error of each bake is chosen from the times of those before, so that it ends in the time left: what remains after
/// the last is too little for an error smaller by a fifth.
pub(crate) fn bake(
    scene: &Scene,
    settings: &Settings,
    extras: &Extras,
    allowed: Duration,
    write: &dyn Fn(&Prt) -> Result<()>,
    console: &Console,
) -> Result<Prt> {
    let began = Instant::now();
    let deadline = began + allowed;
    let mut rungs: Vec<Rung> = Vec::new();
    let mut best: Option<Prt> = None;
    let mut error = COARSEST;
    // The split of the triangles does not depend on the error.
    let scene = &*bake::refine_watched(scene, settings, &watched(&console.progress(), None)).map_err(fault)?;
    loop {
        let start = Instant::now();
        let wanted = Settings { quality: Quality::Error(error), refine: Refine::Off, ..settings.clone() };
        let limit = best.is_some().then_some(deadline);
        let result = bake::bake_with(scene, &wanted, extras, &watched(&console.progress(), limit));
        match (result, best) {
            (Err(bake::Error::Cancelled), Some(best)) => {
                let why = if interrupt::flow().is_break() { "Ctrl-C" } else { "time is up" };
                console.notice(&format!("{why}: the result before stays"));
                return Ok(best);
            }
            (result, _) => {
                let mut prt = result.map_err(fault)?;
                prt.settings.refine = settings.refine;
                write(&prt)?;
                let of_maps = prt.achieved.maps.map_or(0.0, |maps| maps.error[1]);
                let reached = prt.achieved.error[1].max(of_maps);
                // The fewest rays that tell an error often reach a smaller one than was asked for: that is what is to be beaten.
                rungs.push(Rung { error: error.min(reached), seconds: start.elapsed().as_secs_f64() });
                let seconds = began.elapsed().as_secs_f64();
                console.notice(&format!("after {seconds:.1} s: 95% of the errors below {reached:.4}"));
                if reached == 0.0 || spent(&prt, error) {
                    return Ok(prt);
                }
                best = Some(prt);
            }
        }
        let left = deadline.saturating_duration_since(Instant::now()).as_secs_f64();
        match (next(&rungs, left), best.take()) {
            (Some(finer), prt) => (error, best) = (finer, prt),
            (None, Some(prt)) => return Ok(prt),
            (None, None) => unreachable!("a result was just kept"),
        }
    }
}

/// Whether most receivers took all directions that there are: a smaller error would change nothing.
fn spent(prt: &Prt, asked: f32) -> bool {
    prt.achieved.error[0].max(prt.achieved.maps.map_or(0.0, |maps| maps.error[0])) > asked
}

/// The error to ask for next with so many seconds left; none where that would be hardly smaller.
fn next(rungs: &[Rung], left: f64) -> Option<f32> {
    let last = rungs.last()?;
    let exponent = match rungs {
        [.., before, last] => {
            let measured = (last.seconds / before.seconds).ln() / f64::from(before.error / last.error).ln();
            measured.clamp(1.0, 2.0)
        }
        _ => EXPONENT,
    };
    // seconds = last.seconds * (last.error / error)^exponent, solved for the error.
    let shrink = (left * SHARE / last.seconds.max(1e-6)).powf(1.0 / exponent).min(f64::from(STEP));
    let error = (f64::from(last.error) / shrink) as f32;
    let error = error.max(FINEST);
    (shrink > 0.0 && error <= WORTH * last.error).then_some(error)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A rule that says which error follows.
    type Rule = fn(&[Rung], f64) -> Option<f32>;

    /// Plays bakes whose time follows a power of the error, and returns the errors and the time that was used.
    fn play(rule: Rule, allowed: f64, exponent: f64, first: f64) -> (Vec<f32>, f64) {
        let seconds = |error: f32| first * f64::from(COARSEST / error).powf(exponent);
        let (mut rungs, mut used, mut error) = (Vec::new(), 0.0, COARSEST);
        loop {
            used += seconds(error);
            rungs.push(Rung { error, seconds: seconds(error) });
            match rule(&rungs, allowed - used) {
                Some(finer) => error = finer,
                None => return (rungs.iter().map(|r| r.error).collect(), used),
            }
        }
    }

    #[test]
    fn time_is_used_and_kept() {
        for exponent in [1.1, 1.4, 1.9] {
            let (errors, used) = play(next, 100.0, exponent, 1.0);
            assert!(errors.windows(2).all(|w| w[1] <= WORTH * w[0]), "from coarse to fine: {errors:?}");
            assert!(used <= 100.0, "no longer than allowed: {used}");
            // One bake for all the time would reach 100^(-1/exponent) of the first error; the ladder loses little of it.
            let best = f64::from(COARSEST) * 100.0f64.powf(-1.0 / exponent);
            let last = f64::from(*errors.last().expect("one at least"));
            assert!(last < 2.0 * best, "error {last} where {best} is possible");
        }
    }

    /// A ladder that does not look at its clock overruns: the check above would see it.
    #[test]
    fn time_is_used_and_kept_can_fail() {
        let blind: Rule = |rungs, left| (left > 0.0).then(|| rungs.last().expect("one at least").error / STEP);
        let (errors, used) = play(blind, 100.0, 1.9, 1.0);
        assert!(used > 100.0, "{errors:?} take {used}");
    }

    #[test]
    fn nothing_follows_where_time_is_up() {
        assert_eq!(next(&[Rung { error: COARSEST, seconds: 5.0 }], 0.0), None);
        assert_eq!(next(&[Rung { error: FINEST, seconds: 1.0 }], 1000.0), None);
        assert_eq!(next(&[], 10.0), None);
    }
}
