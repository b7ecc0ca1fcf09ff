//! What a bake will take: some receivers are baked for trial, on a clock that the caller brings.

use crate::bake::NEAR_WORTH;
use crate::directions::DirectionBank;
use crate::field::Field;
use crate::gather::{Gathered, Gatherer, Worker};
use crate::passes::{Chunk, Monitor, bounce_pass};
use crate::plan::{Prepared, prepare, simulates, tolerance};
use crate::receivers::morton_order;
use crate::refine::refined;
use crate::{Error, Extras, settings};
use coeff_io::{Effect, Plan, Settings};
use rayon::prelude::*;
use scene::Scene;
use sh_math::Bands;
use std::ops::ControlFlow;
use std::time::Duration;

/// Receivers that are tried, in runs of neighbours as a bake takes them.
const RUNS: usize = 16;
const RUN: usize = 16;

/// A plan with what it will take on this machine. Never part of a file.
#[derive(Debug, Clone, PartialEq)]
pub struct Price {
    /// The plan; its rays are those that the trial leads to expect.
    pub plan: Plan,
    /// Seconds to split the scene, build the tree and decide.
    pub preparation: f64,
    /// Seconds of the any-hit rays.
    pub visibility: f64,
    /// Seconds of the closest-hit rays and of the bounces that are expected.
    pub interreflection: f64,
    /// Seconds of gloss at vertices, as its rays at the speed of all others: nothing of it is tried.
    pub gloss: f64,
    /// Receivers that were tried.
    pub tried: u64,
    /// How much of the sky they see, and those that nothing stands above.
    pub looks: Vec<Look>,
}

/// How much of the sky some receivers of a mesh see. Those that face down are left out: the bottom of what stands on a floor sees none.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Look {
    /// Index of the mesh.
    pub mesh: u32,
    /// How many receivers it stands for.
    pub receivers: f64,
    /// First coefficient of their direct transfer.
    pub first: f32,
}

/// Receivers whose normals point further down face down.
const DOWN: f32 = -0.9;

/// Decides which effects a scene calls for and tries a few hundred receivers; `now` tells the time since any fixed moment. What light maps,
/// transfer textures and volumes take comes on top.
///
/// # Errors
/// As [`crate::bake`].
pub fn price(scene: &Scene, settings: &Settings, extras: &Extras, now: &dyn Fn() -> Duration) -> Result<Price, Error> {
    settings::check(settings)?;
    let began = now();
    let scene = &*refined(scene, settings, &|_| ControlFlow::Continue(()))?;
    let prepared = prepare(scene, settings, extras)?;
    let preparation = (now() - began).as_secs_f64();
    let plan = prepared.plan.clone();
    let mut price =
        Price { plan, preparation, visibility: 0.0, interreflection: 0.0, gloss: 0.0, tried: 0, looks: Vec::new() };
    if simulates(&price.plan, Effect::Visibility) && !prepared.traced.is_empty() {
        try_out(&prepared, settings, now, &mut price)?;
        price.gloss = gloss(&price);
    }
    Ok(price)
}

/// Bakes some receivers: without looking up what blocks, with it, and one bounce.
fn try_out(
    prepared: &Prepared<'_>,
    settings: &Settings,
    now: &dyn Fn() -> Duration,
    price: &mut Price,
) -> Result<(), Error> {
    let Prepared { world, receivers, plan, traced } = prepared;
    let bands = Bands::new(plan.bands).expect("no more than the settings ask for");
    let bank = DirectionBank::new(bands, settings);
    let hits = simulates(plan, Effect::Interreflection);
    let quality = settings.quality;
    let (permanent, worth) = (receivers.permanent as u32, NEAR_WORTH * tolerance(quality));
    let gatherer =
        Gatherer { world, bank: &bank, bands, quality, visibility: true, hits, permanent, worth, mirrors: None };
    let runs = runs(&morton_order(&receivers.list, traced.iter().copied()));
    let gather = |gatherer: &Gatherer<'_>| -> (Vec<Vec<Gathered>>, f64) {
        let start = now();
        let run = |worker: &mut Worker, run: &Vec<u32>| {
            run.iter().map(|&id| gatherer.gather(&receivers.list[id as usize], id, worker)).collect()
        };
        (runs.par_iter().map_init(Worker::new, run).collect(), (now() - start).as_secs_f64())
    };
    // The first turn warms the caches.
    let direct = Gatherer { hits: false, ..gatherer };
    gather(&direct);
    let (seen, visibility) = gather(&direct);
    let tried = seen.iter().map(|run| run.len() as u64).sum::<u64>();
    let scale = traced.len() as f64 / tried as f64;
    price.tried = tried;
    let firsts = runs.iter().flatten().zip(seen.iter().flatten()).map(|(&id, one)| (id, one.transfer[0]));
    price.looks = looks(prepared, &firsts.collect::<Vec<_>>(), scale);
    price.visibility = visibility * scale;
    let rays = |seen: &[Vec<Gathered>], of: fn(&Gathered) -> u64| seen.iter().flatten().map(of).sum::<u64>() as f64;
    set_rays(&mut price.plan, Effect::Visibility, rays(&seen, |g| g.visibility_rays) * scale);
    if hits {
        let (seen, both) = gather(&gatherer);
        set_rays(&mut price.plan, Effect::Interreflection, rays(&seen, |g| g.bounce_rays) * scale);
        // The hits refer to receivers at near points, which a bake would add.
        let mut receivers = receivers.clone();
        for (&id, one) in runs.iter().flatten().zip(seen.iter().flatten()) {
            receivers.add_near(id, one.near.iter().map(|point| world.receiver_at(point)));
        }
        let receivers = &receivers;
        let chunks: Vec<Chunk> =
            runs.iter().zip(&seen).map(|(ids, seen)| Chunk::of(world, ids.clone(), seen)).collect();
        let last = Field::zeros(receivers.list.len(), bands.coefficients(), plan.channels as usize);
        let start = now();
        let monitor = Monitor::new(&|_| ControlFlow::Continue(()));
        bounce_pass(&gatherer, receivers, &chunks, &last, 1, &monitor)?;
        let bounce = (now() - start).as_secs_f64();
        // Receivers at near points are looked from too; those on backs of surfaces are not foreseen.
        let near = rays(&seen, |g| g.near.len() as u64) / tried as f64;
        let lookups = (both - visibility).max(0.0) + near * both;
        price.interreflection = scale * (lookups + bounce * f64::from(plan.expected_bounces));
    }
    Ok(())
}

/// What the tried receivers see, each of which stands for `scale`, and for each mesh those of its vertices that are not traced.
fn looks(prepared: &Prepared<'_>, tried: &[(u32, f32)], scale: f64) -> Vec<Look> {
    let Prepared { world, receivers, traced, .. } = prepared;
    let counts = world.scene.meshes.iter().map(|mesh| mesh.positions.len() as u32);
    let ends: Vec<u32> = counts
        .scan(0, |end, count| {
            *end += count;
            Some(*end)
        })
        .collect();
    let mesh_of = |id: u32| ends.partition_point(|&end| end <= id) as u32;
    let counts = |id: u32| (id as usize) < receivers.vertices && receivers.list[id as usize].normal.y >= DOWN;
    let seen = tried.iter().filter(|(id, _)| counts(*id));
    let mut looks: Vec<Look> = seen.map(|&(id, first)| Look { mesh: mesh_of(id), receivers: scale, first }).collect();
    let mut is_traced = vec![false; receivers.permanent];
    traced.iter().for_each(|&id| is_traced[id as usize] = true);
    let mut open = vec![0.0; ends.len()];
    let others = (0..receivers.vertices as u32).filter(|&id| counts(id) && !is_traced[id as usize]);
    others.for_each(|id| open[mesh_of(id) as usize] += 1.0);
    // All of the sky above the tangent plane.
    let first = (0.25 / std::f64::consts::PI).sqrt() as f32;
    let open = (0..).zip(open).filter(|(_, receivers)| *receivers > 0.0);
    looks.extend(open.map(|(mesh, receivers)| Look { mesh, receivers, first }));
    looks
}

/// Seconds of the rays of gloss at the speed of those that were tried.
fn gloss(price: &Price) -> f64 {
    let rays =
        |effect| price.plan.rows.iter().filter(|row| row.effect == effect).map(|row| row.rays).sum::<u64>() as f64;
    let tried = rays(Effect::Visibility) + rays(Effect::Interreflection);
    if tried > 0.0 { rays(Effect::Glossy) * (price.visibility + price.interreflection) / tried } else { 0.0 }
}

/// Runs of neighbours, evenly spread over the order; all of them where there are few.
fn runs(order: &[u32]) -> Vec<Vec<u32>> {
    let all: Vec<&[u32]> = order.chunks(RUN).collect();
    let count = all.len().min(RUNS);
    (0..count).map(|k| all[(2 * k + 1) * all.len() / (2 * count)].to_vec()).collect()
}

fn set_rays(plan: &mut Plan, effect: Effect, rays: f64) {
    for row in plan.rows.iter_mut().filter(|row| row.effect == effect) {
        row.rays = rays as u64;
    }
}
