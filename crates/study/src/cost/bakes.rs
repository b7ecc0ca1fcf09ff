//! Bakes with a clock, predicted before they start: the scene is split once, so that every bake has the same receivers.

use super::{Error, ProgressFn, Step};
use bake::{Directional, FixedLight, SheetSettings};
use coeff_io::{Effect, Prt, Refine, Settings};
use scene::Scene;
use std::borrow::Cow;
use std::ops::ControlFlow;
use std::time::Instant;

/// Share of the budget that no bake may take, and its most seconds: frames are timed and pictures drawn after the bakes.
const RESERVED: (f64, f64) = (0.15, 12.0);

/// Bakes one after the other, within a budget of time.
pub(super) struct Bakes<'a> {
    /// Split as asked.
    pub(super) scene: Cow<'a, Scene>,
    /// Seconds that splitting took; each bake would take them anew.
    pub(super) split: f64,
    progress: ProgressFn<'a>,
    began: Instant,
    budget: f64,
    count: usize,
}

/// A bake and what it took.
#[derive(Debug)]
pub(super) struct Timed {
    pub(super) prt: Prt,
    /// Wall-clock seconds of splitting and baking.
    pub(super) seconds: f64,
}

/// What a bake takes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Effort {
    /// Wall-clock seconds.
    pub seconds: f64,
    /// Rays of both kinds.
    pub rays: f64,
}

/// A bake as predicted and as it came.
#[derive(Debug, Clone, PartialEq)]
pub struct Check {
    /// The bake.
    pub name: String,
    /// Before it started.
    pub predicted: Effort,
    /// After; `None` where the budget did not allow it.
    pub came: Option<Effort>,
}

impl Timed {
    /// What the bake took.
    pub(super) fn effort(&self) -> Effort {
        let achieved = &self.prt.achieved;
        Effort { seconds: self.seconds, rays: (achieved.visibility_rays + achieved.bounce_rays) as f64 }
    }
}

impl<'a> Bakes<'a> {
    /// Splits the scene as the settings say.
    pub(super) fn new(
        scene: &'a Scene,
        settings: &Settings,
        budget: f64,
        progress: ProgressFn<'a>,
    ) -> Result<Self, Error> {
        let began = Instant::now();
        let scene = bake::refine(scene, settings)?;
        Ok(Self { scene, split: began.elapsed().as_secs_f64(), progress, began, budget, count: 0 })
    }

    /// The same study with the same clock, on the scene split in another way.
    pub(super) fn of_mesh<'b>(&self, scene: Scene, split: f64) -> Bakes<'b>
    where
        'a: 'b,
    {
        Bakes { scene: Cow::Owned(scene), split, ..*self }
    }

    /// Seconds since the study began.
    pub(super) fn spent(&self) -> f64 {
        self.began.elapsed().as_secs_f64()
    }

    /// Seconds of the budget that bakes may still take; below 0 where it is overdrawn.
    pub(super) fn left(&self) -> f64 {
        self.budget - self.reserved() - self.spent()
    }

    /// Seconds of the budget that are kept for timing frames and drawing.
    pub(super) fn reserved(&self) -> f64 {
        (RESERVED.0 * self.budget).min(RESERVED.1)
    }

    /// What a bake will take: a few hundred receivers, evenly drawn, are baked for trial.
    pub(super) fn predict(&self, settings: &Settings) -> Result<Effort, Error> {
        let began = Instant::now();
        let price = bake::price(&self.scene, &as_split(settings), &bake::Extras::default(), &|| began.elapsed())?;
        let rays =
            |effect: Effect| price.plan.rows.iter().filter(move |row| row.effect == effect).map(|row| row.rays as f64);
        Ok(Effort {
            seconds: self.split + price.preparation + price.visibility + price.interreflection + price.gloss,
            rays: rays(Effect::Visibility).chain(rays(Effect::Interreflection)).sum(),
        })
    }

    /// Bakes with these settings; `name` tells the user what is being done.
    pub(super) fn bake(&mut self, name: &str, settings: &Settings) -> Result<Timed, Error> {
        self.count += 1;
        self.tell(name, 0, 1)?;
        let began = Instant::now();
        let (progress, run) = (self.progress, self.count);
        let prt = bake::bake(&self.scene, &as_split(settings), &|now| {
            progress(&Step { name, run, stage: now.stage.to_string(), done: now.done, total: now.total })
        })?;
        Ok(Timed { prt, seconds: self.split + began.elapsed().as_secs_f64() })
    }

    /// Bakes what arrives at the texels of light maps, of a scene that is not split yet; `None` where it took more than `most` seconds.
    pub(super) fn directional(
        &mut self,
        name: &str,
        scene: &Scene,
        settings: &Settings,
        sheets: &[SheetSettings],
        light: &FixedLight,
        most: f64,
    ) -> Result<Option<Directional>, Error> {
        self.count += 1;
        self.tell(name, 0, 1)?;
        let (progress, run, deadline) = (self.progress, self.count, self.spent() + most);
        let is_late = || self.spent() > deadline;
        let found = bake::directional(scene, settings, sheets, light, &|now| {
            if is_late() {
                return ControlFlow::Break(());
            }
            progress(&Step { name, run, stage: now.stage.to_string(), done: now.done, total: now.total })
        });
        match found {
            Ok(found) => Ok(Some(found)),
            // The user's own wish to stop is asked for anew.
            Err(bake::Error::Cancelled) if is_late() => self.tell(name, 0, 1).map(|()| None),
            Err(error) => Err(error.into()),
        }
    }

    /// Bakes a scene as it is with more beside the vertices; `None` where it took more than `most` seconds.
    pub(super) fn bake_with(
        &mut self,
        name: &str,
        scene: &Scene,
        settings: &Settings,
        extras: &bake::Extras,
        most: f64,
    ) -> Result<Option<Timed>, Error> {
        self.count += 1;
        self.tell(name, 0, 1)?;
        let (progress, run, began) = (self.progress, self.count, Instant::now());
        let is_late = || began.elapsed().as_secs_f64() > most;
        let found = bake::bake_with(scene, &as_split(settings), extras, &|now| {
            if is_late() {
                return ControlFlow::Break(());
            }
            progress(&Step { name, run, stage: now.stage.to_string(), done: now.done, total: now.total })
        });
        match found {
            Ok(prt) => Ok(Some(Timed { prt, seconds: began.elapsed().as_secs_f64() })),
            // The user's own wish to stop is asked for anew.
            Err(bake::Error::Cancelled) if is_late() => self.tell(name, 0, 1).map(|()| None),
            Err(error) => Err(error.into()),
        }
    }

    /// Tells of work that is no bake.
    pub(super) fn tell(&self, name: &str, done: u64, total: u64) -> Result<(), Error> {
        let step = Step { name, run: self.count, stage: String::new(), done, total };
        match (self.progress)(&step) {
            ControlFlow::Continue(()) => Ok(()),
            ControlFlow::Break(()) => Err(Error::Cancelled),
        }
    }
}

/// The settings for a scene that is split already.
fn as_split(settings: &Settings) -> Settings {
    Settings { refine: Refine::Off, ..settings.clone() }
}
