//! Compares the numbers of ten bakes by an older program with those of this one, byte by byte.

use crate::run::{self as command, cargo, root};
use anyhow::{Context, Result, bail};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// Which programs bake.
#[derive(Debug, clap::Args)]
pub(crate) struct Options {
    /// The older program: a copy of target/release/relume, made before the change.
    #[arg(long, value_name = "PROGRAM")]
    before: PathBuf,
    /// Bakes only those whose name contains this.
    #[arg(value_name = "NAME")]
    only: Option<String>,
}

/// Name, scene with options, and exports of each bake: vertices with fixed rays and by error, light
/// maps of any light and of a fixed one, transfer textures, volumes.
const BAKES: &[(&str, &str, &[&str])] = &[
    ("vertices", "builtin:atrium --bands 3 --rays 64 --bounces 1", &["npy"]),
    ("vertices-default", "builtin:cornell-box", &["npy"]),
    ("vertices-error", "builtin:teacup --error 0.05", &["npy"]),
    ("vertices-unrefined", "builtin:bumps --refine off --rays 128", &["npy"]),
    ("vertices-compressed", "builtin:paper-plants --bands 3 --rays 32 --bounces 1", &["npy"]),
    (
        "light-maps",
        "builtin:teacup --bands 3 --rays 32 --bounces 1 --storage texture --texels 128 --unwrap",
        &["npy", "ktx2"],
    ),
    (
        "light-maps-fixed",
        "builtin:bumps --bands 3 --rays 32 --storage texture --texels 128 --unwrap --probe builtin:sky \
         --lighting fixed",
        &["npy", "ktx2"],
    ),
    (
        "transfer-textures",
        "builtin:teacup --bands 3 --rays 32 --bounces 1 --storage transfer --texels 128 --unwrap",
        &["npy"],
    ),
    ("volume", "builtin:cornell-box --bands 3 --rays 64 --bounces 1 --volume 1m", &["npy", "json"]),
    ("volume-error", "builtin:two-rooms --bands 3 --error 0.05 --volume 1m", &["npy", "json"]),
];

/// Bakes with both programs, exports arrays and compares them.
///
/// # Errors
/// Where a program fails or any array differs; the message names them.
pub(crate) fn run(options: &Options) -> Result<()> {
    command::run(&cargo(), &["build", "--release", "--workspace", "--bin", "relume"])?;
    let programs = [options.before.clone(), root().join("target/release/relume")];
    let mut differing = Vec::new();
    for bake in BAKES.iter().filter(|(name, ..)| is_asked(options, name)) {
        let [before, now] = [0, 1].map(|k| arrays(&programs[k], ["before", "now"][k], bake));
        let (before, now) = (before?, now?);
        let files = before.keys().chain(now.keys().filter(|file| !before.contains_key(*file)));
        let changed = files.filter(|file| before.get(*file) != now.get(*file));
        differing.extend(changed.map(|file| format!("{}/{file}", bake.0)));
    }
    if differing.is_empty() { Ok(()) } else { bail!("arrays that differ: {}", differing.join(", ")) }
}

fn is_asked(options: &Options, name: &str) -> bool {
    options.only.as_ref().is_none_or(|only| name.contains(only.as_str()))
}

/// Bakes with one program and reads the arrays that it exports, by file name.
fn arrays(
    program: &Path,
    side: &str,
    (name, arguments, formats): &(&str, &str, &[&str]),
) -> Result<BTreeMap<String, Vec<u8>>> {
    let folder = root().join("target/compare").join(side).join(name);
    if folder.exists() {
        std::fs::remove_dir_all(&folder).with_context(|| format!("cannot remove {}", folder.display()))?;
    }
    std::fs::create_dir_all(&folder).with_context(|| format!("cannot create {}", folder.display()))?;
    let (program, file) = (text(program), text(&folder.join("bake.prt")));
    let mut bake = vec!["bake", "--quiet", "--output", &file];
    bake.extend(arguments.split_whitespace());
    command::run(&program, &bake)?;
    let mut arrays = BTreeMap::new();
    for format in *formats {
        let export = text(&folder.join(format));
        command::run(&program, &["export", &file, "--quiet", "--format", format, "--output", &export])?;
        for entry in std::fs::read_dir(&export).with_context(|| format!("cannot read {export}"))? {
            let path = entry?.path();
            let file = path.file_name().map(|name| text(Path::new(name))).unwrap_or_default();
            if is_numbers(&file) {
                arrays.insert(file, std::fs::read(&path).with_context(|| format!("cannot read {}", path.display()))?);
            }
        }
    }
    if arrays.is_empty() {
        bail!("{} holds no arrays", folder.display());
    }
    Ok(arrays)
}

/// Whether a file holds numbers alone, and no words that a change may rename.
fn is_numbers(file: &str) -> bool {
    file.ends_with(".npy") || file.ends_with(".ktx2") || file == "volume.json"
}

fn text(path: &Path) -> String {
    path.to_string_lossy().into_owned()
}
