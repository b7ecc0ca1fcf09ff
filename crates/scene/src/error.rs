//! Whose fault it is when a scene cannot be loaded.

use std::path::{Path, PathBuf};

/// Why a scene was refused; always names the file, the object in it and the value.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// The file is in order but asks for something that this program does not do.
    #[error("{}: {object}: {value} is not supported; {hint}", file.display())]
    Unsupported {
        /// The scene file.
        file: PathBuf,
        /// The object in the file, such as `extensionsRequired`.
        object: String,
        /// The value that is not supported, such as the name of an extension.
        value: String,
        /// What the user can do.
        hint: String,
    },
    /// The file breaks the rules of its format.
    #[error("{}: {object}: {what}", file.display())]
    Invalid {
        /// The scene file.
        file: PathBuf,
        /// The object in the file, such as `accessors[3]` or `line 12`.
        object: String,
        /// What is wrong with it, with the value.
        what: String,
    },
    /// The operating system could not give the file.
    #[error("{}: cannot read the {object}", file.display())]
    Io {
        /// The file that could not be read.
        file: PathBuf,
        /// What wanted it, such as `scene` or `buffers[0]`.
        object: String,
        /// What the operating system said.
        source: std::io::Error,
    },
}

impl Error {
    pub(crate) fn invalid(file: &Path, object: impl Into<String>, what: impl Into<String>) -> Self {
        Self::Invalid { file: file.to_owned(), object: object.into(), what: what.into() }
    }

    pub(crate) fn unsupported(
        file: &Path,
        object: impl Into<String>,
        value: impl Into<String>,
        hint: impl Into<String>,
    ) -> Self {
        Self::Unsupported { file: file.to_owned(), object: object.into(), value: value.into(), hint: hint.into() }
    }

    pub(crate) fn io(file: &Path, object: impl Into<String>, source: std::io::Error) -> Self {
        Self::Io { file: file.to_owned(), object: object.into(), source }
    }
}
