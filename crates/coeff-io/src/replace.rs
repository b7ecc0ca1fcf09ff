//! Files that are there whole or not at all.

use std::collections::BTreeSet;
use std::fs::File;
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, MutexGuard, PoisonError};
use tempfile::NamedTempFile;

/// Files that are being filled, and folders that were made for files; none once all was abandoned.
static MAKING: Mutex<Option<Unfinished>> = Mutex::new(Some(Unfinished { parts: BTreeSet::new(), folders: Vec::new() }));

struct Unfinished {
    parts: BTreeSet<PathBuf>,
    /// From the outer to the inner ones.
    folders: Vec<PathBuf>,
}

/// Writes a file beside `path` and renames it to `path` when `fill` has succeeded and the bytes are on the disk.
///
/// # Errors
/// Whatever `fill` or the system reports; `path` is then as it was before.
pub fn replace(path: &Path, fill: impl FnOnce(&mut BufWriter<&File>) -> io::Result<()>) -> io::Result<()> {
    // What a link points to is replaced, not the link; what is no file, such as a device, is left alone.
    let path = &std::fs::canonicalize(path).unwrap_or_else(|_| path.to_owned());
    if std::fs::metadata(path).is_ok_and(|m| !m.is_file()) {
        return Err(io::Error::other("it exists and is no ordinary file; give another name"));
    }
    let folder = match path.parent() {
        Some(folder) if !folder.as_os_str().is_empty() => folder,
        _ => Path::new("."),
    };
    let beside = Making::begin(folder)?;
    let mut writer = BufWriter::with_capacity(1 << 20, beside.file.as_file());
    fill(&mut writer)?;
    writer.flush()?;
    drop(writer);
    beside.file.as_file().sync_all()?;
    beside.finish(path)?;
    sync_folder(folder)
}

/// Makes a folder for files, and those above it that are missing.
///
/// # Errors
/// As the system reports.
pub fn make_folder(folder: &Path) -> io::Result<()> {
    let mut making = making();
    let unfinished = making.as_mut().ok_or_else(abandoned)?;
    let is_missing = |path: &&Path| !path.as_os_str().is_empty() && !path.exists();
    let missing: Vec<PathBuf> = folder.ancestors().take_while(is_missing).map(Path::to_owned).collect();
    unfinished.folders.extend(missing.into_iter().rev());
    std::fs::create_dir_all(folder)
}

/// Removes what is being written and folders that were made and stayed empty, and lets no further file come to be: for a program that is
/// about to end. Files that are there stay as they are.
pub fn abandon() {
    let Some(Unfinished { parts, folders }) = making().take() else { return };
    // What is left beside a file is no reason to stay.
    parts.iter().for_each(|part| drop(std::fs::remove_file(part)));
    // The system removes no folder that holds anything.
    folders.iter().rev().for_each(|folder| drop(std::fs::remove_dir(folder)));
}

fn making() -> MutexGuard<'static, Option<Unfinished>> {
    MAKING.lock().unwrap_or_else(PoisonError::into_inner)
}

fn abandoned() -> io::Error {
    io::Error::other("the program is about to end")
}

/// A file beside its place.
struct Making {
    file: NamedTempFile,
    part: Part,
}

/// Its name among those that are being filled.
struct Part(PathBuf);

impl Drop for Part {
    fn drop(&mut self) {
        if let Some(unfinished) = making().as_mut() {
            unfinished.parts.remove(&self.0);
        }
    }
}

impl Making {
    fn begin(folder: &Path) -> io::Result<Making> {
        let mut making = making();
        let unfinished = making.as_mut().ok_or_else(abandoned)?;
        let file = builder().tempfile_in(folder)?;
        unfinished.parts.insert(file.path().to_owned());
        let part = Part(file.path().to_owned());
        Ok(Making { file, part })
    }

    fn finish(self, path: &Path) -> io::Result<()> {
        let making = making();
        if making.is_none() {
            return Err(abandoned());
        }
        self.file.persist(path).map_err(|e| e.error)?;
        drop(making);
        drop(self.part);
        Ok(())
    }
}

/// Temporary files are private by default; a result should have the permissions of any other new file.
fn builder() -> tempfile::Builder<'static, 'static> {
    let mut builder = tempfile::Builder::new();
    builder.prefix(".relume-").suffix(".part");
    #[cfg(unix)]
    {
        use std::os::unix::fs::PermissionsExt;
        builder.permissions(std::fs::Permissions::from_mode(0o666));
    }
    builder
}

/// Makes the rename itself durable where the system lets folders be synced.
fn sync_folder(folder: &Path) -> io::Result<()> {
    if cfg!(unix) { File::open(folder)?.sync_all() } else { Ok(()) }
}
