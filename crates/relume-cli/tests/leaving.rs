//! Ctrl-C and a request to terminate end any command at once and leave nothing half written; a time that was given is kept.
//!
//! Nothing sleeps here: a signal follows a line that tells which stage is under way, and waits have limits.

#![cfg(unix)]

mod command;
mod running;

use command::command;
use running::Running;
use std::fs;
use std::path::Path;

fn files(folder: &Path) -> Vec<String> {
    fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect()
}

/// A stage of a command that takes minutes: arguments, the line that tells it.
const STAGES: [(&[&str], &str); 4] = [
    (&["bake", "builtin:atrium", "-o", "a.prt", "--rays", "65536", "--bands", "8", "--refine", "off"], "visibility"),
    (&["bake", "builtin:atrium", "-o", "a.prt", "--refine", "0.02", "--rays", "4096"], "preparation"),
    (&["reference", "builtin:atrium", "--probe", "builtin:sky", "-o", "a.exr", "--spp", "512"], "rows"),
    (&["cost", "builtin:atrium", "--probe", "builtin:sky", "-o", "new/inner", "--budget", "600"], "visibility"),
];

#[test]
fn an_interrupted_command_leaves_nothing() {
    for (arguments, stage) in STAGES {
        for signal in ["INT", "TERM"] {
            let folder = tempfile::tempdir().unwrap();
            let mut running = Running::start(command(folder.path(), arguments));
            running.wait_for(stage);
            running.signal(signal);
            let (code, text) = running.end();
            assert_eq!(code, Some(1), "{arguments:?}: {text}");
            let last = text.lines().last().unwrap();
            assert!(last.starts_with("error: ") && last.contains("cancelled"), "{arguments:?}: {text}");
            assert!(files(folder.path()).is_empty(), "{arguments:?}: {:?}", files(folder.path()));
        }
    }
}

/// Folders that were made for results go with a command that fails; those that were there stay.
#[test]
fn a_command_that_fails_leaves_no_folder() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("a.gltf"), "{}").unwrap();
    fs::create_dir(folder.path().join("old")).unwrap();
    for output in ["new/inner", "old"] {
        let arguments = ["bases", "--scene", "a.gltf", "--probe", "builtin:sky", "-o", output];
        let (code, text) = Running::start(command(folder.path(), &arguments)).end();
        assert_eq!(code, Some(1), "{text}");
        let mut left = files(folder.path());
        left.sort();
        assert_eq!(left, ["a.gltf", "old"], "{text}");
    }
}

/// Without a signal the same command is still at work.
#[test]
fn an_interrupted_command_leaves_nothing_can_fail() {
    let folder = tempfile::tempdir().unwrap();
    let mut running = Running::start(command(folder.path(), STAGES[0].0));
    running.wait_for("visibility");
    running.wait_for("left");
}

#[test]
fn an_interrupted_bake_with_a_time_keeps_its_result() {
    let folder = tempfile::tempdir().unwrap();
    let arguments = ["bake", "builtin:atrium", "-o", "a.prt", "--time", "2h"];
    let mut running = Running::start(command(folder.path(), &arguments));
    running.wait_for("after");
    running.signal("INT");
    let (code, text) = running.end();
    assert_eq!(code, Some(0), "{text}");
    assert!(text.contains("interrupted: the last result stays"), "{text}");
    assert!(text.contains("wrote a.prt"), "{text}");
    assert_eq!(files(folder.path()), ["a.prt"]);
    coeff_io::Prt::read(&folder.path().join("a.prt")).expect("a whole file");
}

/// Whatever the time, there is a result; where it is up, the work under way is left and what was reached is told.
#[test]
fn a_time_that_is_up_keeps_the_last_result() {
    for time in ["0.01", "4s"] {
        let folder = tempfile::tempdir().unwrap();
        let arguments = ["bake", "builtin:atrium", "-o", "a.prt", "--bands", "4", "--time", time];
        let (code, text) = Running::start(command(folder.path(), &arguments)).end();
        assert_eq!(code, Some(0), "{text}");
        assert!(text.contains("after ") && text.contains("wrote a.prt"), "{text}");
        assert!(!text.contains("asked for"), "nobody asked for an error: {text}");
        assert_eq!(files(folder.path()), ["a.prt"]);
        coeff_io::Prt::read(&folder.path().join("a.prt")).expect("a whole file");
    }
}
