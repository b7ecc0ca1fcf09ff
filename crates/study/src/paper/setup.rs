//! A scene in both storages: transfer at its vertices as the paper's baseline has it, and at texels.

use super::Error;
use bake::{Extras, SheetSettings, TextureSettings, settings};
use coeff_io::{Bounces, Effect, Effects, Prt, Quality, Refine, Settings};
use scene::lightmap::{ObjectOptions, objects};
use std::ops::ControlFlow;
use std::time::{Duration, Instant};

/// How scenes are baked for the tables. The numbers in the tables of transfer do not change the time of a picture.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Setup {
    /// Bands; the paper has 5.
    pub bands: u32,
    /// Rays of each receiver.
    pub rays: u32,
    /// Texels along a side, of all sheets together; the paper has 1024.
    pub texels: u32,
    /// Bounces; the paper's table has none.
    pub bounces: u32,
}

impl Setup {
    /// As the paper has it, with few rays.
    #[must_use]
    pub fn paper() -> Self {
        Self { bands: 5, rays: 32, texels: 1024, bounces: 0 }
    }
}

/// A scene baked twice.
#[derive(Debug, Clone)]
pub struct Baked {
    /// Name of the built-in scene.
    pub name: String,
    /// Triangles of the scene.
    pub triangles: u64,
    /// Vertices of the scene as it was made.
    pub vertices: u64,
    /// Transfer at vertices.
    pub at_vertices: Prt,
    /// Transfer at texels.
    pub at_texels: Prt,
    /// Unwrapping, and the bake at texels.
    pub took: [Duration; 2],
}

/// Bakes a built-in scene at its vertices and at texels.
///
/// # Errors
/// [`Error`] where there is no such scene, or it cannot be unwrapped or baked.
pub fn baked(name: &str, setup: &Setup) -> Result<Baked, Error> {
    let mut scene = scene::builtin(name).ok_or_else(|| Error::Scene(name.into()))?;
    let vertices = scene.meshes.iter().map(|mesh| mesh.positions.len() as u64).sum();
    let triangles = scene.meshes.iter().map(|mesh| mesh.triangles.len() as u64).sum();
    let quiet = |_: &bake::Progress| ControlFlow::Continue(());
    let settings = settings_of(setup);
    let at_vertices = bake::bake(&scene, &settings, &quiet)?;
    let began = Instant::now();
    let meshes: Vec<usize> = (0..scene.meshes.len()).filter(|&m| scene.material(m).blocks_rays()).collect();
    let options = ObjectOptions { texels: setup.texels, padding: 2, unwrap: false };
    let sheets = objects(&mut scene, &meshes, &options, &|_, _, _| {})?;
    let unwrapping = began.elapsed();
    let sheets = sheets.iter().map(|sheet| SheetSettings {
        meshes: vec![sheet.mesh],
        width: sheet.width,
        height: sheet.height,
        directional: false,
    });
    let textures = TextureSettings { sheets: sheets.collect(), dilation: 3, levels: true, bent: true, stitch: false };
    let extras = Extras { textures: Some(textures), ..Extras::default() };
    let began = Instant::now();
    let at_texels = bake::bake_with(&scene, &settings, &extras, &quiet)?;
    let took = [unwrapping, began.elapsed()];
    Ok(Baked { name: name.into(), triangles, vertices, at_vertices, at_texels, took })
}

fn settings_of(setup: &Setup) -> Settings {
    let effects = [
        Effect::Visibility,
        Effect::Interreflection,
        Effect::Color,
        Effect::Specular,
        Effect::Glossy,
        Effect::NormalMaps,
    ];
    Settings {
        bands: setup.bands,
        quality: Quality::Rays(setup.rays),
        bounces: Bounces::Fixed(setup.bounces),
        refine: Refine::Off,
        effects: Effects::Only(effects.to_vec()),
        ..settings::standard()
    }
}
