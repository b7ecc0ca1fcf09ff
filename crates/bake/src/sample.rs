//! Direct transfer of a few receivers alone: what a study of accuracy needs of a scene too large to bake again and again.

use crate::directions::DirectionBank;
use crate::gather::{Gatherer, Worker};
use crate::plan::prepare;
use crate::receivers::morton_order;
use crate::refine::refined;
use crate::{Error, Extras, settings};
use coeff_io::Settings;
use rayon::prelude::*;
use scene::Scene;
use sh_math::Bands;
use std::ops::ControlFlow;

/// The direct transfer of one receiver, as a bake finds it.
#[derive(Debug, Clone, PartialEq)]
pub struct Sampled {
    /// Receiver, as row of a bake.
    pub receiver: u32,
    /// Transfer vector in world axes, without albedo.
    pub transfer: Vec<f32>,
    /// Estimated error against the norm of an open receiver's transfer; 0 where it is not estimated.
    pub error: f32,
    /// Any-hit rays traced.
    pub rays: u64,
}

/// Direct transfer of about `count` receivers that something can shadow, evenly spread over the surfaces; the same receivers
/// whatever the settings say of quality and seed.
///
/// # Errors
/// As [`crate::bake`].
pub fn sample(scene: &Scene, settings: &Settings, count: usize) -> Result<Vec<Sampled>, Error> {
    settings::check(settings)?;
    let scene = &*refined(scene, settings, &|_| ControlFlow::Continue(()))?;
    let prepared = prepare(scene, settings, &Extras::default())?;
    let bands = Bands::new(prepared.plan.bands).expect("no more than the settings ask for");
    let bank = DirectionBank::new(bands, settings);
    let gatherer = Gatherer {
        world: &prepared.world,
        bank: &bank,
        bands,
        quality: settings.quality,
        visibility: true,
        hits: false,
        permanent: u32::MAX,
        worth: 0.0,
        mirrors: None,
    };
    let order = morton_order(&prepared.receivers.list, prepared.traced.iter().copied());
    let count = count.min(order.len());
    let ids: Vec<u32> = (0..count).map(|k| order[(2 * k + 1) * order.len() / (2 * count)]).collect();
    let one = |worker: &mut Worker, &receiver: &u32| {
        let (seen, _) = gatherer.direct(&prepared.receivers.list[receiver as usize], receiver, worker);
        Sampled { receiver, transfer: seen.transfer, error: seen.error, rays: seen.visibility_rays }
    };
    Ok(ids.par_iter().map_init(Worker::new, one).collect())
}
