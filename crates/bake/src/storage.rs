//! Whether gloss is better kept at vertices or at texels: by how finely the scene is cut, against the error asked for.

use crate::extras::Extras;
use crate::mirror::shining;
use crate::plan::{may_be_glossy, prepare, simulates};
use crate::refine::refined;
use crate::{Error, settings};
use coeff_io::{Effect, Refine, Settings};
use scene::Scene;
use std::ops::ControlFlow;

/// Times as many vertices as a scene has that the error may ask for before texels are the better place.
const MOST_GROWTH: f64 = 1.5;
/// Texels per vertex that the error asks for: the filter between texels is as wide as an edge between such vertices.
const TEXELS_PER_VERTEX: f64 = 4.0;
/// Share of a sheet that charts are taken to fill.
const FILLED: f64 = 0.6;
/// Fewest and most texels along a side that are chosen.
const SIDES: [u32; 2] = [64, 2048];

/// Where transfer and gloss are kept.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct StorageChoice {
    /// Texels along a side of all sheets together; none where vertices are enough.
    pub texels: Option<u32>,
    /// The facts that decided it, in one sentence.
    pub reason: String,
}

/// Chooses for a scene: texels where surfaces that shine have normal maps, or where the triangles would have to be cut much finer to hold
/// the error asked for; else vertices.
///
/// # Errors
/// As [`crate::plan`].
pub fn storage(scene: &Scene, settings: &Settings) -> Result<StorageChoice, Error> {
    settings::check(settings)?;
    let vertices = |reason: String| Ok(StorageChoice { texels: None, reason });
    let matte = || vertices("vertices: no reflection is simulated by direction".into());
    // Most scenes need no plan, which takes as long to find as all refinement.
    if !may_be_glossy(scene, settings) {
        return matte();
    }
    let split = refined(scene, settings, &|_| ControlFlow::Continue(()))?;
    if !simulates(&prepare(&split, settings, &Extras::default())?.plan, Effect::Glossy) {
        return matte();
    }
    let shines = shining(scene);
    let bent = scene.meshes.iter().any(|mesh| {
        shines[mesh.material as usize]
            && scene.materials[mesh.material as usize].normal_texture.is_some()
            && !mesh.tangents.is_empty()
    });
    let before: usize = scene.meshes.iter().map(|mesh| mesh.positions.len()).sum();
    // As finely as shadows between the vertices ask for, whether the file is to be cut so or not.
    let fine = match settings.refine {
        Refine::Auto => split,
        _ => refined(scene, &Settings { refine: Refine::Auto, ..settings.clone() }, &|_| ControlFlow::Continue(()))?,
    };
    let after: usize = fine.meshes.iter().map(|mesh| mesh.positions.len()).sum();
    let side = (after as f64 * TEXELS_PER_VERTEX / FILLED).sqrt();
    let side = (libm::ceil(side / 16.0) as u32 * 16).clamp(SIDES[0], SIDES[1]);
    let growth = after as f64 / before.max(1) as f64;
    match (bent, growth > MOST_GROWTH) {
        (true, _) => Ok(StorageChoice {
            texels: Some(side),
            reason: "texels: surfaces that shine have normal maps, which vertices cannot follow".into(),
        }),
        (false, true) => Ok(StorageChoice {
            texels: Some(side),
            reason: format!(
                "texels: {before} vertices would have to become {after} to hold the error asked for, {growth:.1} times as many"
            ),
        }),
        (false, false) => vertices(format!(
            "vertices: {before} of them hold the error asked for ({growth:.1} times as many would do it all)"
        )),
    }
}
