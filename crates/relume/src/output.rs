//! Whether a result can be written, asked before long work begins.

use anyhow::{Context, Result, bail};
use std::path::Path;

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
