//! The unit that a scene is modelled in changes nothing: no length counts by itself.

mod support;

use bake::{Extras, MapSettings, SheetSettings, TextureSettings};
use coeff_io::{Bounces, Effect, Effects, Encoding, Prt, Quality, Settings};
use glam::Vec3;
use scene::lightmap::{ObjectOptions, objects};
use scene::{Material, Mesh, Scene};
use sh_math::hemisphere::Basis;

/// A small metal ball over a plane, in another unit.
fn scene(unit: f32) -> Scene {
    let mut scene = scene::builtin("sphere-on-plane").expect("a scene of its own");
    let metal = Material { metallic: 1.0, roughness: 0.3, ..scene.materials[0].clone() };
    scene.materials.push(metal);
    let ball = (0..scene.meshes.len()).max_by_key(|&m| scene.meshes[m].triangles.len()).expect("meshes");
    scene.meshes[ball].material = scene.materials.len() as u32 - 1;
    for mesh in &mut scene.meshes {
        mesh.positions.iter_mut().for_each(|position| *position *= unit);
    }
    scene
}

fn settings() -> Settings {
    Settings {
        bands: 3,
        quality: Quality::Rays(16),
        bounces: Bounces::Fixed(1),
        effects: Effects::Only(vec![
            Effect::Visibility,
            Effect::Interreflection,
            Effect::Color,
            Effect::Specular,
            Effect::Glossy,
        ]),
        ..bake::settings::standard()
    }
}

const OBJECTS: ObjectOptions = ObjectOptions { texels: 64, padding: 2, unwrap: true };

fn sheets(scene: &mut Scene) -> Vec<SheetSettings> {
    let all: Vec<usize> = (0..scene.meshes.len()).collect();
    let found = objects(scene, &all, &OBJECTS, &|_, _, _| {}).expect("it unwraps");
    let sheet = |object: scene::lightmap::ObjectSheet| SheetSettings {
        meshes: vec![object.mesh],
        width: object.width,
        height: object.height,
        directional: false,
    };
    found.into_iter().map(sheet).collect()
}

fn textured(unit: f32) -> (Vec<SheetSettings>, Prt) {
    let mut scene = scene(unit);
    let sheets = sheets(&mut scene);
    let textures = TextureSettings { sheets: sheets.clone(), dilation: 1, levels: false, bent: false, stitch: false };
    let extras = Extras { textures: Some(textures), ..Extras::default() };
    (sheets, bake::bake_with(&scene, &settings(), &extras, &|_| std::ops::ControlFlow::Continue(())).unwrap())
}

fn mapped(unit: f32) -> Prt {
    let mut scene = scene(unit);
    let maps = MapSettings {
        basis: Basis::ModifiedH1,
        sheets: sheets(&mut scene),
        stitch: false,
        dilation: 1,
        encoding: Encoding::F32,
    };
    let extras = Extras { maps: Some(maps), ..Extras::default() };
    bake::bake_with(&scene, &settings(), &extras, &|_| std::ops::ControlFlow::Continue(())).unwrap()
}

/// Powers of two are exact: every number of the file but the lengths is the same to the bit.
#[test]
fn powers_of_two_change_no_bit() {
    let (sheets, metres) = textured(1.0);
    let maps = mapped(1.0);
    for unit in [128.0, 1.0 / 128.0] {
        let (own, prt) = textured(unit);
        assert_eq!(own, sheets, "as many texels in units of 1 / {unit}");
        assert!(prt.transfer.values == metres.transfer.values, "transfer in units of 1 / {unit}");
        assert_eq!(prt.achieved.gloss.map(|gloss| gloss.texels), metres.achieved.gloss.map(|gloss| gloss.texels));
        assert!(mapped(unit).maps == maps.maps, "light maps in units of 1 / {unit}");
    }
    assert!(maps.transfer.values.iter().any(|value| *value != 0.0), "can fail: something is there");
}

/// Centimetres round otherwise than metres: as many texels, and the same light but for what single rays change.
#[test]
fn centimetres_are_as_good_as_metres() {
    let (sheets, metres) = textured(1.0);
    let (own, prt) = textured(100.0);
    assert_eq!(own, sheets);
    let sum = |prt: &Prt| prt.transfer.values.iter().step_by(9).sum::<f32>();
    let off = sum(&prt) / sum(&metres) - 1.0;
    assert!(off.abs() < 0.01, "{off}");
    let count = |prt: &Prt| prt.transfer.values.len() as f32;
    assert!((count(&prt) / count(&metres) - 1.0).abs() < 0.02);
}

/// Openness of every receiver of a bake of direct light, in another unit.
fn openness(unit: f32) -> Result<Vec<f32>, bake::Error> {
    let settings = Settings { bounces: Bounces::Fixed(0), effects: Effects::Auto, ..settings() };
    bake::bake(&scene(unit), &settings, &|_| std::ops::ControlFlow::Continue(())).map(|prt| prt.transfer.openness)
}

/// A unit of 60 nanometres is as good as any; one of 1e-20 m is refused in one sentence that names what to do.
#[test]
fn tiny_units_are_the_same_or_are_refused() {
    let metres = openness(1.0).expect("it bakes");
    let tiny = openness(0.5f32.powi(24)).expect("it bakes");
    assert!(metres == tiny, "another openness in another unit");
    let error = openness(1e-20).expect_err("it is refused").to_string();
    assert!(error.contains("e-20 m across") && error.contains("scale it up to at least 1e-8 m"), "{error}");
    assert!(!error.contains('\n'));
    // The size is never told as the least one.
    let mut almost = Scene { meshes: vec![Mesh::default()], materials: vec![Material::default()], ..Scene::default() };
    almost.meshes[0].positions = [[0.0; 3], [9.96e-9, 0.0, 0.0], [0.0, 9.96e-9, 0.0]].map(Vec3::from_array).to_vec();
    almost.meshes[0].triangles.push([0, 1, 2]);
    let error = bake::plan(&almost, &settings()).expect_err("it is refused").to_string();
    assert!(error.contains("9.96e-9 m across"), "{error}");
}

/// The refusal is called for: squares of areas are nothing there.
#[test]
fn tiny_units_are_the_same_or_are_refused_can_fail() {
    assert!(1e-20f32.powi(4) == 0.0 && (1e-8f32).powi(4) > f32::MIN_POSITIVE);
    assert!(openness(1.0).expect("it bakes").iter().any(|open| *open < 0.9), "something is shaded");
}
