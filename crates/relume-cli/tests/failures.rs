//! Failures end with 1 and one sentence that names the file; what stood there before still stands.

mod command;

use command::{command, complaint, relume};
use std::fs;
use std::path::Path;

/// Runs a command that must fail, checks the form of its complaint and returns it.
fn fail(folder: &Path, arguments: &[&str]) -> String {
    let output = relume(folder, arguments);
    let text = complaint(&output);
    assert_eq!(output.status.code(), Some(1), "{arguments:?}: {text}");
    assert!(text.starts_with("error: ") && text.trim_end().lines().count() == 1, "{arguments:?}: {text}");
    assert!(!text.contains("panicked"), "{arguments:?}: {text}");
    text
}

/// A baked plane in `folder`.
fn bake(folder: &Path) {
    let output = relume(folder, &["bake", "builtin:plane", "-o", "a.prt", "--rays", "16"]);
    assert!(output.status.success(), "{}", complaint(&output));
}

fn files(folder: &Path) -> Vec<String> {
    let mut names: Vec<String> =
        fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect();
    names.sort();
    names
}

#[test]
fn missing_files_are_named() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    assert!(fail(folder, &["inspect", "none.prt"]).contains("none.prt"));
    assert!(fail(folder, &["export", "none.prt", "-o", "out"]).contains("none.prt"));
    assert!(fail(folder, &["plan", "none.glb"]).contains("none.glb"));
    assert!(fail(folder, &["bake", "none.obj", "-o", "a.prt"]).contains("none.obj"));
    assert!(fail(folder, &["light", "none.hdr", "-o", "a.npy"]).contains("none.hdr"));
    bake(folder);
    assert!(fail(folder, &["render", "a.prt", "--probe", "none.exr", "-o", "a.png"]).contains("none.exr"));
    assert_eq!(files(folder), ["a.prt"]);
}

#[test]
fn outputs_that_cannot_be_written_are_named_before_the_work() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    assert!(fail(folder, &["bake", "builtin:atrium", "-o", "none/a.prt"]).contains("none/a.prt"));
    fs::create_dir(folder.join("a.prt")).unwrap();
    assert!(fail(folder, &["bake", "builtin:atrium", "-o", "a.prt"]).contains("folder"));
    assert_eq!(files(folder), ["a.prt"]);
}

#[test]
fn damaged_files_are_refused_and_old_outputs_stay() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    bake(folder);
    let sound = fs::read(folder.join("a.prt")).unwrap();
    let old = b"\x89PNG\r\n\x1a\nan old picture";
    fs::write(folder.join("a.png"), old).unwrap();
    let mut flipped = sound.clone();
    *flipped.last_mut().unwrap() ^= 1;
    for (bytes, reason) in
        [(&sound[..100], "cut off"), (b"#?RADIANCE", "no .prt"), (&flipped, "damaged"), (b"", "no .prt")]
    {
        fs::write(folder.join("a.prt"), bytes).unwrap();
        let text = fail(folder, &["render", "a.prt", "--probe", "builtin:white", "-o", "a.png"]);
        assert!(text.contains("a.prt") && text.contains(reason), "{text}");
        assert!(fail(folder, &["inspect", "a.prt"]).contains("a.prt"));
        fail(folder, &["export", "a.prt", "-o", "out"]);
    }
    assert_eq!(fs::read(folder.join("a.png")).unwrap(), old);
    assert_eq!(files(folder), ["a.png", "a.prt"]);
}

#[test]
fn hostile_files_end_in_an_error() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    for (name, bytes) in
        [("a.glb", &b"glTF\x02\0\0\0\xff\xff\xff\x7f"[..]), ("a.gltf", b"{"), ("a.obj", b"v 1 2\nf 1 2 3\n")]
    {
        fs::write(folder.join(name), bytes).unwrap();
        fail(folder, &["plan", name]);
        fail(folder, &["bake", name, "-o", "out.prt"]);
    }
    for (name, bytes) in [
        ("a.hdr", &b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 2000000000 +X 2000000000\n"[..]),
        ("a.exr", b"\x76\x2f\x31\x01\x02\0\0\0"),
        ("b.exr", b""),
    ] {
        fs::write(folder.join(name), bytes).unwrap();
        fail(folder, &["light", name, "-o", "out.npy"]);
    }
    assert!(!files(folder).iter().any(|name| name.starts_with("out") || name.ends_with(".part")));
}

/// Every malformed file of the outside collection ends in a clear error or loads: within 10 s and 1 GiB, without a panic.
#[test]
#[cfg(target_os = "linux")]
fn malformed_collection_ends_in_clear_errors() {
    let Some(data) = testkit::data_dir() else {
        return testkit::skip("the collection of malformed files");
    };
    let folder = tempfile::tempdir().unwrap();
    let mut stack = vec![data.join("bad")];
    while let Some(path) = stack.pop() {
        if path.is_dir() {
            stack.extend(fs::read_dir(&path).unwrap().map(|entry| entry.unwrap().path()));
            continue;
        }
        let name = path.to_str().unwrap().to_owned();
        // A whole scene, which is read since Draco is: it takes its time.
        if name.ends_with("awkward-sponza_draco_required.glb") {
            continue;
        }
        let arguments = match path.extension().and_then(|e| e.to_str()) {
            Some("gltf" | "glb" | "obj") => vec!["plan", &name],
            Some("hdr" | "exr") => vec!["light", &name, "--bands", "3", "-o", "out.npy"],
            _ => continue,
        };
        let inner = command(folder.path(), &arguments);
        let mut limited = std::process::Command::new("sh");
        // 1 GiB of address space; what a file of some kilobytes may not reach.
        limited.args(["-c", "ulimit -v 1048576; exec timeout 10 \"$@\"", "sh"]).arg(inner.get_program());
        let output = limited.args(inner.get_args()).arg("--threads=1").current_dir(folder.path()).output().unwrap();
        let text = complaint(&output);
        assert!(matches!(output.status.code(), Some(0 | 1)), "{name}: {:?} {text}", output.status);
        assert!(!text.contains("panicked"), "{name}: {text}");
        let errors = text.lines().filter(|line| line.starts_with("error: ")).count();
        assert_eq!(errors, usize::from(!output.status.success()), "{name}: {text}");
    }
}
