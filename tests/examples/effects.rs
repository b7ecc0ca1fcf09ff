//! Prints what the plan saves: `effects`, every scene as its plan says and with every effect; the table of `docs/effects.md`.

#![expect(clippy::print_stdout, reason = "an example that prints a table")]

#[path = "../tests/saving/mod.rs"]
mod saving;

use coeff_io::{Effects, Prt};
use saving::{Cost, difference, scenes, with};
use scene::Scene;
use std::time::Instant;

/// Bakes, and tells the seconds: the better of two.
fn timed(scene: &Scene, effects: &Effects) -> (Prt, f64) {
    let mut best = f64::INFINITY;
    let mut last = None;
    for _ in 0..2 {
        let start = Instant::now();
        last = Some(with(scene, effects.clone()));
        best = best.min(start.elapsed().as_secs_f64());
    }
    (last.expect("two were baked"), best)
}

fn main() {
    println!("| scene | difference | rays auto | all | seconds auto | all | bytes auto | all |");
    println!("|---|---|---|---|---|---|---|---|");
    for (name, scene) in scenes() {
        let (auto, few_seconds) = timed(&scene, &Effects::Auto);
        let (all, seconds) = timed(&scene, &Effects::All);
        let (few, many) = (Cost::of(&auto), Cost::of(&all));
        println!(
            "| {name} | {:.1e} | {} | {} | {few_seconds:.3} | {seconds:.3} | {} | {} |",
            difference(&auto, &all),
            few.rays,
            many.rays,
            few.bytes,
            many.bytes
        );
    }
}
