//! Guards what a machine can guard of the law: arrows, sources, links, sizes.
//!
//! Each check is a pure function from what was read to a list of faults, so that its tests can show it failing.

mod arrows;
mod links;
mod size;
mod source;

use crate::run::{cargo, output, root};
use anyhow::{Context, Result, bail};

/// Fails with a list of all that is out of order.
pub(crate) fn run() -> Result<()> {
    let files = tracked()?;
    let mut faults = arrows::faults(&arrows::read(&output(&cargo(), &arrows::QUESTION)?), &crates(&files));
    for path in &files {
        let whole = root().join(path);
        // A file that git knows and that is being moved away is no fault.
        let Ok(data) = whole.metadata() else { continue };
        faults.extend(size::fault(path, data.len()));
        let read = || std::fs::read_to_string(&whole).with_context(|| format!("cannot read {path}"));
        if path.ends_with(".rs") {
            faults.extend(source::faults(path, &read()?));
        } else if path.ends_with(".md") {
            faults.extend(links::faults(path, &read()?, |target| root().join(target).exists()));
        }
    }
    if !faults.is_empty() {
        bail!("{} thing(s) out of order:\n  {}", faults.len(), faults.join("\n  "));
    }
    Ok(())
}

/// Every file that git keeps or would keep, relative to the root, in order.
fn tracked() -> Result<Vec<String>> {
    let question = ["ls-files", "-z", "--cached", "--others", "--exclude-standard"];
    let answer = output("git", &question).context("tidy asks git which files belong to the project")?;
    let mut files: Vec<String> = answer.split_terminator('\0').map(str::to_owned).collect();
    files.sort();
    Ok(files)
}

/// Names of the folders in `crates`.
fn crates(files: &[String]) -> Vec<&str> {
    let manifests = files.iter().filter_map(|path| path.strip_prefix("crates/")?.strip_suffix("/Cargo.toml"));
    manifests.filter(|name| !name.contains('/')).collect()
}
