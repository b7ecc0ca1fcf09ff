//! The reference: the mean of two bakes with independent seeds, as converged as the budget allows.
//!
//! Half the difference of the two is the reference's own error, receiver by receiver: both err independently, so their mean
//! errs by as much, as a root of mean squares.

use super::bakes::{Bakes, Check, Effort};
use super::deviation::{Spread, Truth};
use super::frames::truncated;
use super::report::ReferenceFacts;
use super::trials::{level, reference_bands};
use super::{Error, Request};
use coeff_io::{Bounces, Prt, Quality, Settings, Transfer};
use sampling::rng;
use sh_math::Bands;

/// Share of the time left that the two bakes may take.
const SHARE: f64 = 0.45;
/// What bounces beyond the last one may still change, against the error asked for.
const BOUNCE_SHARE: f32 = 0.1;
/// Rays of the trial from which the time of many is reckoned.
const TRIAL_RAYS: u32 = 256;
/// The power of the rays over the error, near enough to choose by.
const EXPONENT: f64 = 1.4;
/// Bytes that a surface seen takes while a bake keeps it for the bounces, at most.
const SEEN_BYTES: f64 = 24.0;

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
pub(super) fn reference(request: &Request<'_>, bakes: &mut Bakes<'_>) -> Result<Reference, Error> {
    bakes.tell("predicting", 0, 1)?;
    let bands = reference_bands(request.settings.bands);
    let base = Settings { bands, ..request.settings.clone() };
    let fine = Settings { quality: Quality::Error(level(BOUNCE_SHARE * request.targets.error)), ..base.clone() };
    let plan = bake::plan(&bakes.scene, &Settings { refine: coeff_io::Refine::Off, ..fine })?;
    let base = Settings { bounces: Bounces::Fixed(plan.expected_bounces), ..base };
    let choice = choose(request, &base, plan.shadowed_receivers as f64, bakes)?;
    let settings = |k: u64| Settings {
        quality: choice.quality,
        seed: rng::hash(request.settings.seed, 0x7275_7468, k),
        ..base.clone()
    };
    let first = bakes.bake("reference, 1 of 2", &settings(1))?;
    let second = bakes.bake("reference, 2 of 2", &settings(2))?;
    let transfer = mean(&first.prt.transfer, &second.prt.transfer);
    let light = sh_math::project(supported(bands), request.environment.samples()).values;
    let truth = Truth { transfer, light };
    let own = truth.deviation(&truncated(&first.prt.transfer, request.settings.bands));
    let shadowed = plan.shadowed_receivers.max(1) as f64;
    let rays = first.prt.achieved.visibility_rays + second.prt.achieved.visibility_rays;
    let facts = ReferenceFacts {
        level: choice.words.clone(),
        bands,
        own: Spread::of(&own.receivers),
        own_radiance: own.radiance,
        rays_per_receiver: rays as f64 / shadowed,
        bounces: first.prt.achieved.bounces,
        seconds: first.seconds + second.seconds,
    };
    let name = format!("reference, 1 of 2: {}", choice.words);
    let check = Check { name, predicted: choice.predicted, came: Some(first.effort()) };
    Ok(Reference { truth, facts, check, prt: first.prt })
}

/// How the reference is baked.
#[derive(Debug, Clone)]
struct Choice {
    quality: Quality,
    words: String,
    predicted: Effort,
}

/// The best quality whose two bakes take no more than their share of the time left; the poorest where none does.
fn choose(request: &Request<'_>, base: &Settings, shadowed: f64, bakes: &Bakes<'_>) -> Result<Choice, Error> {
    let error = request.targets.error;
    let few = bakes.predict(&Settings { quality: Quality::Rays(TRIAL_RAYS), ..base.clone() })?;
    let asked = bakes.predict(&Settings { quality: Quality::Error(error), ..base.clone() })?;
    let times = |effort: Effort, factor: f64| Effort { seconds: effort.seconds * factor, rays: effort.rays * factor };
    let rays = |n: u32| Choice {
        quality: Quality::Rays(n),
        words: format!("{n} rays"),
        predicted: times(few, f64::from(n) / f64::from(TRIAL_RAYS)),
    };
    let to = |factor: f32| {
        let e = level(factor * error);
        let predicted = times(asked, f64::from(error / e).powf(EXPONENT));
        Choice { quality: Quality::Error(e), words: format!("error level {e}"), predicted }
    };
    let ladder =
        [rays(16384), rays(8192), rays(4096), to(0.25), rays(2048), to(0.5), rays(1024), to(1.0), to(2.0), to(4.0)];
    let seconds = SHARE * bakes.left();
    let fits = |choice: &Choice| {
        let bytes = |n: u32| SEEN_BYTES * f64::from(n) * shadowed;
        // Surfaces that do not fit into memory would be looked for anew at each bounce.
        let kept = !matches!(choice.quality, Quality::Rays(n) if bytes(n) > 0.5 * request.settings.memory as f64);
        kept && 2.0 * choice.predicted.seconds <= seconds
    };
    first_that_fits(&ladder, fits, |quality| bakes.predict(&Settings { quality, ..base.clone() }))
}

/// The first choice that fits; the last where none does.
///
/// An error level is predicted itself before it is taken: rays have a floor, which no power of the error knows.
fn first_that_fits(
    ladder: &[Choice; 10],
    fits: impl Fn(&Choice) -> bool,
    predict: impl Fn(Quality) -> Result<Effort, Error>,
) -> Result<Choice, Error> {
    let predicted = |choice: &Choice| match choice.quality {
        Quality::Error(_) => Ok(Choice { predicted: predict(choice.quality)?, ..choice.clone() }),
        Quality::Rays(_) => Ok::<_, Error>(choice.clone()),
    };
    let [better @ .., poorest] = ladder;
    for choice in better.iter().filter(|choice| fits(choice)) {
        let choice = predicted(choice)?;
        if fits(&choice) {
            return Ok(choice);
        }
    }
    predicted(poorest)
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

#[cfg(test)]
mod tests {
    use super::*;

    fn effort(seconds: f64) -> Effort {
        Effort { seconds, rays: 1e6 * seconds }
    }

    /// What is chosen of levels 1 to 10 that are reckoned to take 10 to 1 s, where none takes less than `floor` and 3.5 s
    /// are left.
    fn chosen(floor: f64) -> (Quality, Effort) {
        let ladder = std::array::from_fn(|i| Choice {
            quality: Quality::Error(i as f32 + 1.0),
            words: String::new(),
            predicted: effort(10.0 - i as f64),
        });
        let predict = |quality| match quality {
            Quality::Error(e) => Ok(effort((11.0 - f64::from(e)).max(floor))),
            Quality::Rays(_) => Err(Error::Cancelled),
        };
        let choice = first_that_fits(&ladder, |choice| choice.predicted.seconds <= 3.5, predict).unwrap();
        (choice.quality, choice.predicted)
    }

    /// Where rays have a floor, what is told of the choice is the floor and not what was reckoned.
    #[test]
    fn the_reference_is_predicted_itself() {
        assert_eq!(chosen(5.0), (Quality::Error(10.0), effort(5.0)));
    }

    #[test]
    fn the_reference_is_predicted_itself_can_fail() {
        assert_eq!(chosen(0.0), (Quality::Error(8.0), effort(3.0)), "without a floor the first that fits");
    }
}
