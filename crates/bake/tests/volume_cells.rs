//! Probes against rays of the tests' own, cells that are split, and what every bake must keep.

mod support;

use bake::{Error, Extras, Stage, VolumeSettings, VolumeSteps};
use coeff_io::{Node, Sampler, Settings, Volume};
use glam::{DVec3, Vec3};
use raytrace::{Ray, Tracer};
use scene::Scene;
use std::ops::ControlFlow;
use support::fixed;
use support::volume::{Rule, at_normal, bake_volume, boxed, irradiance, lit, normals, white};

/// A tracer over all surfaces.
fn tracer(scene: &Scene) -> Tracer {
    let (mut positions, mut triangles) = (Vec::new(), Vec::new());
    for mesh in &scene.meshes {
        let first = positions.len() as u32;
        triangles.extend(mesh.triangles.iter().map(|t| t.map(|v| v + first)));
        positions.extend(&mesh.positions);
    }
    Tracer::build(&positions, &triangles, &[])
}

/// Irradiance / pi in 3 bands under a light of which surfaces send nothing on, by rays on a grid of equal areas.
fn by_rays(tracer: &Tracer, at: Vec3, side: u32, light: &[f64]) -> [[f64; 3]; 9] {
    let bands = |n| sh_math::Bands::new(n).expect("in range");
    let of_light = bands((light.len() as u32).isqrt());
    let mut sums = [[0.0; 3]; 9];
    for i in 0..side * side {
        let z = 1.0 - 2.0 * (f64::from(i / side) + 0.5) / f64::from(side);
        let phi = std::f64::consts::TAU * (f64::from(i % side) + 0.5) / f64::from(side);
        let radius = (1.0 - z * z).sqrt();
        let direction = DVec3::new(radius * phi.cos(), radius * phi.sin(), z);
        if tracer.occluded(&Ray::new(at, direction.as_vec3()), &|_, _, _| true) {
            continue;
        }
        let (mut of_sky, mut of_normal) = (vec![0.0; light.len()], [0.0; 9]);
        sh_math::evaluate_f64(of_light, direction, &mut of_sky);
        sh_math::evaluate_f64(bands(3), direction, &mut of_normal);
        let radiance: f64 = of_sky.iter().zip(light).map(|(y, l)| y * l).sum();
        for (k, (sum, y)) in sums.iter_mut().zip(of_normal).enumerate() {
            let factor = [1.0, 2.0 / 3.0, 0.25][k.isqrt()];
            *sum = sum.map(|s| s + factor * radiance * y * 4.0 * std::f64::consts::PI / f64::from(side * side));
        }
    }
    sums
}

#[test]
fn probes_see_what_rays_see() {
    let scene = scene::builtin("cornell-box").expect("builtin");
    let tracer = tracer(&scene);
    let inside = boxed(Vec3::new(-2.3, 0.3, -2.4), Vec3::new(2.4, 6.2, 3.1), [3; 3]);
    let volume = bake_volume(&scene, &fixed(4, Sampler::OwenSobol, 4096, 0), &inside);
    let light: Vec<f64> = (0..16).map(|i| 1.0 / (1.0 + f64::from(i)) - 0.2).collect();
    let rgb: Vec<[f32; 3]> = light.iter().map(|&l| [l as f32; 3]).collect();
    let (mut worst, mut scale) = (0.0f64, 0.0f64);
    for probe in (0..27).filter(|&probe| volume.validity[probe] > 0.5) {
        let truth = by_rays(&tracer, Vec3::from_array(volume.positions[probe]), 160, &light);
        for ([a, ..], [b, ..]) in lit(&volume, probe, &rgb).iter().zip(&truth) {
            worst = worst.max((a - b).abs());
            scale = scale.max(b.abs());
        }
    }
    assert!(worst < 5e-3 * scale, "{worst} off, of {scale}");
    // Twin: 17 cm aside would be seen.
    let aside = by_rays(&tracer, Vec3::from_array(volume.positions[13]) + 0.1, 160, &light);
    let moved = lit(&volume, 13, &rgb).iter().zip(&aside).map(|(a, b)| (a[0] - b[0]).abs()).fold(0.0, f64::max);
    assert!(moved > 5e-3 * scale, "{moved}");
}

/// Most that points near the ground and the ball take more or less than rays say.
fn error_near(volume: &Volume, points: &[(Vec3, [[f64; 3]; 9])]) -> f64 {
    let one = |(p, truth): &(Vec3, [[f64; 3]; 9])| {
        let off = |n| (irradiance(volume, *p, n, &white(1), Rule::Visible)[0] - at_normal(truth, n)[0]).abs();
        normals().map(off).fold(0.0, f64::max)
    };
    points.iter().map(one).fold(0.0, f64::max)
}

/// A ball on the ground: near surfaces an octree is as good as an even grid of its finest step.
#[test]
fn cells_are_split_where_it_matters() {
    let scene = scene::builtin("sphere-on-plane").expect("builtin");
    let tracer = tracer(&scene);
    let settings = fixed(1, Sampler::OwenSobol, 256, 0);
    let bake = |probes: [u32; 3], levels: u32| {
        let grid = boxed(Vec3::new(-3.0, 0.02, -3.0), Vec3::new(3.0, 3.02, 3.0), probes);
        bake_volume(&scene, &settings, &VolumeSettings { levels, resolution: 8, ..grid })
    };
    let mut random = sampling::rng::Rng::new(3, 0);
    let mut points = Vec::new();
    while points.len() < 100 {
        let p = Vec3::from_array([(); 3].map(|()| random.next_f32())) * Vec3::new(2.0, 0.15, 2.0)
            - Vec3::new(1.0, -0.02, 1.0);
        if p.distance(0.5 * Vec3::Y) > 0.52 {
            points.push((p, by_rays(&tracer, p, 80, &[(4.0 * std::f64::consts::PI).sqrt()])));
        }
    }
    let (coarse, even, split) = (bake([9, 5, 9], 0), bake([33, 17, 33], 0), bake([9, 5, 9], 2));
    let [a, b, c] = [&coarse, &even, &split].map(|volume| error_near(volume, &points));
    let [p, q, r] = [&coarse, &even, &split].map(|volume| volume.positions.len());
    assert!(c <= 1.05 * b, "split cells err by {c}, even ones by {b}");
    assert!(3 * r < q, "with {r} probes, not {q}");
    // Twin: the coarsest cells alone would be seen.
    assert!(a > 3.0 * b && p < r, "{p} probes err by {a}");
}

#[test]
fn any_number_of_threads_gives_the_same() {
    let scene = scene::builtin("two-rooms").expect("builtin");
    let settings = Settings { quality: coeff_io::Quality::Error(0.05), ..fixed(3, Sampler::OwenSobol, 64, 1) };
    let grid = boxed(Vec3::new(-2.2, -0.1, -1.0), Vec3::new(2.2, 2.2, 1.0), [5, 4, 4]);
    let bake = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("a pool");
        pool.install(|| bake_volume(&scene, &settings, &VolumeSettings { levels: 1, resolution: 8, ..grid.clone() }))
    };
    let one = bake(1);
    assert_eq!(one, bake(2));
    assert!(one.nodes.iter().any(|node| matches!(node, Node::Split(_))));
    let other = bake_volume(&scene, &Settings { seed: 1, ..settings.clone() }, &grid);
    assert_ne!(one.values[..9], other.values[..9], "can fail: another seed gives other numbers");
}

/// Every cell is a leaf with eight probes, or split into eight that follow.
#[test]
fn cells_form_a_tree() {
    let scene = scene::builtin("sphere-on-plane").expect("builtin");
    let wanted =
        VolumeSettings { levels: 3, resolution: 2, steps: VolumeSteps::Spacing(1.5), ..VolumeSettings::standard() };
    let volume = bake_volume(&scene, &fixed(1, Sampler::OwenSobol, 16, 0), &wanted);
    let coarse = volume.cells.iter().product::<u32>() as usize;
    let mut seen = vec![0u32; volume.nodes.len()];
    for node in &volume.nodes {
        match *node {
            Node::Split(first) => (first..first + 8).for_each(|part| seen[part as usize] += 1),
            Node::Leaf(corners) => {
                let [low, high] = [corners[0], corners[7]].map(|c| Vec3::from_array(volume.positions[c as usize]));
                assert!(corners.iter().all(|&c| (c as usize) < volume.positions.len()));
                assert!((high - low).cmpgt(Vec3::splat(-0.05)).all(), "{low} to {high}");
            }
        }
    }
    assert!(seen[..coarse].iter().all(|&n| n == 0) && seen[coarse..].iter().all(|&n| n == 1));
    assert!(volume.nodes.len() > coarse);
}

#[test]
fn what_cannot_be_is_refused() {
    let scene = scene::builtin("cornell-box").expect("builtin");
    let settings = fixed(3, Sampler::OwenSobol, 16, 0);
    let sentence = |settings: &Settings, wanted: VolumeSettings| {
        let extras = Extras { volume: Some(wanted), ..Extras::default() };
        let bake = bake::bake_with(&scene, settings, &extras, &|_| ControlFlow::Continue(()));
        bake.expect_err("refused").to_string()
    };
    let spaced = |step| VolumeSettings { steps: VolumeSteps::Spacing(step), ..VolumeSettings::standard() };
    assert!(sentence(&settings, spaced(1e-4)).contains("wider spacing"));
    assert!(sentence(&settings, spaced(0.03)).contains("memory"), "{}", sentence(&settings, spaced(0.03)));
    let deep = VolumeSettings { levels: 6, ..spaced(0.1) };
    assert!(sentence(&settings, deep.clone()).contains("fewer levels"), "{}", sentence(&settings, deep));
    let little = Settings { memory: 4 << 20, ..settings };
    assert!(sentence(&little, VolumeSettings::standard()).contains("probes needs"));
}

/// Where nothing blocks light by request, every probe is open, also within a body; rays tell otherwise.
#[test]
fn effects_are_obeyed() {
    let scene = scene::builtin("furnace-box").expect("builtin");
    let inside = boxed(Vec3::splat(-0.2), Vec3::splat(0.2), [2; 3]);
    let settings = fixed(3, Sampler::OwenSobol, 64, 0);
    let none = Settings { effects: coeff_io::Effects::Only(Vec::new()), ..settings.clone() };
    let value = |settings: &Settings| {
        let volume = bake_volume(&scene, settings, &VolumeSettings { resolution: 8, ..inside.clone() });
        (at_normal(&lit(&volume, 0, &white(3)), Vec3::Y)[0], volume.validity[0], volume.distances[0] / volume.reach)
    };
    let (open, validity, distance) = value(&none);
    assert!((open - 1.0).abs() < 1e-5 && validity == 1.0 && distance == 1.0, "{open}, {validity}, {distance}");
    let (buried, validity, distance) = value(&settings);
    assert!(buried == 0.0 && validity == 0.0 && distance < 1.0 + 1e-6, "can fail: {buried}, {validity}, {distance}");
}

#[test]
fn a_cancel_is_heard() {
    let scene = scene::builtin("cornell-box").expect("builtin");
    let extras = Extras { volume: Some(VolumeSettings::standard()), ..Extras::default() };
    let stop = |now: &bake::Progress| match now.stage {
        Stage::Probes if now.done > 0 => ControlFlow::Break(()),
        _ => ControlFlow::Continue(()),
    };
    let bake = bake::bake_with(&scene, &fixed(2, Sampler::OwenSobol, 64, 0), &extras, &stop);
    assert_eq!(bake.err(), Some(Error::Cancelled));
}
