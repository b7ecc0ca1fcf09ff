//! `relume bases --scene`: the table, its files, what is recommended, and what is refused.

mod command;

use command::{complaint, relume};
use serde_json::{Value, json};
use std::fs;
use std::path::Path;

/// A square with a normal map under a second square, as glTF.
fn bumped(folder: &Path) {
    let square = |y: f32, s: f32| [[-s, y, -s], [-s, y, s], [s, y, s], [s, y, -s]];
    let mut bytes: Vec<u8> = Vec::new();
    let mut put = |values: &[f32]| bytes.extend(values.iter().flat_map(|v| v.to_le_bytes()));
    put(square(0.0, 1.0).as_flattened());
    put([[0.0, 1.0, 0.0]; 4].as_flattened());
    put(&[0.0, 0.0, 0.0, 1.0, 1.0, 1.0, 1.0, 0.0]);
    put(square(0.5, 0.4).as_flattened());
    bytes.extend([0u16, 1, 2, 0, 2, 3].iter().flat_map(|v| v.to_le_bytes()));
    fs::write(folder.join("scene.bin"), &bytes).unwrap();
    let bumps = image::RgbImage::from_fn(8, 8, |x, y| image::Rgb([(64 + 16 * x) as u8, (64 + 16 * y) as u8, 230]));
    bumps.save(folder.join("bumps.png")).unwrap();
    let view = |offset: u32, length: u32| json!({ "buffer": 0, "byteOffset": offset, "byteLength": length });
    let vertices = |view: u32, kind: &str, s: f32, y: f32| match view {
        0 | 3 => {
            json!({ "bufferView": view, "componentType": 5126, "count": 4, "type": kind, "min": [-s, y, -s], "max": [s, y, s] })
        }
        _ => json!({ "bufferView": view, "componentType": 5126, "count": 4, "type": kind }),
    };
    let primitive = |positions: u32, material: u32| json!({ "primitives": [{ "attributes": { "POSITION": positions, "NORMAL": 1, "TEXCOORD_0": 2 }, "indices": 4, "material": material }] });
    let scene = json!({
        "asset": { "version": "2.0" },
        "buffers": [{ "uri": "scene.bin", "byteLength": bytes.len() }],
        "bufferViews": [view(0, 48), view(48, 48), view(96, 32), view(128, 48), view(176, 12)],
        "accessors": [
            vertices(0, "VEC3", 1.0, 0.0), vertices(1, "VEC3", 0.0, 0.0), vertices(2, "VEC2", 0.0, 0.0), vertices(3, "VEC3", 0.4, 0.5),
            { "bufferView": 4, "componentType": 5123, "count": 6, "type": "SCALAR" }
        ],
        "images": [{ "uri": "bumps.png" }],
        "textures": [{ "source": 0 }],
        "materials": [{ "normalTexture": { "index": 0 } }, { "doubleSided": true }],
        "meshes": [primitive(0, 0), primitive(3, 1)],
        "nodes": [{ "mesh": 0, "name": "floor" }, { "mesh": 1, "name": "roof" }],
        "scenes": [{ "nodes": [0, 1] }],
        "scene": 0
    });
    fs::write(folder.join("bumped.gltf"), scene.to_string()).unwrap();
}

/// The options of a quick look.
const QUICK: [&str; 6] = ["--texels", "32", "--rays", "64", "--bounces", "1"];

/// What is printed as JSON for the scene with bumps.
fn seen(folder: &Path, arguments: &[&str]) -> Value {
    let first = ["bases", "-q", "--json", "--scene", "bumped.gltf", "--probe", "builtin:sky", "-o", "out"];
    let output = relume(folder, &[&first, &QUICK[..], arguments].concat());
    assert_eq!(output.status.code(), Some(0), "{}", complaint(&output));
    assert!(complaint(&output).is_empty(), "-q must be quiet: {}", complaint(&output));
    serde_json::from_slice(&output.stdout).unwrap()
}

#[test]
fn a_basis_is_recommended_for_a_scene_with_normal_maps() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    bumped(folder);
    let loose = seen(folder, &["--target", "0.5"]);
    assert_eq!((&loose["normals"], loose["bases"].as_array().unwrap().len()), (&json!(64), 14));
    assert_eq!(loose["recommended"]["met"], true);
    assert_ne!(loose["recommended"]["basis"], "modified H 1", "no light map where normal maps are");
    let of = |seen: &Value| -> (f64, f64) {
        let wanted = &seen["recommended"];
        let basis =
            seen["bases"].as_array().unwrap().iter().find(|row| row["basis"] == wanted["basis"]).unwrap().clone();
        let stored =
            basis["stored"].as_array().unwrap().iter().find(|s| s["encoding"] == wanted["encoding"]).unwrap().clone();
        (stored["bytes"].as_f64().unwrap(), stored["drawn_relative_rms"].as_f64().unwrap())
    };
    let (bytes, error) = of(&loose);
    assert!(error <= 0.5, "{error}");
    let strict = seen(folder, &["--target", "0.02"]);
    let (more, less) = of(&strict);
    assert!(more > bytes && less < error, "a smaller error takes more: {bytes} {error}, {more} {less}");
    let budget = (more as u64).to_string();
    let (within, best) = of(&seen(folder, &["--budget", &budget]));
    assert!(within <= more && best <= less * 1.01, "{within} {best}");
    // What is recommended can be typed, and takes as many bytes.
    let mut bake = vec!["bake", "-q", "bumped.gltf", "-o", "bumped.prt", "--probe", "builtin:sky"];
    bake.extend(strict["recommended"]["options"].as_str().unwrap().split(' '));
    bake.extend(&QUICK[2..]);
    let output = relume(folder, &bake);
    assert_eq!(output.status.code(), Some(0), "{}", complaint(&output));
    let inspected = relume(folder, &["inspect", "-q", "--json", "bumped.prt"]);
    let file: Value = serde_json::from_slice(&inspected.stdout).unwrap();
    let baked = file["maps"]["bytes"].as_f64().unwrap();
    assert!((baked / more - 1.0).abs() < 0.01, "{baked} baked, {more} foretold");
    assert!((baked / bytes - 1.0).abs() > 0.1, "can fail: the looser choice takes {bytes}");
}

#[test]
fn the_files_of_a_scene_are_written() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let first = ["bases", "--scene", "builtin:half-blocked-plane", "--probe", "builtin:sky", "-o", "new/folder"];
    let output = relume(folder, &[&first, &QUICK[..]].concat());
    assert_eq!(output.status.code(), Some(0), "{}", complaint(&output));
    let text = String::from_utf8_lossy(&output.stdout).into_owned();
    let said = ["modified H 6", "worst texel", "for an error of 2 %", "a light map serves", "--basis modified-h1"];
    assert!(said.iter().all(|part| text.contains(part)), "{text}");
    let folder = folder.join("new/folder");
    let csv = fs::read_to_string(folder.join("bases-scene.csv")).unwrap();
    assert_eq!(csv.lines().count(), 57, "14 bases in 4 encodings: {csv}");
    assert!(fs::read_to_string(folder.join("bases-scene.svg")).unwrap().contains("recommended"));
    assert_eq!(image::open(folder.join("bases-scene.png")).unwrap().to_rgb8().dimensions(), (880, 440));
    assert_eq!(fs::read_dir(&folder).unwrap().count(), 3, "nothing else is left there");
}

#[test]
fn what_cannot_be_on_a_scene_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let plane = ["--scene", "builtin:plane"];
    let lit = ["--scene", "builtin:plane", "--probe", "builtin:sky"];
    for (arguments, reason) in [
        (&plane[..], "--probe"),
        (&["--probe", "builtin:sky"], "--scene"),
        (&["--texels", "64"], "--scene"),
        (&[&lit[..], &["--target", "0.1", "--budget", "1M"]].concat(), "--target-size"),
        (&[&lit[..], &["--target", "0"]].concat(), "above 0"),
        (&[&lit[..], &["--budget", "0"]].concat(), "0 bytes"),
        (&[&lit[..], &["--signals", "10"]].concat(), "--signals"),
        (&[&lit[..], &["--texels", "4"]].concat(), "--texels"),
        (&[&lit[..], &["--bands", "99"]].concat(), "bands"),
        (&["--scene", "builtin:nowhere", "--probe", "builtin:sky"], "builtin:nowhere"),
    ] {
        let output = relume(folder, &[&["bases", "-o", "out"], arguments].concat());
        assert_eq!(output.status.code(), Some(2), "{arguments:?}: {}", complaint(&output));
        assert!(complaint(&output).contains(reason), "{arguments:?}: {}", complaint(&output));
    }
    let dark = relume(
        folder,
        &[&["bases", "-q", "-o", "out", "--scene", "missing.glb", "--probe", "builtin:sky"], &QUICK[..]].concat(),
    );
    assert_eq!(dark.status.code(), Some(1), "{}", complaint(&dark));
    assert!(complaint(&dark).contains("missing.glb"), "{}", complaint(&dark));
}
