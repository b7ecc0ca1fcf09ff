//! Pictures that were looked at once and found good: today's must be the same.
//!
//! `cargo xtask golden check` runs this, `cargo xtask golden bless NAME` accepts what is drawn today. They tell it by
//! `RELUME_GOLDEN`, the name of one picture, and `RELUME_BLESS`. A picture that differs is left in `target/golden/current`
//! with a map of its errors.

mod command;

use command::{complaint, relume};
use std::path::{Path, PathBuf};

/// A picture of a built-in scene under a built-in light.
struct Golden {
    name: &'static str,
    scene: &'static str,
    probe: &'static str,
    turn: &'static str,
}

const PICTURES: [Golden; 4] = [
    Golden { name: "sphere-on-plane", scene: "builtin:sphere-on-plane", probe: "builtin:cone", turn: "0,0,0" },
    Golden { name: "cornell-box", scene: "builtin:cornell-box", probe: "builtin:two-lights", turn: "0,0,0" },
    Golden { name: "teacup", scene: "builtin:teacup", probe: "builtin:studio", turn: "30,0,0" },
    Golden { name: "atrium", scene: "builtin:atrium", probe: "builtin:sky", turn: "0,0,0" },
];

/// Largest mean difference, of 255: half a step of a byte. Bakes are the same on any x86-64 machine; elsewhere roundings differ.
const MEAN: f64 = 0.5;
/// Largest share of values that differ by more than [`FAR`] of 255: a rounding may give a pixel on an edge to the neighbour.
const SHARE: f64 = 0.005;
const FAR: u8 = 8;

type Picture = image::RgbImage;

#[test]
fn pictures_are_as_they_were() {
    let wanted = std::env::var("RELUME_GOLDEN").ok();
    let bless = std::env::var_os("RELUME_BLESS").is_some();
    let chosen: Vec<&Golden> = PICTURES.iter().filter(|p| wanted.as_ref().is_none_or(|w| w == p.name)).collect();
    let names: Vec<&str> = PICTURES.iter().map(|p| p.name).collect();
    assert!(!chosen.is_empty(), "no golden picture is called {wanted:?}; there are {names:?}");
    let faults: Vec<String> = chosen.into_iter().filter_map(|golden| check(golden, bless)).collect();
    assert!(faults.is_empty(), "{}", faults.join("\n"));
}

/// A light turned by fifteen degrees, or 7 % brighter, is another picture. The window leaves little of five degrees.
#[test]
fn pictures_can_fail() {
    let golden = &PICTURES[0];
    let stored = open(&stored(golden.name));
    assert!(difference(&draw(golden, &["--rotate", "0,0,0"]), &stored).is_ok());
    for other in [["--rotate", "15,0,0"], ["--exposure", "0.1"]] {
        let drawn = draw(golden, &other);
        assert!(difference(&drawn, &stored).is_err(), "{other:?} must be seen");
    }
}

/// What is wrong with the picture of today; blessing makes it the one to compare with.
fn check(golden: &Golden, bless: bool) -> Option<String> {
    let name = golden.name;
    let drawn = draw(golden, &["--rotate", golden.turn]);
    if bless {
        drawn.save(stored(name)).unwrap();
        return None;
    }
    let stored = open(&stored(name));
    let reason = difference(&drawn, &stored).err()?;
    let folder = current();
    std::fs::create_dir_all(&folder).unwrap();
    let path = folder.join(format!("{name}.png"));
    drawn.save(&path).unwrap();
    if drawn.dimensions() == stored.dimensions() {
        error_map(&drawn, &stored).save(folder.join(format!("{name}-error.png"))).unwrap();
    }
    Some(format!("{name}: {reason}; see {}, and `cargo xtask golden bless {name}` if it is right", path.display()))
}

/// Bakes and draws on the CPU, by the executable.
fn draw(golden: &Golden, more: &[&str]) -> Picture {
    let folder = tempfile::tempdir().unwrap();
    let bake = ["bake", golden.scene, "-o", "a.prt", "--rays", "256", "--bounces", "2", "-q"];
    let render = ["render", "a.prt", "--probe", golden.probe, "-o", "a.png", "--size", "192x144", "--backend", "cpu"];
    for arguments in [&bake[..], &[&render[..], more].concat()] {
        let output = relume(folder.path(), arguments);
        assert!(output.status.success(), "{arguments:?}: {}", complaint(&output));
    }
    open(&folder.path().join("a.png"))
}

/// Says by how much two pictures differ, where that is too much.
fn difference(a: &Picture, b: &Picture) -> Result<(), String> {
    if a.dimensions() != b.dimensions() {
        return Err(format!("{:?} pixels instead of {:?}", a.dimensions(), b.dimensions()));
    }
    let count = a.len() as f64;
    let differences = || a.iter().zip(b.iter()).map(|(a, b)| a.abs_diff(*b));
    let mean = differences().map(f64::from).sum::<f64>() / count;
    let share = differences().filter(|d| *d > FAR).count() as f64 / count;
    if mean > MEAN || share > SHARE {
        return Err(format!(
            "differs by {mean:.2} of 255 on average, and by more than {FAR} in {:.1} %",
            100.0 * share
        ));
    }
    Ok(())
}

/// Eight times the difference: black where the pictures are the same.
fn error_map(a: &Picture, b: &Picture) -> Picture {
    let mut map = a.clone();
    map.iter_mut().zip(b.iter()).for_each(|(value, b)| *value = value.abs_diff(*b).saturating_mul(8));
    map
}

fn open(path: &Path) -> Picture {
    image::open(path).unwrap_or_else(|e| panic!("cannot read {}: {e}", path.display())).to_rgb8()
}

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

fn stored(name: &str) -> PathBuf {
    root().join("tests/golden").join(format!("{name}.png"))
}

/// `target/golden/current`, wherever cargo keeps its outputs.
fn current() -> PathBuf {
    let target = std::env::var_os("CARGO_TARGET_DIR").map_or_else(|| root().join("target"), PathBuf::from);
    target.join("golden/current")
}
