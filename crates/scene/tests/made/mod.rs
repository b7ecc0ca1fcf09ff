//! Small scene files written by tests.

use std::path::PathBuf;

use scene::{Error, Scene};

/// A folder that goes away with the value.
pub(crate) struct Folder(tempfile::TempDir);

impl Folder {
    /// A fresh folder.
    pub(crate) fn new() -> Self {
        Self(tempfile::tempdir().expect("a temporary folder"))
    }

    /// Writes a file and gives its path.
    pub(crate) fn write(&self, name: &str, content: impl AsRef<[u8]>) -> PathBuf {
        let path = self.0.path().join(name);
        std::fs::create_dir_all(path.parent().expect("a folder")).expect("a made folder");
        std::fs::write(&path, content).expect("a written file");
        path
    }

    /// Writes a scene file and loads it.
    pub(crate) fn load(&self, name: &str, content: impl AsRef<[u8]>) -> Result<Scene, Error> {
        scene::load(&self.write(name, content))
    }
}

/// Loads one scene file of its own.
pub(crate) fn load(name: &str, content: impl AsRef<[u8]>) -> Result<Scene, Error> {
    Folder::new().load(name, content)
}
