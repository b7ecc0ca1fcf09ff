//! Probes in space against closed forms.

mod support;

use coeff_io::Sampler;
use glam::Vec3;
use support::volume::{Rule, at_normal, bake_volume, boxed, irradiance, lit, white};
use support::{fixed, grey};

/// Normals all around.
fn normals() -> impl Iterator<Item = Vec3> {
    let axis = |digit: usize| (digit % 3) as f32 - 1.0;
    (0..27).filter_map(move |i| Vec3::new(axis(i), axis(i / 3), axis(i / 9)).try_normalize())
}

#[test]
fn an_open_point_takes_all_of_the_sky() {
    let scene = scene::builtin("sphere").expect("builtin");
    let volume = bake_volume(
        &scene,
        &fixed(5, Sampler::OwenSobol, 64, 0),
        &boxed(Vec3::splat(500.0), Vec3::splat(501.0), [2; 3]),
    );
    assert!(volume.validity.iter().all(|&v| v == 1.0));
    for probe in 0..8 {
        let under_white = lit(&volume, probe, &white(5));
        for n in normals() {
            let [value, ..] = at_normal(&under_white, n);
            assert!((value - 1.0).abs() < 1e-3, "probe {probe}, {n}: {value}");
        }
        for k in 0..9usize {
            for i in 0..25usize {
                let mut light = vec![[0.0; 3]; 25];
                light[i] = [1.0; 3];
                let expected = if i == k { [1.0, 2.0 / 3.0, 0.25][k.isqrt()] } else { 0.0 };
                let [value, ..] = lit(&volume, probe, &light)[k];
                assert!((value - expected).abs() < 1e-3, "function {k}, coefficient {i}: {value}, not {expected}");
            }
        }
    }
}

/// Half of the sphere is sky of radiance 1, half is ground of radiance a: `(1 + n_y) / 2 + a (1 - n_y) / 2`, which has no bands above 1.
#[test]
fn above_a_plane_half_is_sky() {
    let mut scene = grey("plane", 0.5);
    scene.meshes[0].positions.iter_mut().for_each(|p| *p *= 1000.0);
    let volume =
        bake_volume(&scene, &fixed(4, Sampler::OwenSobol, 256, 2), &boxed(Vec3::splat(-1.0), Vec3::ONE, [3; 3]));
    for probe in 0..27 {
        for n in normals() {
            let [value, ..] = at_normal(&lit(&volume, probe, &white(4)), n);
            let expected = f64::from(0.5 * (1.0 + n.y) + 0.25 * (1.0 - n.y));
            assert!((value - expected).abs() < 5e-3, "probe {probe}, {n}: {value}, not {expected}");
        }
        assert!(volume.positions[probe][1] > 0.0, "those in and below the ground are put above it");
    }
}

/// Walls of albedo 1 vanish, also for what stands in between.
#[test]
fn furnace() {
    let corner = Vec3::new(2.6, 5.4, 2.6);
    let volume = bake_volume(
        &grey("cornell-box", 1.0),
        &fixed(3, Sampler::OwenSobol, 32, 120),
        &boxed(corner * Vec3::new(-1.0, 0.02, -1.0), corner, [4; 3]),
    );
    let good = (0..64).filter(|&p| volume.validity[p] > 0.5);
    for probe in good {
        for n in normals() {
            let [value, ..] = at_normal(&lit(&volume, probe, &white(3)), n);
            assert!((value - 1.0).abs() < 1e-3, "probe {probe}, {n}: {value}");
        }
    }
}

/// No light gets into a closed room, whose walls run through the outermost probes.
#[test]
fn a_sealed_box_is_black() {
    let volume = bake_volume(
        &grey("closed-room", 1.0),
        &fixed(5, Sampler::OwenSobol, 256, 3),
        &boxed(Vec3::splat(-1.0), Vec3::ONE, [5; 3]),
    );
    let largest = |probe: usize| {
        let len = volume.values.len() / volume.validity.len();
        volume.values[probe * len..][..len].iter().fold(0.0f32, |m, v| m.max(v.abs()))
    };
    for probe in 0..125 {
        assert!(volume.validity[probe] > 0.99, "probe {probe}: {}", volume.validity[probe]);
        assert!(largest(probe) < 1e-6, "probe {probe}: {}", largest(probe));
    }
}

/// Two rooms with a wall of 1/10 of a step in between, under a white sky: most of what points in the sealed one take, against what is
/// usual in the open one.
fn leak(volume: &coeff_io::Volume, rule: Rule) -> f64 {
    let axis = |i: usize, low: f32, high: f32| low + (high - low) * (i % 10) as f32 / 9.0;
    let inside = |i: usize, [low, high]: [Vec3; 2]| {
        Vec3::new(axis(i, low.x, high.x), axis(i / 10, low.y, high.y), axis(i / 100, low.z, high.z))
    };
    let at = |p: Vec3| normals().map(move |n| irradiance(volume, p, n, &white(3), rule)[0]);
    let sealed = [Vec3::new(-1.9, 0.05, -0.95), Vec3::new(-0.04, 1.95, 0.95)];
    let open = [Vec3::new(0.1, 0.05, -0.95), Vec3::new(1.9, 1.9, 0.95)];
    let most = (0..1000).flat_map(|i| at(inside(i, sealed))).fold(0.0, f64::max);
    let usual = (0..1000).flat_map(|i| at(inside(i, open))).sum::<f64>() / 26_000.0;
    println!("{rule:?}: {most} of {usual}");
    most / usual
}

#[test]
fn a_thin_wall_keeps_light_out() {
    let scene = scene::builtin("two-rooms").expect("builtin");
    let settings = fixed(3, Sampler::OwenSobol, 256, 2);
    // The wall lies between probes, nearer to one side, or probes lie in the wall.
    for x in [-1.9, -2.0, -2.2, -1.875] {
        let low = Vec3::new(x, 0.05, -0.95);
        let volume = bake_volume(&scene, &settings, &boxed(low, low + 0.625 * Vec3::new(6.0, 3.0, 3.0), [7, 4, 4]));
        println!("{x}");
        let (seen, place) = (leak(&volume, Rule::Visible), leak(&volume, Rule::Trilinear));
    }
}
