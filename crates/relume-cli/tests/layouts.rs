//! Light maps lie where the coordinates of a scene serve, and have texels enough for every chart.

mod command;

use command::{complaint, relume};
use std::path::{Path, PathBuf};

const QUICK: [&str; 8] = ["--storage", "maps", "--rays", "16", "--bounces", "0", "--bands", "2"];

/// Bakes `scene`; the exit status, and what was said.
fn bake(folder: &Path, scene: &str, file: &str, more: &[&str]) -> (Option<i32>, String) {
    let output = relume(folder, &[&["bake", scene, "-o", file][..], &QUICK, more].concat());
    (output.status.code(), complaint(&output))
}

fn picture(folder: &Path, file: &str) -> Vec<[f32; 3]> {
    let drawn = ["render", file, "--probe", "builtin:sky", "--size", "96x96", "--backend", "cpu", "-o", "a.exr", "-q"];
    let output = relume(folder, &drawn);
    assert_eq!(output.status.code(), Some(0), "{}", complaint(&output));
    probe_io::read_picture(&folder.join("a.exr")).unwrap().2
}

/// A folder of the test data.
fn data(folder: &str) -> Option<PathBuf> {
    let found = testkit::data_dir();
    if found.is_none() {
        testkit::skip(folder);
    }
    found.map(|data| data.join(folder))
}

/// The number behind `--texels` in a sentence.
fn texels_named(text: &str) -> u32 {
    let number = text.split("--texels ").nth(1).expect("the option is named");
    number.trim_end().parse().expect("a number ends the sentence")
}

/// Too few texels for the charts are refused with the number that does; half of it does not.
#[test]
fn too_few_texels_are_refused_with_the_number_needed() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let (code, text) = bake(folder, "builtin:teacup", "a.prt", &["--texels", "16", "-q"]);
    assert_eq!((code, text.lines().count()), (Some(1), 1), "{text}");
    let needed = texels_named(&text);
    let fewer = (needed / 2).to_string();
    let (code, again) = bake(folder, "builtin:teacup", "a.prt", &["--texels", &fewer, "-q"]);
    assert_eq!(code, Some(1), "can fail: {fewer} texels are too few: {again}");
    assert!(!folder.join("a.prt").exists(), "nothing is written");
    let (code, text) = bake(folder, "builtin:teacup", "a.prt", &["--texels", &needed.to_string(), "-q"]);
    assert_eq!(code, Some(0), "{text}");
}

/// Coordinates without area are told, and what they leave without light is unwrapped: the picture is that of sound coordinates.
#[test]
fn coordinates_without_area_are_told_and_replaced() {
    let Some(data) = data("cases/uv1-without-area") else { return };
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let scene = |name: &str| data.join(name).display().to_string();
    let texels = ["--texels", "128"];
    let (code, text) = bake(folder, &scene("control-good.gltf"), "good.prt", &texels);
    assert!(code == Some(0) && !text.contains("do not serve"), "{text}");
    let good = picture(folder, "good.prt");
    let mean = |a: &[[f32; 3]]| a.as_flattened().iter().sum::<f32>();
    for name in ["box-on-a-line.gltf", "all-in-one-point.gltf"] {
        let (code, text) = bake(folder, &scene(name), "a.prt", &texels);
        assert!(code == Some(0) && text.contains("'Box' do not serve"), "{name}: {text}");
        let own = picture(folder, "a.prt");
        let pairs = own.as_flattened().iter().zip(good.as_flattened());
        let difference = pairs.map(|(a, b)| (a - b).abs()).sum::<f32>() / mean(&good);
        assert!(difference < 0.03, "{name}: {difference}");
        let black = vec![[0.0; 3]; own.len()];
        assert!(mean(&black) < 0.5 * mean(&good), "can fail: black is far off");
    }
}

/// One layout for each mesh: every mesh keeps its coordinates, on a sheet of its own.
#[test]
fn a_layout_for_each_mesh_is_kept() {
    let Some(data) = data("scenes/cornell-box-lightmap-uv") else { return };
    let folder = tempfile::tempdir().unwrap();
    let scene = data.join("CornellBox.glb").display().to_string();
    let (code, text) = bake(folder.path(), &scene, "a.prt", &["--texels", "128", "--refine", "off"]);
    assert!(code == Some(0) && !text.contains("do not serve"), "{text}");
    let prt = coeff_io::Prt::read(&folder.path().join("a.prt")).unwrap();
    let maps = prt.maps.unwrap();
    assert_eq!(maps.sheets.len(), maps.sheet_of_mesh.iter().flatten().count(), "as many sheets as meshes");
    assert!(maps.sheets.len() > 4);
}
