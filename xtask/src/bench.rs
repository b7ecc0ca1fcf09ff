//! Runs the benchmarks of the crates that own a hot path.

use crate::run::{self as command, cargo, output, root};
use anyhow::{Context, Result};

/// What is done with the figures.
#[derive(Debug, clap::Args)]
pub(crate) struct Options {
    /// Writes the output to docs/bench/DATE-bench.txt (DATE-paper.txt with --paper) with the machine's name.
    #[arg(long)]
    record: bool,
    /// Fills the two tables of the paper on transfer textures instead: frames per second and bytes on scenes of its sizes, at 1920x1080.
    #[arg(long)]
    paper: bool,
    /// With --paper: options and scenes for it, such as --size 640x360 paper-room.
    #[arg(last = true, requires = "paper", value_name = "OPTION|SCENE")]
    more: Vec<String>,
}

/// Crates with benches.
const CRATES: &[&str] = &["sh-math", "raytrace", "bake"];

/// Runs every bench; with `--record` the figures go into a dated file.
pub(crate) fn run(options: &Options) -> Result<()> {
    let mut arguments = vec!["bench"];
    if options.paper {
        arguments = vec!["run", "--release", "--package", "study", "--example", "paper", "--"];
        arguments.extend(options.more.iter().map(String::as_str));
    } else {
        for name in CRATES {
            arguments.extend(["--package", name]);
        }
    }
    if !options.record {
        return command::run(&cargo(), &arguments);
    }
    let figures = output(&cargo(), &arguments)?;
    let date = output("date", &["+%Y-%m-%d"])?.trim().to_owned();
    let machine = std::fs::read_to_string("/proc/cpuinfo").unwrap_or_default();
    let model = machine.lines().find(|l| l.starts_with("model name")).unwrap_or("model name: unknown");
    let text = format!("{date}\n{model}\n$ cargo {}\n\n{figures}", arguments.join(" "));
    let name = if options.paper { "paper" } else { "bench" };
    let path = root().join(format!("docs/bench/{date}-{name}.txt"));
    std::fs::write(&path, text).with_context(|| format!("cannot write {}", path.display()))
}
