//! The list of bakes that a study would like to make, the most telling first.

use super::Request;
use super::report::Knob;
use coeff_io::{Bounces, Quality, Sampler, Settings};

/// Bands that the reference has beyond those asked for, at least, and in all.
const MORE_BANDS: u32 = 3;
const REFERENCE_BANDS: u32 = 8;
/// Rays of the first trial, which is made whatever the budget.
const FEW_RAYS: u32 = 64;

/// A bake to be made.
#[derive(Debug, Clone)]
pub(super) struct Trial {
    pub(super) knob: Knob,
    /// The options that make it.
    pub(super) setting: String,
    pub(super) settings: Settings,
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

/// The bake as asked.
pub(super) fn as_asked(request: &Request<'_>) -> Trial {
    to_error(request, request.targets.error)
}

/// All trials, the most telling first: a few rays, the bake as asked, then one knob at a time.
pub(super) fn trials(request: &Request<'_>) -> Vec<Trial> {
    let e = request.targets.error;
    let most = reference_bands(request.settings.bands);
    let bands = |n: u32| (n != request.settings.bands && n <= most).then(|| in_bands(request, n));
    let along = |sampler: Sampler, n: u32| sampled(request, sampler, n);
    let (usual, fibonacci, stratified) = (Sampler::OwenSobol, Sampler::Fibonacci, Sampler::Stratified);
    let first = [along(usual, FEW_RAYS), as_asked(request), to_error(request, level(4.0 * e)), along(usual, 256)];
    let then = [bouncing(request, 1), along(fibonacci, 256), along(stratified, 256), along(usual, 1024)];
    let finer = [bouncing(request, 0), to_error(request, level(2.0 * e)), to_error(request, level(0.5 * e))];
    let last = [bouncing(request, 2), along(fibonacci, 1024), along(stratified, 1024), along(usual, 4096)];
    let rest = [bouncing(request, 4), to_error(request, level(0.25 * e))];
    let mut trials = first.to_vec();
    trials.extend(bands(3));
    trials.extend(then);
    trials.extend([bands(4), bands(2), bands(6)].into_iter().flatten());
    trials.extend(finer);
    trials.extend(bands(8));
    trials.extend(last);
    trials.extend(rest);
    // Levels at the ends of what is allowed may be the same.
    let mut seen = Vec::new();
    trials.retain(|trial| {
        !seen.contains(&trial.setting) && {
            seen.push(trial.setting.clone());
            true
        }
    });
    trials
}

fn trial(knob: Knob, words: &str, settings: Settings) -> Trial {
    Trial { knob, setting: format!("{}{words}", prefix(&settings)), settings }
}

fn to_error(request: &Request<'_>, e: f32) -> Trial {
    let settings = Settings { quality: Quality::Error(e), ..request.settings.clone() };
    trial(Knob::Error, &format!("--error {e}"), settings)
}

fn bouncing(request: &Request<'_>, n: u32) -> Trial {
    let asked = as_asked(request);
    let words = format!("--error {} --bounces {n}", request.targets.error);
    trial(Knob::Bounces, &words, Settings { bounces: Bounces::Fixed(n), ..asked.settings })
}

fn in_bands(request: &Request<'_>, bands: u32) -> Trial {
    let asked = as_asked(request);
    trial(Knob::Bands, &format!("--error {}", request.targets.error), Settings { bands, ..asked.settings })
}

fn sampled(request: &Request<'_>, sampler: Sampler, n: u32) -> Trial {
    let settings = Settings { sampler, quality: Quality::Rays(n), ..request.settings.clone() };
    let name = match sampler {
        Sampler::OwenSobol => return trial(Knob::Rays, &format!("--rays {n}"), settings),
        Sampler::Fibonacci => "fibonacci",
        Sampler::Stratified => "stratified",
    };
    trial(Knob::Sampler, &format!("--rays {n} --sampler {name}"), settings)
}
