//! The list of bakes that a study would like to make, the most telling first.

use super::Request;
use super::predict::{Prediction, Predictor};
use super::report::Knob;
use coeff_io::{Bounces, Quality, Sampler, Settings};

/// Bands that the reference has beyond those asked for, at least, and in all.
const MORE_BANDS: u32 = 3;
const REFERENCE_BANDS: u32 = 8;

/// A bake to be made.
#[derive(Debug, Clone)]
pub(super) struct Trial {
    pub(super) knob: Knob,
    /// The options that make it.
    pub(super) setting: String,
    pub(super) settings: Settings,
    pub(super) estimate: Prediction,
}

/// What a trial turns.
#[derive(Debug, Clone, Copy)]
pub(super) enum Turn {
    /// An error level, and else as asked.
    Error(f32),
    /// A fixed number of rays.
    Rays(u32),
    /// A fixed number of rays along another sequence.
    Sampler(Sampler, u32),
    /// The error asked for, with so many bounces.
    Bounces(u32),
    /// The error asked for, in so many bands.
    Bands(u32),
}

/// Bands of the reference.
pub(super) fn reference_bands(bands: u32) -> u32 {
    (bands + MORE_BANDS).clamp(REFERENCE_BANDS, bake::settings::MAX_BANDS)
}

/// An error level near `error` with few digits, within what a bake allows.
pub(super) fn level(error: f32) -> f32 {
    let text = format!("{:.1e}", error.clamp(1e-4, 1.0));
    text.parse().unwrap_or(error)
}

/// All turns, the most telling first.
pub(super) fn turns(request: &Request<'_>) -> Vec<Turn> {
    let (e, bands) = (request.targets.error, request.settings.bands);
    let other = |n: u32| (n != bands && n <= reference_bands(bands)).then_some(Turn::Bands(n));
    let (fibonacci, stratified) = (Sampler::Fibonacci, Sampler::Stratified);
    let always = [Turn::Error(e), Turn::Error(level(2.0 * e)), Turn::Rays(256), Turn::Bounces(1)];
    let then = [Turn::Sampler(fibonacci, 256), Turn::Sampler(stratified, 256), Turn::Rays(1024), Turn::Bounces(0)];
    let finer = [Turn::Error(level(0.5 * e)), Turn::Bounces(2), Turn::Sampler(fibonacci, 1024)];
    let last = [Turn::Sampler(stratified, 1024), Turn::Rays(4096), Turn::Bounces(4), Turn::Error(level(0.25 * e))];
    let mut turns = always.to_vec();
    turns.extend(other(3));
    turns.extend(then);
    turns.extend([other(4), other(2), other(6)].into_iter().flatten());
    turns.extend(finer);
    turns.extend(other(8));
    turns.extend(last);
    turns.dedup_by(|a, b| matches!((a, b), (Turn::Error(a), Turn::Error(b)) if a == b));
    turns
}

/// The bake of a turn, before anything is known about its time.
pub(super) fn bake_of(request: &Request<'_>, turn: Turn) -> (Knob, String, Settings) {
    let error = request.targets.error;
    let settings = |quality: Quality| Settings { quality, ..request.settings.clone() };
    let (knob, words, settings) = match turn {
        Turn::Error(e) => (Knob::Error, format!("--error {e}"), settings(Quality::Error(e))),
        Turn::Rays(n) => (Knob::Rays, format!("--rays {n}"), settings(Quality::Rays(n))),
        Turn::Sampler(sampler, n) => {
            let name = match sampler {
                Sampler::OwenSobol => "owen-sobol",
                Sampler::Fibonacci => "fibonacci",
                Sampler::Stratified => "stratified",
            };
            let settings = Settings { sampler, ..settings(Quality::Rays(n)) };
            (Knob::Sampler, format!("--rays {n} --sampler {name}"), settings)
        }
        Turn::Bounces(n) => {
            let settings = Settings { bounces: Bounces::Fixed(n), ..settings(Quality::Error(error)) };
            (Knob::Bounces, format!("--error {error} --bounces {n}"), settings)
        }
        Turn::Bands(bands) => {
            let settings = Settings { bands, ..settings(Quality::Error(error)) };
            (Knob::Bands, format!("--error {error}"), settings)
        }
    };
    (knob, format!("{}{words}", prefix(&settings)), settings)
}

/// The options that a bake needs beside those of its knob.
pub(super) fn prefix(settings: &Settings) -> String {
    let standard = bake::settings::standard();
    let mut text = String::new();
    if settings.bands != standard.bands {
        text += &format!("--bands {} ", settings.bands);
    }
    if settings.seed != standard.seed {
        text += &format!("--seed {} ", settings.seed);
    }
    text
}

/// All trials with what each will take.
pub(super) fn trials(request: &Request<'_>, predictor: &Predictor) -> Vec<Trial> {
    let (error, bands) = (f64::from(request.targets.error), request.settings.bands);
    let estimate = |turn: Turn| match turn {
        Turn::Error(e) => predictor.level(f64::from(e), bands),
        // A bake with fixed rays bounces as one to an error of 1 %.
        Turn::Rays(n) | Turn::Sampler(_, n) => predictor.fixed(n, predictor.level_bounces(0.01), bands),
        Turn::Bounces(_) => predictor.level(error, bands),
        Turn::Bands(n) => predictor.level(error, n),
    };
    let trial = |turn: Turn| {
        let (knob, setting, settings) = bake_of(request, turn);
        Trial { knob, setting, settings, estimate: estimate(turn) }
    };
    turns(request).into_iter().map(trial).collect()
}
