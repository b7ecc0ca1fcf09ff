//! What can go wrong with a light probe, as one sentence each.

use std::path::PathBuf;

/// Why a light probe could not be read or written.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// The operating system refused.
    #[error("cannot {doing} {path}", path = .path.display())]
    Io {
        /// `read` or `write`.
        doing: &'static str,
        /// The file or folder.
        path: PathBuf,
        /// What the system said.
        source: std::io::Error,
    },
    /// The file is fine as such, but holds something that is not read here.
    #[error("{path}: {what}", path = .path.display())]
    Unsupported {
        /// The file or folder.
        path: PathBuf,
        /// What it holds, and what to do.
        what: String,
    },
    /// The bytes contradict the format or hold impossible radiance.
    #[error("{path}: {what}", path = .path.display())]
    Invalid {
        /// The file or folder.
        path: PathBuf,
        /// What is wrong and where in the file.
        what: String,
    },
    /// A pixel is infinite or not a number; [`crate::NonFinite::Clamp`] replaces such pixels.
    #[error("{path}: {what}", path = .path.display())]
    NotFinite {
        /// The file.
        path: PathBuf,
        /// Which pixel, and what to do.
        what: String,
    },
}

/// The part of an error that does not know the file's name yet.
#[derive(Debug)]
pub(crate) enum Fault {
    /// A known thing that is not read here.
    Unsupported(String),
    /// Bytes that contradict the format.
    Invalid(String),
    /// Pixels that are infinite or not a number.
    NotFinite(String),
}

impl Fault {
    /// Names the file.
    pub(crate) fn at(self, path: &std::path::Path) -> Error {
        let path = path.to_path_buf();
        match self {
            Fault::Unsupported(what) => Error::Unsupported { path, what },
            Fault::Invalid(what) => Error::Invalid { path, what },
            Fault::NotFinite(what) => Error::NotFinite { path, what },
        }
    }
}
