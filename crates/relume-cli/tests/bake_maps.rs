//! Light maps and volumes from scene to picture, at the command line.

mod command;

use coeff_io::{Encoding, MapLight, Prt};
use command::{complaint, relume};
use std::path::Path;

/// Runs a command that must end with `code`; returns what it said.
fn run(folder: &Path, arguments: &[&str], code: i32) -> String {
    let output = relume(folder, arguments);
    let text = complaint(&output);
    assert_eq!(output.status.code(), Some(code), "{arguments:?}: {text}");
    assert!(code != 1 || text.trim_end().lines().count() == 1, "one sentence: {text}");
    text
}

const MAPS: [&str; 9] = ["--storage", "texture", "--texels", "64", "--rays", "32", "--bounces", "0", "-q"];

fn picture(folder: &Path, more: &[&str]) -> Vec<[f32; 3]> {
    let drawn =
        ["render", "a.prt", "--probe", "builtin:sky", "--size", "96x64", "--backend", "cpu", "-o", "a.exr", "-q"];
    run(folder, &[&drawn[..], more].concat(), 0);
    probe_io::read_picture(&folder.join("a.exr")).unwrap().2
}

/// Mean difference of two pictures.
fn difference(a: &[[f32; 3]], b: &[[f32; 3]]) -> f32 {
    let sum: f32 = a.as_flattened().iter().zip(b.as_flattened()).map(|(x, y)| (x - y).abs()).sum();
    sum / (3 * a.len()) as f32
}

/// The scene's own coordinates serve; a normal map shows, one function of six is flat, and another basis is nearly the same.
#[test]
fn maps_are_baked_and_drawn() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    run(folder, &[&["bake", "builtin:bumps", "-o", "a.prt", "--basis", "sh9"][..], &MAPS].concat(), 0);
    let prt = Prt::read(&folder.join("a.prt")).unwrap();
    let maps = prt.maps.as_ref().unwrap();
    assert!(matches!(maps.light, MapLight::Relightable { bands: 5 }), "{:?}", maps.light);
    let [sheet] = &maps.sheets[..] else { panic!("one sheet for both meshes") };
    assert_eq!((sheet.layers.width, sheet.layers.count, sheet.layers.encoding), (64, 9 * 25, Encoding::F16));
    let record = prt.achieved.maps.unwrap();
    assert!(record.texels > 1000 && record.rays[0] > 32 * 1000, "{record:?}");
    let (own, h6) = (picture(folder, &[]), picture(folder, &["--basis", "modified-h6"]));
    let flat = picture(folder, &["--basis", "modified-h6", "--functions", "1"]);
    let (near, far) = (difference(&own, &h6), difference(&own, &flat));
    assert!(near < 0.25 * far && far > 0.01, "{near} from one basis to another, {far} without directions");
    assert!(difference(&own, &picture(folder, &["--rotate", "120,0,0"])) > 0.01, "another light must show");
}

/// Fixed light takes a small part of the bytes; surfaces without normal maps one function.
#[test]
fn light_is_baked_in() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let fixed = ["--probe", "builtin:sky", "--light", "fixed", "--window", "auto", "--encoding", "u8"];
    run(folder, &[&["bake", "builtin:sphere-on-plane", "-o", "a.prt"][..], &MAPS, &fixed].concat(), 0);
    let prt = Prt::read(&folder.join("a.prt")).unwrap();
    let maps = prt.maps.unwrap();
    assert_eq!(maps.light, MapLight::Fixed { probe: "builtin:sky".into(), bands: 5 });
    assert_eq!((maps.sheets[0].layers.count, maps.sheets[0].layers.encoding), (1, Encoding::U8));
    let said = run(folder, &["render", "a.prt", "--probe", "builtin:sky", "--rotate", "90,0,0", "-o", "b.png"], 2);
    assert!(said.contains("builtin:sky") && !folder.join("b.png").exists(), "{said}");
}

/// An object in a scene takes its light from the volume: beside a wall of the court another than in the middle.
#[test]
fn a_visitor_is_lit_by_the_volume() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let quick = ["--rays", "32", "--bounces", "0", "--refine", "off", "-q"];
    run(folder, &[&["bake", "builtin:cornell-box", "-o", "a.prt", "--volume", "5x5x5"][..], &quick].concat(), 0);
    run(folder, &[&["bake", "builtin:sphere", "-o", "ball.prt"][..], &quick].concat(), 0);
    let alone = picture(folder, &[]);
    let at = |place: &str| picture(folder, &["--visitor", "ball.prt", &format!("--at={place}")]);
    assert!(difference(&alone, &at("0,4,1,0.5")) > 1e-3, "the ball is seen");
    let walk =
        ["render", "a.prt", "--probe", "builtin:sky", "--size", "48x32", "--backend", "cpu", "-o", "w.png", "-q"];
    let way = ["--visitor", "ball.prt", "--at=-1.5,4,1,0.5", "--to=1.5,4,1", "--frames", "3"];
    run(folder, &[&walk[..], &way].concat(), 0);
    assert!(folder.join("w-0000.png").exists() && folder.join("w-0002.png").exists());
    let said = run(folder, &["render", "ball.prt", "--probe", "builtin:sky", "--visitor", "a.prt", "-o", "b.png"], 1);
    assert!(said.contains("--volume") && !folder.join("b.png").exists(), "{said}");
}

#[test]
fn what_cannot_be_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let refused = |more: &[&str], why: &str| {
        let said = run(folder, &[&["bake", "builtin:plane", "-o", "a.prt"][..], more].concat(), 2);
        assert!(said.contains(why) && !folder.join("a.prt").exists(), "{more:?}: {said}");
    };
    refused(&["--storage", "texture", "--light", "fixed"], "--probe");
    refused(&["--probe", "builtin:sky", "--light", "fixed"], "--storage texture");
    refused(&["--storage", "texture", "--mapped", "roof"], "--mapped roof");
    refused(&["--storage", "texture", "--basis", "h7"], "modified-h6");
    refused(&["--storage", "texture", "--texels", "3"], "from 16 to 8192");
}
