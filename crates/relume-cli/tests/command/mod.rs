//! Runs the executable as a user would.

#![allow(dead_code, reason = "each test file uses its own part of this module")]

use std::path::Path;
use std::process::{Command, Output};

/// The executable with `arguments`, in `folder`, without a graphics driver: the same on every machine.
pub(crate) fn command(folder: &Path, arguments: &[&str]) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_relume"));
    command.args(arguments).current_dir(folder);
    command.env("VK_DRIVER_FILES", "/nonexistent").env("WGPU_BACKEND", "vulkan");
    command
}

/// Runs the executable to its end.
pub(crate) fn relume(folder: &Path, arguments: &[&str]) -> Output {
    command(folder, arguments).output().unwrap()
}

/// What was printed on stderr.
pub(crate) fn complaint(output: &Output) -> String {
    String::from_utf8_lossy(&output.stderr).into_owned()
}
