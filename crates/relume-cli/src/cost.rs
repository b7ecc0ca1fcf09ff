//! `relume cost`: what accuracy costs on the user's own scene and machine, as a table, plots and a page.

use crate::console::Console;
use crate::lens::{self, Lens};
use crate::silence::silenced;
use crate::source::{ProbeOptions, SceneOptions};
use crate::usage::{Usage, bake_fault};
use crate::{output, settings, sheets};
use anyhow::{Context, Result};
use bake::SheetSettings;
use coeff_io::{Settings, replace};
use relume::AtlasOptions;
use render_wgpu::{Driver, Gpu};
use scene::Scene;
use std::io::Write;
use std::ops::ControlFlow;
use std::path::PathBuf;
use std::time::Instant;
use study::cost::report::{Machine, Run};
use study::cost::{Error, Goal, LightMaps, Report, Request, Targets, csv, page, plots};
use study::plot::chart::{Chart, Unit};

pub(crate) const EXAMPLES: &str = "\
Examples:
  relume cost builtin:cornell-box --probe builtin:sky -o cornell-cost
  relume cost house.glb --probe kitchen.hdr -o house-cost --budget 300
  relume cost house.glb --probe kitchen.hdr -o house-cost --target-error 0.005 --target-time 20 --target-size 8M

Writes cost.html (one page that needs nothing else), cost.csv (every run), and the plots cost-seconds and \
cost-bytes as .svg and .png. Runs that do not fit into the budget are left out, and the page says which; the \
reference, which is two bakes, and one of 64 rays are made in any case. A part of the budget is kept for timing \
frames and drawing; on a large scene they may take longer. Ctrl-C ends the study; files are written when all is \
done.";

/// The files of a report, in the order in which they are written.
const FILES: [&str; 6] =
    ["cost.csv", "cost-seconds.svg", "cost-seconds.png", "cost-bytes.svg", "cost-bytes.png", "cost.html"];

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
    #[arg(long, value_name = "E", default_value_t = 0.01, value_parser = settings::error, allow_negative_numbers = true)]
    target_error: f32,
    /// The seconds of baking to recommend settings for; a quarter of what the target error takes by default.
    #[arg(long, value_name = "SECONDS", value_parser = seconds)]
    target_time: Option<f64>,
    /// The bytes of coefficients to recommend settings for; half of those of the target error by default.
    #[arg(long, value_name = "BYTES", value_parser = some_bytes)]
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
    /// The view of the pictures: the name of a camera, or eye x,y,z, target x,y,z and vertical angle of view in degrees.
    #[arg(long, value_name = "NAME|EYE,TARGET,FOV", value_parser = lens::parse, allow_hyphen_values = true)]
    camera: Option<Lens>,
    /// Compare the bases of light maps even where the scene has no normal map, which asks for them.
    #[arg(long)]
    light_maps: bool,
    /// Texels along a side of the sheets of light maps that bases are compared on.
    #[arg(long, value_name = "N", default_value_t = 128, value_parser = clap::value_parser!(u32).range(i64::from(AtlasOptions::MIN_TEXELS)..=8192))]
    texels: u32,
}

pub(crate) fn run(options: &Options, console: &Console) -> Result<()> {
    let settings = options.settings()?;
    let mut scene = options.scene.load(console)?;
    if options.camera.is_some() {
        // Pictures are drawn from the first.
        let camera = lens::of_scene(options.camera.as_ref(), &scene)?;
        scene.cameras.insert(0, camera);
    }
    let environment = options.probe.load(console)?;
    output::check_all(&options.output, &FILES, &[scene.files.clone(), options.probe.files()].concat())?;
    let (mapped, sheet_options) = (options.light_maps(&scene, console)?, sheets::options(&options.atlas()));
    let targets = Targets { error: options.target_error, seconds: options.target_time, bytes: options.target_size };
    let request = Request {
        scene: &scene,
        environment: &environment,
        settings,
        targets,
        budget: options.budget,
        machine: machine(),
        light_maps: mapped.as_ref().map(|(scene, sheets)| LightMaps { scene, sheet_options: &sheet_options, sheets }),
        open_gpu: || silenced(|| Gpu::new(Driver::Any)),
    };
    let report = {
        let progress = console.progress();
        progress.expect(&[("study", 1.0)]);
        let began = Instant::now();
        study::cost::study(&request, &|step| {
            let stage = if step.stage.is_empty() { String::new() } else { format!(": {}", step.stage) };
            let share = began.elapsed().as_secs_f64() / options.budget;
            progress.tell("study", &format!("{} {}{stage}", step.run, step.name), share.min(1.0));
            // Ctrl-C ends the program as a whole.
            ControlFlow::Continue(())
        })
    };
    let report = report.map_err(fault)?;
    write(options, &report)?;
    if let Some(warning) = report.warning() {
        console.notice(&format!("warning: {warning}"));
    }
    if request.light_maps.is_some() && report.bases.is_none() {
        console.notice("bases of light maps are left out, since the time did not suffice: allow more with --budget");
    }
    for line in summary(&report) {
        console.print(&line)?;
    }
    console.notice(&format!("wrote {}", options.output.join("cost.html").display()));
    Ok(())
}

impl Options {
    fn atlas(&self) -> AtlasOptions {
        AtlasOptions::new(self.texels)
    }

    /// The scene with coordinates of light maps and their sheets, where normal maps or the user ask for them.
    fn light_maps(&self, scene: &Scene, console: &Console) -> Result<Option<(Scene, Vec<SheetSettings>)>> {
        if !self.light_maps && !relume::has_normal_maps(scene) {
            return Ok(None);
        }
        let mut scene = scene.clone();
        match sheets::pages(&self.atlas(), &mut scene, console) {
            Ok(sheets) => Ok(Some((scene, sheets))),
            Err(error) if !self.light_maps => {
                console.notice(&format!("bases of light maps are left out: {error}"));
                Ok(None)
            }
            Err(error) => Err(error),
        }
    }

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
            .map_err(|error| Usage(bake_fault(error).to_string().replace("--error", "--target-error")))?;
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

/// Parses a number of bytes of which there is one at least.
pub(crate) fn some_bytes(text: &str) -> Result<u64, String> {
    match settings::bytes(text)? {
        0 => Err("no bake fits into 0 bytes: give a size such as 8M".into()),
        bytes => Ok(bytes),
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
        Error::Bake(error) => crate::usage::bake_fault(error),
        other => other.into(),
    }
}

/// Writes every file of the report; each is there whole or not at all.
fn write(options: &Options, report: &Report) -> Result<()> {
    let plots = plots(report);
    let forms = |chart: &Chart| Ok::<_, anyhow::Error>((chart.svg()?, chart.pixels()?.png()?));
    let (seconds, bytes) = (forms(&plots.seconds)?, forms(&plots.bytes)?);
    let contents: [Vec<u8>; FILES.len()] = [
        csv(report).into_bytes(),
        seconds.0.into_bytes(),
        seconds.1,
        bytes.0.into_bytes(),
        bytes.1,
        page(report)?.into_bytes(),
    ];
    for (name, bytes) in FILES.into_iter().zip(contents) {
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
            "{goal}: {}{met}: {}, {}, {}",
            run.setting,
            achieved(advice.goal, run, report.kept(run), report.reference.bands),
            Unit::Seconds.write(run.seconds),
            Unit::Bytes.write(run.bytes as f64)
        )
    };
    let bases = report.bases.iter().map(|bases| format!("light maps, {}: {}", bases.recommendation(), bases.options()));
    let gloss = report.gloss.iter().map(|gloss| format!("gloss: {}", gloss.options));
    report.advice.iter().map(line).chain(bases).chain(gloss).collect()
}

/// The error of a run that its goal is about, as the page has it: for a size what fewer bands leave out is in it.
fn achieved(goal: Goal, run: &Run, kept: f64, bands: u32) -> String {
    match goal {
        Goal::Bytes(_) => {
            let off = run.radiance_all_bands.unwrap_or(run.radiance);
            format!("radiance differs by {} from {bands} bands", Unit::Share.write(off))
        }
        Goal::Error(_) | Goal::Seconds(_) => format!("error {}", Unit::Share.write(kept)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::fs;
    use study::cost::{Spread, report::Knob};

    #[test]
    fn sizes_are_above_nothing() {
        assert_eq!(some_bytes("8M"), Ok(8 << 20));
        assert!(some_bytes("0").is_err_and(|text| text.contains("0 bytes")));
        assert!(some_bytes("much").is_err());
    }

    #[test]
    fn every_file_is_checked_before() {
        let folder = tempfile::tempdir().unwrap();
        assert!(output::check_all(&folder.path().join("new"), &FILES, &[]).is_ok());
        for name in FILES {
            let folder = tempfile::tempdir().unwrap();
            fs::create_dir(folder.path().join(name)).unwrap();
            assert!(
                output::check_all(folder.path(), &FILES, &[]).is_err_and(|error| error.to_string().contains(name)),
                "{name}"
            );
        }
    }

    /// A folder of a name that is none of ours is no hindrance.
    #[test]
    fn every_file_is_checked_before_can_fail() {
        let folder = tempfile::tempdir().unwrap();
        fs::create_dir(folder.path().join("cost.txt")).unwrap();
        assert!(output::check_all(folder.path(), &FILES, &[]).is_ok());
    }

    /// Two bands are exact in their own bands and leave out a tenth of the light.
    fn few_bands(goal: Goal) -> String {
        let run = Run {
            knob: Knob::Bands,
            setting: String::new(),
            can_be_typed: true,
            bands: 2,
            receivers: 3,
            channels: 1,
            bounces: 0,
            rays: [0; 2],
            seconds: 1.0,
            bytes: 48,
            transfer: Spread::default(),
            radiance: 0.0,
            radiance_all_bands: Some(0.103),
        };
        achieved(goal, &run, 0.0, 8)
    }

    #[test]
    fn the_error_for_a_size_is_that_of_the_page() {
        assert_eq!(few_bands(Goal::Bytes(50)), "radiance differs by 10.3 % from 8 bands");
    }

    #[test]
    fn the_error_for_a_size_is_that_of_the_page_can_fail() {
        assert_eq!(few_bands(Goal::Error(0.01)), "error 0 %");
    }

    #[test]
    fn times_are_numbers_of_seconds() {
        assert_eq!(seconds("1.5"), Ok(1.5));
        for wrong in ["0", "-1", "nan", "inf", "1e9", "soon"] {
            assert!(seconds(wrong).is_err(), "{wrong}");
        }
    }
}
