//! The least error within a time: bakes from coarse to fine, each result kept until a finer one is finished.

use crate::bake::{fault, watched};
use crate::columns::percent;
use crate::console::Console;
use anyhow::Result;
use bake::Extras;
use coeff_io::{Bounces, Prt, Quality, Refine, Settings};
use scene::Scene;
use std::sync::OnceLock;
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

/// Rays of the first result: the fewest that a bake takes, so that it comes as early as the scene allows and tells how fast rays are there.
const FIRST_RAYS: u32 = 16;
/// Rays traced for each of the first result's: some tell what blocks the others.
const PROBES: f64 = 2.0;
/// The same where light bounces: what blocks each ray is looked up, backs and near surfaces look too.
const OTHERS: f64 = 4.0;
/// Rays of a receiver at [`COARSEST`], about.
const COARSE_RAYS: f64 = 128.0;
/// Fewest rays for which bounces are worth their time, and for which another result is.
const FEWEST_RAYS: f64 = 32.0;
/// Time that must be left for splitting the triangles and a coarse bake of them, in that of a coarse bake of the triangles as they are.
const SPLITTING: f64 = 4.0;

/// A finished bake: the error that it kept, asked for or better, and the seconds that it took, all of them and before the first ray.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Rung {
    error: f32,
    seconds: f64,
    preparation: f64,
}

/// Bakes with ever smaller errors while time lasts; `keep` gets each result. The first is finished whatever it takes, so it is the coarsest,
/// of the triangles as they are; from then on whoever called may end the program at the deadline.
///
/// What follows is chosen from the times of the bakes before, so that it ends in the time left: what remains after the last is too little
/// for an error smaller by a fifth.
pub(crate) fn bake(
    scene: &Scene,
    settings: &Settings,
    extras: &Extras,
    deadline: Instant,
    keep: &dyn Fn(&Prt) -> Result<()>,
    console: &Console,
) -> Result<Prt> {
    let ladder = Ladder { extras, deadline, keep, console };
    let first = Settings { quality: Quality::Rays(FIRST_RAYS), bounces: Bounces::Fixed(0), ..settings.clone() };
    // What is done of the splitting that was asked for.
    let mut split = Refine::Off;
    let (mut best, rung) = ladder.step(scene, &first, split)?;
    let mut speed = Speed::of(&first, rung, receivers(scene));
    let mut scene = std::borrow::Cow::Borrowed(scene);
    let (mut before, mut rungs) = (first, Vec::new());
    while rungs.is_empty() {
        let Some(wanted) = coarser(&before, settings, speed, receivers(&scene), ladder.left()) else { return Ok(best) };
        let rung;
        (best, rung) = ladder.step(&scene, &wanted, split)?;
        speed = Speed::of(&wanted, rung, receivers(&scene));
        if let Quality::Error(_) = wanted.quality {
            rungs.push(rung);
        }
        before = wanted;
    }
    if let [rung] = rungs[..]
        && settings.refine != Refine::Off
        && SPLITTING * rung.seconds < ladder.left()
    {
        let fine = bake::refine_watched(&scene, settings, &watched(&console.progress())).map_err(fault)?;
        if speed.coarse(settings, receivers(&fine)) < SHARE * ladder.left() {
            let wanted = Settings { quality: Quality::Error(COARSEST), ..settings.clone() };
            let rung;
            split = settings.refine;
            (best, rung) = ladder.step(&fine, &wanted, split)?;
            rungs = vec![rung];
            scene = std::borrow::Cow::Owned(fine.into_owned());
        }
    }
    while !exhausted(&best) {
        let Some(error) = next(&rungs, ladder.left()) else { break };
        let wanted = Settings { quality: Quality::Error(error), ..settings.clone() };
        let (prt, rung) = ladder.step(&scene, &wanted, split)?;
        best = prt;
        rungs.push(rung);
    }
    Ok(best)
}

/// How fast bakes of a scene are, by one of them.
#[derive(Debug, Clone, Copy)]
struct Speed {
    /// Seconds before the first ray, per receiver.
    preparation: f64,
    /// Seconds per ray, all other work counted in.
    ray: f64,
}

impl Speed {
    fn of(settings: &Settings, rung: Rung, receivers: f64) -> Speed {
        let rays = match settings.quality {
            Quality::Rays(rays) => f64::from(rays),
            Quality::Error(_) => COARSE_RAYS,
        };
        let receivers = receivers.max(1.0);
        let traced = (rung.seconds - rung.preparation).max(0.0);
        Speed { preparation: rung.preparation / receivers, ray: traced / (rays * others(settings.bounces) * receivers) }
    }

    /// Seconds that a bake with so many rays per receiver should take.
    fn seconds(self, rays: f64, bounces: Bounces, receivers: f64) -> f64 {
        receivers * (self.preparation + self.ray * rays * others(bounces))
    }

    fn coarse(self, settings: &Settings, receivers: f64) -> f64 {
        self.seconds(COARSE_RAYS, settings.bounces, receivers)
    }

    /// Rays per receiver of a bake in so many seconds.
    fn rays(self, seconds: f64, bounces: Bounces, receivers: f64) -> f64 {
        (seconds / receivers.max(1.0) - self.preparation) / (self.ray * others(bounces)).max(f64::MIN_POSITIVE)
    }
}

/// Rays that are traced for each that a receiver asks of the sky.
fn others(bounces: Bounces) -> f64 {
    if bounces == Bounces::Fixed(0) { PROBES } else { OTHERS }
}

/// Settings of the result after one of a number of rays: a coarse error, where the time does not suffice more rays than before, with a
/// bounce if possible; none where there would be too few.
fn coarser(before: &Settings, settings: &Settings, speed: Speed, receivers: f64, left: f64) -> Option<Settings> {
    let left = SHARE * left;
    if speed.coarse(settings, receivers) < left {
        return Some(Settings { quality: Quality::Error(COARSEST), ..settings.clone() });
    }
    let Quality::Rays(had) = before.quality else { return None };
    let one = if settings.bounces == Bounces::Fixed(0) { Bounces::Fixed(0) } else { Bounces::Fixed(1) };
    [one, Bounces::Fixed(0)].into_iter().find_map(|bounces| {
        let rays = speed.rays(left, bounces, receivers);
        (rays >= FEWEST_RAYS.max(2.0 * f64::from(had))).then(|| Settings {
            quality: Quality::Rays(rays.min(COARSE_RAYS) as u32),
            bounces,
            ..settings.clone()
        })
    })
}

/// What all bakes have in common.
struct Ladder<'a> {
    extras: &'a Extras,
    deadline: Instant,
    keep: &'a dyn Fn(&Prt) -> Result<()>,
    console: &'a Console,
}

impl Ladder<'_> {
    fn left(&self) -> f64 {
        self.deadline.saturating_duration_since(Instant::now()).as_secs_f64()
    }

    /// One bake of triangles that are split already, as the file will say, or not to be split.
    fn step(&self, scene: &Scene, wanted: &Settings, split: Refine) -> Result<(Prt, Rung)> {
        let start = Instant::now();
        let wanted = Settings { refine: Refine::Off, ..wanted.clone() };
        let (progress, traced) = (self.console.progress(), OnceLock::new());
        let show = watched(&progress);
        let watch = |now: &bake::Progress| {
            if now.stage != bake::Stage::Preparation {
                traced.get_or_init(Instant::now);
            }
            show(now)
        };
        let mut prt = bake::bake_with(scene, &wanted, self.extras, &watch).map_err(fault)?;
        prt.settings.refine = split;
        (self.keep)(&prt)?;
        let reached = reached(&prt);
        // The fewest rays that tell an error often reach a smaller one than was asked for: that is what is to be beaten.
        let error = match wanted.quality {
            Quality::Error(asked) => asked.min(reached),
            Quality::Rays(_) => COARSEST,
        };
        let preparation = traced.get().map_or(0.0, |traced| traced.duration_since(start).as_secs_f64());
        let rung = Rung { error, seconds: start.elapsed().as_secs_f64(), preparation };
        let seconds = self.console.began().elapsed().as_secs_f64();
        match wanted.quality {
            Quality::Error(_) => {
                self.console.notice(&format!("after {seconds:.1} s: 95 % of the errors below {}", percent(reached)));
            }
            Quality::Rays(rays) => {
                self.console.notice(&format!("after {seconds:.1} s: a result of {rays} rays per receiver"));
            }
        }
        Ok((prt, rung))
    }
}

/// The error of most receivers and texels.
fn reached(prt: &Prt) -> f32 {
    prt.achieved.error[1].max(prt.achieved.maps.map_or(0.0, |maps| maps.error[1]))
}

/// Vertices, and the backs of those that have two sides.
fn receivers(scene: &Scene) -> f64 {
    let sides = |mesh: &scene::Mesh| if scene.materials[mesh.material as usize].double_sided { 2.0 } else { 1.0 };
    scene.meshes.iter().map(|mesh| mesh.positions.len() as f64 * sides(mesh)).sum()
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
            // Bakes of one error, or of no time, tell nothing.
            if measured.is_nan() { EXPONENT } else { measured.clamp(1.0, 2.0) }
        }
        _ => EXPONENT,
    };
    // seconds = last.seconds * (last.error / error)^exponent, solved for the error.
    let shrink = (left * SHARE / last.seconds.max(1e-6)).powf(1.0 / exponent);
    // Of a number and what is none the smaller one would be the number.
    let shrink = if shrink.is_nan() { 0.0 } else { shrink.min(f64::from(STEP)) };
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
            rungs.push(Rung { error, seconds: seconds(error), preparation: 0.0 });
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

    /// Of a machine that traces so many rays a second, with so many seconds of preparation: the results in the time, by their rays, and
    /// the seconds that they take. Rays of an error are those of a coarse one.
    fn results(receivers: f64, preparation: f64, rays_per_second: f64, allowed: f64) -> (Vec<f64>, f64) {
        let settings = bake::settings::standard();
        let (mut left, mut found) = (allowed, Vec::new());
        let mut wanted =
            Settings { quality: Quality::Rays(FIRST_RAYS), bounces: Bounces::Fixed(0), ..settings.clone() };
        loop {
            let rays = match wanted.quality {
                Quality::Rays(rays) => f64::from(rays),
                Quality::Error(_) => COARSE_RAYS,
            };
            let seconds = preparation + receivers * rays * others(wanted.bounces) / rays_per_second;
            left -= seconds;
            found.push(rays);
            let speed = Speed::of(&wanted, Rung { error: COARSEST, seconds, preparation }, receivers);
            match coarser(&wanted, &settings, speed, receivers, left) {
                Some(next) if matches!(wanted.quality, Quality::Rays(_)) => wanted = next,
                _ => return (found, allowed - left),
            }
        }
    }

    /// The first result is the coarsest, whatever the time; a coarse error follows where the measured speed allows it, else more rays,
    /// and all of that within the time.
    #[test]
    fn results_follow_from_the_measured_speed() {
        // Twice a first result takes 7 s, then 70 s.
        let (fast, slow) = (4e6, 2e5);
        let (found, used) = results(200_000.0, 2.0, fast, 60.0);
        assert_eq!(found, [16.0, COARSE_RAYS], "in {used} s");
        let (found, used) = results(200_000.0, 2.0, fast, 20.0);
        assert!(found.len() == 2 && found[1] >= FEWEST_RAYS && found[1] < COARSE_RAYS, "{found:?}");
        assert!(used < 20.0, "{used}");
        let (found, used) = results(200_000.0, 2.0, slow, 20.0);
        assert_eq!(found, [16.0], "the time is up before more could come: {used}");
        let (found, used) = results(1_000.0, 0.1, slow, 20.0);
        assert_eq!(found, [16.0, COARSE_RAYS], "a small scene, in {used} s");
    }

    /// The same scene on a machine that is taken to be ten times as fast as it is: the check above would see it.
    #[test]
    fn results_follow_from_the_measured_speed_can_fail() {
        let settings = bake::settings::standard();
        let guessed = Speed { preparation: 1e-5, ray: 1.0 / 4e7 };
        let next = coarser(
            &Settings { quality: Quality::Rays(FIRST_RAYS), ..settings.clone() },
            &settings,
            guessed,
            200_000.0,
            16.0,
        );
        let wanted = next.expect("the guess allows it");
        assert!(2.0 + 200_000.0 * COARSE_RAYS * others(wanted.bounces) / 4e6 > 16.0, "it takes longer");
    }

    /// Two results of one error in one time, or in none, say nothing of how time grows: what is known beforehand stands in.
    #[test]
    fn results_that_tell_nothing_are_passed_over() {
        let rung = |error, seconds| Rung { error, seconds, preparation: 0.0 };
        for seconds in [0.0, 2.0] {
            let known = next(&[rung(0.05, seconds)], 4.0);
            assert!(known.is_some());
            assert_eq!(next(&[rung(0.05, seconds), rung(0.05, seconds)], 4.0), known);
        }
        // A time that is no number allows nothing.
        assert_eq!(next(&[rung(0.05, 2.0)], f64::NAN), None);
        assert_eq!(next(&[rung(0.05, 2.0), rung(0.02, f64::NAN)], f64::NAN), None);
    }

    /// The quotient of two such results is no number, and the least of that and the largest step would be that step.
    #[test]
    fn results_that_tell_nothing_are_passed_over_can_fail() {
        let measured = (2.0f64 / 2.0).ln() / f64::from(0.05f32 / 0.05).ln();
        assert_eq!(measured.clamp(1.0, 2.0).min(f64::from(STEP)), f64::from(STEP));
    }

    #[test]
    fn nothing_follows_where_time_is_up() {
        assert_eq!(next(&[Rung { error: COARSEST, seconds: 5.0, preparation: 0.0 }], 0.0), None);
        assert_eq!(next(&[Rung { error: FINEST, seconds: 1.0, preparation: 0.0 }], 1000.0), None);
        assert_eq!(next(&[], 10.0), None);
    }
}
