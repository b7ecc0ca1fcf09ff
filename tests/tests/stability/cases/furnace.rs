//! A white sky over white surfaces: light that is neither lost nor made.

use super::Case;
use super::baking::{fixed, grey, quiet, radiance, white};
use super::case::worst;
use super::published::{bounced, merged};
use coeff_io::Prt;
use glam::DVec3;
use scene::Scene;
use std::f64::consts::PI;
use testkit::quadrature::sphere_quadrature;

pub(crate) fn hundred_bounces() -> Case {
    Case {
        title: "white furnace: albedo 1, 100 bounces, bowl and Cornell box",
        bound: "radiance - 1: what 100 bounces leave inside and 100 sums in f32 lose",
        limit: 1e-3,
        ours: || worst(["bowl", "cornell-box"].map(|name| from_one(&quiet(&grey(name, 1.0), &fixed(3, 64, 100))))),
        naive_method: "the listings' transfer without 1/π, same number of bounces",
        naive: || worst(["bowl", "cornell-box"].map(|name| without_pi(&grey(name, 1.0)))),
    }
}

pub(crate) fn clamped_cosine() -> Case {
    Case {
        title: "white sky over a sphere of albedo 1",
        bound: "radiance - 1: closed form, rounded to f32",
        limit: 1e-6,
        ours: || from_one(&quiet(&grey("sphere", 1.0), &fixed(5, 16, 0))),
        naive_method: "the listings' cosine without max(0, ·)",
        naive: || unclamped(&grey("sphere", 1.0)),
    }
}

/// Largest difference from 1 under a sky of 1.
fn from_one(prt: &Prt) -> f64 {
    worst(radiance(prt, &white(prt.transfer.bands)).into_iter().map(|value| (value - 1.0).abs()))
}

/// The listings multiply each arriving ray by the albedo and the cosine alone, so π stays in every bounce.
fn without_pi(scene: &Scene) -> f64 {
    let mesh = merged(&scene.meshes);
    worst(bounced(&mesh, &vec![PI; mesh.positions.len()], 100).into_iter().map(|value| (value - 1.0).abs()))
}

/// The mean of a cosine over all directions, which for a convex body is negative where it should count as nothing.
fn unclamped(scene: &Scene) -> f64 {
    let sky = sphere_quadrature(8);
    let mean =
        |normal: DVec3| sky.iter().map(|&(d, weight)| weight * DVec3::from_array(d).dot(normal) / PI).sum::<f64>();
    worst(scene.meshes[0].normals.iter().map(|normal| (mean(normal.as_dvec3()) - 1.0).abs()))
}
