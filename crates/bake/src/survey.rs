//! A look at a few receivers with few rays: facts for the plan that no bound can give.

use crate::Error;
use crate::directions::DirectionBank;
use crate::gather::{Gathered, Gatherer, Worker};
use crate::receivers::Receiver;
use crate::world::World;
use coeff_io::{Quality, Settings, Survey};
use rayon::prelude::*;
use sh_math::{Bands, zonal};

/// Most receivers that are looked at.
const MOST: usize = 128;
/// Of so many receivers that will be traced one is looked at, so that a survey takes at most 3 % of the rays.
const ONE_OF: usize = 32;
/// Most rays per receiver.
const RAYS: u32 = 128;

/// Looks at some of the receivers `traced`; a pure function of scene and settings.
pub(crate) fn survey(
    world: &World<'_>,
    list: &[Receiver],
    traced: &[u32],
    settings: &Settings,
) -> Result<Survey, Error> {
    let bands = Bands::new(settings.bands).expect("checked with the settings");
    let mut survey = Survey { band_norms: open_norms(bands), ..Survey::default() };
    if traced.is_empty() {
        return Ok(survey);
    }
    let rays = match settings.quality {
        Quality::Rays(n) => n.min(RAYS),
        Quality::Error(_) => RAYS,
    };
    let quality = Quality::Rays(rays.max(crate::settings::MIN_STRATIFIED));
    let bank = DirectionBank::new(bands, &Settings { quality, ..settings.clone() });
    let gatherer = Gatherer::of_direct_light(world, &bank, bands, quality);
    let ids = picked(traced, (traced.len() / ONE_OF).clamp(1, MOST));
    let seen: Vec<Gathered> =
        ids.par_iter().map_init(Worker::new, |w, &id| gatherer.gather(&list[id as usize], id, w)).collect();
    survey.receivers = seen.len() as u64;
    for one in &seen {
        survey.rays += one.visibility_rays + one.bounce_rays;
        let covered = 1.0 - one.openness;
        survey.coverage[0] += covered / seen.len() as f32;
        survey.coverage[1] = survey.coverage[1].max(covered);
        for (l, norm) in survey.band_norms.iter_mut().enumerate() {
            *norm = norm.max(band_norm(&one.transfer, l));
        }
    }
    Ok(survey)
}

/// `count` of the ids, evenly spread.
fn picked(ids: &[u32], count: usize) -> Vec<u32> {
    (0..count).map(|k| ids[(2 * k + 1) * ids.len() / (2 * count)]).collect()
}

/// Norm of each band of an open receiver's transfer: the clamped cosine over pi.
pub(crate) fn open_norms(bands: Bands) -> Vec<f32> {
    let norm = |l: usize| zonal::clamped_cosine(l).abs() * ((2 * l + 1) as f64 / (4.0 * std::f64::consts::PI)).sqrt();
    bands.degrees().map(|l| norm(l) as f32).collect()
}

fn band_norm(transfer: &[f32], l: usize) -> f32 {
    transfer[l * l..(l + 1) * (l + 1)].iter().map(|v| v * v).sum::<f32>().sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Against the integral of (max(0, cos)/pi)^2 over the sphere, 2/(3 pi): the bands hold nearly all of it.
    #[test]
    fn open_norms_sum_to_the_lobe() {
        let norms = open_norms(Bands::new(24).unwrap());
        let sum: f64 = norms.iter().map(|&n| f64::from(n * n)).sum();
        let whole = 2.0 / (3.0 * std::f64::consts::PI);
        assert!((sum / whole - 1.0).abs() < 1e-3, "{sum} against {whole}");
        let few: f64 = norms[..2].iter().map(|&n| f64::from(n * n)).sum();
        assert!(few / whole < 0.9, "can fail: two bands hold {few}");
    }

    #[test]
    fn picks_are_spread_and_inside() {
        let ids: Vec<u32> = (0..10).collect();
        assert_eq!(picked(&ids, 2), [2, 7]);
        assert_eq!(picked(&ids, 10), ids);
        assert_eq!(picked(&ids, 1), [5]);
    }
}
