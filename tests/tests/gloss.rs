//! Baked gloss against paths with the same lobes, picture by picture. The example `figures` draws and prints the same for larger scenes.

mod glossy;

use coeff_io::{GlossView, Refine};
use glam::{Vec3, Vec4};
use glossy::{Recipe, Shot, baked, drawn, traced};
use probe_io::Environment;
use scene::{Material, Scene};
use sh_math::lobe::{Lobe, roughness_of_exponent};

/// Paths of each pixel, twice.
const PATHS: u32 = 96;
const SIZE: [u32; 2] = [72, 54];

/// The Cornell box with one block of coloured metal.
fn scene(roughness: f32) -> Scene {
    let mut scene = scene::builtin("cornell-box").expect("a built-in scene");
    let block = (0..scene.meshes.len())
        .rev()
        .find(|&m| scene.meshes[m].name.contains("block"))
        .unwrap_or(scene.meshes.len() - 1);
    scene.meshes[block].material = scene.materials.len() as u32;
    scene.meshes[block].colors.clear();
    scene.materials.push(Material {
        name: "metal".into(),
        metallic: 1.0,
        roughness,
        base_color: Vec4::new(0.9, 0.7, 0.4, 1.0),
        ..Material::default()
    });
    scene
}

/// A broad light, so that few paths are enough.
fn light() -> Environment {
    Environment::from_function("test", 64, |d| {
        let up = 0.6 + 0.4 * d.y;
        [up + 0.5 * (d.x - 0.3).max(0.0), up, up + 0.6 * (-d.x).max(0.0)]
    })
}

fn view(lobe: Lobe, roughness: f32) -> Shot {
    Shot { camera: 0, size: SIZE, view: GlossView { lobe, roughness: Some(roughness), ..GlossView::default() } }
}

fn fine() -> Recipe {
    Recipe { rays: 256, bent: false, refine: Refine::Edge(0.3), ..Recipe::standard() }
}

/// At vertices and at texels, both lobes; against the same without gloss by direction.
#[test]
fn gloss_agrees_with_paths() {
    let light = light();
    for (lobe, roughness) in [(Lobe::Phong, roughness_of_exponent(8.0) as f32), (Lobe::Ggx, 0.6)] {
        let scene = scene(roughness);
        let shot = view(lobe, roughness);
        let truth = traced(&scene, &light, &shot, (PATHS, 2, false));
        let off = |recipe: &Recipe| truth.difference(&drawn(&baked(&scene, recipe, None), &light, &shot));
        let vertices = off(&fine());
        let texels = off(&Recipe { texels: Some(256), ..fine() });
        let openness = off(&Recipe { glossy: false, ..fine() });
        assert!(vertices < 0.045 && texels < 0.045, "{lobe:?}: {vertices} at vertices, {texels} at texels");
        assert!(openness > 2.5 * vertices, "{lobe:?}: {openness} without gloss by direction must show ({vertices})");
    }
}

/// Light that metal mirrors reaches diffuse surfaces: without bounces it is missing.
#[test]
fn mirrors_light_their_surroundings() {
    let light = light();
    let scene = scene(0.5);
    let shot = view(Lobe::Ggx, 0.5);
    let truth = traced(&scene, &light, &shot, (PATHS, 2, false)).picture();
    let drawn = |scene: &Scene| drawn(&baked(scene, &fine(), None), &light, &shot);
    let mean = |picture: &[[f32; 3]]| picture.as_flattened().iter().sum::<f32>();
    let share = mean(&drawn(&scene)) / mean(&truth);
    assert!((share - 1.0).abs() < 0.02, "{share}");
    let mut dark = scene.clone();
    dark.materials.last_mut().unwrap().base_color = Vec3::ZERO.extend(1.0);
    assert!((mean(&drawn(&dark)) / mean(&truth) - 1.0).abs() > 0.05, "can fail: a black block");
}

/// The Cornell box of smooth dielectrics, with or without a block of metal.
fn polished(metal: bool) -> Scene {
    let mut scene = if metal { scene(0.5) } else { scene::builtin("cornell-box").expect("a built-in scene") };
    let dielectrics = scene.materials.iter_mut().filter(|material| material.metallic == 0.0);
    dielectrics.for_each(|material| material.roughness = 0.4);
    scene
}

/// The view into the box, all of it: the outline of what stands before black is drawn up to 1 % thinner or thicker than paths have it.
fn within(mut scene: Scene) -> (Scene, Shot) {
    scene.cameras[0].vertical_fov *= 0.92;
    let view = GlossView { lobe: Lobe::Ggx, ..GlossView::default() };
    (scene, Shot { camera: 0, size: [48, 48], view })
}

fn mean(picture: &[[f32; 3]]) -> f32 {
    picture.as_flattened().iter().sum()
}

/// Coloured walls that shine, by openness and by direction, with the tail and without, under broad lights and lamps: no energy is won or lost
/// against paths.
#[test]
fn a_polished_room_keeps_its_energy() {
    let lights = |names: &[&str]| names.iter().map(|name| probe_io::builtin(name).expect("a light")).collect();
    let all: [(bool, Vec<Environment>); 2] =
        [(false, vec![light()]), (true, [vec![light()], lights(&["white", "hemisphere", "studio"])].concat())];
    for (glossy, lights) in all {
        let (scene, mut shot) = within(polished(glossy));
        let prt = baked(&scene, &Recipe { glossy, ..fine() }, None);
        for light in &lights {
            let truth = mean(&traced(&scene, light, &shot, (PATHS, 2, false)).picture());
            for tail in [false, true] {
                shot.view.tail = tail;
                let share = mean(&drawn(&prt, light, &shot)) / truth;
                // What five bands leave of lamps of 10 degrees is why there is a tail.
                let bound = if tail || light.name != "builtin:studio" { 0.015 } else { 0.03 };
                assert!((share - 1.0).abs() < bound, "{}, by direction {glossy}, tail {tail}: {share}", light.name);
            }
            let mut matte = prt.clone();
            matte.materials.iter_mut().for_each(|material| material.specular = false);
            let share = mean(&drawn(&matte, light, &shot)) / truth;
            assert!((share - 1.0).abs() > 0.015, "can fail: what is mirrored is left out: {share}");
        }
    }
}

/// A floor of metal seen from above and along, under lights that differ below it.
#[test]
fn an_open_floor_keeps_its_energy() {
    for roughness in [0.4, 0.6] {
        let mut scene = scene::builtin("plane").expect("a built-in scene");
        scene.materials.iter_mut().for_each(|m| (m.metallic, m.roughness) = (1.0, roughness));
        let shot = Shot { camera: 0, size: [48, 36], view: GlossView { lobe: Lobe::Ggx, ..GlossView::default() } };
        let prt = baked(&scene, &Recipe { rays: 16, bounces: 0, refine: Refine::Off, ..fine() }, None);
        for name in ["hemisphere", "studio", "sky"] {
            let light = probe_io::builtin(name).expect("a light");
            let truth = mean(&traced(&scene, &light, &shot, (PATHS, 0, false)).picture());
            let share = mean(&drawn(&prt, &light, &shot)) / truth;
            assert!((share - 1.0).abs() < 0.015, "{name}, roughness {roughness}: {share}");
        }
        let light = light();
        let truth = mean(&traced(&scene, &light, &shot, (PATHS, 0, false)).picture());
        let other = mean(&drawn(&prt, &probe_io::builtin("white").expect("a light"), &shot)) / truth;
        assert!((other - 1.0).abs() > 0.015, "can fail: another light shows: {other}");
    }
}
