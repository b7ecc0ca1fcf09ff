//! A white sky over white surfaces: light that is neither lost nor made.

use super::Case;
use super::baking::{fixed, grey, quiet, radiance, white};
use super::case::worst;
use coeff_io::Prt;
use glam::DVec3;
use std::f64::consts::PI;
use testkit::quadrature::sphere_quadrature;

pub(crate) fn hundred_bounces() -> Case {
    Case {
        title: "white furnace: albedo 1, 100 bounces, bowl and Cornell box",
        bound: "radiance - 1: what 100 bounces leave inside and 100 sums in f32 lose",
        limit: 1e-3,
        ours: || worst(["bowl", "cornell-box"].map(|name| from_one(&quiet(&grey(name, 1.0), &fixed(3, 64, 100))))),
        naive_method: "the listings' transfer without 1/π, same number of bounces",
        naive: without_pi,
    }
}

pub(crate) fn clamped_cosine() -> Case {
    Case {
        title: "white sky over a sphere of albedo 1",
        bound: "radiance - 1: closed form, rounded to f32",
        limit: 1e-6,
        ours: || from_one(&quiet(&grey("sphere", 1.0), &fixed(5, 16, 0))),
        naive_method: "the listings' cosine without max(0, ·)",
        naive: unclamped,
    }
}

/// Largest difference from 1 under a sky of 1.
fn from_one(prt: &Prt) -> f64 {
    worst(radiance(prt, &white(prt.transfer.bands)).into_iter().map(|value| (value - 1.0).abs()))
}

/// Every point of the bowl sees half the sky and half the bowl: a geometric series, with π in every term.
fn without_pi() -> f64 {
    let prt = quiet(&grey("bowl", 1.0), &fixed(1, 64, 0));
    let direct = PI * radiance(&prt, &white(1))[0];
    let reflected = PI * 0.5;
    let series = (0..=100).fold((0.0, direct), |(sum, term), _| (sum + term, term * reflected));
    (series.0 - 1.0).abs()
}

/// The mean of a cosine that is negative over half the sphere is nothing.
fn unclamped() -> f64 {
    let sum: f64 = sphere_quadrature(8).into_iter().map(|(d, weight)| weight * DVec3::from_array(d).z / PI).sum();
    (sum - 1.0).abs()
}
