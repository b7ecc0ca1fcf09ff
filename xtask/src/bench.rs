//! Runs the benchmarks of the crates that own a hot path.

use crate::run::{self as command, cargo, output, root};
use anyhow::{Context, Result};

/// What is done with the figures.
#[derive(Debug, clap::Args)]
pub(crate) struct Options {
    /// Writes the output to docs/bench/DATE-bench.txt with the machine's name.
    #[arg(long)]
    record: bool,
}

/// Crates with benches.
const CRATES: &[&str] = &["sh-math", "raytrace", "bake"];

/// Runs every bench; with `--record` the figures go into a dated file.
pub(crate) fn run(options: &Options) -> Result<()> {
    let mut arguments = vec!["bench"];
    for name in CRATES {
        arguments.extend(["--package", name]);
    }
    if !options.record {
        return command::run(&cargo(), &arguments);
    }
    let figures = output(&cargo(), &arguments)?;
    let date = output("date", &["+%Y-%m-%d"])?.trim().to_owned();
    let machine = std::fs::read_to_string("/proc/cpuinfo").unwrap_or_default();
    let model = machine.lines().find(|l| l.starts_with("model name")).unwrap_or("model name: unknown");
    let text = format!("{date}\n{model}\n$ cargo {}\n\n{figures}", arguments.join(" "));
    let path = root().join(format!("docs/bench/{date}-bench.txt"));
    std::fs::write(&path, text).with_context(|| format!("cannot write {}", path.display()))
}
