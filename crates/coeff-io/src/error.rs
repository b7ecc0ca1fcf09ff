//! What can go wrong with a `.prt` file, and whose fault it is.

/// Why a `.prt` file could not be read or written.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// The file may be sound, but this program does not know what it holds.
    #[error("{0}")]
    Unsupported(String),
    /// The file (or the data to be written) contradicts the format.
    #[error("{what} (at byte {at})")]
    Invalid {
        /// Offset in the file, bytes.
        at: u64,
        /// What is wrong there, in one sentence.
        what: String,
    },
    /// The system refused to read or write.
    #[error(transparent)]
    Io(#[from] std::io::Error),
}

impl Error {
    /// The file is wrong at byte `at`.
    pub(crate) fn invalid(at: u64, what: impl Into<String>) -> Self {
        Self::Invalid { at, what: what.into() }
    }
}
