//! How light maps are looked at, and what is said where there are none.

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

/// Maps that hold the light of one probe can be drawn in any basis, but not turned.
#[test]
fn fixed_maps_are_drawn_as_they_lay() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let light = ["--light", "fixed", "--probe", "builtin:sky"];
    let bake = ["bake", "builtin:plane", "-o", "a.prt", "--bands", "3", "--storage", "texture", "--texels", "16"];
    let output = relume(folder, &[&bake[..], &light].concat());
    assert_eq!(output.status.code(), Some(0), "{}", complaint(&output));
    for options in [["--rotate", "10,0,0"], ["--frames", "2"]] {
        let output = relume(folder, &[&RENDER[..], &options].concat());
        let text = complaint(&output);
        assert_eq!(output.status.code(), Some(2), "{options:?}: {text}");
        assert!(text.contains("`builtin:sky`") && text.lines().count() == 1, "{options:?}: {text}");
        assert_eq!(std::fs::read_dir(folder).unwrap().count(), 1, "nothing is drawn");
    }
    let picture = |options: &[&str]| {
        let output = relume(folder, &[&RENDER[..], options].concat());
        let text = complaint(&output);
        assert_eq!(output.status.code(), Some(0), "{options:?}: {text}");
        assert!(text.contains("hold the light of builtin:sky"), "another probe must be told: {text}");
        probe_io::read_picture(&folder.join("a.exr")).unwrap().2
    };
    let own = picture(&[]);
    // Without normal maps the sheet is an ordinary light map, the same in every basis.
    assert!(own == picture(&["--basis", "hl2"]));
    assert!(own != picture(&["--albedo", "off"]));
}
