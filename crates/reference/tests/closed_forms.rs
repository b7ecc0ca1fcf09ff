//! Direct light against form factors, lamps against their irradiance, pictures against sums over their pixels.

mod ground;

use glam::{DVec3, Vec3};
use ground::ground;
use probe_io::{Environment, Lamp};
use reference::{Estimate, Light, Receiver, Settings, World, radiance_at};
use scene::{Scene, builtin, known};
use std::f64::consts::{PI, TAU};
use testkit::ttest;

/// One chance in a hundred that a right result is refused; seeds are fixed, so it never flickers.
const ALPHA: f64 = 0.01;

fn direct(scene: &Scene, light: &Light, receivers: &[Receiver], samples: u32) -> Vec<Estimate> {
    radiance_at(&World::new(scene), light, receivers, &Settings { samples, seed: 9, max_bounces: Some(0) })
}

fn check(estimate: &Estimate, expected: [f64; 3], n_tests: usize) -> Result<(), String> {
    for (c, expected) in expected.into_iter().enumerate() {
        let (mean, error) = (f64::from(estimate.mean[c]), f64::from(estimate.std_error[c]));
        ttest::z_test(mean, error, expected, ALPHA, 3 * n_tests).map_err(|e| format!("channel {c}: {e}"))?;
    }
    Ok(())
}

fn open_plane() -> Scene {
    builtin("plane").expect("a built-in scene")
}

/// Share of the sky that each ground point of a scene sees, against its closed form.
fn check_shares(name: &str, points: &[(f32, f32)], share: impl Fn(f64, f64) -> f64) -> Result<(), String> {
    let scene = builtin(name).expect("a built-in scene");
    let receivers: Vec<_> = points.iter().map(|&(x, z)| ground(x, z, 0.5)).collect();
    let light = Light::new(&Environment::constant([1.0, 2.0, 0.5]));
    for (estimate, &(x, z)) in direct(&scene, &light, &receivers, 40_000).iter().zip(points) {
        let seen = 0.5 * share(f64::from(x), f64::from(z));
        check(estimate, [seen, 2.0 * seen, 0.5 * seen], points.len()).map_err(|e| format!("{name} {x} {z}: {e}"))?;
    }
    Ok(())
}

const GROUND: [(f32, f32); 5] = [(0.05, 0.0), (0.3, 1.0), (1.0, -0.7), (2.0, 0.0), (3.9, 1.9)];
const BETWEEN: [(f32, f32); 4] = [(0.0, 0.0), (0.5, -0.3), (0.9, 0.9), (-0.2, 0.6)];

#[test]
fn hidden_sky_equals_form_factors() {
    check_shares("half-blocked-plane", &GROUND, known::half_blocked_plane_share).expect("the wall");
    check_shares("facing-planes", &BETWEEN, known::facing_planes_share).expect("the upper plane");
}

#[test]
fn other_form_factors_can_fail() {
    let nearer = |x, z| known::half_blocked_plane_share(x + 0.5, z);
    assert!(check_shares("half-blocked-plane", &GROUND, nearer).is_err(), "half a metre off");
    assert!(check_shares("facing-planes", &BETWEEN, |_, _| 0.5).is_err(), "the same everywhere");
}

/// An otherwise black sky with one lamp at the polar angle `theta` (from +y towards +x), radians.
fn lamp_at(theta: f32, half_angle: f32) -> Light {
    let mut environment = Environment::constant([0.0; 3]);
    let direction = Vec3::new(theta.sin(), theta.cos(), 0.0);
    environment.lamps.push(Lamp { direction, half_angle, irradiance: [3.0, 2.0, 1.0] });
    Light::new(&environment)
}

/// Irradiance of a lamp with the facing irradiance 1 on a horizontal plane, by quadrature over the disc.
fn disc_irradiance(theta: f64, half_angle: f64) -> f64 {
    let mut sum = 0.0;
    for (d, weight) in testkit::quadrature::band_quadrature(half_angle.cos(), 1.0, 200) {
        let height = d[2] * theta.cos() - d[0] * theta.sin();
        sum += weight * height.max(0.0);
    }
    sum / (PI * half_angle.sin().powi(2))
}

#[test]
fn lamps_give_their_irradiance() {
    let at = |light: &Light| direct(&open_plane(), light, &[ground(0.0, 0.0, 0.5)], 20_000)[0];
    let expected = |irradiance: f64| [3.0, 2.0, 1.0].map(|e| 0.5 / PI * e * irradiance);
    for (theta, half_angle) in [(0.3, 0.0), (1.2, 0.0), (0.0, 0.1), (1.0, 0.004_65), (0.7, 0.5), (0.4, 1.1)] {
        let estimate = at(&lamp_at(theta, half_angle));
        check(&estimate, expected(libm::cos(f64::from(theta))), 7).expect("a whole disc counts with its axis");
    }
    let sunk = at(&lamp_at(1.4, 0.5));
    check(&sunk, expected(disc_irradiance(f64::from(1.4_f32), 0.5)), 7).expect("the disc is cut by the horizon");
    assert_eq!(at(&lamp_at(3.0, 0.0)).mean, [0.0; 3], "a lamp below the horizon");
}

#[test]
fn wrong_lamps_can_fail() {
    let estimate = direct(&open_plane(), &lamp_at(0.7, 0.5), &[ground(0.0, 0.0, 0.5)], 20_000)[0];
    let by_angle = [3.0, 2.0, 1.0].map(|e| 0.5 / PI * e * 0.75);
    assert!(check(&estimate, by_angle, 7).is_err(), "cos 0.7 is 0.765");
    assert!(check(&estimate, [3.0, 2.0, 1.0].map(|e| 0.5 * e * libm::cos(0.7)), 7).is_err(), "without 1/pi");
}

#[test]
fn walls_hide_lamps() {
    let scene = builtin("half-blocked-plane").expect("a built-in scene");
    let receivers = [ground(1.0, 0.0, 0.5)];
    let west = direct(&scene, &lamp_at(-1.0, 0.01), &receivers, 100);
    assert_eq!(west[0].mean, [0.0; 3], "the wall stands in the west");
    let east = direct(&scene, &lamp_at(1.0, 0.01), &receivers, 100);
    check(&east[0], [3.0, 2.0, 1.0].map(|e| 0.5 / PI * e * libm::cos(1.0)), 1).expect("the east is free");
}

const ROWS: usize = 16;

/// A picture of 32 x 16 pixels with a bright spot and, if asked for, negative places.
fn picture(lowest: f32) -> Vec<[f32; 3]> {
    let mut rng = sampling::rng::Rng::new(31, 0);
    let mut pixels: Vec<[f32; 3]> =
        (0..2 * ROWS * ROWS).map(|_| std::array::from_fn(|_| lowest + (1.0 - lowest) * rng.next_f32())).collect();
    pixels[5 * 2 * ROWS + 13] = [40.0, 30.0, 20.0];
    pixels
}

/// The integral of radiance times clamped cosine over pi, by 16 x 16 points in each pixel, which is constant.
fn pixel_sum(pixels: &[[f32; 3]], normal: DVec3) -> [f64; 3] {
    const N: usize = 16;
    let (rows, columns) = (ROWS * N, 2 * ROWS * N);
    let mut sum = [0.0; 3];
    for y in 0..rows {
        let (theta, step) = (PI * (y as f64 + 0.5) / rows as f64, PI / rows as f64);
        let area = (libm::cos(theta - 0.5 * step) - libm::cos(theta + 0.5 * step)) * TAU / columns as f64;
        for x in 0..columns {
            let (sin, cos) = libm::sincos(TAU * ((x as f64 + 0.5) / columns as f64 - 0.5));
            let direction = DVec3::new(-sin * libm::sin(theta), libm::cos(theta), cos * libm::sin(theta));
            let weight = normal.dot(direction).max(0.0) * area / PI;
            let pixel = pixels[(y / N) * 2 * ROWS + x / N];
            (0..3).for_each(|c| sum[c] += weight * f64::from(pixel[c]));
        }
    }
    sum
}

fn tilted(normal: Vec3) -> Receiver {
    Receiver { normal, geometric_normal: Vec3::Y, ..ground(0.0, 0.0, 1.0) }
}

/// Two receivers on a plane far away that blocks nothing above it, under a picture.
fn check_picture(pixels: &[[f32; 3]], assumed: &[[f32; 3]]) -> Result<(), String> {
    let light = Light::from_equirect(2 * ROWS, pixels.to_vec()).expect("a full picture");
    let normals = [Vec3::Y, Vec3::new(0.3, 0.9, -0.2).normalize()];
    let mut scene = open_plane();
    scene.meshes[0].positions.iter_mut().for_each(|p| p.y -= 1e6);
    for (estimate, normal) in direct(&scene, &light, &normals.map(tilted), 100_000).iter().zip(normals) {
        check(estimate, pixel_sum(assumed, normal.as_dvec3()), 4).map_err(|e| format!("{normal}: {e}"))?;
    }
    Ok(())
}

#[test]
fn pictures_equal_the_sum_over_their_pixels() {
    check_picture(&picture(0.0), &picture(0.0)).expect("a positive picture");
    check_picture(&picture(-0.8), &picture(-0.8)).expect("a picture with negative pixels");
}

#[test]
fn other_pictures_can_fail() {
    let mirrored: Vec<_> = picture(0.0).chunks(2 * ROWS).flat_map(|row| row.iter().rev().copied()).collect();
    assert!(check_picture(&picture(0.0), &mirrored).is_err(), "left and right matter");
    let clamped: Vec<_> = picture(-0.8).iter().map(|p| p.map(|v| v.max(0.0))).collect();
    assert!(check_picture(&picture(-0.8), &clamped).is_err(), "negative light counts");
}

#[test]
fn unusable_pictures_can_fail() {
    assert!(Light::from_equirect(4, vec![[1.0; 3]; 7]).is_none(), "half a row");
    assert!(Light::from_equirect(0, Vec::new()).is_none(), "nothing");
    assert!(Light::from_equirect(2, vec![[f32::NAN; 3]; 2]).is_none(), "not a number");
}
