//! Whether gloss is better kept at vertices or at texels: by how finely the scene is cut, against the error asked for.

use crate::extras::Extras;
use crate::mirror::shining;
use crate::plan::{may_be_glossy, prepare, simulates};
use crate::refine::{Halved, check_size};
use crate::{Error, ProgressFn, settings};
use coeff_io::{Effect, Refine, Settings};
use scene::Scene;
use std::borrow::Cow;
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
#[derive(Debug, Clone)]
pub struct StorageChoice {
    /// Texels along a side of all sheets together; none where vertices are enough.
    pub texels: Option<u32>,
    /// The facts that decided it, in one sentence.
    pub reason: String,
    /// The scene as a bake at vertices splits it, where that was found on the way: [`crate::bake_refined`] takes it.
    pub refined: Option<Scene>,
}

/// Chooses for a scene: texels where surfaces that shine have normal maps, or where the triangles would have to be cut much finer to hold
/// the error asked for; else vertices.
///
/// # Errors
/// As [`crate::plan`].
pub fn storage(scene: &Scene, settings: &Settings) -> Result<StorageChoice, Error> {
    storage_watched(scene, settings, &|_| ControlFlow::Continue(()))
}

/// [`storage`] that reports progress and can be cancelled.
///
/// # Errors
/// As [`storage`], and [`Error::Cancelled`].
pub fn storage_watched(scene: &Scene, settings: &Settings, progress: ProgressFn<'_>) -> Result<StorageChoice, Error> {
    settings::check(settings)?;
    let matte = |refined| {
        let reason = "vertices: no reflection is simulated by direction".into();
        Ok(StorageChoice { texels: None, reason, refined })
    };
    // Most scenes need no plan, which takes as long to find as all refinement.
    if !may_be_glossy(scene, settings) {
        return matte(None);
    }
    check_size(scene)?;
    let split = Halved::new(scene, settings, progress)?;
    if !simulates(&prepare(split.scene(), settings, &Extras::default())?.plan, Effect::Glossy) {
        return matte(whole(split, settings, progress)?);
    }
    let shines = shining(scene);
    let bent = scene.meshes.iter().any(|mesh| {
        shines[mesh.material as usize]
            && scene.materials[mesh.material as usize].normal_texture.is_some()
            && !mesh.tangents.is_empty()
    });
    // As finely as shadows between the vertices ask for, whether the file is to be cut so or not.
    let fine = match settings.refine {
        Refine::Auto => None,
        _ => Some(Halved::new(scene, &Settings { refine: Refine::Auto, ..settings.clone() }, progress)?),
    };
    let vertices = |scene: &Scene| scene.meshes.iter().map(|mesh| mesh.positions.len()).sum::<usize>();
    let (before, after) = (vertices(scene), vertices(fine.as_ref().unwrap_or(&split).scene()));
    let side = (after as f64 * TEXELS_PER_VERTEX / FILLED).sqrt();
    let side = (libm::ceil(side / 16.0) as u32 * 16).clamp(SIDES[0], SIDES[1]);
    let growth = after as f64 / before.max(1) as f64;
    let (texels, reason) = match (bent, growth > MOST_GROWTH) {
        (true, _) => (Some(side), "texels: surfaces that shine have normal maps, which vertices cannot follow".into()),
        (false, true) => (
            Some(side),
            format!(
                "texels: {before} vertices would have to become {after} to hold the error asked for, {growth:.1} times as many"
            ),
        ),
        (false, false) => (
            None,
            format!("vertices: {before} of them hold the error asked for ({growth:.1} times as many would do it all)"),
        ),
    };
    let refined = if texels.is_none() { whole(split, settings, progress)? } else { None };
    Ok(StorageChoice { texels, reason, refined })
}

/// The scene with all its cuts, if there are any.
fn whole(split: Halved<'_>, settings: &Settings, progress: ProgressFn<'_>) -> Result<Option<Scene>, Error> {
    Ok(match split.cut(settings, progress)? {
        Cow::Owned(scene) => Some(scene),
        Cow::Borrowed(_) => None,
    })
}
