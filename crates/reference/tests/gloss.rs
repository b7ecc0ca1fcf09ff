//! Surfaces that shine: against what they return of a white sky, and against the lobes as they are written down.

mod scatter;

use glam::{Vec3, Vec4};
use probe_io::{Environment, Lamp};
use reference::{
    Estimate, Gaze, Gloss, Light, Lobe, Mirroring, Settings, World, directional_albedo, radiance_at, radiance_seen,
};
use scene::{Scene, builtin};
use std::f64::consts::PI;

const MODELS: [Mirroring; 3] = [Mirroring::Lobe(Lobe::Phong), Mirroring::Lobe(Lobe::Ggx), Mirroring::Microfacet];

fn white_sky() -> Light {
    Light::new(&Environment::constant([1.0; 3]))
}

/// A scene of one plain material.
fn painted(name: &str, base: f32, metallic: f32) -> Scene {
    let mut scene = builtin(name).expect("a built-in scene");
    for material in &mut scene.materials {
        material.base_color = Vec4::new(base, base, base, 1.0);
        material.base_color_texture = None;
        material.metallic_roughness_texture = None;
        (material.metallic, material.roughness) = (metallic, 0.5);
    }
    scene.meshes.iter_mut().for_each(|mesh| mesh.colors.clear());
    scene
}

/// A gaze at the middle of the floor under an angle of that cosine.
fn gaze(cosine: f32) -> Gaze {
    let view = Vec3::new((1.0 - cosine * cosine).sqrt(), cosine, 0.0);
    Gaze { eye: view * 2.0, direction: -view }
}

/// The share of a white sky that a dielectric's mirror takes from the diffuse part below.
fn taken(cosine: f32) -> f32 {
    let view = glam::DVec3::new(f64::from(1.0 - cosine * cosine).sqrt(), 0.0, f64::from(cosine));
    let term = |(d, weight): ([f64; 3], f64)| {
        let half = (view + glam::DVec3::from(d)).normalize();
        weight * d[2].max(0.0) / PI * (0.04 + 0.96 * (1.0 - view.dot(half)).powi(5))
    };
    testkit::quadrature::sphere_quadrature(200).into_iter().map(term).sum::<f64>() as f32
}

fn see(scene: &Scene, gloss: Gloss, light: &Light, cosine: f32, samples: u32) -> Estimate {
    let settings = Settings { samples, seed: 12, max_bounces: None };
    radiance_seen(&World::new(scene).with_gloss(gloss), light, &[gaze(cosine)], &settings)[0]
}

fn rough(mirroring: Mirroring, roughness: f32) -> Gloss {
    Gloss { roughness: Some(roughness), ..Gloss::new(mirroring) }
}

/// Whether an estimate lies within four standard errors of a value, and `own`, what the value itself is worth.
fn near(estimate: &Estimate, value: f32, own: f32) -> bool {
    (0..3).all(|c| (estimate.mean[c] - value).abs() <= own + 4.0 * estimate.std_error[c])
}

/// A lobe returns its share of a white sky, a dielectric's diffuse part gives up Schlick's term for it. Tables: of lobes above the plane
/// to 3e-4, of the microfacets' integral to 4e-3.
#[test]
fn furnace_returns_the_directional_albedo() {
    for (base, metallic) in [(1.0, 1.0), (0.5, 0.0)] {
        let scene = painted("plane", base, metallic);
        let expected = |roughness, cosine| {
            let f0 = 0.04 + (base - 0.04) * metallic;
            directional_albedo(Vec3::splat(f0), roughness, cosine).x + base * (1.0 - metallic) * (1.0 - taken(cosine))
        };
        for mirroring in MODELS {
            let own = if mirroring == Mirroring::Microfacet { 4e-3 } else { 3e-4 };
            for (roughness, cosine) in [(0.1, 0.3), (0.3, 0.8), (0.5, 0.2), (0.7, 0.6), (1.0, 0.15), (1.0, 1.0)] {
                let seen = see(&scene, rough(mirroring, roughness), &white_sky(), cosine, 40_000);
                let value = expected(roughness, cosine);
                assert!(near(&seen, value, own), "{mirroring:?} {roughness} {cosine}: {seen:?} {value}");
                assert!(!near(&seen, value * 1.03, own), "can fail: 3 % more");
            }
        }
    }
}

/// Sharp white mirrors lose nothing: radiance 1 everywhere after any number of bounces, for matte receivers between them, too.
#[test]
fn white_mirrors_vanish() {
    let scene = painted("cornell-box", 1.0, 1.0);
    let receivers: Vec<_> = scatter::receivers(&scene, 12, 3)
        .into_iter()
        .map(|receiver| reference::Receiver { albedo: Vec3::ONE, ..receiver })
        .collect();
    let trace = |gloss| {
        let settings = Settings { samples: 2000, seed: 5, max_bounces: None };
        radiance_at(&World::new(&scene).with_gloss(gloss), &white_sky(), &receivers, &settings)
    };
    for mirroring in MODELS {
        // Each bounce is worth up to 3e-4, and there are about five.
        let lit: Vec<_> = trace(rough(mirroring, 0.1)).into_iter().filter(|e| e.mean[0] != 0.0).collect();
        assert!(lit.len() >= 8, "{} receivers see light", lit.len());
        lit.iter().for_each(|e| assert!(near(e, 1.0, 2e-3), "{mirroring:?}: {e:?}"));
        let lossy = trace(rough(mirroring, 0.8));
        assert!(lossy.iter().any(|e| !near(e, 1.0, 2e-3)), "can fail: rough metal loses light");
    }
}

/// The lobe in a direction whose angle with the mirror direction has this cosine; not normalised.
fn shape(lobe: Lobe, alpha: f64, cosine: f64) -> f64 {
    match lobe {
        _ if cosine <= 0.0 => 0.0,
        Lobe::Phong => cosine.powf(0.5 * (1.0 / (alpha * alpha) - 1.0)),
        Lobe::Ggx => {
            let half = 0.5 * (1.0 + cosine);
            cosine / (half * (alpha * alpha - 1.0) + 1.0).powi(2)
        }
    }
}

/// What a lobe sends of a lamp's irradiance: its value over its integral above the floor, by quadrature.
fn mirrored(lobe: Lobe, roughness: f32, axis: [f64; 3], lamp: [f64; 3]) -> f64 {
    let alpha = f64::from(roughness).powi(2);
    let dot = |a: [f64; 3], b: [f64; 3]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
    let above: f64 = testkit::quadrature::sphere_quadrature(600)
        .into_iter()
        .filter(|(d, _)| d[1] > 0.0)
        .map(|(d, weight)| weight * shape(lobe, alpha, dot(d, axis)))
        .sum();
    shape(lobe, alpha, dot(lamp, axis)) / above
}

#[test]
fn a_sun_draws_the_lobe() {
    let scene = painted("plane", 0.5, 0.0);
    for lobe in [Lobe::Phong, Lobe::Ggx] {
        for (roughness, cosine) in [(0.4f32, 0.8f32), (0.6, 0.3), (1.0, 0.5)] {
            for angle in [0.1f32, 0.6, 1.1] {
                let direction = Vec3::new(-angle.sin(), angle.cos(), 0.0);
                let mut environment = Environment::constant([0.0; 3]);
                environment.lamps.push(Lamp { direction, half_angle: 0.0, irradiance: [3.0; 3] });
                let gloss = rough(Mirroring::Lobe(lobe), roughness);
                let seen = see(&scene, gloss, &Light::new(&environment), cosine, 2).mean[0];
                let axis = [-f64::from((1.0 - cosine * cosine).sqrt()), f64::from(cosine), 0.0];
                let share = f64::from(directional_albedo(Vec3::splat(0.04), roughness, cosine).x);
                // Light and view are apart by their heights' difference; the half vector halves it.
                let apart = f64::from(angle) + f64::from(cosine).acos();
                let left = 0.96 * (1.0 - (1.0 - (0.5 * apart).cos()).powi(5));
                let value = |lobe| {
                    let lobe = mirrored(lobe, roughness, axis, direction.as_dvec3().to_array());
                    3.0 * (share * lobe + 0.5 * left * f64::from(angle).cos() / PI)
                };
                testkit::assert_close!(seen, value(lobe), 1e-5, 1e-3, "{lobe:?} {roughness} {cosine} {angle}");
                let other = if lobe == Lobe::Ggx { Lobe::Phong } else { Lobe::Ggx };
                let tells = (value(other) - value(lobe)).abs() > 3e-3 * value(lobe);
                assert!(!tells || !testkit::close(f64::from(seen), value(other), 1e-5, 1e-3), "can fail: {lobe:?}");
            }
        }
    }
}

/// A matte scene has the same bits whatever shines elsewhere; one that shines has others.
#[test]
fn matte_scenes_keep_their_bits() {
    let trace = |scene: &Scene, gloss: Option<Gloss>| {
        let world = gloss.into_iter().fold(World::new(scene), World::with_gloss);
        radiance_seen(&world, &white_sky(), &[gaze(0.6)], &Settings { samples: 64, seed: 1, max_bounces: None })
    };
    let mut scene = painted("plane", 0.5, 0.0);
    scene.materials.iter_mut().for_each(|material| material.roughness = 0.9);
    for mirroring in MODELS {
        let gloss = rough(mirroring, 0.2);
        assert_eq!(trace(&scene, Some(gloss)), trace(&scene, None), "the material itself is matte");
    }
    let shiny = painted("plane", 0.5, 0.0);
    assert_ne!(trace(&shiny, Some(Gloss::new(MODELS[1]))), trace(&shiny, None), "can fail");
}

/// Red radiance straight down on the bumpy floor, beside the ball and its shadow, under one sun.
fn bumpy_floor(base: f32, metallic: f32, [diffuse, mirror]: [bool; 2]) -> Vec<f32> {
    let mut environment = Environment::constant([0.0; 3]);
    let direction = Vec3::new(0.3, 0.8, 0.5).normalize();
    environment.lamps.push(Lamp { direction, half_angle: 0.0, irradiance: [3.0; 3] });
    let scene = painted("bumps", base, metallic);
    let eye = |k: usize| Vec3::new(1.3 + 0.025 * k as f32, 3.0, 1.5);
    let gazes: Vec<Gaze> = (0..40).map(|k| Gaze { eye: eye(k), direction: Vec3::NEG_Y }).collect();
    let gloss = Gloss { bent: mirror, ..rough(Mirroring::Lobe(Lobe::Ggx), 0.3) };
    let world = World::with_normal_maps(&scene, diffuse).with_gloss(gloss);
    let settings = Settings { samples: 4, seed: 1, max_bounces: Some(0) };
    radiance_seen(&world, &Light::new(&environment), &gazes, &settings).iter().map(|e| e.mean[0]).collect()
}

/// Normal maps bend what mirrors, diffuse light, or both.
#[test]
fn normal_maps_bend_what_they_are_asked_to() {
    let spread = |values: &[f32]| {
        let ends = values.iter().fold([f32::MAX, f32::MIN], |[low, high], v| [low.min(*v), high.max(*v)]);
        (ends[1] - ends[0]) / ends[1]
    };
    assert!(spread(&bumpy_floor(1.0, 1.0, [false, true])) > 0.5, "the bumps show in a metal");
    assert!(spread(&bumpy_floor(1.0, 1.0, [true, false])) < 1e-3, "the same metal without its map is smooth");
    // A black dielectric mirrors what a white one does: the rest is diffuse.
    let diffuse = |bent| -> Vec<f32> {
        bumpy_floor(1.0, 0.0, bent).iter().zip(bumpy_floor(0.0, 0.0, bent)).map(|(a, b)| a - b).collect()
    };
    assert!(spread(&diffuse([false, true])) < 1e-3, "diffuse light keeps the plain normal");
    assert!(spread(&diffuse([true, true])) > 0.1, "both are bent");
}
