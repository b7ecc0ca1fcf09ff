//! Help ends with 0, wrong usage with 2 and a reason.

mod command;

use command::{complaint, relume};
use std::path::Path;

const COMMANDS: [&str; 11] =
    ["plan", "bake", "render", "reference", "inspect", "export", "light", "cost", "bases", "uv", "list"];

#[test]
fn every_command_has_help() {
    for command in COMMANDS {
        let output = relume(Path::new("."), &[command, "--help"]);
        let text = String::from_utf8_lossy(&output.stdout).into_owned();
        assert_eq!(output.status.code(), Some(0), "{command}: {}", complaint(&output));
        assert!(text.contains("--threads") && text.contains("--quiet"), "{command}: {text}");
        assert!(text.contains("Example") || command == "list", "{command} has no example: {text}");
    }
}

/// Commands of later work are not promised.
#[test]
fn help_names_only_what_there_is() {
    let output = relume(Path::new("."), &["--help"]);
    let text = String::from_utf8_lossy(&output.stdout).into_owned();
    assert!(COMMANDS.iter().all(|command| text.contains(&format!("  {command}"))), "{text}");
}

#[test]
fn list_names_what_is_built_in() {
    let output = relume(Path::new("."), &["list"]);
    let text = String::from_utf8_lossy(&output.stdout).into_owned();
    assert!(text.contains("builtin:cornell-box") && text.contains("builtin:sky"), "{text}");
}

#[test]
fn wrong_usage_ends_with_2_and_a_reason() {
    let cases: &[(&[&str], &str)] = &[
        (&[], "Usage"),
        (&["frobnicate"], "frobnicate"),
        (&["cost", "builtin:plane", "-o", "a"], "--probe"),
        (&["cost", "builtin:plane", "--probe", "builtin:sky", "-o", "a", "--budget", "0"], "seconds"),
        (&["cost", "builtin:plane", "--probe", "builtin:sky", "-o", "a", "--target-error", "7"], "--target-error"),
        (&["cost", "builtin:plane", "--probe", "builtin:sky", "-o", "a", "--camera", "nowhere"], "nowhere"),
        (&["bake", "builtin:plane"], "--output"),
        (&["bake", "builtin:nowhere", "-o", "a.prt"], "atrium"),
        (&["bake", "builtin:plane", "-o", "a.prt", "--rays", "9", "--error", "0.1"], "cannot be used with"),
        (&["bake", "builtin:plane", "-o", "a.prt", "--storage", "cloud"], "cloud"),
        (&["bake", "builtin:plane", "-o", "a.prt", "--bands", "0"], "--bands"),
        (&["bake", "builtin:plane", "-o", "a.prt", "--bands", "many"], "many"),
        (&["bake", "builtin:plane", "-o", "a.prt", "--effects", "magic"], "magic"),
        (&["bake", "builtin:plane", "-o", "a.prt", "--bounces", "-1"], "-1"),
        (&["bake", "builtin:plane", "-o", "a.prt", "--memory", "lots"], "lots"),
        (&["bake", "builtin:plane", "-o", "a.prt", "--threads", "0"], "--threads"),
        (&["bake", "builtin:plane", "-o", "a.prt", "-q", "-v"], "cannot be used with"),
        (&["render", "a.prt", "-o", "a.png"], "--probe"),
        (&["render", "a.prt", "--probe", "builtin:sky", "-o", "a.jpg"], ".png"),
        (&["render", "a.prt", "--probe", "builtin:sky", "-o", "a.png", "--size", "0x5"], "960x540"),
        (&["render", "a.prt", "--probe", "builtin:sky", "-o", "a.png", "--rotate", "1,2"], "90,0,0"),
        (&["render", "a.prt", "--probe", "builtin:sky", "-o", "a.png", "--camera", "1,2,3"], "seven numbers"),
        (&["render", "a.prt", "--probe", "builtin:sky", "-o", "a.png", "--backend", "magic"], "magic"),
        (&["render", "a.prt", "--probe", "builtin:sky", "-o", "a.png", "--basis", "h5"], "modified-h6"),
        (&["render", "a.prt", "--probe", "builtin:sky", "-o", "a.png", "--functions", "few"], "few"),
        (&["render", "a.prt", "--probe", "builtin:sky", "-o", "a.png", "--albedo", "dim"], "dim"),
        (&["reference", "builtin:plane", "--probe", "builtin:sky", "-o", "a.exr", "--light", "some"], "bands:N"),
        (&["reference", "builtin:plane", "--probe", "builtin:sky", "-o", "a.exr", "--spp", "0"], "--spp"),
        (
            &["reference", "builtin:plane", "--probe", "builtin:sky", "-o", "a.exr", "--window", "auto"],
            "--light bands:N",
        ),
        (&["plan", "builtin:plane", "--time", "5m"], "--time"),
        (&["bake", "builtin:plane", "-o", "a.prt", "--time", "1e30h"], "30 days"),
        (&["light", "builtin:sky", "--bands", "1000", "-o", "a.npy"], "129"),
        (&["light", "builtin:nothing", "-o", "a.npy"], "sky"),
        (&["export", "a.prt", "--format", "fbx", "-o", "a"], "fbx"),
    ];
    let folder = tempfile::tempdir().unwrap();
    for (arguments, reason) in cases {
        let output = relume(folder.path(), arguments);
        let text = complaint(&output);
        assert_eq!(output.status.code(), Some(2), "{arguments:?}: {text}");
        assert!(text.contains(reason), "{arguments:?} says nothing of {reason}: {text}");
        assert!(!text.contains("panicked"), "{arguments:?}: {text}");
    }
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 0, "wrong usage must leave nothing behind");
}
