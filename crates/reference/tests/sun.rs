//! A sun of a hundred thousand times the sky in one pixel costs no fireflies.

mod ground;

use glam::Vec3Swizzles;
use probe_io::{Environment, Layout, Probe};
use reference::{Light, Settings, World, radiance_at};
use sampling::rng::Rng;
use sampling::warp::{square_to_uniform_hemisphere, uniform_hemisphere_pdf};
use scene::builtin;
use std::f64::consts::PI;

const REPLICATES: u64 = 200;
const SAMPLES: u32 = 256;
const ROWS: usize = 32;
const SUN: f32 = 1e5;

fn sunny(layout: Layout) -> Environment {
    let (width, height) = match layout {
        Layout::Equirect => (2 * ROWS, ROWS),
        Layout::Faces => (ROWS / 2, 3 * ROWS),
        _ => (ROWS, ROWS),
    };
    let mut probe = Probe { layout, width, height, pixels: vec![[1.0; 3]; width * height] };
    let up = probe.texel_index(glam::Vec3::new(0.3, 0.8, 0.5).normalize());
    probe.pixels[up] = [SUN; 3];
    Environment { name: "sunny".into(), image: probe, lamps: Vec::new() }
}

/// Exact irradiance over pi on the ground from sums over small parts of the pixels.
fn truth(environment: &Environment) -> f64 {
    const N: usize = 1024;
    let mut sum = 0.0;
    for y in 0..N / 2 {
        let theta = PI * (y as f64 + 0.5) / N as f64;
        let weight = theta.cos() * theta.sin() / N as f64 * PI / N as f64;
        for x in 0..2 * N {
            let (sin, cos) = libm::sincos(PI * (x as f64 + 0.5) / N as f64);
            let d = glam::DVec3::new(sin * theta.sin(), theta.cos(), cos * theta.sin());
            sum += weight * f64::from(environment.image.texel_radiance(d.as_vec3())[0]);
        }
    }
    sum
}

/// Root mean square error of `SAMPLES` paths, relative to the truth.
fn importance_error(environment: &Environment, truth: f64) -> f64 {
    let scene = builtin("plane").expect("a built-in scene");
    let receivers = vec![ground::ground(0.0, 0.0, 1.0); REPLICATES as usize];
    let settings = Settings { samples: SAMPLES, seed: 1, max_bounces: None };
    let estimates = radiance_at(&World::new(&scene), &Light::new(environment), &receivers, &settings);
    relative_error(estimates.iter().map(|e| f64::from(e.mean[0])), truth)
}

/// The same with directions uniform over the hemisphere.
fn uniform_error(environment: &Environment, truth: f64) -> f64 {
    let mean = |seed| {
        let mut rng = Rng::new(seed, 77);
        let mut value = || {
            let d = square_to_uniform_hemisphere(rng.next_square());
            f64::from(environment.image.texel_radiance(d.xzy())[0] * d.z / uniform_hemisphere_pdf(d)) / PI
        };
        (0..SAMPLES).map(|_| value()).sum::<f64>() / f64::from(SAMPLES)
    };
    relative_error((0..REPLICATES).map(mean), truth)
}

fn relative_error(values: impl Iterator<Item = f64>, truth: f64) -> f64 {
    (values.map(|v| (v / truth - 1.0).powi(2)).sum::<f64>() / REPLICATES as f64).sqrt()
}

#[test]
fn importance_sampling_tames_the_sun() {
    // A pixel of a panorama is a cell of the table: only the share of the sky is spread. In other layouts the sun
    // shares its cells with the sky, so that as few as a quarter of the paths may find it: sqrt(3 / 256).
    for (layout, bound) in [(Layout::Equirect, 0.02), (Layout::Angular, 0.11), (Layout::Faces, 0.11)] {
        let environment = sunny(layout);
        let truth = truth(&environment);
        let (importance, uniform) = (importance_error(&environment, truth), uniform_error(&environment, truth));
        assert!(importance < 0.1 * uniform, "{layout:?}: {importance:.4} against {uniform:.4}");
        assert!(importance < bound, "{layout:?}: {importance:.4} of the truth");
    }
}

#[test]
fn uniform_sampling_can_fail() {
    let environment = sunny(Layout::Equirect);
    let error = uniform_error(&environment, truth(&environment));
    assert!(error > 0.5, "a uniform sampler must suffer from this sun: {error:.4}");
}
