//! User seconds of bakes whose ground is cut into slivers, flush with a floor, beside ground of compact triangles.
//!
//! `cargo bench -p bake --bench slivers` prints one row per kind: one thread, 32 rays per receiver, 3 bands, no bounce, refinement as by
//! default, for a number of triangles and twice as many.
#![expect(clippy::print_stdout, reason = "a bench shows its figures")]

#[path = "../tests/support/grounds.rs"]
mod grounds;

use bake::settings;
use coeff_io::{Bounces, Quality, Settings};
use glam::{Vec3, vec3};
use grounds::{Kind, compact, disc, polygon, star};
use scene::{Material, Mesh, Scene};
use std::ops::ControlFlow;

fn main() {
    println!("| ground | slivers | receivers | user s | twice: receivers | user s |");
    println!("|---|---|---|---|---|---|");
    let kinds: [Kind; 5] =
        [("disc", disc), ("polygon", polygon), ("star", star), ("comb", comb), ("compact triangles", compact)];
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build().expect("a thread");
    pool.install(|| {
        for (name, kind) in kinds {
            let [(few, fast), (many, slow)] = [1_000, 2_000].map(|n| measured(kind(n)));
            println!("| {name} | 1000 | {few} | {fast:.2} | {many} | {slow:.2} |");
        }
    });
}

/// Receivers and user seconds of a bake of ground on a floor, with posts on it.
fn measured(ground: Mesh) -> (u64, f64) {
    let corners = [[-12.0, -12.0], [-12.0, 12.0], [12.0, 12.0], [12.0, -12.0]];
    let positions = corners.map(|[x, z]| vec3(x, 0.0, z)).to_vec();
    let floor = Mesh { positions, triangles: vec![[0, 1, 2], [0, 2, 3]], ..Mesh::default() };
    let meshes = vec![floor, ground, posts()];
    let scene = Scene { meshes, materials: vec![Material::default()], ..Scene::default() };
    let settings =
        Settings { bands: 3, quality: Quality::Rays(32), bounces: Bounces::Fixed(0), ..settings::standard() };
    let start = user_seconds();
    let prt = bake::bake(&scene, &settings, &|_| ControlFlow::Continue(())).expect("the scene bakes");
    (prt.plan.receivers, user_seconds() - start)
}

/// User time of this process, as Linux tells it in hundredths of a second.
fn user_seconds() -> f64 {
    let stat = std::fs::read_to_string("/proc/self/stat").expect("Linux tells the time of processes");
    let after_name = stat.rsplit(')').next().unwrap_or_default();
    after_name.split_whitespace().nth(11).and_then(|ticks| ticks.parse::<f64>().ok()).expect("user time") / 100.0
}

/// Pyramids that stand on the ground.
fn posts() -> Mesh {
    let mut mesh = Mesh::default();
    for k in 0..20u32 {
        let (angle, radius) = (k as f32 * 2.4, 10.0 * ((k as f32 + 0.5) / 20.0).sqrt());
        let at = vec3(radius * angle.sin(), 0.0, radius * angle.cos());
        let first = 5 * k;
        let corners = [[-1.0, -1.0], [-1.0, 1.0], [1.0, 1.0], [1.0, -1.0]];
        mesh.positions.extend(corners.map(|[x, z]| at + 0.2 * vec3(x, 0.0, z)));
        mesh.positions.push(at + 0.5 * Vec3::Y);
        mesh.triangles.extend((0..4).map(|i| [first + i, first + (i + 1) % 4, first + 4]));
    }
    mesh
}

/// Long teeth side by side.
fn comb(n: u32) -> Mesh {
    let x = |k: u32| 8.0 * k as f32 / n as f32 - 4.0;
    let positions = (0..n).flat_map(|k| [vec3(x(k), 0.0, -1.0), vec3(x(k + 1), 0.0, -1.0), vec3(x(k), 0.0, 1.0)]);
    let triangles = (0..n).map(|k| [3 * k, 3 * k + 2, 3 * k + 1]).collect();
    Mesh { positions: positions.collect(), triangles, ..Mesh::default() }
}
