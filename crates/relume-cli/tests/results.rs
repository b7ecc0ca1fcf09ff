//! What the commands write is what they say: from a scene to a file to pictures and arrays.

mod command;

use command::{command, complaint, relume};
use std::fs;
use std::path::Path;

/// Runs a command that must succeed; returns stdout and stderr.
fn succeed(folder: &Path, arguments: &[&str]) -> (String, String) {
    let output = relume(folder, arguments);
    let text = complaint(&output);
    assert_eq!(output.status.code(), Some(0), "{arguments:?}: {text}");
    (String::from_utf8_lossy(&output.stdout).into_owned(), text)
}

fn json(folder: &Path, arguments: &[&str]) -> serde_json::Value {
    serde_json::from_str(&succeed(folder, arguments).0).unwrap()
}

#[test]
fn a_bake_tells_what_it_holds() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let plan = json(folder, &["plan", "builtin:half-blocked-plane", "--probe", "builtin:sky", "--json"]);
    assert!(plan["plan"]["receivers"].as_u64().unwrap() > 0);
    assert!(plan["light"]["lamps"].as_u64().unwrap() > 0);
    let rows = plan["plan"]["rows"].as_array().unwrap();
    assert_eq!(rows.len(), 11);
    assert!(rows.iter().all(|row| row["seconds"].is_number() && row["at_stake"].is_string()), "{rows:?}");
    assert!(plan["seconds"]["together"].as_f64().unwrap() > 0.0 && plan["plan"]["meshes"][0]["name"].is_string());
    let bake = ["bake", "builtin:half-blocked-plane", "-o", "a.prt", "--bands", "3", "--rays", "64", "--seed", "5"];
    let (out, said) = succeed(folder, &bake);
    assert!(out.is_empty() && said.contains("a.prt") && said.contains("rays"), "{said}");
    let seen = json(folder, &["inspect", "a.prt", "--json"]);
    assert_eq!(seen["version"], 5);
    assert_eq!(seen["header"]["settings"]["seed"], 5);
    assert_eq!(seen["header"]["bands"], 3);
    assert_eq!(seen["file_length"], fs::metadata(folder.join("a.prt")).unwrap().len());
    assert!(seen["chunks"].as_array().unwrap().iter().all(|chunk| chunk["sound"] == true));
    let cost = &seen["header"]["achieved"]["effects"][0];
    assert_eq!((cost["effect"].as_str(), cost["rays"].as_u64() > Some(0)), (Some("Visibility"), true), "{cost}");
    assert!(cost["saved_rays"].as_u64() > Some(0), "most of the plane has a closed form: {cost}");
    let (text, _) = succeed(folder, &["inspect", "a.prt"]);
    assert!(text.contains("saved") && text.contains("closed form"), "{text}");
    assert!(text.contains("half-blocked-plane") && text.contains("TRAN") && text.contains("visibility"), "{text}");
}

/// A white light shows one band, and auto bakes no more; a number is kept to.
#[test]
fn bands_that_the_light_cannot_show_are_left_out() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    for (bands, light, expected) in
        [("auto", "builtin:white", 1), ("5", "builtin:white", 5), ("auto:4", "builtin:sky", 3)]
    {
        succeed(folder, &["bake", "builtin:plane", "-o", "a.prt", "--bands", bands, "--probe", light]);
        let seen = json(folder, &["inspect", "a.prt", "--json"]);
        assert_eq!(seen["header"]["bands"], expected, "--bands {bands} under {light}");
    }
}

/// Threads change nothing: the file is the same byte by byte.
#[test]
fn threads_do_not_change_a_bake() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    for (name, threads, seed) in [("1.prt", "1", "0"), ("2.prt", "3", "0"), ("other.prt", "1", "1")] {
        let bake = [
            "bake",
            "builtin:half-blocked-plane",
            "-o",
            name,
            "--rays",
            "64",
            "--threads",
            threads,
            "--seed",
            seed,
            "-q",
        ];
        let (_, said) = succeed(folder, &bake);
        assert!(said.is_empty(), "-q must be quiet: {said}");
    }
    let bytes = |name: &str| fs::read(folder.join(name)).unwrap();
    assert_eq!(bytes("1.prt"), bytes("2.prt"));
    // The comparison can fail: another seed is another file.
    assert_ne!(bytes("1.prt"), bytes("other.prt"));
}

/// From a scene to its picture twice: file and pictures are the same byte by byte.
#[test]
fn the_same_commands_give_the_same_bytes() {
    let folders = [tempfile::tempdir().unwrap(), tempfile::tempdir().unwrap()];
    let names = ["a.prt", "a.png", "a.exr", "other.png"];
    let [first, second] = folders.each_ref().map(|folder| {
        let folder = folder.path();
        succeed(folder, &["bake", "builtin:cornell-box", "-o", "a.prt", "--bands", "3", "--rays", "64"]);
        for (picture, turn) in [("a.png", "0,0,0"), ("a.exr", "0,0,0"), ("other.png", "10,0,0")] {
            let light = ["--probe", "builtin:studio", "--rotate", turn];
            let render = ["render", "a.prt", "-o", picture, "--size", "96x64", "--backend", "cpu"];
            succeed(folder, &[&render[..], &light].concat());
        }
        names.map(|name| fs::read(folder.join(name)).unwrap())
    });
    for (name, (a, b)) in names.iter().zip(first.iter().zip(&second)) {
        assert!(a == b, "{name} differs from one run to the next");
    }
    // The comparison can fail: a light turned by ten degrees is another picture.
    assert!(first[1] != first[3], "the turned light must show");
}

/// Whatever drivers there are, none is in sight: the CPU draws and says so.
#[test]
fn without_any_driver_the_cpu_draws() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    succeed(folder, &["bake", "builtin:sphere", "-o", "a.prt", "--bands", "2"]);
    let render = ["render", "a.prt", "--probe", "builtin:sky", "-o", "a.png", "--size", "32x32"];
    let mut command = command(folder, &render);
    command.env_remove("WGPU_BACKEND").env("__EGL_VENDOR_LIBRARY_FILENAMES", "/nonexistent");
    let output = command.output().unwrap();
    let said = complaint(&output);
    assert!(output.status.success() && said.contains("on the CPU"), "{said}");
    assert!(folder.join("a.png").exists());
}

/// A plane of albedo a under a white sky has radiance a; the sky behind has 1.
#[test]
fn a_white_sky_gives_the_albedo() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    succeed(folder, &["bake", "builtin:plane", "-o", "a.prt", "--bands", "3"]);
    let render = ["render", "a.prt", "--probe", "builtin:white", "-o", "a.exr", "--size", "64x48"];
    let (_, said) = succeed(folder, &render);
    assert!(said.contains("drawing on the CPU: no graphics driver"), "the fall-back must be told: {said}");
    let scene = scene::builtin("plane").unwrap();
    let albedo = scene.albedo(0, 0, 0.3, 0.3);
    let (width, height, pixels) = probe_io::read_picture(&folder.join("a.exr")).unwrap();
    assert_eq!((width, height), (64, 48));
    let near = |a: [f32; 3], b: [f32; 3]| a.iter().zip(b).all(|(a, b)| (a - b).abs() < 1e-3);
    assert!(near(pixels[0], [1.0; 3]), "the sky: {:?}", pixels[0]);
    let plane = pixels.iter().filter(|pixel| near(**pixel, albedo.to_array())).count();
    assert!(plane > 200, "only {plane} pixels show the plane with its albedo of {albedo}");
    let darker = [&render[..], &["--exposure", "-1"]].concat();
    succeed(folder, &darker);
    let (_, _, pixels) = probe_io::read_picture(&folder.join("a.exr")).unwrap();
    assert!(near(pixels[0], [0.5; 3]), "the sky, one stop darker: {:?}", pixels[0]);
}

#[test]
fn frames_are_numbered_and_timed() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    succeed(folder, &["bake", "builtin:sphere", "-o", "a.prt", "--bands", "3"]);
    let render = ["render", "a.prt", "--probe", "builtin:directional", "--backend", "cpu", "--size", "48x48"];
    let (out, _) = succeed(folder, &[&render[..], &["--frames", "4", "-o", "f.png"]].concat());
    assert!(out.contains("4 frames") && out.contains("ms"), "{out}");
    succeed(folder, &[&render[..], &["--rotate", "90,0,0", "-o", "turned.png"]].concat());
    let bytes = |name: &str| fs::read(folder.join(name)).unwrap();
    assert_eq!(bytes("f-0001.png"), bytes("turned.png"), "frame 1 of 4 is a quarter turn");
    assert_ne!(bytes("f-0000.png"), bytes("turned.png"), "a light from the side must change when it is turned");
    assert!(folder.join("f-0003.png").exists() && !folder.join("f-0004.png").exists());
}

#[test]
fn a_missing_gpu_is_an_error_where_it_was_asked_for() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    succeed(folder, &["bake", "builtin:plane", "-o", "a.prt", "--bands", "2"]);
    let output = relume(folder, &["render", "a.prt", "--probe", "builtin:white", "-o", "a.png", "--backend", "gpu"]);
    assert_eq!(output.status.code(), Some(1), "{}", complaint(&output));
    assert!(complaint(&output).contains("adapter"), "{}", complaint(&output));
    let render = ["render", "a.prt", "--probe", "builtin:white", "-o", "a.png", "--camera", "nobody"];
    let output = relume(folder, &render);
    assert_eq!(output.status.code(), Some(2), "{}", complaint(&output));
    assert!(complaint(&output).contains("nobody"), "{}", complaint(&output));
    assert!(!folder.join("a.png").exists());
}

/// Under a white sky the reference shows the albedo too, and so does its reconstruction from few bands.
#[test]
fn the_reference_agrees_on_a_plane() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let albedo = scene::builtin("plane").unwrap().albedo(0, 0, 0.3, 0.3).to_array();
    for light in ["full", "bands:3"] {
        let reference = ["reference", "builtin:plane", "--probe", "builtin:white", "-o", "r.exr", "--size", "32x24"];
        succeed(folder, &[&reference[..], &["--light", light, "--spp", "64"]].concat());
        let (_, _, pixels) = probe_io::read_picture(&folder.join("r.exr")).unwrap();
        let near = |pixel: &&[f32; 3]| pixel.iter().zip(albedo).all(|(p, a)| (p - a).abs() < 0.02);
        let plane = pixels.iter().filter(near).count();
        assert!(plane > 50, "{light}: only {plane} pixels show the plane with its albedo of {albedo:?}");
    }
}

/// Under the same window, the path tracer's plane is as bright as the baked one; without it, it is not.
#[test]
fn the_reference_sees_the_same_window() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    succeed(folder, &["bake", "builtin:plane", "-o", "p.prt"]);
    let common = ["--probe", "builtin:sky", "--camera", "0,2,0.5,0,0,0,60", "--size", "32x24"];
    let mean = |file: &str| {
        let (_, _, pixels) = probe_io::read_picture(&folder.join(file)).unwrap();
        pixels.as_flattened().iter().map(|&v| f64::from(v)).sum::<f64>() / pixels.len() as f64
    };
    succeed(folder, &[&["render", "p.prt", "-o", "b.exr", "--window", "auto"], &common[..]].concat());
    let baked = mean("b.exr");
    for (window, same) in [("auto", true), ("none", false)] {
        let traced =
            ["reference", "builtin:plane", "-o", "r.exr", "--light", "bands:5", "--spp", "256", "--window", window];
        succeed(folder, &[&traced[..], &common[..]].concat());
        let difference = (mean("r.exr") / baked - 1.0).abs();
        assert_eq!(difference < 0.02, same, "--window {window}: {difference}");
    }
}

#[test]
fn exports_have_the_shapes_that_they_promise() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    succeed(folder, &["bake", "builtin:cornell-box", "-o", "a.prt", "--bands", "2", "--rays", "32"]);
    succeed(folder, &["export", "a.prt", "--format", "npy", "-o", "out"]);
    let rows = json(folder, &["inspect", "a.prt", "--json"])["vertices"].as_u64().unwrap();
    let header = String::from_utf8_lossy(&fs::read(folder.join("out/transfer.npy")).unwrap()[..128]).into_owned();
    assert!(header.contains(&format!("({rows}, 4, 3")), "{header}");
    succeed(folder, &["light", "builtin:white", "--bands", "2", "--format", "json", "-o", "l.json"]);
    let light: serde_json::Value = serde_json::from_slice(&fs::read(folder.join("l.json")).unwrap()).unwrap();
    let first = light["coefficients"][0][1].as_f64().unwrap();
    assert!((first - (4.0 * std::f64::consts::PI).sqrt()).abs() < 1e-3, "{first}");
    assert!(light["coefficients"][3][2].as_f64().unwrap().abs() < 1e-4);
}

/// Drivers complain on stderr where there is no display; nobody needs one to time frames.
#[test]
fn a_study_says_nothing_of_displays() {
    let folder = tempfile::tempdir().unwrap();
    let study = ["cost", "builtin:plane", "--probe", "builtin:sky", "-o", "c", "--budget", "1", "--bands", "2"];
    let mut command = command(folder.path(), &study);
    command.env_remove("VK_DRIVER_FILES").env_remove("WGPU_BACKEND").env_remove("XDG_RUNTIME_DIR");
    let output = command.output().unwrap();
    let said = complaint(&output);
    assert!(output.status.success() && !said.contains("XDG_RUNTIME_DIR"), "{said}");
}
