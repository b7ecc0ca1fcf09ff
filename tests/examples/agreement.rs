//! Prints how far a bake is from the path tracer: `agreement -- SCENE PROBE [RECEIVERS] [RAYS] [all]`.
//!
//! SCENE is a path, `builtin:NAME`, or `pine`, whose cards blend. One line for direct light, one for a single bounce, one for all bounces (`all`: that line alone); the figures of `docs/comparison.md`.

#![expect(clippy::print_stdout, reason = "an example that prints a table")]

mod named;
#[path = "../tests/support/pine.rs"]
mod pine;
#[path = "../tests/support/mod.rs"]
mod support;

use coeff_io::{Bounces, Quality};
use sh_math::Bands;
use std::time::Instant;
use support::{BandLight, Subject, measure};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [scene_name, probe_name, ..] = &arguments[..] else {
        return Err("give a scene and a probe: agreement -- SCENE PROBE [RECEIVERS] [RAYS] [all]".into());
    };
    let count = arguments.get(2).map_or(Ok(100), |n| n.parse())?;
    let quality = match arguments.get(3) {
        Some(word) if word == "all" => bake::settings::standard().quality,
        Some(rays) => Quality::Rays(rays.parse()?),
        None => bake::settings::standard().quality,
    };
    let scene = match scene_name.as_str() {
        "pine" => pine::pine(tempfile::tempdir()?.path()),
        name => named::scene(name)?,
    };
    let environment = named::probe(probe_name)?;
    let bands = Bands::new(bake::settings::standard().bands).ok_or("no such number of bands")?;
    let light = BandLight::new(&sh_math::project(bands, environment.samples()));
    println!("{scene_name} under {probe_name}: {} vertices", scene.vertex_count());
    let rows = [(Bounces::Fixed(0), Some(0)), (Bounces::Fixed(1), Some(1)), (Bounces::Auto, None)];
    let only_all = arguments.last().is_some_and(|last| last == "all");
    for (bounces, limit) in rows.into_iter().skip(if only_all { 2 } else { 0 }) {
        let start = Instant::now();
        let subject = Subject::bake(scene.clone(), bounces, quality, count);
        let baked = start.elapsed().as_secs_f64();
        let f = measure(&subject, &light, limit, 0.0048);
        let (bounces, traced) = (subject.prt.achieved.bounces, start.elapsed().as_secs_f64() - baked);
        println!("{bounces} bounces, baked in {baked:.0} s, traced in {traced:.0} s, {f}");
    }
    Ok(())
}
