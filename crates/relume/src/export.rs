//! `relume export`: the coefficients of a baked file for other programs.

use crate::console::Console;
use crate::source;
use anyhow::{Context, Result};
use std::path::PathBuf;

pub(crate) const EXAMPLES: &str = "\
Example:
  relume export atrium.prt --format npy -o atrium/

Writes positions.npy [R,3], normals.npy [R,3] and transfer.npy [R, n*n, C]. Where C is 3, transfer times light is
outgoing radiance. Where C is 1, albedo.npy [R,3] is written too and outgoing radiance is albedo times that.";

#[derive(Debug, clap::Args)]
pub(crate) struct Options {
    /// The baked file.
    #[arg(value_name = "F.prt")]
    file: PathBuf,
    /// What to write.
    #[arg(long, value_enum, default_value_t = Format::Npy)]
    format: Format,
    /// The folder to write into; made if need be.
    #[arg(short, long, value_name = "DIR")]
    output: PathBuf,
}

#[derive(Debug, Clone, Copy, clap::ValueEnum)]
enum Format {
    /// Arrays of NumPy.
    Npy,
}

pub(crate) fn run(options: &Options, console: &Console) -> Result<()> {
    let prt = source::prt(&options.file)?;
    match options.format {
        Format::Npy => coeff_io::export::npy(&prt, &options.output)
            .with_context(|| format!("cannot write into {}", options.output.display()))?,
    }
    console.notice(&format!("wrote {} receivers into {}", prt.geometry.positions.len(), options.output.display()));
    Ok(())
}
