//! `relume light`: the spherical harmonics coefficients of a light probe.

use crate::console::Console;
use crate::draw::Window;
use crate::output;
use crate::render;
use crate::source::{self, ProbeSource, ReadOptions};
use crate::usage::Usage;
use anyhow::{Context, Result};
use glam::Quat;
use sh_math::Bands;
use std::path::PathBuf;

pub(crate) const EXAMPLES: &str = "\
Examples:
  relume light kitchen.hdr --bands 5 --format json -o kitchen.json
  relume light builtin:sky --bands 3 --format npy -o sky.npy
  relume light kitchen.exr --layer beauty --rotate 90,0,0 --window auto -o kitchen.npy

The array has the shape [n*n, 3]; index l(l+1)+m, real orthonormal harmonics without Condon-Shortley phase.";

#[derive(Debug, clap::Args)]
pub(crate) struct Options {
    /// The light: .hdr, .exr, a folder of six faces, or builtin:NAME.
    #[arg(value_name = "PROBE", value_parser = source::probe)]
    probe: ProbeSource,
    /// Number of bands.
    #[arg(long, value_name = "N", default_value = "5", value_parser = source::bands)]
    bands: Bands,
    /// What to write; told by the ending of the file where not given.
    #[arg(long, value_enum)]
    format: Option<Format>,
    /// The file to write.
    #[arg(short, long, value_name = "FILE")]
    output: PathBuf,
    /// Turns the light, in degrees: yaw about y (upwards), then pitch about the turned x, then roll about the turned z.
    #[arg(long, value_name = "YAW,PITCH,ROLL", default_value = "0,0,0", value_parser = render::rotation, allow_hyphen_values = true)]
    rotate: Quat,
    /// What is done against ringing under a strong small light; see docs/shading.md.
    #[arg(long, value_enum, default_value_t = Window::None)]
    window: Window,
    #[command(flatten)]
    read: ReadOptions,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
enum Format {
    /// An array of NumPy.
    Npy,
    /// JSON with the convention beside the numbers.
    Json,
}

impl Options {
    /// What is written: the ending of the file must agree with what was asked for.
    fn format(&self) -> Result<Format> {
        let ending = self.output.extension().map(|ending| ending.to_ascii_lowercase());
        let named = match ending.as_ref().and_then(|ending| ending.to_str()) {
            Some("npy") => Format::Npy,
            Some("json") => Format::Json,
            _ => return Err(Usage("give a file that ends in .npy or .json with --output".into()).into()),
        };
        match self.format {
            Some(asked) if asked != named => Err(Usage(format!(
                "{} is not the name of what --format asks for: give another ending, or leave --format out",
                self.output.display()
            ))
            .into()),
            _ => Ok(named),
        }
    }
}

pub(crate) fn run(options: &Options, console: &Console) -> Result<()> {
    let format = options.format()?;
    output::check(&options.output, &options.probe.files())?;
    let environment = options.probe.load(&options.read, console)?;
    // As a picture of the light is made: windowed, then turned; what is not asked for changes no bit.
    let light = options.window.apply(&sh_math::project(options.bands, environment.samples()));
    let light = if options.rotate == Quat::IDENTITY { light } else { light.rotated(options.rotate) };
    let path = &options.output;
    let written = match format {
        Format::Npy => coeff_io::export::light_npy(&light, path),
        Format::Json => coeff_io::export::light_json(&light, path),
    };
    written.with_context(|| format!("cannot write {}", path.display()))?;
    console.notice(&format!("wrote {} coefficients to {}", options.bands.coefficients(), path.display()));
    console.next("relume export F.prt -o DIR, whose transfer times these coefficients is outgoing radiance");
    Ok(())
}
