//! Starts a command, shows it and fails when it fails.

use anyhow::{Context, Result, bail};
use std::path::PathBuf;
use std::process::Command;

/// The root of the workspace.
pub(crate) fn root() -> PathBuf {
    let here = PathBuf::from(env!("CARGO_MANIFEST_DIR"));
    here.parent().map(PathBuf::from).unwrap_or(here)
}

/// The cargo that started this program.
pub(crate) fn cargo() -> String {
    std::env::var("CARGO").unwrap_or_else(|_| "cargo".to_owned())
}

/// Runs a command at the root of the workspace, after printing it.
///
/// # Errors
/// Where it cannot be started or does not succeed.
pub(crate) fn run(program: &str, arguments: &[&str]) -> Result<()> {
    run_with(&[], program, arguments)
}

/// Runs a command with more in its environment, after printing it.
///
/// # Errors
/// Where it cannot be started or does not succeed.
pub(crate) fn run_with(environment: &[(&str, &str)], program: &str, arguments: &[&str]) -> Result<()> {
    show(environment, program, arguments);
    let status = Command::new(program)
        .envs(environment.iter().copied())
        .args(arguments)
        .current_dir(root())
        .status()
        .with_context(|| format!("cannot start '{program}'"))?;
    if !status.success() {
        bail!("'{program} {}' failed: {status}", arguments.join(" "));
    }
    Ok(())
}

/// Runs a command and returns what it printed.
///
/// # Errors
/// Where it cannot be started or does not succeed.
pub(crate) fn output(program: &str, arguments: &[&str]) -> Result<String> {
    let output = Command::new(program)
        .args(arguments)
        .current_dir(root())
        .output()
        .with_context(|| format!("cannot start '{program}'"))?;
    if !output.status.success() {
        bail!("'{program} {}' failed: {}", arguments.join(" "), String::from_utf8_lossy(&output.stderr).trim());
    }
    String::from_utf8(output.stdout).context("the command printed bytes that are not text")
}

#[expect(clippy::print_stdout, reason = "a task shows what it runs")]
fn show(environment: &[(&str, &str)], program: &str, arguments: &[&str]) {
    let name = std::path::Path::new(program).file_name().map_or(program.into(), |n| n.to_string_lossy());
    let set: String = environment.iter().map(|(name, value)| format!("{name}={value} ")).collect();
    println!("$ {set}{name} {}", arguments.join(" "));
}
