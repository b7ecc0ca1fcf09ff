//! A small baked file and a small report for tests.

use super::report::{Knob, Machine, ReferenceFacts, Report, Run};
use super::{Advice, Goal, Spread};
use coeff_io::{Prt, Quality, Settings};
use std::ops::ControlFlow;

/// The Cornell box in two bands, 32 rays per receiver.
pub(crate) fn prt() -> Prt {
    let scene = scene::builtin("cornell-box").expect("it is built in");
    let settings = Settings { bands: 2, quality: Quality::Rays(32), ..bake::settings::standard() };
    bake::bake(&scene, &settings, &|_| ControlFlow::Continue(())).expect("the Cornell box can be baked")
}

/// A run in five bands; of 120 receivers, 100 are shadowed.
fn run(knob: Knob, setting: &str, seconds: f64, p95: f64, rays: u64) -> Run {
    Run {
        knob,
        setting: setting.into(),
        can_be_typed: true,
        bands: 5,
        receivers: 120,
        channels: 3,
        bounces: 1,
        rays: [rays, 0],
        seconds,
        bytes: 36_000,
        transfer: Spread { p95, ..Spread::default() },
        radiance: p95,
        radiance_all_bands: Some(0.1),
    }
}

/// A report of three runs: few rays, as asked with an error of 1 %, and another sampler.
pub(crate) fn report() -> Report {
    Report {
        scene: "builtin:plane".into(),
        light: "builtin:sky".into(),
        bands: 5,
        machine: Machine { threads: 1, system: "test".into(), version: "0".into() },
        budget: [60.0, 50.0],
        receivers: [120, 100],
        texture_bytes: 0,
        reference: ReferenceFacts {
            level: "4096 rays".into(),
            bands: 8,
            own: Spread::default(),
            own_radiance: 0.0,
            rays_per_receiver: 8192.0,
            bounces: 1,
            seconds: 20.0,
        },
        runs: vec![
            run(Knob::Rays, "--rays 64", 1.0, 0.05, 6_000),
            run(Knob::Error, "--error 0.01", 4.0, 0.01, 60_000),
            run(Knob::Sampler, "--rays 64 --sampler stratified", 1.0, 0.15, 3_000),
        ],
        fast_front: vec![],
        small_front: vec![],
        advice: vec![Advice { goal: Goal::Error(0.01), run: 1, met: true }],
        resolution: None,
        bases: None,
        gloss: None,
        frames: vec![],
        checks: vec![],
        worst: vec![],
        asked: Some(1),
        shown: 1,
        views: vec![],
        map_range: [1e-4, 1e-1],
        left_out: vec![],
    }
}
