//! The options of light maps on a file that has none.

mod command;

use command::{complaint, relume};
use std::path::Path;

fn bake(folder: &Path) {
    let output = relume(folder, &["bake", "builtin:plane", "-o", "a.prt", "--bands", "3"]);
    assert_eq!(output.status.code(), Some(0), "{}", complaint(&output));
}

const RENDER: [&str; 8] = ["render", "a.prt", "--probe", "builtin:white", "--size", "64x48", "-o", "a.exr"];

#[test]
fn a_basis_without_light_maps_is_wrong_usage() {
    let folder = tempfile::tempdir().unwrap();
    bake(folder.path());
    for options in [["--basis", "HL2"], ["--functions", "4"]] {
        let output = relume(folder.path(), &[&RENDER[..], &options].concat());
        let text = complaint(&output);
        assert_eq!(output.status.code(), Some(2), "{options:?}: {text}");
        assert!(text.contains("no light maps") && text.lines().count() == 1, "{options:?}: {text}");
        assert!(!folder.path().join("a.exr").exists(), "nothing is drawn");
    }
}

/// Under a white sky a white plane is as bright as the sky; with its albedo it is not.
#[test]
fn without_albedo_the_light_alone_is_drawn() {
    let folder = tempfile::tempdir().unwrap();
    bake(folder.path());
    let dark = |albedo: &str| {
        let output = relume(folder.path(), &[&RENDER[..], &["--albedo", albedo]].concat());
        assert_eq!(output.status.code(), Some(0), "{}", complaint(&output));
        let (_, _, pixels) = probe_io::read_picture(&folder.path().join("a.exr")).unwrap();
        pixels.iter().filter(|pixel| pixel.iter().any(|value| (value - 1.0).abs() > 1e-3)).count()
    };
    let (with, without) = (dark("on"), dark("off"));
    assert!(with > 200 && without == 0, "{with} pixels of the plane with albedo, {without} without");
}
