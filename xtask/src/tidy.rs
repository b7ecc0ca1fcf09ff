//! Guards the law of the house: the arrows between crates, the size of files, a first line that says what a file is.

use crate::run::{cargo, output, root};
use anyhow::{Context, Result, bail};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// Which crate may depend on which; dev-dependencies are free.
const ARROWS: &[(&str, &[&str])] = &[
    ("sh-math", &[]),
    ("sampling", &[]),
    ("raytrace", &[]),
    ("scene", &[]),
    ("probe-io", &[]),
    ("testkit", &[]),
    ("xtask", &[]),
    ("coeff-io", &["sh-math"]),
    ("bake", &["sh-math", "sampling", "raytrace", "scene", "probe-io", "coeff-io"]),
    ("reference", &["sampling", "raytrace", "scene", "probe-io"]),
    ("render-cpu", &["sh-math", "raytrace", "probe-io", "coeff-io"]),
    ("render-wgpu", &["sh-math", "probe-io", "coeff-io"]),
    (
        "relume",
        &[
            "sh-math",
            "sampling",
            "raytrace",
            "scene",
            "probe-io",
            "coeff-io",
            "bake",
            "reference",
            "render-cpu",
            "render-wgpu",
        ],
    ),
    ("end-to-end", &[]),
];

/// Crates that know no files, no clock, no logging and no GPU.
const MATHS: &[&str] = &["sh-math", "sampling", "raytrace"];
/// What the maths crates may never name.
const FORBIDDEN_IN_MATHS: &[&str] = &["std::fs", "std::time", "std::io", "println!", "eprintln!", "rayon::"];
/// Lines above which a file asks for a reason; generated tables are exempt by their first line.
const MAX_LINES: usize = 400;

/// Fails with a list of all that is out of order.
pub(crate) fn run() -> Result<()> {
    let mut faults = check_arrows()?;
    for file in sources(&root())? {
        check_file(&file, &mut faults)?;
    }
    if !faults.is_empty() {
        bail!("{} thing(s) out of order:\n  {}", faults.len(), faults.join("\n  "));
    }
    Ok(())
}

/// Compares the graph that cargo sees with the table.
fn check_arrows() -> Result<Vec<String>> {
    let allowed: BTreeMap<&str, &[&str]> = ARROWS.iter().copied().collect();
    let mut faults = Vec::new();
    for (name, _) in ARROWS {
        let arguments = ["tree", "--package", name, "--edges", "normal", "--depth", "1", "--prefix", "none"];
        for line in output(&cargo(), &arguments)?.lines().skip(1) {
            let to = line.split_whitespace().next().unwrap_or_default();
            if allowed.contains_key(to) && !allowed[name].contains(&to) {
                faults.push(format!("crate '{name}' may not depend on '{to}': see the arrows in ARCHITECTURE.md"));
            }
        }
    }
    for entry in std::fs::read_dir(root().join("crates"))? {
        let name = entry?.file_name().to_string_lossy().into_owned();
        if !allowed.contains_key(name.as_str()) {
            faults.push(format!("crate '{name}' is in no row of the arrows in xtask/src/tidy.rs"));
        }
    }
    Ok(faults)
}

fn check_file(path: &Path, faults: &mut Vec<String>) -> Result<()> {
    let text = std::fs::read_to_string(path).with_context(|| format!("cannot read {}", path.display()))?;
    let shown = path.strip_prefix(root()).unwrap_or(path).display().to_string();
    if !text.starts_with("//! ") {
        faults.push(format!("{shown}: the first line must be '//! ' and say what the file is"));
    }
    let lines = text.lines().count();
    if lines > MAX_LINES && !text.lines().next().is_some_and(|l| l.contains("Generated")) {
        faults.push(format!("{shown}: {lines} lines; split it at a noun ({MAX_LINES} at most)"));
    }
    let stem = path.file_stem().map(|s| s.to_string_lossy().into_owned()).unwrap_or_default();
    if ["util", "utils", "common", "helpers", "misc"].contains(&stem.as_str()) {
        faults.push(format!("{shown}: name the noun that this file holds"));
    }
    let in_maths = MATHS.iter().any(|c| shown.starts_with(&format!("crates/{c}/src")));
    for word in FORBIDDEN_IN_MATHS.iter().filter(|w| in_maths && text.contains(**w)) {
        faults.push(format!("{shown}: the maths crates may not use {word}"));
    }
    if text.contains("wgpu::") && !shown.starts_with("crates/render-wgpu") && !shown.starts_with("xtask") {
        faults.push(format!("{shown}: only render-wgpu names wgpu"));
    }
    Ok(())
}

/// All Rust sources of the project, in order.
fn sources(root: &Path) -> Result<Vec<PathBuf>> {
    let mut found = Vec::new();
    let mut folders = vec![root.join("crates"), root.join("xtask"), root.join("tests")];
    while let Some(folder) = folders.pop() {
        for entry in std::fs::read_dir(&folder)? {
            let path = entry?.path();
            if path.is_dir() {
                folders.push(path);
            } else if path.extension().is_some_and(|e| e == "rs") {
                found.push(path);
            }
        }
    }
    found.sort();
    Ok(found)
}
