//! The files that a scene file may refer to: those in its own folder, never the network.

use std::cell::RefCell;
use std::fs;
use std::path::{Path, PathBuf};

/// Largest file that is read, bytes (2 GiB): a guard against devices and mistakes.
pub(crate) const MAX_FILE_BYTES: u64 = 2 << 30;

/// Why a referenced file is not there.
#[derive(Debug)]
pub(crate) enum Missing {
    /// The reference itself is refused; says why.
    Refused(String),
    /// The file cannot be read.
    Io(PathBuf, std::io::Error),
}

impl std::fmt::Display for Missing {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Refused(why) => f.write_str(why),
            Self::Io(path, error) => write!(f, "{}: {error}", path.display()),
        }
    }
}

/// Reads a whole regular file of at most [`MAX_FILE_BYTES`].
pub(crate) fn read_file(path: &Path) -> std::io::Result<Vec<u8>> {
    let metadata = fs::metadata(path)?;
    if !metadata.is_file() {
        return Err(std::io::Error::new(std::io::ErrorKind::InvalidInput, "not a regular file"));
    }
    if metadata.len() > MAX_FILE_BYTES {
        let what = format!("{} bytes; at most {MAX_FILE_BYTES} are read", metadata.len());
        return Err(std::io::Error::new(std::io::ErrorKind::FileTooLarge, what));
    }
    fs::read(path)
}

/// What stands after the last `/` or `\`.
pub(crate) fn bare(path: &str) -> &str {
    path.rsplit(['/', '\\']).next().unwrap_or(path)
}

/// What stands before it, with it.
pub(crate) fn folder_of(path: &str) -> &str {
    &path[..path.len() - bare(path).len()]
}

/// Where programs that write OBJ mean a file to be that another one in the folder `near` names.
fn places(near: &str, path: &str) -> [String; 4] {
    let bare = bare(path);
    [format!("{near}{path}"), path.to_owned(), format!("{near}{bare}"), bare.to_owned()]
}

/// The folder of a scene file, and which of its files the scene names.
#[derive(Debug)]
pub(crate) struct Folder {
    path: PathBuf,
    /// Files that were read, or that are named and not read.
    files: RefCell<Vec<PathBuf>>,
}

impl Folder {
    /// The folder in which `scene_file` lies.
    pub(crate) fn of(scene_file: &Path) -> Self {
        let path = scene_file.parent().unwrap_or(Path::new("")).to_owned();
        Self { path, files: RefCell::default() }
    }

    /// The files that the scene named so far, as far as they are there.
    pub(crate) fn into_files(self) -> Vec<PathBuf> {
        self.files.into_inner()
    }

    /// Notes a file that the scene names and that is not read, such as a picture of an unsupported kind; looked for as
    /// [`Folder::find`] does.
    pub(crate) fn mention(&self, near: &str, path: &str) {
        for place in places(near, path) {
            for name in [Some(place.clone()), self.any_case(&place)].into_iter().flatten() {
                if let Ok(path) = self.resolve(&name) {
                    self.note(&path);
                }
            }
        }
    }

    fn note(&self, path: &Path) {
        let mut files = self.files.borrow_mut();
        if path.is_file() && !files.iter().any(|file| file == path) {
            files.push(path.to_owned());
        }
    }

    /// Reads the file at a relative path with `/` or `\` between its parts.
    pub(crate) fn read(&self, relative: &str) -> Result<Vec<u8>, Missing> {
        let path = self.resolve(relative).map_err(Missing::Refused)?;
        self.note(&path);
        read_file(&path).map_err(|error| Missing::Io(path, error))
    }

    /// Looks for a file as programs that write OBJ mean it: at its path, from the folder `near` of the file that names
    /// it or from this folder, else by its bare name in either; last with other capitals. Gives its path and content.
    pub(crate) fn find(&self, near: &str, path: &str) -> Result<(String, Vec<u8>), Missing> {
        let places = places(near, path);
        let mut first = None;
        for place in &places {
            match self.read(place) {
                Ok(bytes) => return Ok((place.replace('\\', "/"), bytes)),
                Err(missing) => first.get_or_insert(missing),
            };
        }
        for place in &places {
            if let Some(found) = self.any_case(place)
                && let Ok(bytes) = self.read(&found)
            {
                return Ok((found, bytes));
            }
        }
        Err(first.unwrap_or_else(|| Missing::Refused(format!("{path:?} is not a file name"))))
    }

    /// The path with the capitals that the files have: names written where capitals do not matter.
    fn any_case(&self, relative: &str) -> Option<String> {
        self.resolve(relative).ok()?;
        let mut found = String::new();
        for part in relative.replace('\\', "/").split('/').filter(|part| !matches!(*part, "" | ".")) {
            // A scene of the working folder lies in one without a name, which cannot be listed.
            let folder = self.path.join(&found);
            let entries = fs::read_dir(if folder.as_os_str().is_empty() { Path::new(".") } else { &folder }).ok()?;
            let names = entries.filter_map(|entry| entry.ok()?.file_name().into_string().ok());
            // The first in order, since folders list theirs in any.
            let name = names.filter(|name| part == ".." || name.eq_ignore_ascii_case(part)).min();
            let name = if part == ".." { "..".to_owned() } else { name? };
            found = if found.is_empty() { name } else { format!("{found}/{name}") };
        }
        Some(found)
    }

    /// The path of a relative reference; refuses URLs, absolute paths and paths that leave the folder.
    fn resolve(&self, relative: &str) -> Result<PathBuf, String> {
        let unified = relative.replace('\\', "/");
        if unified.is_empty() || unified.contains('\0') {
            return Err(format!("{relative:?} is not a file name"));
        }
        if let Some((scheme, _)) = unified.split_once(':')
            && scheme.chars().all(|c| c.is_ascii_alphanumeric() || "+-.".contains(c))
        {
            return Err(format!("{relative:?} is a URL or absolute path; only files in the scene's folder are read"));
        }
        if unified.starts_with('/') {
            return Err(format!("{relative:?} is an absolute path; only files in the scene's folder are read"));
        }
        let mut depth = 0i64;
        for part in unified.split('/') {
            depth += match part {
                "" | "." => 0,
                ".." => -1,
                _ => 1,
            };
            if depth < 0 {
                return Err(format!("{relative:?} leaves the scene's folder; move the file into it"));
            }
        }
        Ok(self.path.join(unified))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_files_below_the_folder_are_reached() {
        let folder = Folder::of(Path::new("scenes/a.gltf"));
        for good in ["b.bin", "textures/b.png", "textures\\b.png", "x/../b.png", "./b c.png"] {
            assert!(folder.resolve(good).is_ok_and(|p| p.starts_with("scenes")), "{good}");
        }
        for bad in ["", "../b.bin", "x/../../b", "/etc/passwd", "http://a/b", "file:b", "C:\\b", "\\\\host\\b"] {
            assert!(folder.resolve(bad).is_err(), "{bad}");
        }
    }
}
