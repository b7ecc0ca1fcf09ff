//! `relume bases`: what each basis of irradiance normal mapping loses, and what it costs.

use crate::bases_scene::{self, OnScene};
use crate::console::Console;
use crate::output;
use crate::source::{self, SceneSource};
use anyhow::{Context, Result};
use coeff_io::replace;
use image::codecs::png::{CompressionType, FilterType, PngEncoder};
use image::{ExtendedColorType, ImageEncoder};
use std::fs::File;
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};
use study::bases::{Picture, SIGNALS, Settings};

pub(crate) const EXAMPLES: &str = "\
Examples:
  relume bases -o bases/
  relume bases --signals 1000000 --seed 7 -o bases/
  relume bases --scene house.glb --probe kitchen.hdr -o house-bases/
  relume bases --scene house.glb --probe kitchen.hdr --target-error 1% --texels 512 --error 0.05 -o house-bases/
  relume bases --scene builtin:atrium --probe builtin:sky --target-size 256K --bounces 1 -o atrium-bases/ --json

Prints the table and writes bases.csv, bases.svg and bases.png. Errors depend on the seed alone; the nanoseconds \
are measured on this machine: let it rest meanwhile. One thread does all the work, whatever --threads says.

With --scene the scene is baked once, in 5 bands over normals, and the bases are compared on what arrives at its \
texels; one is recommended for --target-error or --target-size. Writes bases-scene.csv, bases-scene.svg and \
bases-scene.png.";

/// The files that are written: the table, then the two forms of the plot.
const FILES: [&str; 3] = ["bases.csv", "bases.svg", "bases.png"];

#[derive(Debug, clap::Args)]
pub(crate) struct Options {
    /// Random irradiance signals to average over.
    #[arg(long, value_name = "N", default_value_t = SIGNALS, value_parser = clap::value_parser!(u32).range(2..=10_000_000),
          conflicts_with = "scene")]
    signals: u32,
    /// Seed of everything random: of the signals, or of the bake.
    #[arg(long, value_name = "S", default_value_t = 0)]
    seed: u64,
    /// The folder to write into; made if need be.
    #[arg(short, long, value_name = "DIR")]
    output: PathBuf,
    /// Compare on this scene instead: .gltf, .glb, .obj, or builtin:NAME.
    #[arg(long, value_name = "SCENE", requires = "probe", value_parser = source::scene)]
    scene: Option<SceneSource>,
    #[command(flatten)]
    on_scene: OnScene,
}

pub(crate) fn run(options: &Options, console: &Console) -> Result<()> {
    let folder = &options.output;
    if let Some(scene) = &options.scene {
        return bases_scene::run(scene, &options.on_scene, options.seed, folder, console);
    }
    output::check_all(folder, &FILES, &[])?;
    let study = study::bases::study(Settings { signals: options.signals, seed: options.seed });
    let (svg, picture) = (study.svg()?, study.picture()?);
    let [table, drawing, pixels] = FILES.map(|name| folder.join(name));
    write(&table, |file| file.write_all(study.csv().as_bytes()))?;
    write(&drawing, |file| file.write_all(svg.as_bytes()))?;
    write(&pixels, |file| png(&picture, file))?;
    console.print(&study.text())?;
    console.notice(&format!("wrote bases.csv, bases.svg and bases.png into {}", folder.display()));
    Ok(())
}

/// Writes a file whole or not at all.
pub(crate) fn write(path: &Path, fill: impl FnOnce(&mut BufWriter<&File>) -> io::Result<()>) -> Result<()> {
    replace(path, fill).with_context(|| format!("cannot write {}", path.display()))
}

/// Plots are few colours: the slow compression makes them a fraction.
fn png(picture: &Picture, file: &mut BufWriter<&File>) -> io::Result<()> {
    let encoder = PngEncoder::new_with_quality(file, CompressionType::Best, FilterType::NoFilter);
    let written = encoder.write_image(&picture.rgb, picture.width, picture.height, ExtendedColorType::Rgb8);
    written.map_err(io::Error::other)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_file_is_checked_before() {
        for name in FILES {
            let folder = tempfile::tempdir().unwrap();
            std::fs::create_dir(folder.path().join(name)).unwrap();
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
        std::fs::create_dir(folder.path().join("bases.txt")).unwrap();
        assert!(output::check_all(folder.path(), &FILES, &[]).is_ok());
    }
}
