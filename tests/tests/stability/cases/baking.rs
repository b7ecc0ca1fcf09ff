//! Bakes of hard scenes, and the radiance of their receivers.

use bake::settings;
use coeff_io::{Bounces, Prt, Quality, Refine, Sampler, Settings};
use glam::{Quat, Vec3, Vec4};
use scene::Scene;
use sh_math::{Bands, Rgb};
use std::ops::ControlFlow;

/// A known scene with every surface grey, of albedo `albedo`.
pub(crate) fn grey(name: &str, albedo: f32) -> Scene {
    let mut scene = scene::builtin(name).unwrap_or_else(|| panic!("builtin:{name} exists"));
    for material in &mut scene.materials {
        material.base_color = Vec4::new(albedo, albedo, albedo, 1.0);
    }
    scene.meshes.iter_mut().for_each(|mesh| mesh.colors.clear());
    scene
}

/// A fixed number of rays and bounces, vertices as they are.
pub(crate) fn fixed(bands: u32, rays: u32, bounces: u32) -> Settings {
    Settings {
        bands,
        sampler: Sampler::OwenSobol,
        quality: Quality::Rays(rays),
        bounces: Bounces::Fixed(bounces),
        refine: Refine::Off,
        ..settings::standard()
    }
}

/// Bakes without a word.
pub(crate) fn quiet(scene: &Scene, settings: &Settings) -> Prt {
    bake::bake(scene, settings, &|_| ControlFlow::Continue(())).expect("the scene bakes")
}

/// A turn of no special kind: no wall stays in an axis plane.
pub(crate) fn askew() -> Quat {
    Quat::from_xyzw(0.2, 0.3, -0.5, 0.8).normalize()
}

/// Turns, scales and moves a scene.
pub(crate) fn placed(mut scene: Scene, turn: Quat, scale: f32, place: Vec3) -> Scene {
    for mesh in &mut scene.meshes {
        mesh.positions.iter_mut().for_each(|p| *p = place + scale * (turn * *p));
        mesh.normals.iter_mut().for_each(|n| *n = (turn * *n).normalize());
    }
    scene.cameras.clear();
    scene
}

/// Coefficients of a sky of radiance 1.
pub(crate) fn white(bands: u32) -> Rgb {
    let mut light = Rgb::black(Bands::new(bands).expect("in range"));
    light.values[0] = [(4.0 * std::f64::consts::PI).sqrt() as f32; 3];
    light
}

/// Radiance of the first channel of every receiver under a light of as many bands.
pub(crate) fn radiance(prt: &Prt, light: &Rgb) -> Vec<f64> {
    let transfer = &prt.transfer;
    let row = (transfer.bands * transfer.bands * transfer.channels) as usize;
    let step = transfer.channels as usize;
    let lit = |values: &[f32]| {
        let terms = values.iter().step_by(step).zip(&light.values);
        terms.map(|(t, l)| f64::from(*t) * f64::from(l[0])).sum::<f64>()
    };
    assert_eq!(light.values.len(), (transfer.bands * transfer.bands) as usize, "a light of as many bands");
    assert_eq!(transfer.values.len(), row * transfer.albedo.len(), "an albedo for each receiver");
    let rows = transfer.values.chunks_exact(row).zip(&transfer.albedo);
    rows.map(|(values, albedo)| f64::from(albedo[0]) * lit(values)).collect()
}

/// Open share of every vertex; a bake leaves the list out where all are open, which is the worst that a closed scene can do.
pub(crate) fn shares(prt: &Prt) -> Vec<f64> {
    let (count, openness) = (prt.geometry.positions.len(), &prt.transfer.openness);
    if openness.is_empty() {
        return vec![1.0; count];
    }
    assert_eq!(openness.len(), count, "a share for each vertex");
    openness.iter().map(|&share| f64::from(share)).collect()
}

/// Numbers of a bake's transfer in f64.
pub(crate) fn values(prt: &Prt) -> Vec<f64> {
    prt.transfer.values.iter().map(|&v| f64::from(v)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// What a bowl or a gap would be if no ray met it: an empty list, and still a share for each vertex to judge.
    #[test]
    fn open_receivers_have_shares() {
        let prt = quiet(&grey("plane", 0.5), &fixed(1, 16, 0));
        assert!(prt.transfer.openness.is_empty());
        assert_eq!(shares(&prt), vec![1.0; prt.geometry.positions.len()]);
    }
}
