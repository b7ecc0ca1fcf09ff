//! Sky domes round a scene take no light from it, and what shuts it in is named.

mod command;
mod model;

use command::{complaint, relume};
use model::{Shape, material, picture, unlit};
use serde_json::{Value, json};
use std::f32::consts::{FRAC_PI_2, PI};
use std::fs;
use std::path::Path;

const QUICK: [&str; 8] = ["--rays", "32", "--bounces", "1", "--bands", "3", "--refine", "off"];

type Part = (&'static str, Shape, Value);

/// A crate on a ground.
fn crate_on(half: f32) -> Vec<Part> {
    let crate_ = Shape::cuboid([-0.5, 0.0, -0.5], [0.5, 1.0, 0.5]);
    let ground = ("Ground", Shape::ground(half), material([0.6; 3], json!({})));
    vec![ground, ("Crate", crate_, material([0.8, 0.2, 0.1], json!({})))]
}

/// What was said of a bake, and the picture from a place within any dome.
fn drawn(folder: &Path, scene: &str) -> (String, Vec<[f32; 3]>) {
    let baked = relume(folder, &[&["bake", scene, "-o", "a.prt"][..], &QUICK].concat());
    assert_eq!(baked.status.code(), Some(0), "{}", complaint(&baked));
    let look = ["--probe", "builtin:sky", "--camera", "2,1.5,3,0,0.5,0,40", "--size", "48x36", "--backend", "cpu"];
    let drawn = relume(folder, &[&["render", "a.prt", "-o", "a.exr"][..], &look].concat());
    assert_eq!(drawn.status.code(), Some(0), "{}", complaint(&drawn));
    let pixels = probe_io::read_picture(&folder.join("a.exr")).unwrap().2;
    (complaint(&baked) + &complaint(&drawn), pixels)
}

fn scene(folder: &Path, half: f32, more: Vec<Part>) -> (String, Vec<[f32; 3]>) {
    model::write(folder, "a.gltf", &[crate_on(half), more].concat());
    drawn(folder, "a.gltf")
}

fn furthest(a: &[[f32; 3]], b: &[[f32; 3]]) -> f32 {
    a.as_flattened().iter().zip(b.as_flattened()).map(|(a, b)| (a - b).abs()).fold(0.0, f32::max)
}

/// Domes of every kind, with the half width of the ground under them.
fn domes(folder: &Path) -> Vec<(&'static str, f32, Vec<Part>)> {
    picture(&folder.join("sky.png"));
    let unlit = |more: Value| {
        let mut all = json!({ "extensions": unlit() });
        all.as_object_mut().unwrap().extend(more.as_object().unwrap().clone());
        material([0.4, 0.6, 0.9], all)
    };
    let sphere = |from, to| Shape::sphere(8.0, from, to);
    let ball = || sphere(0.0, PI);
    let cube = Shape::cuboid([-8.0; 3], [8.0; 3]).turned();
    let side = |k: usize| ("Side", cube.side(k), unlit(json!({})));
    let glow = material([0.0; 3], json!({ "emissiveFactor": [0.4, 0.6, 0.9] }));
    vec![
        ("sphere", 3.0, vec![("Dome", ball().turned(), unlit(json!({})))]),
        ("normals outwards", 3.0, vec![("Dome", ball(), unlit(json!({})))]),
        ("double-sided", 3.0, vec![("Dome", ball(), unlit(json!({ "doubleSided": true })))]),
        ("masked", 3.0, vec![("Dome", ball(), unlit(json!({ "alphaMode": "MASK" })))]),
        ("blended", 3.0, vec![("Dome", ball(), unlit(json!({ "alphaMode": "BLEND" })))]),
        ("with a picture", 3.0, vec![("Dome", ball(), unlit(json!({ "picture": "sky.png" })))]),
        ("that glows", 3.0, vec![("Dome", ball(), glow)]),
        ("half", 3.0, vec![("Dome", sphere(0.0, FRAC_PI_2), unlit(json!({})))]),
        ("as wide as the ground", 8.0, vec![("Dome", sphere(0.0, FRAC_PI_2), unlit(json!({})))]),
        ("on a wide ground", 30.0, vec![("Dome", ball(), unlit(json!({})))]),
        ("box", 3.0, vec![("Dome", cube.clone(), unlit(json!({})))]),
        ("box of six", 3.0, (0..6).map(side).collect()),
        (
            "two halves",
            3.0,
            vec![
                ("Above", sphere(0.0, FRAC_PI_2), unlit(json!({}))),
                ("Below", sphere(FRAC_PI_2, PI), unlit(json!({}))),
            ],
        ),
    ]
}

#[test]
fn domes_are_left_out_and_named() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let mut controls: Vec<(f32, Vec<[f32; 3]>)> = Vec::new();
    for (what, half, parts) in domes(folder) {
        if !controls.iter().any(|(of, _)| *of == half) {
            controls.push((half, scene(folder, half, Vec::new()).1));
        }
        let control = &controls.iter().find(|(of, _)| *of == half).unwrap().1;
        let names: Vec<&str> = parts.iter().map(|part| part.0).collect();
        let (said, pixels) = scene(folder, half, parts);
        assert!(names.iter().all(|name| said.contains(name)), "{what}: {said}");
        assert!(said.contains("a sky dome") && said.contains("left out"), "{what}: {said}");
        assert!(furthest(&pixels, control) < 1e-6, "{what}: off by {}", furthest(&pixels, control));
    }
}

/// An OBJ file has no unlit materials: what glows and is black is one.
#[test]
fn domes_of_obj_files_are_left_out() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let text = |parts: &[Part]| {
        let mut text = String::from("mtllib a.mtl\n");
        let mut first = 1;
        for (name, shape, _) in parts {
            text += &format!("o {name}\nusemtl {name}\n");
            shape.positions.iter().for_each(|[x, y, z]| text += &format!("v {x} {y} {z}\n"));
            shape
                .triangles
                .iter()
                .for_each(|t| text += &format!("f {} {} {}\n", t[0] + first, t[1] + first, t[2] + first));
            first += shape.positions.len() as u32;
        }
        text
    };
    let library = "newmtl Ground\nKd 0.6 0.6 0.6\nnewmtl Crate\nKd 0.8 0.2 0.1\nnewmtl Dome\n";
    let dome = ("Dome", Shape::sphere(8.0, 0.0, PI), json!({}));
    let with = [crate_on(3.0), vec![dome]].concat();
    picture(&folder.join("sky.png"));
    fs::write(folder.join("a.obj"), text(&with[..2])).unwrap();
    fs::write(folder.join("a.mtl"), library).unwrap();
    let control = drawn(folder, "a.obj").1;
    fs::write(folder.join("a.obj"), text(&with)).unwrap();
    for look in ["Kd 0 0 0\nKe 0.4 0.6 0.9\n", "Kd 0 0 0\nmap_Ke sky.png\n"] {
        fs::write(folder.join("a.mtl"), format!("{library}{look}")).unwrap();
        let (said, pixels) = drawn(folder, "a.obj");
        assert!(said.contains("warning: Dome") && said.contains("left out"), "{look}: {said}");
        assert!(furthest(&pixels, &control) < 1e-6, "{look}: off by {}", furthest(&pixels, &control));
    }
    // What is lit stays, and is named.
    fs::write(folder.join("a.mtl"), format!("{library}Kd 1 1 1\nmap_Kd sky.png\n")).unwrap();
    let (said, pixels) = drawn(folder, "a.obj");
    assert!(said.contains("warning: Dome: encloses the scene") && !said.contains("left out"), "{said}");
    assert!(furthest(&pixels, &control) > 0.1, "can fail: nothing is lit in it");
}

/// Walls, whichever side they show, and what else is lit all round a scene.
#[test]
fn what_shuts_a_scene_in_is_named() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let plain = || material([0.7; 3], json!({}));
    let room = Shape::cuboid([-4.0, 0.0, -4.0], [4.0, 3.0, 4.0]);
    let thick = {
        let outer = Shape::cuboid([-4.2, -0.2, -4.2], [4.2, 3.2, 4.2]);
        let mut both = room.clone().turned();
        both.triangles.extend(outer.triangles.iter().map(|t| t.map(|v| v + 8)));
        both.positions.extend(outer.positions);
        both
    };
    let both_sides = material([0.7; 3], json!({ "doubleSided": true }));
    for (what, shape, look, shows_inside) in [
        ("seen from within", room.clone().turned(), plain(), true),
        ("seen from without", room.clone(), plain(), false),
        ("both", room, both_sides, true),
        ("thick", thick, plain(), true),
        ("dome", Shape::sphere(8.0, 0.0, PI), plain(), false),
    ] {
        let (said, pixels) = scene(folder, 3.0, vec![("Shell", shape, look)]);
        assert!(said.contains("warning: Shell: encloses"), "{what}: {said}");
        let planned = complaint(&relume(folder, &[&["plan", "a.gltf"][..], &QUICK].concat()));
        assert!(planned.contains("warning: Shell: encloses"), "{what}: {planned}");
        // Where its inside is not drawn, the sky is behind.
        let black = pixels.as_flattened().iter().all(|v| *v == 0.0);
        assert_eq!(black, shows_inside, "{what}");
        assert_eq!(said.contains("warning: the picture is black"), black, "{what}: {said}");
    }
}

#[test]
fn shells_and_domes_can_fail() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let (said, control) = scene(folder, 3.0, Vec::new());
    assert!(!["encloses", "left out", "black"].iter().any(|word| said.contains(word)), "{said}");
    let planned = complaint(&relume(folder, &[&["plan", "a.gltf"][..], &QUICK].concat()));
    assert!(!planned.contains("encloses"), "{planned}");
    let open = Shape::cuboid([-4.0, 0.0, -4.0], [4.0, 3.0, 4.0]).turned();
    let open = Shape { triangles: [&open.triangles[..6], &open.triangles[8..]].concat(), ..open };
    let (said, pixels) = scene(folder, 3.0, vec![("Shell", open, material([0.7; 3], json!({})))]);
    assert!(!said.contains("encloses") && !said.contains("black"), "light comes in from above: {said}");
    assert!(furthest(&pixels, &control) > 0.05, "its walls show");
    let lamp = Shape::sphere(0.2, 0.0, PI);
    let (said, _) = scene(folder, 3.0, vec![("Lamp", lamp, material([1.0; 3], json!({ "extensions": unlit() })))]);
    assert!(!said.contains("left out"), "what is unlit and small stays: {said}");
}

/// A hall of 20 m with a slit in its roof, of which few rays tell most receivers nothing.
#[test]
fn a_hall_with_a_slit_is_open_to_few_rays() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let hall = Shape::cuboid([-10.0, 0.0, -10.0], [10.0, 8.0, 10.0]).turned();
    let open = Shape { triangles: [&hall.triangles[..6], &hall.triangles[8..]].concat(), ..hall.clone() };
    let roof = |x: [f32; 2]| Shape::cuboid([x[0], 0.0, -10.0], [x[1], 8.0, 10.0]).turned().side(3);
    let said = |shell: Shape, more: &[Shape]| {
        let plain = || material([0.7; 3], json!({}));
        let mut parts = vec![("Hall", shell, plain())];
        parts.extend(more.iter().map(|roof| ("Roof", roof.clone(), plain())));
        model::write(folder, "hall.gltf", &[crate_on(4.0), parts].concat());
        let few =
            ["bake", "hall.gltf", "-o", "a.prt", "--rays", "16", "--bounces", "0", "--bands", "2", "--refine", "1"];
        complaint(&relume(folder, &few))
    };
    let slit = said(open, &[roof([-10.0, -0.15]), roof([0.15, 10.0])]);
    assert!(!slit.contains("encloses"), "{slit}");
    let closed = said(hall, &[]);
    assert!(closed.contains("warning: Hall: encloses"), "can fail: {closed}");
}
