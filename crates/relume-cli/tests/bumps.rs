//! Normal maps show with plain commands, as the path tracer has them; where they are left out it is said.

mod command;

use command::{complaint, relume};
use std::path::Path;

const LOOK: [&str; 8] = ["--size", "128x96", "--probe", "builtin:sky", "--window", "none", "-o", "a.exr"];

fn run(folder: &Path, arguments: &[&str]) -> String {
    let output = relume(folder, arguments);
    let text = complaint(&output);
    assert_eq!(output.status.code(), Some(0), "{arguments:?}: {text}");
    text
}

/// Means of blocks of 4 by 4 pixels of the picture that was drawn last.
fn blocks(folder: &Path) -> Vec<f32> {
    let (width, _, pixels) = probe_io::read_picture(&folder.join("a.exr")).unwrap();
    let mut sums = vec![0.0; pixels.len() / 16];
    for (k, pixel) in pixels.iter().enumerate() {
        let (x, y) = (k % width, k / width);
        sums[y / 4 * (width / 4) + x / 4] += pixel.iter().sum::<f32>() / 48.0;
    }
    sums
}

fn difference(a: &[f32], b: &[f32]) -> f32 {
    a.iter().zip(b).map(|(a, b)| (a - b).abs()).sum::<f32>() / b.iter().sum::<f32>()
}

#[test]
fn bumps_show_as_paths_have_them() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let quick = ["--bands", "5", "--rays", "128", "--bounces", "1"];
    let bake = |more: &[&str]| run(folder, &[&["bake", "builtin:bumps", "-o", "a.prt"], &quick[..], more].concat());
    let draw = || run(folder, &[&["render", "a.prt", "--backend", "cpu"][..], &LOOK].concat());
    let paths = ["reference", "builtin:bumps", "--normal-maps", "--light", "bands:5", "--bounces", "1", "--spp", "64"];
    run(folder, &[&paths[..], &LOOK].concat());
    let exact = blocks(folder);
    assert!(!bake(&[]).contains("normal maps are left out"));
    assert!(!draw().contains("normal maps are left out"));
    let bent = difference(&blocks(folder), &exact);
    let text = bake(&["--effects", "visibility,interreflection,color"]);
    assert!(text.contains("normal maps are left out: left out by --effects"), "{text}");
    assert!(draw().contains("normal maps are left out"));
    let plain = difference(&blocks(folder), &exact);
    assert!(bent < 0.08, "{bent} of the light is off");
    assert!(plain > 2.5 * bent, "can fail: {plain} without normal maps, {bent} with them");
}
