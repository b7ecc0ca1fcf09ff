//! `relume light` and the options with which probes are read.

mod command;

use command::{complaint, relume};
use std::path::Path;

/// The coefficients that the command writes, `[coefficient][channel]`.
fn light(folder: &Path, arguments: &[&str]) -> Vec<[f64; 3]> {
    let output = relume(folder, &[&["light", "--format", "json", "-o", "l.json"], arguments].concat());
    assert_eq!(output.status.code(), Some(0), "{arguments:?}: {}", complaint(&output));
    let text = std::fs::read(folder.join("l.json")).unwrap();
    let value: serde_json::Value = serde_json::from_slice(&text).unwrap();
    let row = |row: &serde_json::Value| std::array::from_fn(|c| row[c].as_f64().unwrap());
    value["coefficients"].as_array().unwrap().iter().map(row).collect()
}

/// The mean direction of the red light, from the second band: y, z and x stand at 1, 2 and 3.
fn direction(light: &[[f64; 3]]) -> [f64; 3] {
    [light[3][0], light[1][0], light[2][0]]
}

fn distance(a: [f64; 3], b: [f64; 3]) -> f64 {
    a.iter().zip(b).map(|(a, b)| (a - b) * (a - b)).sum::<f64>().sqrt()
}

#[test]
fn lights_are_turned_about_their_own_axes() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let [x, y, z] = direction(&light(folder, &["builtin:sky"]));
    // By hand: yaw takes z to x, pitch y to z, roll x to y; the last one named is done first.
    for (turns, expected) in [
        ("0,0,0", [x, y, z]),
        ("90,0,0", [z, y, -x]),
        ("0,90,0", [x, -z, y]),
        ("0,0,90", [-y, x, z]),
        ("90,90,0", [y, -z, -x]),
        ("0,90,90", [-y, -z, x]),
    ] {
        let found = direction(&light(folder, &["builtin:sky", "--rotate", turns]));
        assert!(distance(found, expected) < 1e-4, "{turns}: {found:?} is not {expected:?}");
    }
    // Turns about the axes of the world would give something else.
    let found = direction(&light(folder, &["builtin:sky", "--rotate", "90,90,0"]));
    assert!(distance(found, [z, x, y]) > 0.1, "{found:?}");
}

#[test]
fn windows_leave_the_mean_and_dim_the_rest() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let plain = light(folder, &["builtin:sky"]);
    assert_eq!(light(folder, &["builtin:sky", "--window", "none"]), plain);
    let windowed = light(folder, &["builtin:sky", "--window", "auto"]);
    assert_eq!(windowed[0], plain[0]);
    let power = |light: &[[f64; 3]]| light[9..].iter().flatten().map(|v| v * v).sum::<f64>();
    assert!(power(&windowed) < 0.9 * power(&plain), "{} of {}", power(&windowed), power(&plain));
}

#[test]
fn probes_are_read_as_the_options_say() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let mut pixels = vec![[1.0f32; 3]; 128];
    pixels[20] = [f32::INFINITY; 3];
    probe_io::write_exr(&folder.join("sun.exr"), 16, 8, &pixels).unwrap();
    let output = relume(folder, &["light", "sun.exr", "-o", "l.npy"]);
    assert_eq!(output.status.code(), Some(1));
    let told = complaint(&output);
    assert!(told.contains("pixel (4, 1)") && told.contains("--nonfinite clamp"), "{told}");
    pixels[20] = [65_504.0; 3];
    probe_io::write_exr(&folder.join("half.exr"), 16, 8, &pixels).unwrap();
    assert_eq!(light(folder, &["sun.exr", "--nonfinite", "clamp"]), light(folder, &["half.exr"]));
    let output = relume(folder, &["light", "half.exr", "--layer", "beauty\u{1b}[2J", "-o", "l.npy"]);
    let told = complaint(&output);
    assert_eq!(output.status.code(), Some(1));
    assert!(told.contains("no layer") && told.contains("beauty") && !told.contains('\u{1b}'), "{told}");
}

/// Coefficients are numbers: light whose sum would be none is refused.
#[test]
fn light_beyond_all_numbers_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let mut pixels = vec![[1e38f32; 3]; 128];
    probe_io::write_exr(&folder.join("a.exr"), 16, 8, &pixels).unwrap();
    for probe in ["a.exr", "builtin:constant:1e38"] {
        let output = relume(folder, &["light", probe, "-o", "l.json"]);
        let told = complaint(&output);
        assert!(output.status.code() == Some(1) && told.contains("1e38") && told.contains("1e30"), "{told}");
        assert!(!folder.join("l.json").exists());
    }
    pixels.fill([1e30; 3]);
    probe_io::write_exr(&folder.join("a.exr"), 16, 8, &pixels).unwrap();
    assert!(light(folder, &["a.exr"]).iter().flatten().all(|value| value.is_finite()), "can fail");
}

/// Minus infinity is no light, and not the largest there is.
#[test]
fn minus_infinity_becomes_nothing_and_is_told() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let mut pixels = vec![[1.0f32; 3]; 128];
    pixels[20] = [f32::NEG_INFINITY; 3];
    probe_io::write_exr(&folder.join("a.exr"), 16, 8, &pixels).unwrap();
    let told = complaint(&relume(folder, &["light", "a.exr", "--nonfinite", "clamp", "-o", "l.npy"]));
    assert!(told.contains("1 of minus infinity 0") && told.contains("0 infinite ones"), "{told}");
    pixels[20] = [0.0; 3];
    probe_io::write_exr(&folder.join("b.exr"), 16, 8, &pixels).unwrap();
    assert_eq!(light(folder, &["a.exr", "--nonfinite", "clamp"]), light(folder, &["b.exr"]));
}
