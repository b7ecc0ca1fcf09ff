//! Rays and receivers per second of whole bakes on one thread, and the share of the time that goes into tracing.
//!
//! `cargo bench -p bake` prints one row per scene: 1,024 cosine-weighted any-hit rays per receiver and 5 bands, no bounce;
//! then the default bake (1 % error, bounces until they stop to matter). Real scenes are taken where they are at hand.
#![expect(clippy::print_stdout, reason = "a bench shows its figures")]

use bake::{Receivers, settings};
use coeff_io::{Bounces, Quality, Refine, Sampler, Settings};
use glam::Vec3;
use raytrace::{FanState, Tracer, offset_origin};
use sampling::frame::Frame;
use sampling::sequence::{self, Sequence};
use sampling::warp;
use scene::Scene;
use std::ops::ControlFlow;
use std::time::{Duration, Instant};

const RAYS: u32 = 1024;

fn main() {
    println!("One thread; {RAYS} rays per receiver, 5 bands, no bounce; then the default bake of the same mesh.\n");
    println!(
        "| scene | triangles | receivers | Mray/s | receivers/s | tracing | the rest | default bake: receivers/s | rays per receiver | Mray/s |"
    );
    println!("|---|---|---|---|---|---|---|---|---|---|");
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build().expect("a thread");
    pool.install(|| {
        for (name, scene) in scenes() {
            row(&name, &scene);
        }
    });
}

/// Builtin scenes, and the real ones that are at hand.
fn scenes() -> Vec<(String, Scene)> {
    let builtins = ["cornell-box", "teacup", "atrium"];
    let mut scenes: Vec<(String, Scene)> =
        builtins.iter().map(|n| ((*n).to_owned(), scene::builtin(n).expect("builtin"))).collect();
    let Some(data) = testkit::data_dir() else {
        testkit::skip("bunny, house and Sponza");
        return scenes;
    };
    for (name, path) in [
        ("bunny", "stanford-bunny/stanford-bunny.obj"),
        ("house", "house-lightmap-uv/house.glb"),
        ("Sponza", "sponza/sponza.gltf"),
    ] {
        scenes.push((name.to_owned(), scene::load(&data.join("scenes").join(path)).expect("the scene loads")));
    }
    scenes
}

fn row(name: &str, scene: &Scene) {
    let fixed = Settings {
        quality: Quality::Rays(RAYS),
        sampler: Sampler::Fibonacci,
        bounces: Bounces::Fixed(0),
        refine: Refine::Off,
        ..settings::standard()
    };
    let quiet = |settings: &Settings| {
        let start = Instant::now();
        let prt = bake::bake(scene, settings, &|_| ControlFlow::Continue(())).expect("the scene bakes");
        (start.elapsed().as_secs_f64(), prt.achieved, prt.plan.receivers as f64)
    };
    let (build, traced) = traced_alone(scene);
    let (seconds, achieved, receivers) = quiet(&fixed);
    let working = (seconds - build.as_secs_f64()).max(1e-9);
    let share = (traced.as_secs_f64() / working).min(1.0);
    let rays = achieved.visibility_rays as f64;
    let (auto_seconds, auto, _) = quiet(&Settings { refine: Refine::Off, ..settings::standard() });
    let auto_rays = (auto.visibility_rays + auto.bounce_rays) as f64;
    println!(
        "| {name} | {} | {receivers} | {:.2} | {:.0} | {:.0} % | {:.0} % | {:.0} | {:.0} | {:.2} |",
        scene.triangle_count(),
        rays / working / 1e6,
        receivers / working,
        100.0 * share,
        100.0 * (1.0 - share),
        receivers / auto_seconds,
        auto_rays / receivers,
        auto_rays / auto_seconds / 1e6,
    );
}

/// Time to build the tree, and time in the tracer alone for like directions at the same receivers.
fn traced_alone(scene: &Scene) -> (Duration, Duration) {
    let mut positions: Vec<Vec3> = Vec::new();
    let mut triangles = Vec::new();
    for mesh in scene.meshes.iter().filter(|m| scene.materials[m.material as usize].blocks_rays()) {
        let first = positions.len() as u32;
        positions.extend(&mesh.positions);
        triangles.extend(mesh.triangles.iter().map(|t| t.map(|v| v + first)));
    }
    let start = Instant::now();
    let tracer = Tracer::build(&positions, &triangles, &[]);
    let build = start.elapsed();
    let mut points = Vec::new();
    sequence::fill(Sequence::Fibonacci, RAYS, 7, &mut points);
    points.sort_by_key(|[x, y]| ((x * 16.0) as u32, (y * 16.0) as u32));
    let local: Vec<Vec3> = points.into_iter().map(warp::square_to_cosine_hemisphere).collect();
    let (mut state, mut blocked) = (FanState::new(), vec![0u64; RAYS as usize / 64]);
    let (mut xs, mut ys, mut zs) = (Vec::new(), Vec::new(), Vec::new());
    let mut traced = Duration::ZERO;
    for receiver in Receivers::of(scene).list.iter().filter(|r| tracer.anything_above(r.vertex, r.normal)) {
        let frame = Frame::from_normal(receiver.normal);
        for (axis, list) in [&mut xs, &mut ys, &mut zs].into_iter().enumerate() {
            list.clear();
            list.extend(local.iter().map(|d| frame.to_world(*d)[axis]));
        }
        let origin = offset_origin(receiver.position, receiver.geometric_normal);
        let start = Instant::now();
        tracer.occluded_fan(origin, &xs, &ys, &zs, &|_, _, _| true, &mut state, &mut blocked);
        traced += start.elapsed();
    }
    (build, traced)
}
