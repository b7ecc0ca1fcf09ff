//! Whether a result can be written, asked before long work begins.

use anyhow::{Context, Result, bail};
use std::fs;
use std::path::Path;

/// Makes a folder, and fails where one of the files of those names cannot be made in it.
pub(crate) fn check_all(folder: &Path, names: &[&str]) -> Result<()> {
    fs::create_dir_all(folder)
        .with_context(|| format!("cannot make the folder {}: choose another, or make room for it", folder.display()))?;
    names.iter().try_for_each(|name| check(&folder.join(name)))
}

/// Fails where no file can be made at `path`.
pub(crate) fn check(path: &Path) -> Result<()> {
    if path.is_dir() {
        bail!("cannot write {}: it is a folder; name a file", path.display());
    }
    let folder = match path.parent() {
        Some(folder) if !folder.as_os_str().is_empty() => folder,
        _ => Path::new("."),
    };
    tempfile::tempfile_in(folder)
        .with_context(|| format!("cannot write {}: make the folder or choose another", path.display()))?;
    Ok(())
}
