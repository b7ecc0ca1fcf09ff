//! The main job from end to end: bake, file, pictures, the truth beside them.

use crate::run::{self as command, cargo, root};
use anyhow::{Context, Result};
use std::path::{Path, PathBuf};

/// What goes through the pipeline; by default a scene and a light of the project's own.
#[derive(Debug, clap::Args)]
pub(crate) struct Options {
    /// A .gltf, .glb or .obj file, or builtin:NAME.
    #[arg(default_value = "builtin:atrium")]
    scene: String,
    /// A light probe (.hdr, .exr, a folder of six faces), or builtin:NAME.
    #[arg(long, default_value = "builtin:sky")]
    probe: String,
    /// Folder for the .prt file and the pictures.
    #[arg(long, default_value = "out")]
    out: PathBuf,
    /// Size of the pictures.
    #[arg(long, default_value = "960x540")]
    size: String,
}

/// Runs the commands of the main job and prints each.
pub(crate) fn run(options: &Options) -> Result<()> {
    let out = root().join(&options.out);
    std::fs::create_dir_all(&out).with_context(|| format!("cannot make the folder {}", out.display()))?;
    command::run(&cargo(), &["build", "--release", "--package", "relume-cli"])?;
    let relume = relume();
    let stem = stem(&options.scene);
    let path = |suffix: &str| options.out.join(format!("{stem}{suffix}")).display().to_string();
    let prt = path(".prt");
    command::run(&relume, &["bake", &options.scene, "-o", &prt])?;
    command::run(&relume, &["inspect", &prt])?;
    let look = ["--size", &options.size, "--window", "auto", "--tonemap", "filmic", "--exposure", "0.5"];
    let draw = |output: &str, more: &[&str]| {
        let mut arguments = vec!["render", &prt, "--probe", &options.probe, "-o", output];
        arguments.extend(look.iter().chain(more));
        command::run(&relume, &arguments)
    };
    draw(&path(".png"), &[])?;
    // The same file under a turned light: nothing is baked again.
    draw(&path("-turned.png"), &["--rotate", "120,0,0"])?;
    draw(&path(".exr"), &[])?;
    Ok(())
}

/// The command line that the build left behind.
fn relume() -> String {
    let target = std::env::var_os("CARGO_TARGET_DIR").map_or_else(|| root().join("target"), PathBuf::from);
    let name = format!("relume{}", std::env::consts::EXE_SUFFIX);
    target.join("release").join(name).display().to_string()
}

/// Name of the outputs: `builtin:atrium` and `scenes/atrium.glb` both give `atrium`.
fn stem(scene: &str) -> String {
    let name = scene.strip_prefix("builtin:").unwrap_or(scene);
    Path::new(name).file_stem().map_or_else(|| "scene".to_owned(), |s| s.to_string_lossy().into_owned())
}
