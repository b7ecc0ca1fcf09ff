//! Suns in few bands: reconstructions that ring below zero.

use super::Case;
use super::case::{worse, worst};
use glam::DVec3;
use sampling::rng::Rng;
use sh_math::{Bands, Rgb, project, window};
use std::f64::consts::{PI, TAU};
use testkit::quadrature::sphere_quadrature;

pub(crate) fn bare_sun() -> Case {
    Case {
        title: "one sun in the dark, 2 to 10 bands",
        bound: "depth below zero over the peak: the window's kernel is a square, so only rounding to f32 is left",
        limit: 1e-6,
        ours: || worst((2..=10).map(|n| depth(&one_sun(n), &window::non_negative(bands(n))))),
        naive_method: "Hann window, w = n",
        naive: || worst((2..=10).map(|n| depth(&one_sun(n), &hann(n)))),
    }
}

pub(crate) fn energy_of_a_sun() -> Case {
    Case {
        title: "energy of the sun under the window, 2 to 10 bands",
        bound: "relative error of the integral over the sphere: the window leaves the mean as it is; 1 % is asked for",
        limit: 0.01,
        ours: || worst((2..=10).map(|n| energy_error(&one_sun(n).windowed(&window::non_negative(bands(n))), |v| v))),
        naive_method: "negative values set to 0",
        naive: || worst((2..=10).map(|n| energy_error(&one_sun(n), |v| v.max(0.0)))),
    }
}

pub(crate) fn many_suns() -> Case {
    Case {
        title: "30 skies of 6 suns within 1 : 160,000, 5 bands",
        bound: "depth below zero over the peak, as for one sun",
        limit: 1e-6,
        ours: || worst(skies().iter().map(|sky| depth(sky, &window::non_negative(bands(5))))),
        naive_method: "no window",
        naive: || worst(skies().iter().map(|sky| depth(sky, &[1.0; 5]))),
    }
}

fn bands(count: u32) -> Bands {
    Bands::new(count).expect("in range")
}

const SUN: DVec3 = DVec3::new(2.0 / 7.0, -3.0 / 7.0, 6.0 / 7.0);

/// A sun of irradiance π.
fn one_sun(n: u32) -> Rgb {
    project(bands(n), [(SUN, [PI; 3])])
}

fn skies() -> Vec<Rgb> {
    let mut rng = Rng::new(17, 0);
    let mut sun = || {
        let direction = DVec3::new(rng.next_f64() - 0.5, rng.next_f64() - 0.5, rng.next_f64() - 0.5).normalize();
        (direction, [libm::exp(12.0 * rng.next_f64()); 3])
    };
    (0..30).map(|_| project(bands(5), std::iter::repeat_with(&mut sun).take(6))).collect()
}

/// `(1 + cos(π l / n)) / 2`.
fn hann(n: u32) -> Vec<f64> {
    (0..n).map(|l| 0.5 + 0.5 * libm::cos(PI * f64::from(l) / f64::from(n))).collect()
}

/// How far the windowed reconstruction falls below zero, over its peak: on a grid of directions around the one sun of
/// most of the light, finer than any wave of ten bands.
fn depth(light: &Rgb, window: &[f64]) -> f64 {
    let windowed = light.windowed(window);
    let (mut depth, mut highest) = (0.0f64, 0.0f64);
    let (u, v) = SUN.any_orthonormal_pair();
    for i in 0..=400 {
        let (sin, cos) = libm::sincos(PI * f64::from(i) / 400.0);
        for j in 0..60 {
            let (s, c) = libm::sincos(TAU * f64::from(j) / 60.0);
            let direction = SUN * cos + (u * c + v * s) * sin;
            let value = f64::from(windowed.reconstruct(direction.as_vec3())[0]);
            (depth, highest) = (worse(depth, -value), highest.max(value));
        }
    }
    depth / highest
}

/// Relative error of the energy that a reconstruction holds after `change`.
fn energy_error(light: &Rgb, change: fn(f64) -> f64) -> f64 {
    let value = |d: [f64; 3]| change(f64::from(light.reconstruct(DVec3::from_array(d).as_vec3())[0]));
    let energy: f64 = sphere_quadrature(64).into_iter().map(|(d, weight)| weight * value(d)).sum();
    (energy / PI - 1.0).abs()
}
