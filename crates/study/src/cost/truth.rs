//! The reference: the mean of two bakes with independent seeds, as converged as the budget allows.
//!
//! Half the difference of the two is the reference's own error, receiver by receiver: both err independently, so their mean
//! errs by as much, as a root of mean squares.

use super::bakes::{Bakes, Timed};
use super::deviation::{Spread, Truth};
use super::frames::truncated;
use super::predict::{Check, Prediction, Predictor};
use super::report::ReferenceFacts;
use super::trials::{level, reference_bands};
use super::{Error, Request};
use coeff_io::{Bounces, Prt, Quality, Settings, Transfer};
use sampling::rng;
use sh_math::Bands;

/// Share of the time left that the two bakes may take.
const SHARE: f64 = 0.45;
/// What bounces beyond the last one may still change, against the error asked for.
const BOUNCE_SHARE: f64 = 0.04;

/// The reference and what is known about it.
#[derive(Debug)]
pub(super) struct Reference {
    pub(super) truth: Truth,
    pub(super) facts: ReferenceFacts,
    pub(super) check: Check,
    /// One of the two bakes, in all bands.
    pub(super) prt: Prt,
}

/// Bakes the reference.
///
/// # Errors
/// As a bake.
pub(super) fn reference(
    request: &Request<'_>,
    predictor: &Predictor,
    bakes: &mut Bakes<'_>,
) -> Result<Reference, Error> {
    let bands = reference_bands(request.settings.bands);
    let bounces = predictor.level_bounces(BOUNCE_SHARE * f64::from(request.targets.error));
    let (quality, level, predicted) = choose(request, predictor, bounces, SHARE * bakes.left());
    let settings = |k: u64| Settings {
        bands,
        quality,
        bounces: Bounces::Fixed(bounces),
        seed: rng::hash(request.settings.seed, 0x7275_7468, k),
        ..request.settings.clone()
    };
    let first = bakes.bake("reference, 1 of 2", &settings(1))?;
    let second = bakes.bake("reference, 2 of 2", &settings(2))?;
    let transfer = mean(&first.prt.transfer, &second.prt.transfer);
    let light = sh_math::project(supported(bands), request.environment.samples()).values;
    let truth = Truth { transfer, light };
    let own = truth.deviation(&truncated(&first.prt.transfer, request.settings.bands));
    let came = came(&first);
    let facts = ReferenceFacts {
        level,
        bands,
        own: Spread::of(&own.receivers),
        own_radiance: own.radiance,
        rays_per_receiver: came.rays_per_receiver + self::came(&second).rays_per_receiver,
        bounces: came.bounces,
        seconds: first.seconds + second.seconds,
    };
    let check = Check { name: format!("reference, 1 of 2: {}", facts.level), predicted, came: Some(came) };
    Ok(Reference { truth, facts, check, prt: first.prt })
}

/// The best quality whose two bakes take no more than so many seconds; the poorest where none does.
fn choose(request: &Request<'_>, predictor: &Predictor, bounces: u32, seconds: f64) -> (Quality, String, Prediction) {
    let (error, bands) = (request.targets.error, reference_bands(request.settings.bands));
    let rays = |n: u32| (Quality::Rays(n), format!("{n} rays"), predictor.fixed(n, bounces, bands));
    let to = |factor: f32| {
        let e = level(factor * error);
        (Quality::Error(e), format!("--error {e}"), predictor.level(f64::from(e), bands))
    };
    let ladder =
        [rays(16384), rays(8192), rays(4096), to(0.25), rays(2048), to(0.5), rays(1024), to(1.0), to(2.0), to(4.0)];
    let fits = |(quality, _, predicted): &(Quality, String, Prediction)| {
        // Surfaces that do not fit into memory would be traced anew for each bounce.
        let kept =
            !matches!(quality, Quality::Rays(n) if predictor.seen_bytes(*n) > 0.5 * request.settings.memory as f64);
        kept && 2.0 * predicted.seconds <= seconds
    };
    let poorest = ladder[ladder.len() - 1].clone();
    ladder.into_iter().find(fits).unwrap_or(poorest)
}

/// What a bake took, in the terms of a prediction.
pub(super) fn came(timed: &Timed) -> Prediction {
    let shadowed = timed.prt.plan.shadowed_receivers.max(1) as f64;
    Prediction {
        seconds: timed.seconds,
        rays_per_receiver: timed.prt.achieved.visibility_rays as f64 / shadowed,
        bounces: timed.prt.achieved.bounces,
    }
}

/// The mean of two transfers of the same shape.
fn mean(a: &Transfer, b: &Transfer) -> Transfer {
    let values = a.values.iter().zip(&b.values).map(|(a, b)| 0.5 * (a + b)).collect();
    Transfer { values, ..a.clone() }
}

/// A number of bands that a bake has had.
fn supported(bands: u32) -> Bands {
    Bands::new(bands).expect("bakes check the number of bands")
}
