//! `relume plan`: which effects a scene calls for and why, and what each will cost; bakes nothing.

use crate::console::Console;
use crate::settings::BakeOptions;
use crate::source::{self, ProbeSource, ReadOptions, SceneOptions};
use anyhow::Result;
use coeff_io::{Plan, PlanRow, Settings};
use probe_io::Environment;
use serde_json::json;
use sh_math::{Bands, Rgb};
use std::fmt::Write;

pub(crate) const EXAMPLES: &str = "\
Examples:
  relume plan house.glb
  relume plan house.glb --probe kitchen.hdr --json
  relume plan builtin:atrium --effects all";

/// Bands that the light is measured with.
const LIGHT_BANDS: u32 = 16;

#[derive(Debug, clap::Args)]
pub(crate) struct Options {
    #[command(flatten)]
    scene: SceneOptions,
    /// A light: tells how much of it the bands hold.
    #[arg(long, value_name = "PROBE", value_parser = source::probe)]
    probe: Option<ProbeSource>,
    #[command(flatten)]
    read: ReadOptions,
    #[command(flatten)]
    bake: BakeOptions,
    /// Print JSON.
    #[arg(long)]
    json: bool,
}

pub(crate) fn run(options: &Options, console: &Console) -> Result<()> {
    let settings = options.bake.settings()?;
    let scene = options.scene.load(console)?;
    let plan = bake::plan(&scene, &settings).map_err(crate::bake::fault)?;
    let light = match &options.probe {
        Some(probe) => Some(LightFacts::of(&probe.load(&options.read, console)?)?),
        None => None,
    };
    let text = if options.json {
        let light = light.as_ref().map(LightFacts::json);
        format!("{:#}", json!({ "scene": scene.name, "settings": settings, "plan": plan, "light": light }))
    } else {
        let mut text = as_text(&scene.name, &plan, settings.bands)?;
        light.iter().try_for_each(|light| light.write(&mut text, &settings))?;
        text
    };
    console.print(&text)
}

fn as_text(scene: &str, plan: &Plan, bands: u32) -> Result<String> {
    let mut text = String::new();
    let (receivers, shadowed) = (plan.receivers, plan.shadowed_receivers);
    writeln!(text, "{scene}: {receivers} receivers, {shadowed} of them with something above")?;
    writeln!(text, "{} channel(s), about {} bounces\n", plan.channels, plan.bounces)?;
    writeln!(text, "{:<16} {:<8} {:>14} {:>14}  reason", "effect", "simulate", "rays", "bytes")?;
    plan.rows.iter().try_for_each(|row| write_row(&mut text, row))?;
    let (rays, bytes) = plan
        .rows
        .iter()
        .fold((0_u64, 0_u64), |(rays, bytes), row| (rays.saturating_add(row.rays), bytes.saturating_add(row.bytes)));
    // What every bake has, whatever its effects: one channel of transfer.
    let base = plan.receivers.saturating_mul(u64::from(bands * bands) * 4);
    writeln!(text, "{:<16} {:<8} {:>14} {base:>14}  one channel of transfer for every receiver", "Transfer", "yes", 0)?;
    let bytes = bytes.saturating_add(base);
    writeln!(text, "{:<16} {:<8} {rays:>14} {bytes:>14}", "together", "")?;
    Ok(text)
}

fn write_row(text: &mut String, row: &PlanRow) -> Result<()> {
    let name = format!("{:?}", row.effect);
    let simulate = if row.simulate { "yes" } else { "no" };
    write!(text, "{name:<16} {simulate:<8} {:>14} {:>14}  {}", row.rays, row.bytes, row.reason)?;
    if !row.called_for_by.is_empty() {
        write!(text, " ({})", row.called_for_by.join(", "))?;
    }
    Ok(writeln!(text)?)
}

/// What matters about a light to a bake.
struct LightFacts {
    name: String,
    lamps: usize,
    /// Share of the squared coefficients, up to [`LIGHT_BANDS`], in each band.
    share: Vec<f64>,
}

impl LightFacts {
    fn of(environment: &Environment) -> Result<Self> {
        let bands = source::bands(&LIGHT_BANDS.to_string()).map_err(crate::usage::Usage)?;
        let light = sh_math::project(bands, environment.samples());
        Ok(Self { name: environment.name.clone(), lamps: environment.lamps.len(), share: shares(bands, &light) })
    }

    fn json(&self) -> serde_json::Value {
        json!({ "name": self.name, "lamps": self.lamps, "share_by_band": self.share })
    }

    fn write(&self, text: &mut String, settings: &Settings) -> Result<()> {
        let held: f64 = self.share.iter().take(settings.bands as usize).sum();
        writeln!(
            text,
            "\n{}: {} lamp(s); {} bands hold {:.1}% of the power in the first {LIGHT_BANDS}",
            self.name,
            self.lamps,
            settings.bands,
            100.0 * held
        )?;
        Ok(())
    }
}

fn shares(bands: Bands, light: &Rgb) -> Vec<f64> {
    let square = |value: &[f32; 3]| value.iter().map(|v| f64::from(*v) * f64::from(*v)).sum::<f64>();
    let power: Vec<f64> =
        bands.degrees().map(|l| light.values[l * l..(l + 1) * (l + 1)].iter().map(square).sum()).collect();
    let total: f64 = power.iter().sum();
    // A black light has no shares.
    power.iter().map(|p| if total > 0.0 { p / total } else { 0.0 }).collect()
}
