//! A scene baked as its plan says and with every effect, side by side.
#![allow(dead_code, reason = "the test and the example use a part each")]

use coeff_io::{Effects, Prt, Quality, Refine, Settings};
use scene::Scene;
use std::ops::ControlFlow;

/// Few bands and rays, the mesh as it is: what is compared is the decision, not the quality.
pub(crate) fn cheap() -> Settings {
    Settings { bands: 3, quality: Quality::Rays(64), refine: Refine::Off, ..bake::settings::standard() }
}

/// Change below which the plan may leave something out at a fixed number of rays: a quarter of a percent of an open receiver.
pub(crate) const TOLERANCE: f64 = 2.5e-3;

/// Bakes without showing progress.
pub(crate) fn baked(scene: &Scene, settings: &Settings) -> Prt {
    bake::bake(scene, settings, &|_| ControlFlow::Continue(())).expect("the scene bakes")
}

/// Bakes with some effects.
pub(crate) fn with(scene: &Scene, effects: Effects) -> Prt {
    baked(scene, &Settings { effects, ..cheap() })
}

/// Mean share of an open receiver's light that gloss may be short of where it is not called for: glazed cups send on little.
pub(crate) const GLOSS_MISSED: f64 = 0.02;

/// Largest norm over receivers and channels of the difference of what two bakes send out under any light: albedo times
/// transfer, against that of a white open receiver.
pub(crate) fn difference(a: &Prt, b: &Prt) -> f64 {
    differences(a, b).into_iter().fold(0.0, f64::max)
}

/// The mean of the same.
pub(crate) fn mean_difference(a: &Prt, b: &Prt) -> f64 {
    let all = differences(a, b);
    all.iter().sum::<f64>() / all.len().max(1) as f64
}

fn differences(a: &Prt, b: &Prt) -> Vec<f64> {
    assert_eq!(a.geometry.positions, b.geometry.positions, "the same receivers");
    let n = (a.transfer.bands.max(b.transfer.bands) as usize).pow(2);
    let value = |prt: &Prt, vertex: usize, i: usize, c: usize| {
        let (own, channels) = ((prt.transfer.bands as usize).pow(2), prt.transfer.channels as usize);
        let at = (vertex * own + i) * channels + c.min(channels - 1);
        if i < own { f64::from(prt.transfer.values[at]) } else { 0.0 }
    };
    // Integral of (cos/pi)^2 over the hemisphere.
    let open = (2.0 / (3.0 * std::f64::consts::PI)).sqrt();
    let mut all = Vec::new();
    for (vertex, albedo) in a.transfer.albedo.iter().enumerate() {
        for (c, &albedo) in albedo.iter().enumerate() {
            let square = |i: usize| (value(a, vertex, i, c) - value(b, vertex, i, c)).powi(2);
            all.push(f64::from(albedo) * (0..n).map(square).sum::<f64>().sqrt() / open);
        }
    }
    all
}

/// What a bake took.
pub(crate) struct Cost {
    pub(crate) rays: u64,
    pub(crate) bytes: u64,
}

impl Cost {
    /// Rays with those of the survey, and bytes of the file.
    pub(crate) fn of(prt: &Prt) -> Self {
        let rays = prt.achieved.visibility_rays + prt.achieved.bounce_rays + prt.plan.survey.rays;
        Self { rays, bytes: prt.to_bytes().expect("a sound file").len() as u64 }
    }
}

/// Six scenes that others made: name, and path below the folder of scenes.
pub(crate) const REAL: [(&str, &str); 6] = [
    ("house", "house-lightmap-uv/house.glb"),
    ("Suzanne", "suzanne/Suzanne.gltf"),
    ("water bottle", "water-bottle/WaterBottle.gltf"),
    ("Cornell box GLB", "cornell-box-lightmap-uv/CornellBox.glb"),
    ("teapot", "teapot/teapot.obj"),
    ("glass table", "glass-table/glass-table.glb"),
];

/// Every known scene, and the real ones where their data is.
pub(crate) fn scenes() -> Vec<(String, Scene)> {
    let known = scene::BUILTINS.iter().map(|(name, _)| ((*name).to_owned(), scene::builtin(name).expect("listed")));
    let mut all: Vec<(String, Scene)> = known.collect();
    match testkit::data_dir() {
        Some(data) => all.extend(REAL.iter().map(|(name, path)| {
            let scene = scene::load(&data.join("scenes").join(path)).expect("a good scene");
            ((*name).to_owned(), scene)
        })),
        None => testkit::skip("auto against all on real scenes"),
    }
    all
}
