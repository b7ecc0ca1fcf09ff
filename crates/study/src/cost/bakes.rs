//! Bakes with a clock: how long each part took, and how much time is left.

use super::{Error, ProgressFn, Step};
use coeff_io::{Prt, Settings};
use scene::Scene;
use std::ops::ControlFlow;
use std::sync::Mutex;
use std::time::Instant;

/// Bakes one after the other, within a budget of time.
pub(super) struct Bakes<'a> {
    scene: &'a Scene,
    progress: ProgressFn<'a>,
    began: Instant,
    budget: f64,
    count: usize,
}

/// A bake and what it took.
#[derive(Debug)]
pub(super) struct Timed {
    pub(super) prt: Prt,
    /// Wall-clock seconds from the call to the result.
    pub(super) seconds: f64,
    /// Of these: tracing, that is all stages but bounces.
    pub(super) tracing: f64,
    /// Of these: bounces.
    pub(super) bouncing: f64,
}

/// When the stage now running began and what the others took.
struct Stages {
    since: Instant,
    bounce: Option<bool>,
    seconds: [f64; 2],
}

impl Stages {
    /// A report came: the time since the last one belongs to the stage that it tells of.
    fn note(&mut self, is_bounce: bool) {
        let now = Instant::now();
        if self.bounce.is_some() {
            self.seconds[usize::from(is_bounce)] += (now - self.since).as_secs_f64();
        }
        self.bounce = Some(is_bounce);
        self.since = now;
    }
}

impl<'a> Bakes<'a> {
    pub(super) fn new(scene: &'a Scene, budget: f64, progress: ProgressFn<'a>) -> Self {
        Self { scene, progress, began: Instant::now(), budget, count: 0 }
    }

    /// Seconds since the study began.
    pub(super) fn spent(&self) -> f64 {
        self.began.elapsed().as_secs_f64()
    }

    /// Seconds of the budget that are left; below 0 where it is overdrawn.
    pub(super) fn left(&self) -> f64 {
        self.budget - self.spent()
    }

    /// Bakes with these settings; `name` tells the user what is being done.
    ///
    /// # Errors
    /// [`Error`] as the bake has it, or where the user asked to stop.
    pub(super) fn bake(&mut self, name: &str, settings: &Settings) -> Result<Timed, Error> {
        self.count += 1;
        self.tell(name, 0, 1)?;
        let began = Instant::now();
        let stages = Mutex::new(Stages { since: began, bounce: None, seconds: [0.0; 2] });
        let progress = self.progress;
        let run = self.count;
        let prt = bake::bake(self.scene, settings, &|now| {
            // A panic elsewhere is no reason for another one here.
            let mut stages = stages.lock().unwrap_or_else(std::sync::PoisonError::into_inner);
            stages.note(matches!(now.stage, bake::Stage::Bounce(_)));
            progress(&Step { name, run, stage: now.stage.to_string(), done: now.done, total: now.total })
        })?;
        let seconds = began.elapsed().as_secs_f64();
        let [tracing, bouncing] = stages.into_inner().unwrap_or_else(std::sync::PoisonError::into_inner).seconds;
        Ok(Timed { prt, seconds, tracing, bouncing })
    }

    /// Tells of work that is no bake.
    ///
    /// # Errors
    /// [`Error::Cancelled`] where the user asked to stop.
    pub(super) fn tell(&self, name: &str, done: u64, total: u64) -> Result<(), Error> {
        let step = Step { name, run: self.count, stage: String::new(), done, total };
        match (self.progress)(&step) {
            ControlFlow::Continue(()) => Ok(()),
            ControlFlow::Break(()) => Err(Error::Cancelled),
        }
    }
}
