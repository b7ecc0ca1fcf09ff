//! The least error within a time: bakes from coarse to fine, each result kept until a finer one is finished.

use crate::bake::{fault, watched};
use crate::columns::percent;
use crate::console::Console;
use anyhow::Result;
use bake::Extras;
use coeff_io::{Bounces, Prt, Quality, Refine, Settings};
use scene::Scene;
use std::time::Instant;

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

/// Rays per second that any thread traces in a bake of any scene, all other work counted in.
const SPEED: f64 = 0.4e6;
/// Share of the time that the first result may take, for what is foreseen of it.
const FIRST: f64 = 0.3;
/// Rays for each that a receiver asks of the sky: what blocks them is looked up, backs and near surfaces look too.
const OTHERS: f64 = 4.0;
/// Rays of a receiver at [`COARSEST`], about.
const COARSE_RAYS: f64 = 128.0;
/// Fewest rays of a first result, and fewest for which its bounces are worth their time.
const FEWEST_RAYS: u32 = 16;
/// Receivers from which on the time of a bake tells that of one with more of them.
const TELLING: f64 = 20_000.0;

/// A finished bake: the error that it kept, asked for or better, and the seconds that it took.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Rung {
    error: f32,
    seconds: f64,
}

/// Bakes with ever smaller errors while time lasts; `keep` gets each result. The first is finished whatever it takes, so it is a coarse
/// one, of the triangles as they are; from then on whoever called may end the program at the deadline.
///
/// The error of each bake is chosen from the times of those before, so that it ends in the time left: what remains after
/// the last is too little for an error smaller by a fifth.
pub(crate) fn bake(
    scene: &Scene,
    settings: &Settings,
    extras: &Extras,
    deadline: Instant,
    keep: &dyn Fn(&Prt) -> Result<()>,
    console: &Console,
) -> Result<Prt> {
    let ladder = Ladder { settings, extras, deadline, keep, console };
    let first = first(scene, settings, ladder.left());
    let (mut best, rung) = ladder.step(scene, &first)?;
    let mut rungs = vec![rung];
    let mut scene = std::borrow::Cow::Borrowed(scene);
    if settings.refine != Refine::Off && ladder.left() > rung.seconds {
        let fine = bake::refine_watched(&scene, settings, &watched(&console.progress())).map_err(fault)?;
        if foreseen(&scene, &fine, &first, rung) < ladder.left() {
            let wanted = Settings { quality: Quality::Error(COARSEST), ..settings.clone() };
            let rung;
            (best, rung) = ladder.step(&fine, &wanted)?;
            rungs = vec![rung];
            scene = std::borrow::Cow::Owned(fine.into_owned());
        }
    }
    while !exhausted(&best) {
        let Some(error) = next(&rungs, ladder.left()) else { break };
        let (prt, rung) = ladder.step(&scene, &Settings { quality: Quality::Error(error), ..settings.clone() })?;
        best = prt;
        rungs.push(rung);
    }
    Ok(best)
}

/// What all bakes have in common.
struct Ladder<'a> {
    settings: &'a Settings,
    extras: &'a Extras,
    deadline: Instant,
    keep: &'a dyn Fn(&Prt) -> Result<()>,
    console: &'a Console,
}

impl Ladder<'_> {
    fn left(&self) -> f64 {
        self.deadline.saturating_duration_since(Instant::now()).as_secs_f64()
    }

    /// One bake of triangles that are split already, or not to be split.
    fn step(&self, scene: &Scene, wanted: &Settings) -> Result<(Prt, Rung)> {
        let start = Instant::now();
        let wanted = Settings { refine: Refine::Off, ..wanted.clone() };
        let mut prt =
            bake::bake_with(scene, &wanted, self.extras, &watched(&self.console.progress())).map_err(fault)?;
        prt.settings.refine = self.settings.refine;
        (self.keep)(&prt)?;
        let reached = reached(&prt);
        // The fewest rays that tell an error often reach a smaller one than was asked for: that is what is to be beaten.
        let error = match wanted.quality {
            Quality::Error(asked) => asked.min(reached),
            Quality::Rays(_) => COARSEST,
        };
        let rung = Rung { error, seconds: start.elapsed().as_secs_f64() };
        let seconds = self.console.began().elapsed().as_secs_f64();
        match wanted.quality {
            Quality::Error(_) => {
                self.console.notice(&format!("after {seconds:.1} s: 95 % of the errors below {}", percent(reached)));
            }
            Quality::Rays(rays) => self.console.notice(&format!("after {seconds:.1} s: a first result of {rays} rays")),
        }
        Ok((prt, rung))
    }
}

/// The error of most receivers and texels.
fn reached(prt: &Prt) -> f32 {
    prt.achieved.error[1].max(prt.achieved.maps.map_or(0.0, |maps| maps.error[1]))
}

/// Settings of the first result: as coarse as the time needs, by a speed that every machine has.
fn first(scene: &Scene, settings: &Settings, seconds: f64) -> Settings {
    let rays = SPEED * rayon::current_num_threads() as f64 * FIRST * seconds / (OTHERS * receivers(scene).max(1.0));
    if rays >= COARSE_RAYS {
        return Settings { quality: Quality::Error(COARSEST), ..settings.clone() };
    }
    let bounces = match settings.bounces {
        _ if rays < f64::from(FEWEST_RAYS) / 2.0 => Bounces::Fixed(0),
        Bounces::Fixed(0) => Bounces::Fixed(0),
        _ => Bounces::Fixed(1),
    };
    Settings { quality: Quality::Rays((rays as u32).clamp(FEWEST_RAYS, 64)), bounces, ..settings.clone() }
}

/// Vertices, and the backs of those that have two sides.
fn receivers(scene: &Scene) -> f64 {
    let sides = |mesh: &scene::Mesh| if scene.materials[mesh.material as usize].double_sided { 2.0 } else { 1.0 };
    scene.meshes.iter().map(|mesh| mesh.positions.len() as f64 * sides(mesh)).sum()
}

/// Seconds that a coarse bake of the split triangles should take, by the first bake; 0 where that was too small to tell.
fn foreseen(scene: &Scene, fine: &Scene, first: &Settings, rung: Rung) -> f64 {
    let before = receivers(scene);
    if before < TELLING {
        return 0.0;
    }
    let rays = match first.quality {
        Quality::Rays(rays) => COARSE_RAYS / f64::from(rays),
        Quality::Error(_) => 1.0,
    };
    rung.seconds * rays * receivers(fine) / before
}

/// Whether no error is left, or most receivers took all directions that there are: a smaller error would change nothing.
fn exhausted(prt: &Prt) -> bool {
    match prt.settings.quality {
        Quality::Rays(_) => false,
        Quality::Error(asked) => {
            reached(prt) == 0.0
                || prt.achieved.error[0].max(prt.achieved.maps.map_or(0.0, |maps| maps.error[0])) > asked
        }
    }
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

    /// A scene too large for its time gets few rays, and no bounces where even these are many; a small one is as asked for.
    #[test]
    fn the_first_result_is_as_coarse_as_its_time() {
        let scene = scene::builtin("atrium").expect("built in");
        let settings = bake::settings::standard();
        assert_eq!(first(&scene, &settings, 60.0).quality, Quality::Error(COARSEST));
        let quick = first(&scene, &settings, 1e-3 * receivers(&scene) * 1e-3);
        assert_eq!(quick.quality, Quality::Rays(FEWEST_RAYS));
        assert!(matches!(quick.bounces, Bounces::Fixed(0 | 1)), "{:?}", quick.bounces);
        let none = first(&scene, &settings, 0.0);
        assert_eq!((none.quality, none.bounces), (Quality::Rays(FEWEST_RAYS), Bounces::Fixed(0)));
    }

    #[test]
    fn nothing_follows_where_time_is_up() {
        assert_eq!(next(&[Rung { error: COARSEST, seconds: 5.0 }], 0.0), None);
        assert_eq!(next(&[Rung { error: FINEST, seconds: 1.0 }], 1000.0), None);
        assert_eq!(next(&[], 10.0), None);
    }
}
