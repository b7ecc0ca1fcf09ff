//! What accuracy costs on one scene, under one light, on this machine.
//!
//! [`study`] bakes the scene again and again, one knob turned at a time, compares every result with a converged one, and
//! returns a [`Report`]: [`csv()`] and [`page()`] write it down, [`plots`] draws it.

mod bakes;
mod csv;
mod deviation;
mod format;
mod frames;
mod gloss;
mod light_maps;
mod page;
mod plots;
mod recommend;
pub mod report;
mod resolution;
#[cfg(test)]
mod sample;
mod study;
mod trials;
mod truth;
mod views;

pub use crate::front::front;
pub use bakes::{Check, Effort};
pub use csv::csv;
pub use deviation::{Deviation, Spread, Truth, open_norm};
pub use format::Format;
pub use frames::Frames;
pub use gloss::{GlossRun, GlossStudy, WayTime};
pub use light_maps::LightMaps;
pub use page::page;
pub use plots::{Plots, plots};
pub use recommend::{Advice, Goal, Ground, advise};
pub use report::Report;
pub use resolution::Resolution;
pub use study::study;

use coeff_io::Settings;
use probe_io::Environment;
use scene::Scene;
use std::ops::ControlFlow;

/// What is to be studied.
#[derive(Debug, Clone)]
pub struct Request<'a> {
    /// The scene, not split yet.
    pub scene: &'a Scene,
    /// The light under which radiance is compared.
    pub environment: &'a Environment,
    /// What every bake has that no knob turns: bands, seed, memory, refinement. Its quality is not used.
    pub settings: Settings,
    /// What the user wants.
    pub targets: Targets,
    /// Seconds that the study may take; the least that makes a study, the reference and a bake of few rays, is done in
    /// any case.
    pub budget: f64,
    /// Facts to write into the report.
    pub machine: report::Machine,
    /// Light maps whose bases are to be compared as well; an effect of scenes with normal maps.
    pub light_maps: Option<LightMaps<'a>>,
    /// Opens the device whose frames are timed; the caller knows what drivers may say meanwhile.
    pub open_gpu: fn() -> Result<render_wgpu::Gpu, render_wgpu::Error>,
}

/// What the user wants.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Targets {
    /// Error of the transfer, as for `--error`.
    pub error: f32,
    /// Seconds of a bake; a quarter of what `error` takes where none are given.
    pub seconds: Option<f64>,
    /// Bytes of coefficients; half of those of `error` where none are given.
    pub bytes: Option<u64>,
}

/// How far a study is.
#[derive(Debug, Clone, PartialEq)]
pub struct Step<'a> {
    /// The run, in words.
    pub name: &'a str,
    /// Its number, from 1.
    pub run: usize,
    /// What the bake does; empty where none runs.
    pub stage: String,
    /// Of `total`.
    pub done: u64,
    /// All of the stage.
    pub total: u64,
}

/// Called while a study runs; returning `Break` cancels it.
pub type ProgressFn<'a> = &'a (dyn Fn(&Step<'_>) -> ControlFlow<()> + Sync);

/// Why there is no report.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// A bake failed.
    #[error(transparent)]
    Bake(bake::Error),
    /// A picture could not be drawn.
    #[error(transparent)]
    Draw(#[from] render_cpu::Error),
    /// A plot could not be drawn.
    #[error(transparent)]
    Plot(#[from] crate::plot::Error),
    /// The progress callback asked to stop.
    #[error("the study was cancelled; no file was written")]
    Cancelled,
}

impl From<bake::Error> for Error {
    fn from(error: bake::Error) -> Self {
        match error {
            bake::Error::Cancelled => Self::Cancelled,
            other => Self::Bake(other),
        }
    }
}
