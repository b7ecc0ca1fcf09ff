//! The least error within a time: bakes from coarse to fine, each result kept until a finer one is finished.

use crate::schedule::{COARSEST, FIRST_RAYS, Rung, SHARE, SPLITTING, Speed, coarser, next, receivers};
use bake::{Extras, ProgressFn};
use coeff_io::{Bounces, Prt, Quality, Refine, Settings};
use scene::Scene;
use std::borrow::Cow;
use std::sync::OnceLock;
use std::time::Instant;

/// Bakes with ever smaller errors while time lasts, and returns the finest result; `keep` gets each as it is finished.
///
/// The first result is finished however long it takes, so it is the coarsest, of the triangles as they are. Each next bake is chosen
/// from the times of those before, so that it ends within the time; the last leaves too little for an error smaller by a fifth.
/// Where `progress` cancels after the first result, the finest so far is returned.
///
/// # Errors
/// Those of [`bake::bake_with`], and those of `keep`.
pub fn bake_within<E: From<bake::Error>>(
    scene: &Scene,
    settings: &Settings,
    extras: &Extras,
    deadline: Instant,
    keep: &dyn Fn(&Prt) -> Result<(), E>,
    progress: ProgressFn<'_>,
) -> Result<Prt, E> {
    let ladder = Ladder { extras, deadline, keep, progress };
    let first = Settings { quality: Quality::Rays(FIRST_RAYS), bounces: Bounces::Fixed(0), ..settings.clone() };
    let mut climb = ladder.first(scene, first)?;
    while climb.rungs.is_empty() {
        let (speed, receivers) = (climb.speed, receivers(&climb.scene));
        let Some(wanted) = coarser(&climb.before, settings, speed, receivers, ladder.left()) else {
            return Ok(climb.best);
        };
        if !ladder.step(&mut climb, &wanted)? {
            return Ok(climb.best);
        }
    }
    if !ladder.split(&mut climb, settings)? {
        return Ok(climb.best);
    }
    while !exhausted(&climb.best) {
        let Some(error) = next(&climb.rungs, ladder.left()) else { break };
        let wanted = Settings { quality: Quality::Error(error), ..settings.clone() };
        if !ladder.step(&mut climb, &wanted)? {
            break;
        }
    }
    Ok(climb.best)
}

/// The error that 95 % of the receivers and texels of a bake stay below.
pub fn achieved_error(prt: &Prt) -> f32 {
    prt.achieved.error[1].max(prt.achieved.maps.map_or(0.0, |maps| maps.error[1]))
}

/// What all bakes have in common.
struct Ladder<'a, E> {
    extras: &'a Extras,
    deadline: Instant,
    keep: &'a dyn Fn(&Prt) -> Result<(), E>,
    progress: ProgressFn<'a>,
}

/// The results so far.
struct Climb<'a> {
    /// The scene, split or not.
    scene: Cow<'a, Scene>,
    /// How it was split.
    split: Refine,
    best: Prt,
    /// Settings of the best.
    before: Settings,
    speed: Speed,
    /// Results with an error, from coarse to fine.
    rungs: Vec<Rung>,
}

impl<E: From<bake::Error>> Ladder<'_, E> {
    fn left(&self) -> f64 {
        self.deadline.saturating_duration_since(Instant::now()).as_secs_f64()
    }

    /// The first result, which nothing cuts short.
    fn first<'a>(&self, scene: &'a Scene, first: Settings) -> Result<Climb<'a>, E> {
        let Some((best, rung)) = self.kept(scene, &first, Refine::Off)? else {
            return Err(bake::Error::Cancelled.into());
        };
        let speed = Speed::new(&first, rung, receivers(scene));
        let scene = Cow::Borrowed(scene);
        Ok(Climb { scene, split: Refine::Off, best, before: first, speed, rungs: Vec::new() })
    }

    /// One more result; false where it was cancelled.
    fn step(&self, climb: &mut Climb<'_>, wanted: &Settings) -> Result<bool, E> {
        let Some((prt, rung)) = self.kept(&climb.scene, wanted, climb.split)? else { return Ok(false) };
        climb.best = prt;
        climb.speed = Speed::new(wanted, rung, receivers(&climb.scene));
        climb.before = wanted.clone();
        if let Quality::Error(_) = wanted.quality {
            climb.rungs.push(rung);
        }
        Ok(true)
    }

    /// After one coarse result: splits the triangles and bakes them, where the time suffices; false where it was cancelled.
    fn split(&self, climb: &mut Climb<'_>, settings: &Settings) -> Result<bool, E> {
        let [rung] = climb.rungs[..] else { return Ok(true) };
        if settings.refine == Refine::Off || SPLITTING * rung.seconds >= self.left() {
            return Ok(true);
        }
        let fine = match bake::refine_watched(&climb.scene, settings, self.progress) {
            Err(bake::Error::Cancelled) => return Ok(false),
            fine => fine?.into_owned(),
        };
        if climb.speed.coarse(settings, receivers(&fine)) >= SHARE * self.left() {
            return Ok(true);
        }
        climb.scene = Cow::Owned(fine);
        climb.split = settings.refine;
        climb.rungs.clear();
        self.step(climb, &Settings { quality: Quality::Error(COARSEST), ..settings.clone() })
    }

    /// One bake whose result is kept, with the time of both; none where it was cancelled.
    fn kept(&self, scene: &Scene, wanted: &Settings, split: Refine) -> Result<Option<(Prt, Rung)>, E> {
        let start = Instant::now();
        let (prt, rung) = match self.bake(scene, wanted, split) {
            Err(bake::Error::Cancelled) => return Ok(None),
            result => result?,
        };
        (self.keep)(&prt)?;
        Ok(Some((prt, Rung { seconds: start.elapsed().as_secs_f64(), ..rung })))
    }

    /// One bake of triangles that are split already, as the file will say, or not to be split.
    fn bake(&self, scene: &Scene, wanted: &Settings, split: Refine) -> Result<(Prt, Rung), bake::Error> {
        let start = Instant::now();
        let wanted = Settings { refine: Refine::Off, ..wanted.clone() };
        let traced = OnceLock::new();
        let watch = |now: &bake::Progress| {
            if now.stage != bake::Stage::Preparation {
                traced.get_or_init(Instant::now);
            }
            (self.progress)(now)
        };
        let mut prt = bake::bake_with(scene, &wanted, self.extras, &watch)?;
        prt.settings.refine = split;
        // The fewest rays that tell an error often reach a smaller one than was asked for: that is what is to be beaten.
        let error = match wanted.quality {
            Quality::Error(asked) => asked.min(achieved_error(&prt)),
            Quality::Rays(_) => COARSEST,
        };
        let preparation = traced.get().map_or(0.0, |traced| traced.duration_since(start).as_secs_f64());
        let rung = Rung { error, seconds: start.elapsed().as_secs_f64(), preparation };
        Ok((prt, rung))
    }
}

/// Whether no error is left, or most receivers took all directions that there are: a smaller error would change nothing.
fn exhausted(prt: &Prt) -> bool {
    match prt.settings.quality {
        Quality::Rays(_) => false,
        Quality::Error(asked) => {
            achieved_error(prt) == 0.0
                || prt.achieved.error[0].max(prt.achieved.maps.map_or(0.0, |maps| maps.error[0])) > asked
        }
    }
}
