//! Suns of a hundred thousand and a million times the sky: fireflies, and formats that clip.

use super::Case;
use super::case::worst;
use glam::{Vec3, Vec3Swizzles};
use probe_io::{Environment, Layout, LoadOptions, Probe, write_exr, write_hdr};
use reference::{Light, Receiver, Settings, World, radiance_at};
use sampling::rng::Rng;
use sampling::sequence::{Sequence, fill};
use sampling::warp::{square_to_uniform_hemisphere, square_to_uniform_sphere};
use sh_math::{Bands, project};
use std::f64::consts::PI;

const FIREFLIES: &str =
    "error of 256 directions over that of uniform ones: a tenth is asked for; importance leaves the sky's share";

pub(crate) fn sun_of_1e5() -> Case {
    Case {
        title: "sun of 1e5 in one pixel of a panorama",
        bound: FIREFLIES,
        limit: 0.1,
        ours: || by_importance(1e5) / uniform(1e5),
        naive_method: "the paper's jittered sphere",
        naive: || jittered(1e5) / uniform(1e5),
    }
}

pub(crate) fn sun_of_1e6() -> Case {
    Case {
        title: "sun of 1e6 in one pixel of a panorama",
        bound: FIREFLIES,
        limit: 0.1,
        ours: || by_importance(1e6) / uniform(1e6),
        naive_method: "the paper's jittered sphere",
        naive: || jittered(1e6) / uniform(1e6),
    }
}

pub(crate) fn files_keep_suns() -> Case {
    Case {
        title: "suns of 1e5 and 1e6 through .hdr and .exr into coefficients",
        bound: "relative error of the mean coefficient: half a step of the 8-bit mantissa of .hdr, 2⁻⁸",
        limit: 1.0 / 256.0,
        ours: || worst([1e5, 1e6].map(|sun| file_error(sun, |v| v))),
        naive_method: "radiance in half floats, 65,504 at most",
        naive: || worst([1e5, 1e6].map(|sun| file_error(sun, |v| v.min(65_504.0)))),
    }
}

const ROWS: usize = 32;
const REPLICATES: u64 = 200;
const SAMPLES: u32 = 256;

/// A sky of 1 with one pixel of `sun`.
fn sunny(sun: f32) -> Probe {
    let (width, height) = (2 * ROWS, ROWS);
    let mut probe = Probe { layout: Layout::Equirect, width, height, pixels: vec![[1.0; 3]; width * height] };
    let place = probe.texel_index(Vec3::new(0.3, 0.8, 0.5).normalize());
    probe.pixels[place] = [sun; 3];
    probe
}

/// Irradiance over π on the ground, from sums over small parts of the pixels.
fn truth(probe: &Probe) -> f64 {
    const N: usize = 512;
    let mut sum = 0.0;
    for y in 0..N / 2 {
        let (sin_theta, cos_theta) = libm::sincos(PI * (y as f64 + 0.5) / N as f64);
        for x in 0..2 * N {
            let (sin, cos) = libm::sincos(PI * (x as f64 + 0.5) / N as f64);
            let d = glam::DVec3::new(sin * sin_theta, cos_theta, cos * sin_theta).as_vec3();
            sum += f64::from(probe.texel_radiance(d)[0]) * cos_theta * sin_theta;
        }
    }
    sum * PI / (N * N) as f64
}

/// Root mean square error of some estimates relative to the truth.
fn relative_error(values: impl ExactSizeIterator<Item = f64>, truth: f64) -> f64 {
    let n = values.len() as f64;
    (values.map(|value| (value / truth - 1.0).powi(2)).sum::<f64>() / n).sqrt()
}

/// The path tracer's error on open ground.
fn by_importance(sun: f32) -> f64 {
    let environment = Environment::from_image("sunny", sunny(sun));
    let ground = Receiver { position: Vec3::ZERO, normal: Vec3::Y, geometric_normal: Vec3::Y, albedo: Vec3::ONE };
    let scene = scene::builtin("plane").expect("builtin");
    let settings = Settings { samples: SAMPLES, seed: 1, max_bounces: Some(0) };
    let receivers = vec![ground; REPLICATES as usize];
    let found = radiance_at(&World::new(&scene), &Light::new(&environment), &receivers, &settings);
    relative_error(found.iter().map(|e| f64::from(e.mean[0])), truth(&environment.image))
}

/// The error of random directions, uniform over the hemisphere.
fn uniform(sun: f32) -> f64 {
    let probe = sunny(sun);
    let mean = |replicate: u64| {
        let mut rng = Rng::new(77, replicate);
        let directions = (0..SAMPLES).map(|_| square_to_uniform_hemisphere(rng.next_square()));
        let sum: f64 = directions.map(|d| f64::from(probe.texel_radiance(d.xzy())[0] * d.z)).sum();
        2.0 * sum / f64::from(SAMPLES)
    };
    relative_error((0..REPLICATES as u32).map(|r| mean(u64::from(r))), truth(&probe))
}

/// The error of the paper's directions, one in each cell of a grid over the sphere; half of them are below the ground.
fn jittered(sun: f32) -> f64 {
    let probe = sunny(sun);
    let mean = |replicate: u64| {
        let mut points = Vec::new();
        fill(Sequence::Stratified, SAMPLES, replicate, &mut points);
        let directions = points.into_iter().map(square_to_uniform_sphere);
        let sum: f64 = directions.map(|d| f64::from(probe.texel_radiance(d.xzy())[0] * d.z.max(0.0))).sum();
        4.0 * sum / f64::from(SAMPLES)
    };
    relative_error((0..REPLICATES as u32).map(|r| mean(u64::from(r))), truth(&probe))
}

/// Error of the mean coefficient of a sunny sky that went through both kinds of files and through `store`.
fn file_error(sun: f32, store: fn(f32) -> f32) -> f64 {
    let probe = sunny(sun);
    let folder = tempfile::tempdir().expect("a temporary folder");
    let [hdr, exr] = ["sunny.hdr", "sunny.exr"].map(|name| folder.path().join(name));
    write_hdr(&hdr, probe.width, probe.height, &probe.pixels).expect("a written file");
    write_exr(&exr, probe.width, probe.height, &probe.pixels).expect("a written file");
    let flux: f64 = probe.texels().map(|t| f64::from(t.radiance[0]) * t.solid_angle).sum();
    let expected = flux / (4.0 * PI).sqrt();
    let error = |path| {
        let (mut environment, _) = Environment::load(path, &LoadOptions::strict()).expect("a good probe");
        environment.image.pixels.iter_mut().for_each(|pixel| *pixel = pixel.map(store));
        let light = project(Bands::new(1).expect("in range"), environment.samples());
        (f64::from(light.values[0][0]) / expected - 1.0).abs()
    };
    worst([error(&hdr), error(&exr)])
}
