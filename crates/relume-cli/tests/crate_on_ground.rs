//! The shadow and the bounced light of a small crate are there whatever the size of the ground that it stands on.

mod command;
mod model;

use command::{complaint, relume};
use model::{Shape, material};
use serde_json::json;
use std::path::Path;

/// Light, view and accuracy that the right values are stated for.
const LIGHT: [&str; 2] = ["--probe", "builtin:sky:25,60"];
const SIZE: [usize; 2] = [480, 360];
/// Columns and rows near the crate.
const NEAR: [std::ops::Range<usize>; 2] = [40..440, 224..344];
/// Side of a block that is averaged, pixels.
const BLOCK: usize = 8;
/// Largest error of a block, of the mean near the crate.
const BOUND: f32 = 0.15;
const CAMERA: &str = "1.125,0.875,1.5,0.1,0.1,0.1,45";

fn run(folder: &Path, arguments: &[&str]) {
    let output = relume(folder, arguments);
    assert_eq!(output.status.code(), Some(0), "{arguments:?}: {}", complaint(&output));
}

/// Means of the blocks near the crate, channel by channel, of the picture that was made last.
fn blocks(folder: &Path) -> Vec<[f32; 3]> {
    let (width, _, pixels) = probe_io::read_picture(&folder.join("a.exr")).unwrap();
    let [columns, rows] = NEAR.map(|range| range.step_by(BLOCK));
    let mean = |x: usize, y: usize| {
        let inside = (0..BLOCK * BLOCK).map(|k| pixels[(y + k / BLOCK) * width + x + k % BLOCK]);
        inside.fold([0.0; 3], |sum: [f32; 3], p| std::array::from_fn(|c| sum[c] + p[c] / (BLOCK * BLOCK) as f32))
    };
    rows.flat_map(|y| columns.clone().map(move |x| (x, y))).map(|(x, y)| mean(x, y)).collect()
}

fn size() -> String {
    format!("{}x{}", SIZE[0], SIZE[1])
}

/// The truth: paths under the light that four bands hold; 16 of them per pixel are 1,024 in a block.
fn truth(folder: &Path, scene: &str, more: &[&str]) -> Vec<[f32; 3]> {
    let paths =
        ["reference", scene, "--light", "bands:4", "--bounces", "1", "--spp", "16", "--size", &size(), "-o", "a.exr"];
    run(folder, &[&paths[..], &LIGHT, more].concat());
    blocks(folder)
}

fn drawn(folder: &Path, scene: &str, bake: &[&str], more: &[&str]) -> Vec<[f32; 3]> {
    let quick = ["--bands", "4", "--rays", "256", "--bounces", "1"];
    run(folder, &[&["bake", scene, "-o", "a.prt"][..], &quick, bake].concat());
    let draw = ["render", "a.prt", "--backend", "cpu", "--size", &size(), "-o", "a.exr"];
    run(folder, &[&draw[..], &LIGHT, more].concat());
    blocks(folder)
}

/// The largest difference of two blocks over the mean of all.
fn worst(a: &[[f32; 3]], truth: &[[f32; 3]]) -> f32 {
    let mean = truth.as_flattened().iter().sum::<f32>() / truth.as_flattened().len() as f32;
    let apart = a.as_flattened().iter().zip(truth.as_flattened()).map(|(a, b)| (a - b).abs());
    apart.fold(0.0, f32::max) / mean
}

#[test]
fn crates_of_the_test_data_have_their_shadow() {
    let Some(data) = testkit::data_dir() else {
        return testkit::skip("cases/crate-on-large-ground");
    };
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let scene = |name: &str| data.join("cases/crate-on-large-ground").join(name).display().to_string();
    let truth = truth(folder, &scene("control-ground-4m.gltf"), &[]);
    for name in ["ground-50m.gltf", "ground-1km.gltf", "control-ground-4m.gltf"] {
        let off = worst(&drawn(folder, &scene(name), &[], &[]), &truth);
        assert!(off <= BOUND, "{name}: {off}");
    }
    let unsplit = drawn(folder, &scene("ground-1km.gltf"), &["--refine", "off"], &[]);
    assert!(worst(&unsplit, &truth) > 2.0 * BOUND, "can fail: {} without splitting", worst(&unsplit, &truth));
}

/// The same kind in small: a red crate off the middle of its ground.
#[test]
fn crates_on_large_grounds_have_their_shadow() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let write = |name: &str, half: f32| {
        let mut ground = Shape::ground(half);
        ground.positions.iter_mut().for_each(|p| *p = [p[0] + 0.24 * (half - 2.0), p[1], p[2] - 0.12 * (half - 2.0)]);
        let crate_ = Shape::cuboid([-0.25, 0.0, -0.25], [0.25, 0.5, 0.25]);
        let parts = [
            ("Ground", ground, material([0.6; 3], json!({}))),
            ("Crate", crate_, material([0.8, 0.1, 0.1], json!({}))),
        ];
        model::write(folder, name, &parts);
    };
    let view = ["--camera", CAMERA];
    write("near.gltf", 2.0);
    let truth = truth(folder, "near.gltf", &view);
    write("far.gltf", 400.0);
    let off = worst(&drawn(folder, "far.gltf", &[], &view), &truth);
    assert!(off <= BOUND, "{off}");
    let unsplit = worst(&drawn(folder, "far.gltf", &["--refine", "off"], &view), &truth);
    assert!(unsplit > BOUND, "can fail: {unsplit} without splitting");
}
