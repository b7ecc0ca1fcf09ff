//! Slips of the hand: files of the wrong kind, names that are nearly right, outputs that would cost a file.

mod command;

use command::{complaint, relume};
use std::fs;
use std::path::Path;

const SCENE: &str = "v 0 0 0\nv 1 0 0\nv 0 0 -1\nf 1 2 3\n";

/// A folder with a scene, a probe, a baked file and a diary.
fn folder() -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("house.obj"), SCENE).unwrap();
    let light = b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 2\n\x80\x80\x80\x81\x80\x80\x80\x81";
    fs::write(folder.path().join("sky.hdr"), light).unwrap();
    fs::write(folder.path().join("diary.png"), "Monday: rain").unwrap();
    let baked = relume(folder.path(), &["bake", "builtin:plane", "-o", "plane.prt", "--rays", "16"]);
    assert!(baked.status.success(), "{}", complaint(&baked));
    folder
}

/// Name and bytes of all files of a folder.
fn contents(folder: &Path) -> Vec<(String, Vec<u8>)> {
    let entries = fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()).filter(|path| path.is_file());
    let mut files: Vec<_> = entries
        .map(|path| (path.file_name().unwrap().to_string_lossy().into_owned(), fs::read(&path).unwrap()))
        .collect();
    files.sort();
    files
}

/// Each command must fail with a sentence that holds the word, and leave every file as it is.
fn refuse(cases: &[(&[&str], &str)]) {
    let folder = folder();
    let before = contents(folder.path());
    for (arguments, word) in cases {
        let output = relume(folder.path(), arguments);
        let text = complaint(&output);
        assert!(matches!(output.status.code(), Some(1 | 2)), "{arguments:?}: {:?} {text}", output.status);
        assert!(text.contains(word), "{arguments:?} says nothing of {word}: {text}");
        assert!(!text.contains("panicked"), "{arguments:?}: {text}");
        assert!(contents(folder.path()) == before, "{arguments:?} changed a file");
    }
}

#[test]
fn outputs_replace_neither_inputs_nor_strangers() {
    refuse(&[
        (&["bake", "house.obj", "-o", "house.obj"], ".prt"),
        (&["bake", "house.obj", "-o", "sky.hdr"], ".prt"),
        (&["bake", "house.obj", "-o", "baked"], ".prt"),
        (&["light", "sky.hdr", "-o", "sky.hdr"], ".npy"),
        (&["light", "sky.hdr", "-o", "sky.npy", "--format", "json"], "--format"),
        (&["light", "sky.hdr", "-o", "light"], ".npy"),
        (&["render", "plane.prt", "--probe", "sky.hdr", "-o", "sky.hdr"], ".png"),
        (&["render", "plane.prt", "--probe", "sky.hdr", "-o", "plane.prt"], ".png"),
        (&["render", "plane.prt", "--probe", "sky.hdr", "-o", "diary.png"], "no .png file"),
        (&["reference", "house.obj", "--probe", "sky.hdr", "-o", "diary.png"], "no .png file"),
        (&["uv", "house.obj", "--unwrap", "--layout", "diary.png"], "no .png file"),
        (&["export", "plane.prt", "-o", "house.obj"], "is a file"),
        (&["export", "plane.prt", "-o", "."], "no .png file"),
    ]);
}

/// What is written may be written again.
#[test]
fn outputs_replace_their_like() {
    let folder = folder();
    for arguments in [
        &["bake", "builtin:plane", "-o", "plane.prt", "--rays", "16"][..],
        &["export", "plane.prt", "-o", "arrays"],
        &["export", "plane.prt", "-o", "arrays"],
        &["light", "sky.hdr", "-o", "sky.npy"],
        &["light", "sky.hdr", "-o", "sky.npy"],
        &["light", "sky.hdr", "-o", "sky.json"],
        &["light", "sky.hdr", "-o", "sky.json", "--format", "json"],
    ] {
        let output = relume(folder.path(), arguments);
        assert!(output.status.success(), "{arguments:?}: {}", complaint(&output));
    }
}

#[cfg(unix)]
#[test]
fn an_input_by_another_name_is_an_input() {
    let folder = folder();
    let before = contents(folder.path());
    std::os::unix::fs::symlink(folder.path().join("plane.prt"), folder.path().join("link.prt")).unwrap();
    fs::write(folder.path().join("scene.gltf"), "{}").unwrap();
    std::os::unix::fs::symlink(folder.path().join("scene.gltf"), folder.path().join("scene.prt")).unwrap();
    let output = relume(folder.path(), &["bake", "scene.gltf", "-o", "scene.prt"]);
    assert!(complaint(&output).contains("replace the input"), "{}", complaint(&output));
    assert_eq!(fs::read(folder.path().join("scene.gltf")).unwrap(), b"{}");
    assert!(before.iter().all(|(name, bytes)| fs::read(folder.path().join(name)).unwrap() == *bytes));
}

#[test]
fn files_of_another_kind_are_told() {
    refuse(&[
        (&["bake", "plane.prt", "-o", "a.prt"], "relume render"),
        (&["plan", "plane.prt"], "relume render"),
        (&["plan", "sky.hdr"], "--probe"),
        (&["plan", "."], "folder"),
        (&["render", "house.obj", "--probe", "sky.hdr", "-o", "a.png"], "relume bake house.obj -o house.prt"),
        (&["inspect", "house.obj"], "relume bake"),
        (&["inspect", "sky.hdr"], "light probe"),
        (&["inspect", "."], "folder"),
        (&["export", "house.obj", "-o", "a"], "relume bake"),
        (&["render", "plane.prt", "--probe", "house.obj", "-o", "a.png"], "not a light probe"),
        (&["render", "plane.prt", "--probe", "plane.prt", "-o", "a.png"], "not a light probe"),
        (&["light", "house.obj", "-o", "a.npy"], "not a light probe"),
    ]);
}

#[test]
fn near_misses_name_what_was_meant() {
    refuse(&[
        (&["plan", "atrium"], "did you mean builtin:atrium?"),
        (&["plan", "builtin:atrum"], "did you mean builtin:atrium?"),
        (&["plan", "huose.obj"], "did you mean house.obj?"),
        (&["inspect", "plain.prt"], "did you mean plane.prt?"),
        (&["light", "sky", "-o", "a.npy"], "did you mean builtin:sky?"),
        (&["light", "skye.hdr", "-o", "a.npy"], "did you mean sky.hdr?"),
        (&["light", "sky:40,90", "-o", "a.npy"], "did you mean builtin:sky:40,90?"),
        (&["light", "builtin:skye", "-o", "a.npy"], "did you mean builtin:sky?"),
        (&["light", "builtin:sky:abc", "-o", "a.npy"], "ELEVATION"),
        (&["light", "builtin:sky:1,2,3", "-o", "a.npy"], "ELEVATION"),
        (&["light", "builtin:white:2", "-o", "a.npy"], "no numbers"),
        (&["render", "plane.prt", "--probe", "builtin:sky", "-o", "a.png", "--camera", "mian"], "main"),
    ]);
}

#[test]
fn shares_and_signs_are_understood() {
    refuse(&[
        (&["bake", "builtin:plane", "-o", "a.prt", "--error", "-1"], "0.01 or 1%"),
        (&["bake", "builtin:plane", "-o", "a.prt", "--error", "0"], "0.01 or 1%"),
        (&["bake", "builtin:plane", "-o", "a.prt", "--error", "much"], "0.01 or 1%"),
        (&["bake", "builtin:plane", "-o", "a.prt", "--rays", "-5"], "--rays"),
        (&["bake", "builtin:plane", "-o", "a.prt", "--bounces", "-1"], "auto"),
    ]);
    let folder = folder();
    let output = relume(folder.path(), &["bake", "builtin:plane", "-o", "a.prt", "--error", "5%"]);
    assert!(output.status.success(), "{}", complaint(&output));
    let seen = relume(folder.path(), &["inspect", "a.prt"]);
    assert!(String::from_utf8_lossy(&seen.stdout).contains("error 5 %"), "{}", String::from_utf8_lossy(&seen.stdout));
}

/// A minus before a number is a wrong value and no option; complaints of parsers say what to do instead.
#[test]
fn wrong_numbers_are_told_what_they_should_be() {
    let bake = |option: &'static str, value: &'static str| vec!["bake", "builtin:plane", "-o", "a.prt", option, value];
    let draw = |option: &'static str, value: &'static str| {
        vec!["render", "plane.prt", "--probe", "builtin:sky", "-o", "a.png", option, value]
    };
    for (arguments, word) in [
        (bake("--time", "-5"), "give a time above 0"),
        (bake("--memory", "-1"), "such as 500M or 4G"),
        (bake("--memory", "10%"), "such as 500M or 4G"),
        (bake("--seed", "-1"), "give a whole number"),
        (bake("--rays", "1k"), "give a whole number"),
        (bake("--rays", "-5"), "give a whole number from 0 on"),
        (bake("--refine", "-1"), "above 0"),
        (bake("--threads", "-1"), "from 1 to 1024"),
        (bake("--effects", "visiblity"), "did you mean visibility?"),
        (bake("--effects", "all,none"), "interreflection"),
        (draw("--size", "-5x5"), "960x540"),
        (draw("--bloom", "50%"), "give a number"),
        (draw("--frames", "0"), "above 0"),
        (draw("--frames", "-1"), "give a whole number"),
        (vec!["light", "builtin:sky:-10,0", "-o", "a.npy"], "1 to 90 degrees"),
        (vec!["light", "builtin:sphere:0.5", "-o", "a.npy"], "from 1 on"),
        (vec!["light", "builtin:sky 40,90", "-o", "a.npy"], "did you mean builtin:sky?"),
        (vec!["light", "builtin-sky", "-o", "a.npy"], "did you mean builtin:sky?"),
        (vec!["inspect", "builtin:plane"], "relume bake builtin:plane"),
        (vec!["plan", ""], "empty"),
    ] {
        refuse(&[(&arguments, word)]);
    }
}

/// What a file is shows in its bytes, whatever its name says.
#[test]
fn files_under_wrong_names_are_told() {
    let folder = folder();
    for (from, to) in [("plane.prt", "a.glb"), ("sky.hdr", "b.glb"), ("plane.prt", "c.hdr")] {
        fs::copy(folder.path().join(from), folder.path().join(to)).unwrap();
    }
    for name in ["none.glb", "none.prt", "none.hdr"] {
        fs::write(folder.path().join(name), "").unwrap();
    }
    fs::write(folder.path().join("noend"), SCENE).unwrap();
    for (arguments, word) in [
        (["plan", "a.glb"], "relume render"),
        (["plan", "b.glb"], "--probe"),
        (["plan", "none.glb"], "is empty"),
        (["inspect", "none.prt"], "is empty"),
        (["plan", "noend"], "without an ending"),
    ] {
        let text = complaint(&relume(folder.path(), &arguments));
        assert!(text.contains(word), "{arguments:?} says nothing of {word}: {text}");
    }
    for (name, word) in [("c.hdr", "a baked file"), ("none.hdr", "is empty")] {
        let text = complaint(&relume(folder.path(), &["light", name, "-o", "a.npy"]));
        assert!(text.contains(word), "{name} says nothing of {word}: {text}");
    }
}

/// Tables are no wider than the terminal, at any width.
#[test]
fn tables_fit_the_terminal() {
    let folder = folder();
    for columns in [40, 60, 80, 200] {
        for arguments in
            [&["list"][..], &["inspect", "plane.prt"], &["plan", "builtin:cornell-box"], &["uv", "builtin:teacup"]]
        {
            let output =
                command::command(folder.path(), arguments).env("COLUMNS", columns.to_string()).output().unwrap();
            let text = String::from_utf8_lossy(&output.stdout).into_owned();
            let widest = text.lines().map(|line| line.chars().count()).max().unwrap_or(0);
            assert!(widest <= columns && widest > 0, "{arguments:?}: {widest} of {columns}:\n{text}");
        }
    }
    let output = command::command(folder.path(), &["list"]).env("COLUMNS", "200").output().unwrap();
    let widest = String::from_utf8_lossy(&output.stdout).lines().map(|line| line.chars().count()).max();
    assert!(widest > Some(100), "can fail: wide terminals are used");
}

#[cfg(unix)]
#[test]
fn a_folder_that_takes_no_file_is_told_beforehand() {
    use std::os::unix::fs::PermissionsExt;
    let folder = folder();
    let closed = folder.path().join("closed");
    fs::create_dir(&closed).unwrap();
    fs::set_permissions(&closed, fs::Permissions::from_mode(0o555)).unwrap();
    if tempfile::tempfile_in(&closed).is_ok() {
        return testkit::skip("this user may write everywhere: a folder that takes no file");
    }
    for arguments in [
        &["bake", "builtin:atrium", "-o", "closed/a.prt"][..],
        &["light", "builtin:sky", "-o", "closed/a.npy"],
        &["export", "plane.prt", "-o", "closed"],
    ] {
        let output = relume(folder.path(), arguments);
        let text = complaint(&output);
        assert!(
            !output.status.success() && text.contains("closed") && text.contains("another"),
            "{arguments:?}: {text}"
        );
    }
}
