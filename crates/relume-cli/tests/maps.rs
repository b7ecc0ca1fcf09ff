//! Light maps and irradiance volumes at the command line: inspected, exported, refused where there are none.

mod command;

use coeff_io::{Encoding, Layers, MapLight, Maps, Node, Prt, Sheet, Volume, import};
use command::{complaint, relume};
use sh_math::hemisphere::Basis;
use std::path::Path;

/// Runs a command that must end with `code`; returns stdout and stderr.
fn run(folder: &Path, arguments: &[&str], code: i32) -> (String, String) {
    let output = relume(folder, arguments);
    let text = complaint(&output);
    assert_eq!(output.status.code(), Some(code), "{arguments:?}: {text}");
    (String::from_utf8_lossy(&output.stdout).into_owned(), text)
}

/// A baked plane `plain.prt`, and the same with maps and a volume under `light`: `full.prt`.
fn bake(folder: &Path, light: MapLight) -> Prt {
    run(folder, &["bake", "builtin:plane", "-o", "plain.prt", "--rays", "16", "-q"], 0);
    let mut prt = Prt::read(&folder.join("plain.prt")).unwrap();
    prt.geometry.uv1 = vec![[0.5; 2]; prt.geometry.positions.len()];
    let depth = light.depth() as u32;
    let values: Vec<f32> = (0..8 * 4 * 4 * depth * 3).map(|i| (i % 61) as f32 / 64.0).collect();
    let coding = coeff_io::Coding::plain(Encoding::Bc6h);
    let layers = Layers::encode([8, 4, 4 * depth, 3], &values, &coding).layers;
    prt.maps = Some(Maps {
        basis: Basis::H4,
        light: light.clone(),
        sheets: vec![Sheet { layers }],
        sheet_of_mesh: vec![Some(0); prt.meshes.len()],
    });
    prt.volume = Some(Volume {
        origin: [0.0; 3],
        spacing: [2.0, 1.0, 1.0],
        cells: [1; 3],
        nodes: vec![Node::Leaf([0, 1, 2, 3, 4, 5, 6, 7])],
        light,
        channels: 1,
        values: (0..8 * 9 * depth).map(|i| (i % 7) as f32 * 0.125).collect(),
        positions: (0..8).map(|i| [2.0 * (i & 1) as f32, (i >> 1 & 1) as f32, (i >> 2) as f32]).collect(),
        validity: vec![1.0; 8],
        distances: vec![],
        resolution: 0,
        reach: 1.0,
    });
    prt.write(&folder.join("full.prt")).unwrap();
    prt
}

#[test]
fn maps_and_volumes_are_inspected() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let prt = bake(folder, MapLight::Fixed { probe: "builtin:sky".into(), bands: 5 });
    let (text, _) = run(folder, &["inspect", "full.prt"], 0);
    for part in ["H 4, of builtin:sky in 5 bands", "8x4 bc6h 4 layers", "1x1x1, 1 cells, 8 probes", "MAPS 0", "VVAL"] {
        assert!(text.contains(part), "nothing of '{part}': {text}");
    }
    let json: serde_json::Value = serde_json::from_str(&run(folder, &["inspect", "full.prt", "--json"], 0).0).unwrap();
    let maps = &json["maps"];
    assert_eq!((&maps["basis"], &maps["light"]["probe"]), (&"h4".into(), &"builtin:sky".into()));
    let bytes = prt.maps.unwrap().sheets[0].layers.bytes.len();
    assert_eq!((&maps["sheets"][0]["encoding"], &maps["sheets"][0]["bytes"]), (&"bc6h".into(), &bytes.into()));
    // A cell of 32 bytes, and per probe 36 of coefficients, 12 of its place and 4 of validity.
    assert_eq!((&json["volume"]["probes"], &json["volume"]["bytes"]), (&8.into(), &(32 + 8 * 52).into()));
    let (text, _) = run(folder, &["inspect", "plain.prt"], 0);
    assert!(!text.contains("light maps") && !text.contains("volume "), "{text}");
    let json: serde_json::Value = serde_json::from_str(&run(folder, &["inspect", "plain.prt", "--json"], 0).0).unwrap();
    assert!(json["maps"].is_null() && json["volume"].is_null());
}

#[test]
fn textures_and_text_come_back() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let prt = bake(folder, MapLight::Fixed { probe: "builtin:sky".into(), bands: 5 });
    for format in ["ktx2", "dds"] {
        let (_, said) = run(folder, &["export", "full.prt", "--format", format, "-o", format], 0);
        assert!(said.contains("1 sheets and 9 textures"), "{said}");
        assert_eq!(Some(import::maps(&folder.join(format)).unwrap()), prt.maps);
        let grid = import::grid(&folder.join(format)).unwrap();
        assert_eq!((grid.points, grid.step), ([2, 2, 2], [2.0, 1.0, 1.0]));
        assert_eq!(grid.functions[3][5], [prt.volume.as_ref().unwrap().values[5 * 9 + 3]; 3]);
    }
    run(folder, &["export", "full.prt", "--format", "json", "-o", "text"], 0);
    run(folder, &["export", "full.prt", "--format", "npy", "-o", "arrays"], 0);
    let size = |name: &str| std::fs::metadata(folder.join("arrays").join(name)).map_or(0, |file| file.len());
    let (vertices, triangles) = (prt.geometry.positions.len() as u64, prt.geometry.triangles.len() as u64);
    assert_eq!(
        (size("uv1.npy") - 8 * vertices, size("triangles.npy") - 12 * triangles),
        (128, 128),
        "header and numbers"
    );
    run(folder, &["export", "plain.prt", "--format", "npy", "-o", "bare"], 0);
    assert!(folder.join("bare/triangles.npy").exists(), "every export has its mesh");
    assert_eq!(Some(import::volume_json(&folder.join("text/volume.json")).unwrap()), prt.volume);
}

/// The textures of a relightable volume are lit by the probe, and linear in it: reckoned here from the coefficients of `relume light`.
#[test]
fn volumes_are_lit_by_the_probe() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let prt = bake(folder, MapLight::Relightable { bands: 2 });
    let (_, said) = run(folder, &["export", "full.prt", "--format", "dds", "-o", "a"], 2);
    assert!(said.contains("--probe"), "{said}");
    assert!(!folder.join("a").exists(), "nothing may be written");
    run(folder, &["export", "full.prt", "--format", "dds", "--probe", "builtin:sky", "-o", "a"], 0);
    run(folder, &["light", "builtin:sky", "--bands", "2", "--format", "json", "-o", "sky.json"], 0);
    let sky: serde_json::Value = serde_json::from_slice(&std::fs::read(folder.join("sky.json")).unwrap()).unwrap();
    let values = &prt.volume.as_ref().unwrap().values;
    let grid = import::grid(&folder.join("a")).unwrap();
    for channel in 0..3 {
        let expected: f64 = (0..4)
            .map(|i| f64::from(values[(6 * 9 + 2) * 4 + i]) * sky["coefficients"][i][channel].as_f64().unwrap())
            .sum();
        let found = f64::from(grid.functions[2][6][channel]);
        assert!((found - expected).abs() <= expected.abs() / 1024.0 + 1e-6, "{found}, not {expected}");
    }
    assert_eq!(import::maps(&folder.join("a")).unwrap().sheets[0].layers.count, 16);
}

#[test]
fn what_is_not_there_is_not_exported() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    bake(folder, MapLight::Relightable { bands: 1 });
    for format in ["ktx2", "dds", "json"] {
        let (_, said) = run(folder, &["export", "plain.prt", "--format", format, "-o", "none"], 1);
        assert!(said.contains("plain.prt") && said.contains("volume") && said.contains("npy"), "{said}");
        assert!(said.trim_end().lines().count() == 1 && !folder.join("none").exists(), "{said}");
    }
}
