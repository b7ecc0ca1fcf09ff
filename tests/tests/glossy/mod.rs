//! Baked gloss beside paths with the same lobes: for the test and for the figures.
#![allow(dead_code, reason = "the test and the example use a part each")]

use bake::{Extras, FixedLight, SheetSettings, TextureSettings};
use coeff_io::{Bounces, Effect, Effects, GlossView, Prt, Quality, Refine, Settings};
use probe_io::Environment;
use reference::{Gloss, Light, Mirroring, World};
use scene::Scene;
use scene::lightmap::{ObjectOptions, objects};
use sh_math::lobe::Lobe;
use std::ops::ControlFlow;

/// How a scene is baked.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Recipe {
    pub(crate) bands: u32,
    pub(crate) rays: u32,
    pub(crate) bounces: u32,
    pub(crate) refine: Refine,
    /// Texels along a side, or vertices.
    pub(crate) texels: Option<u32>,
    /// Whether gloss is kept by direction.
    pub(crate) glossy: bool,
    /// Whether normal maps are in the transfer.
    pub(crate) bent: bool,
}

impl Recipe {
    pub(crate) fn standard() -> Self {
        Self { bands: 5, rays: 512, bounces: 2, refine: Refine::Auto, texels: None, glossy: true, bent: true }
    }
}

/// Bakes a scene, under one light where one is given.
pub(crate) fn baked(scene: &Scene, recipe: &Recipe, light: Option<FixedLight>) -> Prt {
    let mut scene = scene.clone();
    let mut effects =
        vec![Effect::Visibility, Effect::Interreflection, Effect::Color, Effect::Specular, Effect::NormalMaps];
    effects.extend(recipe.glossy.then_some(Effect::Glossy));
    let settings = Settings {
        bands: recipe.bands,
        quality: Quality::Rays(recipe.rays),
        bounces: Bounces::Fixed(recipe.bounces),
        refine: recipe.refine,
        effects: Effects::Only(effects),
        ..bake::settings::standard()
    };
    let textures = recipe.texels.map(|texels| textures(&mut scene, texels, recipe.bent));
    let extras = Extras { textures, light, ..Extras::default() };
    bake::bake_with(&scene, &settings, &extras, &|_| ControlFlow::Continue(())).expect("the scene bakes")
}

fn textures(scene: &mut Scene, texels: u32, bent: bool) -> TextureSettings {
    let meshes: Vec<usize> = (0..scene.meshes.len()).filter(|&m| scene.material(m).blocks_rays()).collect();
    let options = ObjectOptions { texels, padding: 2, unwrap: false };
    let sheets = objects(scene, &meshes, &options, &|_, _, _| {}).expect("it unwraps");
    let sheets = sheets.iter().map(|sheet| SheetSettings {
        meshes: vec![sheet.mesh],
        width: sheet.width,
        height: sheet.height,
        directional: false,
    });
    TextureSettings { sheets: sheets.collect(), dilation: 3, levels: true, bent, stitch: true }
}

/// What is looked at.
#[derive(Debug, Clone)]
pub(crate) struct Shot {
    /// Index among the cameras of the scene.
    pub(crate) camera: usize,
    pub(crate) size: [u32; 2],
    pub(crate) view: GlossView,
}

/// The baked scene, linear, without sky.
pub(crate) fn drawn(prt: &Prt, environment: &Environment, shot: &Shot) -> Vec<[f32; 3]> {
    let camera = prt.cameras[shot.camera.min(prt.cameras.len() - 1)].clone();
    let frame = render_cpu::Frame {
        gloss: shot.view,
        sky: false,
        // Outlines as the paths have them, which cover pixels evenly.
        supersample: 6,
        ..render_cpu::Frame::plain(camera, shot.size[0], shot.size[1])
    };
    render_cpu::render(prt, environment, &frame).expect("it draws").linear
}

/// What paths find, twice and independently: the noise of one is not that of the other.
pub(crate) struct Truth([Vec<[f32; 3]>; 2]);

impl Truth {
    /// Both together.
    pub(crate) fn picture(&self) -> Vec<[f32; 3]> {
        let [a, b] = &self.0;
        a.iter().zip(b).map(|(a, b)| [0, 1, 2].map(|c| 0.5 * (a[c] + b[c]))).collect()
    }

    /// Relative root mean square of the difference of a picture, without the noise of the paths: the mean of `(p - a)(p - b)` is that of
    /// `(p - t)^2` where a and b are independent and t their expectation. Brighter than four times the mean is cut there: fireflies and outlines of lamps.
    pub(crate) fn difference(&self, picture: &[[f32; 3]]) -> f64 {
        let [a, b] = &self.0;
        let lit = a.iter().filter(|p| p.iter().any(|x| *x > 0.0)).count().max(1);
        let mean = a.as_flattened().iter().sum::<f32>() / (3 * lit) as f32;
        let cut = |x: f32| f64::from(x.min(4.0 * mean));
        let halves = a.as_flattened().iter().zip(b.as_flattened());
        let (mut off, mut all) = (0.0, 0.0);
        for (p, (a, b)) in picture.as_flattened().iter().zip(halves) {
            let [p, a, b] = [*p, *a, *b].map(cut);
            off += (p - a) * (p - b);
            all += a * b;
        }
        (off.max(0.0) / all).sqrt()
    }
}

/// Paths with the same lobes under the whole light, without sky, two times `samples`; `bent` as for diffuse light of transfer textures.
pub(crate) fn traced(
    scene: &Scene,
    environment: &Environment,
    shot: &Shot,
    (samples, bounces, bent): (u32, u32, bool),
) -> Truth {
    let lobe = match shot.view.lobe {
        Lobe::Ggx => reference::Lobe::Ggx,
        Lobe::Phong => reference::Lobe::Phong,
    };
    let gloss = Gloss { roughness: shot.view.roughness, ..Gloss::new(Mirroring::Lobe(lobe)) };
    let world = World::with_normal_maps(scene, bent).with_gloss(gloss);
    let light = Light::new(environment).with_sky(&Environment::constant([0.0; 3]));
    let camera = &scene.cameras[shot.camera.min(scene.cameras.len() - 1)];
    let half = |seed| {
        let settings = reference::Settings { samples, seed, max_bounces: Some(bounces) };
        reference::render(&world, &light, camera, shot.size, &settings, &|_| ControlFlow::Continue(()))
            .expect("nobody stops it")
            .pixels
    };
    Truth([half(1), half(2)])
}
