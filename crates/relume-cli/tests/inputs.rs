//! No output replaces a file that the scene consists of, whichever command writes it and by whatever name.

mod command;
mod model;

use command::{complaint, relume};
use model::{Shape, material, picture};
use serde_json::json;
use std::fs;
use std::path::Path;

/// A glTF with a buffer and two pictures, one of which no material reads, and an OBJ with a library that names three.
fn scenes(folder: &Path) {
    fs::create_dir_all(folder.join("looks")).unwrap();
    let pictures = ["wood.png", "unused.png", "cost-bytes.png", "bases-scene.png", "looks/bark.png", "looks/rough.png"];
    pictures.iter().for_each(|name| picture(&folder.join(name)));
    let part = |name: &'static str| (name, Shape::ground(1.0), material([1.0; 3], json!({ "picture": name })));
    model::write(folder, "a.gltf", &[part("wood.png"), part("cost-bytes.png"), part("bases-scene.png")]);
    let text = fs::read_to_string(folder.join("a.gltf")).unwrap();
    let mut value: serde_json::Value = serde_json::from_str(&text).unwrap();
    value["images"].as_array_mut().unwrap().push(json!({ "uri": "./unused.png" }));
    fs::write(folder.join("a.gltf"), value.to_string()).unwrap();
    fs::write(folder.join("a.obj"), "mtllib looks/a.mtl\nusemtl m\nv 0 0 0\nv 1 0 0\nv 0 0 -1\nf 1 2 3\n").unwrap();
    let library = "newmtl m\nKd 1 1 1\nmap_Kd BARK.PNG\nmap_Ns -imfchan r rough.png\nbump ..\\wood.png\n";
    fs::write(folder.join("looks/a.mtl"), library).unwrap();
}

/// The bytes of every file below the folder.
fn contents(folder: &Path) -> Vec<(String, Vec<u8>)> {
    let mut files = Vec::new();
    let mut stack = vec![folder.to_owned()];
    while let Some(path) = stack.pop() {
        if path.is_dir() {
            stack.extend(fs::read_dir(&path).unwrap().map(|entry| entry.unwrap().path()));
        } else {
            files.push((path.display().to_string(), fs::read(&path).unwrap()));
        }
    }
    files.sort();
    files
}

fn refuse(folder: &Path, arguments: &[&str]) {
    let before = contents(folder);
    let output = relume(folder, arguments);
    let text = complaint(&output);
    assert_eq!(output.status.code(), Some(2), "{arguments:?}: {text}");
    assert!(text.contains("would replace the input") && text.contains("another name"), "{arguments:?}: {text}");
    assert!(contents(folder) == before, "{arguments:?} changed a file");
}

#[test]
fn files_of_the_scene_are_never_replaced() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    scenes(folder);
    let light = ["--probe", "builtin:sky"];
    for (scene, picture) in [
        ("a.gltf", "wood.png"),
        ("a.gltf", "unused.png"),
        ("a.gltf", "./looks/../wood.png"),
        ("./a.gltf", "wood.png"),
        ("a.obj", "looks/bark.png"),
        ("a.obj", "looks/rough.png"),
        ("a.obj", "wood.png"),
    ] {
        refuse(folder, &[&["reference", scene, "-o", picture][..], &light].concat());
        refuse(folder, &["uv", scene, "--unwrap", "--image", picture]);
    }
    refuse(folder, &[&["cost", "a.gltf", "-o", "."][..], &light].concat());
    refuse(folder, &[&["bases", "--scene", "a.gltf", "-o", "."][..], &light].concat());
    // A buffer may have any name.
    for (file, from, to) in [("a.gltf", "a.bin", "a.prt"), ("a.obj", "looks/a.mtl", "a.prt")] {
        fs::copy(folder.join(from), folder.join(to)).unwrap();
        let named = fs::read_to_string(folder.join(file)).unwrap().replace(from, to);
        fs::write(folder.join(file), named).unwrap();
        let before = contents(folder);
        let output = relume(folder, &["bake", file, "-o", "a.prt"]);
        assert_eq!(output.status.code(), Some(2), "{}", complaint(&output));
        assert!(contents(folder) == before);
        fs::remove_file(folder.join(to)).unwrap();
    }
}

#[cfg(unix)]
#[test]
fn files_of_the_scene_by_links_are_never_replaced() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    scenes(folder);
    std::os::unix::fs::symlink(folder.join("wood.png"), folder.join("soft.png")).unwrap();
    fs::hard_link(folder.join("wood.png"), folder.join("hard.png")).unwrap();
    std::os::unix::fs::symlink(folder.join("looks"), folder.join("way")).unwrap();
    for (scene, picture) in [("a.gltf", "soft.png"), ("a.gltf", "hard.png"), ("a.obj", "way/bark.png")] {
        refuse(folder, &["reference", scene, "-o", picture, "--probe", "builtin:sky"]);
    }
}

/// Pictures that are none of the scene's are replaced as ever.
#[test]
fn files_of_the_scene_can_fail() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    scenes(folder);
    picture(&folder.join("mine.png"));
    let before = fs::read(folder.join("mine.png")).unwrap();
    let quick = ["--probe", "builtin:sky", "--size", "8x8", "--spp", "1", "-o", "mine.png"];
    let output = relume(folder, &[&["reference", "a.gltf"][..], &quick].concat());
    assert!(output.status.success(), "{}", complaint(&output));
    assert!(fs::read(folder.join("mine.png")).unwrap() != before);
}
