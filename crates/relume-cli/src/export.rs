//! `relume export`: the coefficients of a baked file for other programs.

use crate::console::Console;
use crate::output;
use crate::source::{self, ProbeSource, ReadOptions};
use crate::usage::Usage;
use anyhow::{Context, Result, bail};
use coeff_io::{Container, MapLight, Prt, Volume, export};
use sh_math::Bands;
use std::path::{Path, PathBuf};

pub(crate) const EXAMPLES: &str = "\
Examples:
  relume export atrium.prt --format npy -o atrium/
  relume export atrium.prt --format ktx2 -o textures/
  relume export atrium.prt --format dds --probe builtin:sky -o textures/
  relume export atrium.prt --format json -o text/

npy writes positions.npy [R,3] (of the world, float64 where that lies far away), normals.npy [R,3] and \
transfer.npy [R, n*n, C]. Where C is 3, transfer times light is outgoing radiance. Where C is 1, albedo.npy [R,3] is written too and outgoing radiance is albedo times \
that. The mesh follows: triangles.npy [T,3], uv0.npy and uv1.npy [R,2] where there are texture coordinates, and \
meshes.json with names, ranges and materials. Gloss and transfer textures follow as arrays of rows: gloss_*.npy, \
sheet_S_L_*.npy, bounce_book.npy and sheets.json (docs/format.md).

ktx2 and dds write light maps as 2-D arrays (sheet_0 ..., one layer per function and coefficient of the light, \
blocks and floating numbers as they are held, eight bits as halves) with maps.json, and a volume as nine 3-D \
textures of RGBA halves (volume_0 ... volume_8, spherical harmonics of irradiance / pi over world normals) with \
volume.json. A volume that answers to any light is lit by --probe.

json writes a volume with its cells and all numbers of its probes: volume.json.";

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
    /// The light for textures of a volume that answers to any: .hdr, .exr, a folder of six faces, or builtin:NAME.
    #[arg(long, value_name = "PROBE", value_parser = source::probe)]
    probe: Option<ProbeSource>,
    #[command(flatten)]
    read: ReadOptions,
}

#[derive(Debug, Clone, Copy, clap::ValueEnum)]
enum Format {
    /// Arrays of NumPy: the transfer of vertices and texels, and gloss.
    Npy,
    /// Textures of Khronos: light maps and irradiance volumes.
    Ktx2,
    /// Textures of DirectX: light maps and irradiance volumes.
    Dds,
    /// Readable text: irradiance volumes.
    Json,
}

pub(crate) fn run(options: &Options, console: &Console) -> Result<()> {
    let prt = source::prt(&options.file)?;
    let folder = &options.output;
    let probe = options.probe.as_ref().map(ProbeSource::files).unwrap_or_default();
    output::check_folder(folder, &[vec![options.file.clone()], probe].concat())?;
    let about = || format!("cannot write into {}", folder.display());
    let wrote = match options.format {
        Format::Npy => {
            export::npy(&prt, folder).with_context(about)?;
            format!("{} receivers", prt.geometry.positions.len())
        }
        Format::Ktx2 => textures(&prt, Container::Ktx2, options, console)?,
        Format::Dds => textures(&prt, Container::Dds, options, console)?,
        Format::Json => {
            let volume = prt.volume.as_ref().with_context(|| lacks(&options.file, "no irradiance volume"))?;
            coeff_io::make_folder(folder).with_context(about)?;
            export::volume_json(volume, &folder.join("volume.json")).with_context(about)?;
            format!("{} probes", volume.positions.len())
        }
    };
    console.notice(&format!("wrote {wrote} into {}", folder.display()));
    Ok(())
}

/// Writes what there is of maps and volume; tells what it was.
fn textures(prt: &Prt, container: Container, options: &Options, console: &Console) -> Result<String> {
    if prt.maps.is_none() && prt.volume.is_none() {
        bail!(lacks(&options.file, "neither light maps nor an irradiance volume"));
    }
    let about = || format!("cannot write into {}", options.output.display());
    let mut wrote = Vec::new();
    // The light is asked for before anything is written.
    let light = prt.volume.as_ref().map(|volume| light(volume, options, console)).transpose()?;
    if let Some(maps) = &prt.maps {
        export::maps(maps, container, &options.output).with_context(about)?;
        wrote.push(format!("{} sheets", maps.sheets.len()));
    }
    if let Some((volume, light)) = prt.volume.as_ref().zip(light) {
        export::volume(volume, &light, container, &options.output).with_context(about)?;
        wrote.push("9 textures of the volume".into());
    }
    Ok(wrote.join(" and "))
}

/// The coefficients that light a volume: none where its light is fixed.
fn light(volume: &Volume, options: &Options, console: &Console) -> Result<Vec<[f32; 3]>> {
    let MapLight::Relightable { bands } = volume.light else { return Ok(Vec::new()) };
    let Some(probe) = &options.probe else {
        bail!(Usage("the volume answers to any light: give the one for its textures with --probe".into()));
    };
    let bands = Bands::new(bands).context("the volume has no bands")?;
    Ok(sh_math::project(bands, probe.load(&options.read, console)?.samples()).values)
}

fn lacks(file: &Path, what: &str) -> String {
    format!(
        "{} holds {what}: bake them into it, or export the transfer of its vertices with --format npy",
        file.display()
    )
}
