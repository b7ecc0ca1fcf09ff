//! Surfaces that claim to send out more than arrives.

use super::Case;
use super::baking::{fixed, grey, quiet, radiance, white};
use super::case::worst;
use super::published::bounced;
use glam::{Vec3, Vec4};
use scene::{Material, Mesh, Scene};
use std::path::Path;

pub(crate) fn above_one() -> Case {
    Case {
        title: "bowl with vertex colours of 2, 100 bounces, white sky",
        bound: "radiance - 1: clamped to 1 where they are read, the furnace of albedo 1",
        limit: 1e-3,
        ours: || {
            let found = radiance(&quiet(&painted(), &fixed(1, 256, 100)), &white(1));
            worst(found.into_iter().map(|value| (value - 1.0).abs()))
        },
        naive_method: "the series of the bounces as it is",
        naive: || {
            let mesh = &painted().meshes[0];
            let factors: Vec<f64> = mesh.colors.iter().map(|color| f64::from(color.x)).collect();
            worst(bounced(mesh, &factors, 100).into_iter().map(|value| (value - 1.0).abs()))
        },
    }
}

pub(crate) fn reported() -> Case {
    Case {
        title: "albedo above 1 in files: factor, Kd, vertex colour, their product",
        bound: "files that load without a word or still hold an albedo above 1, and sound ones that are blamed",
        limit: 0.0,
        ours: || misjudged(|path| scene::load(path).expect("a sound file")),
        naive_method: "to clamp in silence where it is used",
        naive: || misjudged(clamped_in_silence),
    }
}

/// A bowl that claims to send back twice what it gets.
fn painted() -> Scene {
    let mut scene = grey("bowl", 1.0);
    let mesh = &mut scene.meshes[0];
    mesh.colors = vec![Vec4::new(2.0, 2.0, 2.0, 1.0); mesh.positions.len()];
    scene
}

/// A way to read a file.
type Load = fn(&Path) -> Scene;

fn misjudged(load: Load) -> f64 {
    count(BRIGHT, load, |scene| !is_blamed(scene) || is_above_one(scene)) + count(SOUND, load, is_blamed)
}

/// The colour that a file gives its material, at most 1; vertex colours would be clamped where they are looked up.
fn clamped_in_silence(path: &Path) -> Scene {
    let text = |path: &Path| std::fs::read_to_string(path).expect("a file");
    let color: Vec<f32> = if path.extension().is_some_and(|kind| kind == "obj") {
        let library = text(&path.with_extension("mtl"));
        let line = library.lines().find_map(|line| line.strip_prefix("Kd ")).expect("a colour");
        line.split(' ').map(|number| number.parse().expect("a number")).collect()
    } else {
        let file: serde_json::Value = serde_json::from_str(&text(path)).expect("glTF is JSON");
        let factor = &file["materials"][0]["pbrMetallicRoughness"]["baseColorFactor"];
        (0..3).map(|i| factor[i].as_f64().expect("a number") as f32).collect()
    };
    let base_color = Vec3::from_slice(&color).min(Vec3::ONE).extend(1.0);
    let material = Material { base_color, ..Material::default() };
    Scene { meshes: vec![Mesh::default()], materials: vec![material], ..Scene::default() }
}

fn is_above_one(scene: &Scene) -> bool {
    let mesh = &scene.meshes[0];
    let factor = scene.materials[mesh.material as usize].base_color;
    let colors = mesh.colors.iter().copied().chain([Vec4::ONE].into_iter().filter(|_| mesh.colors.is_empty()));
    // what is no number is not within 1
    let within = |color: Vec4| (factor * color).truncate().cmple(Vec3::splat(1.0 + f32::EPSILON)).all();
    colors.into_iter().any(|color| !within(color))
}

fn is_blamed(scene: &Scene) -> bool {
    scene.report.warnings.iter().any(|warning| warning.message.contains("clamped"))
}

/// Base colour and vertex colour of a glTF file, and the diffuse colour of an OBJ file.
type Colors = ([f32; 3], Option<f32>, f32);

/// Each claims more than all: by the factor and Kd, by the vertex colours, by the product of both.
const BRIGHT: &[Colors] = &[([1.0, 2.0, 1.0], None, 1.5), ([1.0; 3], Some(1.5), 7.0), ([0.8; 3], Some(1.5), 1.1)];
/// A vertex colour above 1 is none where the factor makes up for it.
const SOUND: &[Colors] = &[([1.0; 3], Some(1.0), 1.0), ([0.5; 3], Some(1.5), 0.0)];

/// How many of the files are such, a glTF and an OBJ file of each kind.
fn count(kinds: &[Colors], load: Load, is: fn(&Scene) -> bool) -> f64 {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let write = |name: &str, text: &str| {
        let path = folder.path().join(name);
        std::fs::write(&path, text).expect("a written file");
        path
    };
    let mut found = 0;
    for &(factor, color, diffuse) in kinds {
        write("made.mtl", &format!("newmtl made\nKd {diffuse} 0.5 0.5\n"));
        let obj = write("made.obj", "mtllib made.mtl\nusemtl made\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
        let files = [obj, write("made.gltf", &gltf(factor, color))];
        found += files.iter().filter(|path| is(&load(path))).count();
    }
    found as f64
}

/// A triangle of a base colour, with vertex colours where one is given.
fn gltf([r, g, b]: [f32; 3], color: Option<f32>) -> String {
    let positions = [0.0f32, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0];
    let bytes = positions.into_iter().chain([color.unwrap_or(1.0); 9]).flat_map(f32::to_le_bytes);
    let escaped: String = bytes.map(|byte| format!("%{byte:02x}")).collect();
    let attribute = if color.is_some() { r#","COLOR_0":1"# } else { "" };
    format!(
        r#"{{"asset":{{"version":"2.0"}},
        "buffers":[{{"uri":"data:application/octet-stream,{escaped}","byteLength":72}}],
        "bufferViews":[{{"buffer":0,"byteLength":36}},{{"buffer":0,"byteOffset":36,"byteLength":36}}],
        "accessors":[
          {{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3","min":[0,0,0],"max":[1,1,0]}},
          {{"bufferView":1,"componentType":5126,"count":3,"type":"VEC3"}}],
        "materials":[{{"pbrMetallicRoughness":{{"baseColorFactor":[{r},{g},{b},1],"metallicFactor":0}}}}],
        "meshes":[{{"primitives":[{{"attributes":{{"POSITION":0{attribute}}},"material":0}}]}}],
        "nodes":[{{"mesh":0}}],"scenes":[{{"nodes":[0]}}],"scene":0}}"#
    )
}
