//! `relume light`: the spherical harmonics coefficients of a light probe.

use crate::console::Console;
use crate::source::{self, ProbeSource, ReadOptions};
use anyhow::{Context, Result};
use sh_math::Bands;
use std::path::PathBuf;

pub(crate) const EXAMPLES: &str = "\
Examples:
  relume light kitchen.hdr --bands 5 --format json -o kitchen.json
  relume light builtin:sky --bands 3 --format npy -o sky.npy

The array has the shape [n*n, 3]; index l(l+1)+m, real orthonormal harmonics without Condon-Shortley phase.";

#[derive(Debug, clap::Args)]
pub(crate) struct Options {
    /// The light: .hdr, .exr, a folder of six faces, or builtin:NAME.
    #[arg(value_name = "PROBE", value_parser = source::probe)]
    probe: ProbeSource,
    /// Number of bands.
    #[arg(long, value_name = "N", default_value = "5", value_parser = source::bands)]
    bands: Bands,
    /// What to write.
    #[arg(long, value_enum, default_value_t = Format::Npy)]
    format: Format,
    /// The file to write.
    #[arg(short, long, value_name = "FILE")]
    output: PathBuf,
    #[command(flatten)]
    read: ReadOptions,
}

#[derive(Debug, Clone, Copy, clap::ValueEnum)]
enum Format {
    /// An array of NumPy.
    Npy,
    /// JSON with the convention beside the numbers.
    Json,
}

pub(crate) fn run(options: &Options, console: &Console) -> Result<()> {
    let environment = options.probe.load(&options.read, console)?;
    let light = sh_math::project(options.bands, environment.samples());
    let path = &options.output;
    let written = match options.format {
        Format::Npy => coeff_io::export::light_npy(&light, path),
        Format::Json => coeff_io::export::light_json(&light, path),
    };
    written.with_context(|| format!("cannot write {}", path.display()))?;
    console.notice(&format!("wrote {} coefficients to {}", options.bands.coefficients(), path.display()));
    Ok(())
}
