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
    Ok(choose(scene, settings, &|_| ControlFlow::Continue(()))?.0)
}

/// [`storage`] before a bake, which reports progress and can be cancelled. Where vertices are chosen, also the scene as that bake splits it, if
/// it was split on the way: [`crate::bake_refined`] takes it.
///
/// # Errors
/// As [`storage`], and [`Error::Cancelled`].
pub fn storage_watched(
    scene: &Scene,
    settings: &Settings,
    progress: ProgressFn<'_>,
) -> Result<(StorageChoice, Option<Scene>), Error> {
    let (choice, split) = choose(scene, settings, progress)?;
    let refined = match split.filter(|_| choice.texels.is_none()) {
        Some(split) => owned(split.cut(settings, progress)?),
        None => None,
    };
    Ok((choice, refined))
}

fn owned(scene: Cow<'_, Scene>) -> Option<Scene> {
    match scene {
        Cow::Owned(scene) => Some(scene),
        Cow::Borrowed(_) => None,
    }
}

/// The choice, and the scene with its edges halved where that decided it.
fn choose<'a>(
    scene: &'a Scene,
    settings: &Settings,
    progress: ProgressFn<'_>,
) -> Result<(StorageChoice, Option<Halved<'a>>), Error> {
    settings::check(settings)?;
    let matte = || StorageChoice { texels: None, reason: "vertices: no reflection is simulated by direction".into() };
    // Most scenes need no plan, which takes as long to find as all refinement.
    if !may_be_glossy(scene, settings) {
        return Ok((matte(), None));
    }
    check_size(scene)?;
    let split = Halved::new(scene, settings, progress)?;
    if !simulates(&prepare(split.scene(), settings, &Extras::default())?.plan, Effect::Glossy) {
        return Ok((matte(), Some(split)));
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
    Ok((StorageChoice { texels, reason }, Some(split)))
}
