//! `relume bases --scene`: which basis to bake the light maps of a scene in.

use crate::bases::write;
use crate::console::Console;
use crate::draw::Window;
use crate::source::{self, ProbeSource, ReadOptions, SceneSource};
use crate::usage::Usage;
use crate::{bake as baking, cost, output, settings, sheets};
use anyhow::Result;
use bake::{Directional, SheetSettings};
use coeff_io::{Bounces, Quality, Refine, Settings};
use probe_io::Environment;
use relume::AtlasOptions;
use scene::Scene;
use serde_json::{Value, json};
use std::io::Write;
use std::path::Path;
use study::bases::scene::{Comparison, Goal, PICKED, Request, Row, Stored, compare, nanoseconds};

/// The files that are written: the table, then the two forms of the plot.
const FILES: [&str; 3] = ["bases-scene.csv", "bases-scene.svg", "bases-scene.png"];
/// The error that a basis is recommended for where nothing is asked.
const TARGET: f64 = 0.02;

/// What is asked of a scene, as typed.
#[derive(Debug, clap::Args)]
pub(crate) struct OnScene {
    /// The light of --scene: .hdr, .exr, a folder of six faces, or builtin:NAME.
    #[arg(long, value_name = "PROBE", requires = "scene", value_parser = source::probe)]
    probe: Option<ProbeSource>,
    #[command(flatten)]
    read: ReadOptions,
    /// The relative error as drawn to recommend for, the fewest bytes that keep it (0.02 where neither this nor --target-size is given).
    #[arg(long, value_name = "E", requires = "scene", conflicts_with = "target_size", value_parser = target,
          alias = "target")]
    target_error: Option<f64>,
    /// The bytes of light maps to recommend for, the least error that fits; K, M and G stand for powers of 1024.
    #[arg(long, value_name = "BYTES", requires = "scene", value_parser = cost::some_bytes, alias = "budget")]
    target_size: Option<u64>,
    /// Texels along a side of the sheets: about so many times as many in all, shared by area.
    #[arg(long, value_name = "N", default_value_t = 256, requires = "scene",
          value_parser = clap::value_parser!(u32).range(i64::from(AtlasOptions::MIN_TEXELS)..=8192))]
    texels: u32,
    /// Unwraps all surfaces, whatever light-map coordinates the scene brings.
    #[arg(long, requires = "scene")]
    unwrap: bool,
    /// Number of bands of the light.
    #[arg(long, value_name = "N", default_value_t = bake::settings::standard().bands, requires = "scene")]
    bands: u32,
    /// What is done against ringing of the light, as for `bake --lighting fixed`.
    #[arg(long, value_enum, default_value_t = Window::Auto, requires = "scene")]
    window: Window,
    /// Fixed number of rays per receiver and texel.
    #[arg(long, value_name = "N", conflicts_with = "error", requires = "scene")]
    rays: Option<u32>,
    /// Relative error of the bake that bases are judged by (0.01 where neither is given).
    #[arg(long, value_name = "E", requires = "scene", value_parser = settings::error, allow_negative_numbers = true)]
    error: Option<f32>,
    /// How often light may bounce: a number, or auto.
    #[arg(long, value_name = "N|auto", default_value = "auto", requires = "scene", value_parser = settings::bounces)]
    bounces: Bounces,
    /// Splits large triangles, as for `bake --refine`.
    #[arg(long, value_name = "auto|off|METRES", default_value = "auto", requires = "scene", value_parser = settings::refine)]
    refine: Refine,
    /// Memory that the bake may take; K, M and G stand for powers of 1024.
    #[arg(long, value_name = "BYTES", requires = "scene", value_parser = settings::bytes)]
    memory: Option<u64>,
    /// Print JSON.
    #[arg(long, requires = "scene")]
    json: bool,
}

pub(crate) fn run(scene: &SceneSource, options: &OnScene, seed: u64, folder: &Path, console: &Console) -> Result<()> {
    let settings = options.settings(seed)?;
    let Some(probe) = &options.probe else {
        return Err(Usage("--scene is judged under a light: say which with --probe".into()).into());
    };
    output::check_all(folder, &FILES, &[scene.files(), probe.files()].concat())?;
    let mut scene = scene.load(console)?;
    output::check_all(folder, &FILES, &scene.files)?;
    let environment = probe.load(&options.read, console)?;
    let atlas = AtlasOptions { unwrap_all: options.unwrap, ..AtlasOptions::new(options.texels) };
    let sheets = sheets::pages(&atlas, &mut scene, console)?;
    let found = bake(&scene, &settings, &sheets, &environment, options.window, console)?;
    let bake_options = match options.window {
        Window::None => format!("--window none {}", sheets::options(&atlas)),
        Window::Auto => sheets::options(&atlas),
    };
    let request = Request {
        scene: &scene,
        light: &environment.name,
        sheet_options: &bake_options,
        sheets: &sheets,
        found: &found,
        goal: options.goal(),
        nanoseconds: &nanoseconds(),
    };
    let comparison = compare(&request)?;
    let chart = comparison.chart();
    let contents = [comparison.csv().into_bytes(), chart.svg()?.into_bytes(), chart.pixels()?.png()?];
    for (name, bytes) in FILES.into_iter().zip(contents) {
        write(&folder.join(name), |file| file.write_all(&bytes))?;
    }
    if options.json {
        console.print(&format!("{:#}", as_json(&comparison)))?;
    } else {
        console.print(&comparison.text())?;
        console.print(&comparison.recommendation())?;
        console.print(&format!("  {}", comparison.options()))?;
        if let Some(remark) = comparison.remark() {
            console.print(&remark)?;
        }
    }
    console.notice(&format!("wrote {} into {}", FILES.join(", "), folder.display()));
    Ok(())
}

/// The truth that bases are judged by.
fn bake(
    scene: &Scene,
    settings: &Settings,
    sheets: &[SheetSettings],
    environment: &Environment,
    window: Window,
    console: &Console,
) -> Result<Directional> {
    let light = relume::fixed_light(environment, settings.bands, window.into()).map_err(crate::usage::fault)?;
    let progress = console.progress();
    progress.expect(&baking::stages(settings, 1.0, false));
    bake::directional(scene, settings, sheets, &light, &baking::watched(&progress)).map_err(crate::usage::bake_fault)
}

impl OnScene {
    fn settings(&self, seed: u64) -> Result<Settings> {
        let standard = bake::settings::standard();
        let settings = Settings {
            bands: self.bands,
            quality: self.rays.map(Quality::Rays).or(self.error.map(Quality::Error)).unwrap_or(standard.quality),
            bounces: self.bounces,
            refine: self.refine,
            seed,
            memory: self.memory.unwrap_or(standard.memory),
            ..standard
        };
        bake::settings::check(&settings).map_err(crate::usage::bake_fault)?;
        Ok(settings)
    }

    fn goal(&self) -> Goal {
        self.target_size.map_or(Goal::Error(self.target_error.unwrap_or(TARGET)), Goal::Bytes)
    }
}

/// Parses a relative error.
fn target(text: &str) -> Result<f64, String> {
    match settings::share(text).map(f64::from) {
        Some(value) if value > 0.0 && value < 10.0 => Ok(value),
        _ => Err("give a relative error above 0 and below 10, such as 0.02 or 2%".into()),
    }
}

fn as_json(comparison: &Comparison) -> Value {
    let stored = |stored: &Stored| {
        json!({
            "encoding": stored.encoding.id(),
            "bytes": stored.bytes,
            "drawn_relative_rms": stored.drawn.rms,
            "drawn_relative_p99": stored.drawn.p99,
        })
    };
    let row = |row: &Row| {
        json!({
            "basis": row.basis.name(),
            "functions": row.basis.count(),
            "imse": row.imse,
            "relative_rms": row.relative,
            "worst": {
                "sheet": row.worst.sheet,
                "row": row.worst.place[0],
                "column": row.worst.place[1],
                "position": row.worst.position,
                "mesh": row.worst.mesh,
                "relative_rms": row.worst.relative,
            },
            "ns_per_evaluation": row.nanoseconds,
            "stored": row.stored.iter().map(stored).collect::<Vec<_>>(),
        })
    };
    let choice = comparison.choice;
    let chosen = &comparison.rows[choice.row];
    let goal = match choice.goal {
        Goal::Error(error) => json!({ "relative_rms": error }),
        Goal::Bytes(bytes) => json!({ "bytes": bytes }),
    };
    json!({
        "scene": comparison.scene,
        "light": comparison.light,
        "texels": comparison.texels,
        "sheet_texels": comparison.sheet_texels,
        "normals": if comparison.has_normal_maps { PICKED } else { 1 },
        "mean": comparison.mean,
        "drawn_mean": comparison.drawn_mean,
        "negative_share": comparison.negative,
        "bases": comparison.rows.iter().map(row).collect::<Vec<_>>(),
        "recommended": {
            "goal": goal,
            "met": choice.met,
            "basis": chosen.basis.name(),
            "encoding": chosen.stored[choice.stored].encoding.id(),
            "options": comparison.options(),
            "remark": comparison.remark(),
        },
    })
}
