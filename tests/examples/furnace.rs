//! Prints what a white ball of a smooth dielectric shows of a white sky, as a table of roughnesses: by the formulas of glTF 2.0 by quadrature, by the
//! path tracer with microfacets, and as a bake is drawn; the figures of `docs/comparison.md`.

#![expect(clippy::print_stdout, reason = "an example that prints a table")]

#[path = "../tests/glossy/mod.rs"]
mod glossy;

use coeff_io::GlossView;
use glam::{Vec3, Vec4};
use glossy::{Recipe, Shot, baked, drawn};
use probe_io::Environment;
use reference::{Gloss, Light, Mirroring, Settings, World};
use scene::{Camera, Scene};
use std::ops::ControlFlow;
use testkit::gltf::Surface;

/// Pixels along a side of the pictures.
const SIZE: u32 = 64;
/// Paths per pixel.
const PATHS: u32 = 256;
/// Rougher dielectrics count as matte.
const ROUGHNESSES: [f32; 3] = [0.0, 0.2, 0.4];

fn main() {
    println!("| roughness | formula | reference | difference | drawn | difference |\n|---|---|---|---|---|---|");
    for roughness in ROUGHNESSES {
        let scene = ball(roughness);
        let formula = Surface { base: 1.0, metallic: 0.0, roughness: f64::from(roughness) }.of_white_sky_on_average();
        let (traced, shown) = (traced(&scene), shown(&scene));
        let [to_formula, to_traced] = [traced - formula, shown - traced];
        println!("| {roughness} | {formula:.4} | {traced:.4} | {to_formula:+.4} | {shown:.4} | {to_traced:+.4} |");
    }
}

/// A white ball, looked at from afar.
fn ball(roughness: f32) -> Scene {
    let mut scene = scene::builtin("sphere").expect("a built-in scene");
    for material in &mut scene.materials {
        (material.base_color, material.metallic, material.roughness) = (Vec4::ONE, 0.0, roughness);
    }
    let eye = Vec3::new(0.0, 0.0, 100.0);
    scene.cameras =
        vec![Camera { name: "far".into(), eye, target: Vec3::ZERO, up: Vec3::Y, vertical_fov: 2.4f32 / 100.0 }];
    scene
}

fn sum(pixels: &[[f32; 3]]) -> f64 {
    pixels.iter().map(|p| f64::from(p[1])).sum()
}

/// By paths; over what a matte ball shows, which is 1 where it is hit.
fn traced(scene: &Scene) -> f64 {
    let black = Environment::constant([0.0; 3]);
    let light = Light::new(&Environment::constant([1.0; 3])).with_sky(&black);
    let settings = Settings { samples: PATHS, seed: 1, max_bounces: None };
    let picture = |world: &World| {
        let size = [SIZE; 2];
        let go_on = |_| ControlFlow::Continue(());
        reference::render(world, &light, &scene.cameras[0], size, &settings, &go_on).expect("nobody stops it").pixels
    };
    let shiny = picture(&World::new(scene).with_gloss(Gloss::new(Mirroring::Microfacet)));
    sum(&shiny) / sum(&picture(&World::new(scene)))
}

/// As a bake is drawn; over what is drawn without a mirror.
fn shown(scene: &Scene) -> f64 {
    let recipe = Recipe { rays: 64, bounces: 0, glossy: false, ..Recipe::standard() };
    let (mut prt, sky) = (baked(scene, &recipe, None), Environment::constant([1.0; 3]));
    let shot = Shot { camera: 0, size: [SIZE; 2], view: GlossView::default() };
    let shiny = drawn(&prt, &sky, &shot);
    prt.materials.iter_mut().for_each(|material| material.specular = false);
    sum(&shiny) / sum(&drawn(&prt, &sky, &shot))
}
