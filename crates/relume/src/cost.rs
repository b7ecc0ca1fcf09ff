//! `relume cost`: what accuracy costs on the user's own scene and machine, as a table, plots and a page.

use crate::console::Console;
use crate::source::{ProbeOptions, SceneOptions};
use crate::usage::Usage;
use crate::{interrupt, output, settings};
use anyhow::{Context, Result};
use coeff_io::{Settings, replace};
use std::fs;
use std::io::Write;
use std::path::PathBuf;
use study::cost::{Error, Goal, Report, Request, Targets, csv, page, plots, report::Machine};
use study::plot::chart::{Chart, Unit};

pub(crate) const EXAMPLES: &str = "\
Examples:
  relume cost builtin:cornell-box --probe builtin:sky -o cornell-cost
  relume cost house.glb --probe kitchen.hdr -o house-cost --budget 300
  relume cost house.glb --probe kitchen.hdr -o house-cost --target-error 0.005 --target-time 20 --target-size 8M

Writes cost.html (one page that needs nothing else), cost.csv (every run), and the plots cost-seconds and cost-bytes as .svg
and .png. Runs that do not fit into the budget are left out, and the page says which; three short bakes and the reference are
made in any case. Ctrl-C ends the study; files are written when all is done.";

/// Longest budget, seconds: a week.
const MOST_SECONDS: f64 = 604_800.0;

#[derive(Debug, clap::Args)]
pub(crate) struct Options {
    #[command(flatten)]
    scene: SceneOptions,
    #[command(flatten)]
    probe: ProbeOptions,
    /// The folder to write into; made if need be.
    #[arg(short, long, value_name = "DIR")]
    output: PathBuf,
    /// Seconds that the study may take.
    #[arg(long, value_name = "SECONDS", default_value_t = 60.0, value_parser = seconds)]
    budget: f64,
    /// The error to recommend settings for, as for `bake --error`.
    #[arg(long, value_name = "E", default_value_t = 0.01)]
    target_error: f32,
    /// The seconds of baking to recommend settings for; a quarter of what the target error takes by default.
    #[arg(long, value_name = "SECONDS", value_parser = seconds)]
    target_time: Option<f64>,
    /// The bytes of coefficients to recommend settings for; half of those of the target error by default.
    #[arg(long, value_name = "BYTES", value_parser = settings::bytes)]
    target_size: Option<u64>,
    /// Number of bands of the bakes that turn another knob.
    #[arg(long, value_name = "N", default_value_t = bake::settings::standard().bands)]
    bands: u32,
    /// Seed of everything random.
    #[arg(long, value_name = "S", default_value_t = bake::settings::standard().seed)]
    seed: u64,
    /// Memory that coefficients and caches of a bake may take; K, M and G stand for powers of 1024.
    #[arg(long, value_name = "BYTES", value_parser = settings::bytes)]
    memory: Option<u64>,
}

pub(crate) fn run(options: &Options, console: &Console) -> Result<()> {
    let settings = options.settings()?;
    let scene = options.scene.load(console)?;
    let environment = options.probe.load(console)?;
    fs::create_dir_all(&options.output)
        .with_context(|| format!("cannot make the folder {}", options.output.display()))?;
    output::check(&options.output.join("cost.html"))?;
    interrupt::watch()?;
    let targets = Targets { error: options.target_error, seconds: options.target_time, bytes: options.target_size };
    let request = Request {
        scene: &scene,
        environment: &environment,
        settings,
        targets,
        budget: options.budget,
        machine: machine(),
    };
    let report = {
        let progress = console.progress();
        study::cost::study(&request, &|step| {
            let stage = if step.stage.is_empty() { String::new() } else { format!(": {}", step.stage) };
            progress.set(&format!("{} {}{stage}", step.run, step.name), step.done, step.total);
            interrupt::flow()
        })
    };
    let report = report.map_err(fault)?;
    write(options, &report)?;
    for line in summary(&report) {
        console.print(&line)?;
    }
    console.notice(&format!("wrote {}", options.output.join("cost.html").display()));
    Ok(())
}

impl Options {
    /// What every bake of the study has.
    fn settings(&self) -> Result<Settings> {
        let standard = bake::settings::standard();
        let settings = Settings {
            bands: self.bands,
            quality: coeff_io::Quality::Error(self.target_error),
            seed: self.seed,
            memory: self.memory.unwrap_or(standard.memory),
            ..standard
        };
        bake::settings::check(&settings)
            .map_err(|error| Usage(error.to_string().replace("--error", "--target-error")))?;
        Ok(settings)
    }
}

/// Parses a time in seconds.
fn seconds(text: &str) -> Result<f64, String> {
    match text.parse() {
        Ok(value) if value > 0.0 && value <= MOST_SECONDS => Ok(value),
        _ => Err("give a number of seconds above 0, such as 60; a week at most".into()),
    }
}

fn machine() -> Machine {
    Machine {
        threads: rayon::current_num_threads(),
        system: format!("{} {}", std::env::consts::ARCH, std::env::consts::OS),
        version: env!("CARGO_PKG_VERSION").into(),
    }
}

fn fault(error: Error) -> anyhow::Error {
    match error {
        Error::Bake(error) => crate::bake::fault(error),
        other => other.into(),
    }
}

/// Writes every file of the report; each is there whole or not at all.
fn write(options: &Options, report: &Report) -> Result<()> {
    let plots = plots(report);
    let forms = |chart: &Chart| Ok::<_, anyhow::Error>((chart.svg()?, chart.pixels()?.png()?));
    let (seconds, bytes) = (forms(&plots.seconds)?, forms(&plots.bytes)?);
    let files = [
        ("cost.csv", csv(report).into_bytes()),
        ("cost-seconds.svg", seconds.0.into_bytes()),
        ("cost-seconds.png", seconds.1),
        ("cost-bytes.svg", bytes.0.into_bytes()),
        ("cost-bytes.png", bytes.1),
        ("cost.html", page(report)?.into_bytes()),
    ];
    for (name, bytes) in files {
        let path = options.output.join(name);
        replace(&path, |file| file.write_all(&bytes)).with_context(|| format!("cannot write {}", path.display()))?;
    }
    Ok(())
}

/// The recommendations, a line each.
fn summary(report: &Report) -> Vec<String> {
    let line = |advice: &study::cost::Advice| {
        let run = &report.runs[advice.run];
        let goal = match advice.goal {
            Goal::Error(error) => format!("error {}", Unit::Share.write(error)),
            Goal::Seconds(seconds) => format!("time {}", Unit::Seconds.write(seconds)),
            Goal::Bytes(bytes) => format!("size {}", Unit::Bytes.write(bytes as f64)),
        };
        let met = if advice.met { "" } else { " (not met by any run; the nearest)" };
        format!(
            "{goal}: {}{met}: error {}, {}, {}",
            run.setting,
            Unit::Share.write(run.transfer.p95),
            Unit::Seconds.write(run.seconds),
            Unit::Bytes.write(run.bytes as f64)
        )
    };
    report.advice.iter().map(line).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn times_are_numbers_of_seconds() {
        assert_eq!(seconds("1.5"), Ok(1.5));
        for wrong in ["0", "-1", "nan", "inf", "1e9", "soon"] {
            assert!(seconds(wrong).is_err(), "{wrong}");
        }
    }
}
