//! What the tests of the baker share: grey scenes, quiet bakes, radiance under a white sky.
#![allow(dead_code, unused_imports, reason = "each test file uses a part")]

pub(crate) mod grounds;
mod rectangle;
pub(crate) mod volume;

pub(crate) use rectangle::rectangle;

use bake::settings;
use coeff_io::{Bounces, Prt, Quality, Refine, Sampler, Settings};
use glam::Vec4;
use scene::Scene;
use std::ops::ControlFlow;

/// A builtin scene with every surface grey, of albedo `a`.
pub(crate) fn grey(name: &str, a: f32) -> Scene {
    let mut scene = scene::builtin(name).unwrap_or_else(|| panic!("builtin:{name} exists"));
    for material in &mut scene.materials {
        material.base_color = Vec4::new(a, a, a, 1.0);
        material.base_color_texture = None;
        material.metallic_roughness_texture = None;
        material.metallic = 0.0;
    }
    scene.meshes.iter_mut().for_each(|m| m.colors.clear());
    scene
}

/// A fixed number of rays and bounces.
pub(crate) fn fixed(bands: u32, sampler: Sampler, rays: u32, bounces: u32) -> Settings {
    Settings {
        bands,
        sampler,
        quality: Quality::Rays(rays),
        bounces: Bounces::Fixed(bounces),
        refine: Refine::Off,
        ..settings::standard()
    }
}

/// Bakes without showing progress.
pub(crate) fn quiet(scene: &Scene, settings: &Settings) -> Prt {
    bake::bake(scene, settings, &|_| ControlFlow::Continue(())).expect("the scene bakes")
}

/// Radiance of every receiver under a sky of radiance 1: only the constant coefficient of the light is not zero.
pub(crate) fn under_white(prt: &Prt) -> Vec<f64> {
    let t = &prt.transfer;
    let row = (t.bands * t.bands * t.channels) as usize;
    let light = (4.0 * std::f64::consts::PI).sqrt();
    let rows = t.values.chunks_exact(row);
    rows.zip(&t.albedo).map(|(r, a)| f64::from(a[0]) * f64::from(r[0]) * light).collect()
}

/// Largest difference from one expected value, with the receiver where it stands.
pub(crate) fn worst(values: &[f64], expected: f64) -> (f64, usize) {
    let differences = values.iter().map(|v| (v - expected).abs());
    differences.enumerate().map(|(i, d)| (d, i)).fold((0.0, 0), |a, b| if b.0 > a.0 { b } else { a })
}

/// Radiance as it is drawn at a point of the plane z = 0: between the corners of its triangle.
pub(crate) fn drawn(prt: &Prt, radiance: &[f64], x: f64, y: f64) -> f64 {
    let corner = |v: u32| prt.geometry.positions[v as usize].map(f64::from);
    let on = |t: &[u32; 3]| {
        let [a, b, c] = t.map(corner);
        let area = |p: [f64; 3], q: [f64; 3]| (p[0] - x) * (q[1] - y) - (p[1] - y) * (q[0] - x);
        let parts = [area(b, c), area(c, a), area(a, b)];
        let (whole, flat) = (parts.iter().sum::<f64>(), [a, b, c].iter().all(|p| p[2] == 0.0));
        let within = flat && whole > 1e-12 && parts.iter().all(|part| part / whole > -1e-9);
        within.then(|| (0..3).map(|k| parts[k] / whole * radiance[t[k] as usize]).sum::<f64>())
    };
    prt.geometry.triangles.iter().find_map(on).expect("a point of the wall")
}
