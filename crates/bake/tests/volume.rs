//! Probes in space against closed forms.

mod support;

use bake::{Extras, FixedLight, VolumeSettings};
use coeff_io::{MapLight, Sampler};
use glam::Vec3;
use scene::Scene;
use std::ops::ControlFlow;
use support::volume::{at_normal, bake_volume, boxed, lit, normals, white};
use support::{fixed, grey};

/// Most by which a probe differs from a closed form, over normals, under a white sky.
fn furthest(volume: &coeff_io::Volume, probe: usize, expected: impl Fn(Vec3) -> f64) -> f64 {
    let bands = (volume.light.depth() as u32).isqrt();
    let coefficients = lit(volume, probe, &white(bands));
    normals().map(|n| (at_normal(&coefficients, n)[0] - expected(n)).abs()).fold(0.0, f64::max)
}

/// Against the factors of the clamped cosine, [N] eq. 2.3: 1, 2/3, 1/4.
#[test]
fn an_open_point_takes_all_of_the_sky() {
    let scene = scene::builtin("sphere").expect("builtin");
    let far = boxed(Vec3::splat(500.0), Vec3::splat(501.0), [2; 3]);
    let volume = bake_volume(&scene, &fixed(5, Sampler::OwenSobol, 64, 0), &far);
    assert!(volume.validity.iter().all(|&v| v == 1.0) && volume.light == MapLight::Relightable { bands: 5 });
    for probe in 0..8 {
        let off = furthest(&volume, probe, |_| 1.0);
        assert!(off < 1e-3, "probe {probe} is {off} off");
        for k in 0..9usize {
            for i in 0..25usize {
                let mut light = vec![[0.0; 3]; 25];
                light[i] = [1.0; 3];
                let expected = if i == k { [1.0, 2.0 / 3.0, 0.25][k.isqrt()] } else { 0.0 };
                let [value, ..] = lit(&volume, probe, &light)[k];
                assert!((value - expected).abs() < 1e-3, "function {k}, coefficient {i}: {value}, not {expected}");
                // Twin: radiance instead of irradiance would have 1 in every band.
                assert!(i != k || k == 0 || (value - 1.0).abs() > 0.1);
            }
        }
    }
}

/// The ground in y = 0, so wide that it has no end, of albedo a half.
fn ground() -> Scene {
    let mut scene = grey("plane", 0.5);
    scene.meshes[0].positions.iter_mut().for_each(|p| *p *= 1000.0);
    scene
}

/// Half of the sphere is sky of radiance 1, half is ground of radiance 1/2: `(1 + n_y) / 2 + (1 - n_y) / 4`, which has no bands above 1.
#[test]
fn above_the_ground_half_is_sky() {
    let around = boxed(Vec3::splat(-0.8), Vec3::splat(0.8), [3; 3]);
    let volume = bake_volume(&ground(), &fixed(4, Sampler::OwenSobol, 4096, 2), &around);
    let expected = |n: Vec3| f64::from(0.5 * (1.0 + n.y) + 0.25 * (1.0 - n.y));
    for probe in 0..27 {
        let off = furthest(&volume, probe, expected);
        assert!(off < 5e-3, "probe {probe} is {off} off");
        assert!(
            furthest(&volume, probe, |n| f64::from(0.5 * (1.0 + n.y))) > 0.2,
            "without the ground's light it fails"
        );
    }
    // Those in the ground and below it were put above it, those above stayed.
    let heights: Vec<f32> = [1, 4, 7].map(|probe| volume.positions[probe][1]).to_vec();
    assert!(heights[0] > 0.0 && heights[0] < 0.2 && heights[1] > 0.0 && heights[1] < 0.2, "{heights:?}");
    assert_eq!(heights[2], 0.8);
}

/// Walls of albedo 1 vanish, also for what stands between them.
#[test]
fn furnace() {
    let corner = Vec3::new(2.6, 5.4, 2.6);
    let inside = boxed(corner * Vec3::new(-1.0, 0.02, -1.0), corner, [4; 3]);
    let worst = |albedo: f32| {
        let volume = bake_volume(&grey("cornell-box", albedo), &fixed(3, Sampler::OwenSobol, 32, 120), &inside);
        assert!(volume.validity.iter().filter(|&&v| v > 0.5).count() > 55, "few are in the blocks");
        (0..64).filter(|&p| volume.validity[p] > 0.0).map(|p| furthest(&volume, p, |_| 1.0)).fold(0.0, f64::max)
    };
    let off = worst(1.0);
    assert!(off < 1e-3, "{off} is lost or won");
    assert!(worst(0.99) > 1e-3, "a hundredth is seen");
}

fn largest(volume: &coeff_io::Volume, probe: usize) -> f32 {
    let len = volume.values.len() / volume.validity.len();
    volume.values[probe * len..][..len].iter().fold(0.0, |m, v| m.max(v.abs()))
}

/// No light gets into a closed room, whose walls run through the outermost probes.
#[test]
fn a_sealed_box_is_black() {
    let scene = grey("closed-room", 1.0);
    let settings = fixed(5, Sampler::OwenSobol, 256, 3);
    let volume = bake_volume(&scene, &settings, &boxed(Vec3::NEG_ONE, Vec3::ONE, [5; 3]));
    for probe in 0..125 {
        assert!(volume.validity[probe] > 0.99, "probe {probe} sees {}", volume.validity[probe]);
        assert!(largest(&volume, probe) < 1e-6, "probe {probe}: {}", largest(&volume, probe));
    }
    // Twin: probes around it, just outside, see light.
    let around = bake_volume(&scene, &settings, &boxed(Vec3::splat(-1.8), Vec3::splat(1.8), [2; 3]));
    assert!((0..8).all(|probe| largest(&around, probe) > 0.1));
}

/// A cube of 2 m edge: a probe a quarter of a metre inside comes out of its face; the one in the middle is too deep and takes what is
/// beside it.
#[test]
fn probes_come_out_of_bodies() {
    let around = boxed(Vec3::splat(-1.5), Vec3::splat(1.5), [5; 3]);
    let volume = bake_volume(&grey("furnace-box", 0.5), &fixed(3, Sampler::OwenSobol, 4096, 1), &around);
    let middle = 62;
    assert!(volume.validity[middle] > 0.0 && volume.validity[middle] < 0.05, "{}", volume.validity[middle]);
    assert_eq!(volume.positions[middle], [0.0; 3]);
    assert!(largest(&volume, middle) > 0.1, "it borrows light");
    for (probe, &[x, y, z]) in volume.positions.iter().enumerate().filter(|(probe, _)| *probe != middle) {
        assert!(volume.validity[probe] > 0.9, "probe {probe} at {x}, {y}, {z}: {}", volume.validity[probe]);
        let out = x.abs().max(y.abs()).max(z.abs());
        assert!(out > 1.0, "probe {probe} at {x}, {y}, {z} is inside");
    }
    // Near the middle of a face half is sky, half the face, of radiance a half.
    let above = middle + 5;
    assert!(volume.positions[above][1] < 1.1, "{:?}", volume.positions[above]);
    let off = furthest(&volume, above, |n| f64::from(0.5 * (1.0 + n.y) + 0.25 * (1.0 - n.y)));
    assert!(off < 0.03, "{off} off: the face ends, 1 m away");
}

/// A light that is baked in gives what the same light gives afterwards.
#[test]
fn fixed_and_relit_agree() {
    let scene = scene::builtin("cornell-box").expect("builtin");
    let settings = fixed(4, Sampler::OwenSobol, 128, 2);
    let inside = boxed(Vec3::new(-2.5, 0.2, -2.5), Vec3::new(2.5, 5.2, 2.5), [3; 3]);
    let light: Vec<[f32; 3]> = (0..16).map(|i| [1.0 / (1.0 + i as f32), 0.3 - 0.05 * i as f32, 0.1]).collect();
    let relit = bake_volume(&scene, &settings, &inside);
    let extras = Extras {
        volume: Some(inside.clone()),
        light: Some(FixedLight { name: "builtin:test".into(), coefficients: light.clone() }),
        ..Extras::default()
    };
    let baked = bake::bake_with(&scene, &settings, &extras, &|_| ControlFlow::Continue(())).expect("it bakes");
    let baked = baked.volume.expect("asked for");
    assert_eq!(baked.light, MapLight::Fixed { probe: "builtin:test".into(), bands: 4 });
    assert_eq!((baked.channels, baked.values.len()), (3, 27 * 9 * 3));
    let mut scale = 0.0f64;
    for probe in 0..27 {
        let (a, b) = (lit(&baked, probe, &[]), lit(&relit, probe, &light));
        for (a, b) in a.as_flattened().iter().zip(b.as_flattened()) {
            assert!((a - b).abs() < 2e-5, "probe {probe}: {a} and {b}");
            scale = scale.max(a.abs());
        }
    }
    assert!(scale > 0.5, "there is light to compare: {scale}");
}

/// Auto fills the scene from wall to wall.
#[test]
fn auto_fills_the_scene() {
    let scene = scene::builtin("cornell-box").expect("builtin");
    let volume = bake_volume(
        &scene,
        &fixed(1, Sampler::OwenSobol, 32, 0),
        &VolumeSettings { resolution: 8, ..VolumeSettings::standard() },
    );
    assert_eq!(volume.cells, [16; 3]);
    assert_eq!(volume.validity.len(), 17 * 17 * 17);
    assert!(volume.validity.iter().filter(|&&v| v > 0.9).count() > 4500);
}
