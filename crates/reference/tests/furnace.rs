//! Under a sky of radiance 1 the bounces of light are known in closed form.

mod scatter;

use glam::{Vec3, Vec4};
use probe_io::Environment;
use reference::{Estimate, Light, Settings, World, radiance_at};
use scene::{Scene, builtin, known};
use testkit::ttest;

/// One chance in a hundred that a right result of a test is refused; seeds are fixed, so it never flickers.
const ALPHA: f64 = 0.01;
/// Scenes whose surfaces no light leaves.
const CLOSED: [&str; 1] = ["closed-room"];

fn white_sky() -> Light {
    Light::new(&Environment::constant([1.0; 3]))
}

fn painted(name: &str, albedo: f32) -> Scene {
    let mut scene = builtin(name).expect("a built-in scene");
    for material in &mut scene.materials {
        material.base_color = Vec4::new(albedo, albedo, albedo, 1.0);
        material.base_color_texture = None;
        material.metallic = 0.0;
    }
    scene.meshes.iter_mut().for_each(|mesh| mesh.colors.clear());
    scene
}

fn trace(scene: &Scene, n: usize, samples: u32, max_bounces: Option<u32>) -> Vec<Estimate> {
    let settings = Settings { samples, seed: 5, max_bounces };
    radiance_at(&World::new(scene), &white_sky(), &scatter::receivers(scene, n, 3), &settings)
}

/// Tests each receiver, and their mean, which is more exact.
fn check(estimates: &[Estimate], expected: f64) -> Result<(), String> {
    let n = estimates.len() as f64;
    let (mut mean, mut variance) = (0.0, 0.0);
    for Estimate { mean: [value, ..], std_error: [error, ..] } in estimates {
        let (value, error) = (f64::from(*value), f64::from(*error));
        ttest::z_test(value, error, expected, ALPHA, estimates.len() + 1)?;
        mean += value / n;
        variance += error * error / (n * n);
    }
    ttest::z_test(mean, variance.sqrt(), expected, ALPHA, estimates.len() + 1).map(drop)
}

#[test]
fn white_surfaces_vanish_in_every_scene() {
    for (name, _) in scene::BUILTINS.iter().filter(|(name, _)| !CLOSED.contains(name)) {
        let estimates = trace(&painted(name, 1.0), 24, 1000, None);
        // Floors go on under blocks and columns, where no light comes in: exactly none.
        let (lit, sealed): (Vec<_>, Vec<_>) = estimates.into_iter().partition(|e| e.mean[0] != 0.0);
        // A quarter of all surfaces are those of the sealed one of two rooms.
        let most = if *name == "two-rooms" { 12 } else { 4 };
        assert!(sealed.len() <= most, "{name}: {} receivers in the dark", sealed.len());
        check(&lit, 1.0).unwrap_or_else(|e| panic!("{name}: {e}"));
    }
}

#[test]
fn grey_surfaces_can_fail() {
    let estimates = trace(&painted("cornell-box", 0.995), 24, 2000, None);
    assert!(check(&estimates, 1.0).is_err(), "half a percent is lost at each bounce");
}

#[test]
fn closed_room_is_black() {
    for estimate in trace(&painted("closed-room", 1.0), 24, 200, None) {
        assert_eq!(estimate.mean, [0.0; 3], "no light gets in");
    }
}

#[test]
fn convex_bodies_reflect_once() {
    for max_bounces in [Some(0), Some(3), None] {
        check(&trace(&painted("furnace-box", 0.5), 24, 2000, max_bounces), 0.5).expect("nothing else is seen");
    }
}

/// Mean radiance in the bowl; the facets of the mesh are worth at most `FACETS`.
fn bowl(max_bounces: Option<u32>) -> f64 {
    let scene = builtin("bowl").expect("a built-in scene");
    let estimates = trace(&scene, 96, 4000, max_bounces);
    estimates.iter().map(|e| f64::from(e.mean[0])).sum::<f64>() / 96.0
}

/// Relative: chords of 3.75 degrees lie 5e-4 inside the sphere; and three standard errors of 384,000 paths.
const FACETS: f64 = 3e-3;

#[test]
fn bowl_equals_its_series() {
    for bounces in [0, 1, 2, 5] {
        testkit::assert_close!(bowl(Some(bounces)), known::bowl_radiance(bounces), 0.0, FACETS, "{bounces} bounces");
    }
    testkit::assert_close!(bowl(None), known::bowl_radiance(60), 0.0, FACETS);
}

#[test]
fn bowl_with_other_bounces_can_fail() {
    assert!(!testkit::close(bowl(Some(4)), known::bowl_radiance(5), 0.0, FACETS), "the fifth bounce is 0.4 %");
    assert!(!testkit::close(bowl(Some(1)), known::bowl_radiance(2), 0.0, FACETS), "the second bounce is missing");
}

#[test]
fn backs_reflect_too() {
    // Of two sheets face to face the upper turns its back to the sky and its front to the lower: both sides count.
    let scene = painted("facing-planes", 1.0);
    let mut receiver = scatter::receivers(&scene, 2, 1)[1];
    receiver.geometric_normal = -receiver.geometric_normal;
    receiver.normal = -receiver.normal;
    let settings = Settings { samples: 500, seed: 1, max_bounces: None };
    let estimate = radiance_at(&World::new(&scene), &white_sky(), &[receiver], &settings);
    check(&estimate, 1.0).expect("the back is white");
    assert_eq!(receiver.normal, Vec3::Y, "it is the upper sheet");
}
