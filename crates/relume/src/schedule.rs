//! Which bake follows within a time: predictions from the times of the bakes before.

use coeff_io::{Bounces, Quality, Settings};
use scene::Scene;

/// Error of the first result: it takes hardly more rays than the two looks that any estimate needs.
pub(crate) const COARSEST: f32 = 0.1;
/// Errors are not asked below this.
pub(crate) const FINEST: f32 = 1e-4;
/// An error this much smaller than the last is worth another bake.
pub(crate) const WORTH: f32 = 0.8;
/// Most by which an error may shrink from one bake to the next: beyond, the prediction would guess.
pub(crate) const STEP: f32 = 4.0;
/// Share of the time left that a bake is planned to take.
pub(crate) const SHARE: f64 = 0.8;
/// Exponent of the time over the error before two results tell: rays grow with about this power.
pub(crate) const EXPONENT: f64 = 1.4;

/// Rays of the first result: the fewest that a bake takes, so that it comes as early as the scene allows and tells how fast rays are there.
pub(crate) const FIRST_RAYS: u32 = 16;
/// Rays traced for each of the first result's: some tell what blocks the others.
pub(crate) const PROBES: f64 = 2.0;
/// The same where light bounces: what blocks each ray is looked up, backs and near surfaces look too.
pub(crate) const OTHERS: f64 = 4.0;
/// Rays of a receiver at [`COARSEST`], about.
pub(crate) const COARSE_RAYS: f64 = 128.0;
/// Fewest rays for which bounces are worth their time, and for which another result is.
pub(crate) const FEWEST_RAYS: f64 = 32.0;
/// Time that must be left for splitting the triangles and a coarse bake of them, in that of a coarse bake of the triangles as they are.
pub(crate) const SPLITTING: f64 = 4.0;

/// A finished bake: the error that it kept, asked for or better, and the seconds that it took, all of them and before the first ray.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Rung {
    pub(crate) error: f32,
    pub(crate) seconds: f64,
    pub(crate) preparation: f64,
}

/// How fast bakes of a scene are, by one of them.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Speed {
    /// Seconds before the first ray, per receiver.
    preparation: f64,
    /// Seconds per ray, all other work counted in.
    ray: f64,
}

impl Speed {
    pub(crate) fn new(settings: &Settings, rung: Rung, receivers: f64) -> Speed {
        let rays = match settings.quality {
            Quality::Rays(rays) => f64::from(rays),
            Quality::Error(_) => COARSE_RAYS,
        };
        let receivers = receivers.max(1.0);
        let traced = (rung.seconds - rung.preparation).max(0.0);
        Speed { preparation: rung.preparation / receivers, ray: traced / (rays * others(settings.bounces) * receivers) }
    }

    /// Seconds that a bake with so many rays per receiver should take.
    pub(crate) fn seconds(self, rays: f64, bounces: Bounces, receivers: f64) -> f64 {
        receivers * (self.preparation + self.ray * rays * others(bounces))
    }

    pub(crate) fn coarse(self, settings: &Settings, receivers: f64) -> f64 {
        self.seconds(COARSE_RAYS, settings.bounces, receivers)
    }

    /// Rays per receiver of a bake in so many seconds.
    pub(crate) fn rays(self, seconds: f64, bounces: Bounces, receivers: f64) -> f64 {
        (seconds / receivers.max(1.0) - self.preparation) / (self.ray * others(bounces)).max(f64::MIN_POSITIVE)
    }
}

/// Rays that are traced for each that a receiver asks of the sky.
pub(crate) fn others(bounces: Bounces) -> f64 {
    if bounces == Bounces::Fixed(0) { PROBES } else { OTHERS }
}

/// Settings of the result after one of a number of rays: a coarse error, where the time does not suffice more rays than before, with a
/// bounce if possible; none where there would be too few.
pub(crate) fn coarser(
    before: &Settings,
    settings: &Settings,
    speed: Speed,
    receivers: f64,
    left: f64,
) -> Option<Settings> {
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

/// Vertices, and the backs of those that have two sides.
pub(crate) fn receivers(scene: &Scene) -> f64 {
    let sides = |mesh: &scene::Mesh| if scene.materials[mesh.material as usize].double_sided { 2.0 } else { 1.0 };
    scene.meshes.iter().map(|mesh| mesh.positions.len() as f64 * sides(mesh)).sum()
}

/// The error to ask for next with so many seconds left; none where that would be hardly smaller.
pub(crate) fn next(rungs: &[Rung], left: f64) -> Option<f32> {
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
            let speed = Speed::new(&wanted, Rung { error: COARSEST, seconds, preparation }, receivers);
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
