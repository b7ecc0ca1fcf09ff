//! Everything that CI checks, in CI's order.

use crate::run::{self as command, cargo};
use crate::tidy;
use anyhow::Result;

/// How much is checked.
#[derive(Debug, clap::Args)]
pub(crate) struct Options {
    /// Leaves out the tests and the pipeline.
    #[arg(long)]
    fast: bool,
}

/// Stops at the first check that fails.
pub(crate) fn run(options: &Options) -> Result<()> {
    let cargo = cargo();
    command::run(&cargo, &["fmt", "--all", "--check"])?;
    tidy::run()?;
    command::run(&cargo, &["clippy", "--release", "--workspace", "--all-targets", "--", "-D", "warnings"])?;
    let document = ["doc", "--release", "--workspace", "--no-deps"];
    command::run_with(&[("RUSTDOCFLAGS", "-Dwarnings")], &cargo, &document)?;
    if !options.fast {
        command::run(&cargo, &["test", "--release", "--workspace"])?;
        command::run(&cargo, &["xtask", "pipeline", "--size", "320x180"])?;
    }
    Ok(())
}
