//! Why a picture cannot be drawn.

use std::fmt;

/// Why a picture cannot be drawn.
#[derive(Debug, Clone, PartialEq, Eq)]
#[non_exhaustive]
pub enum Error {
    /// What is asked for is out of range: the field, its value, the range.
    Frame(String),
    /// The baked scene contradicts itself: what, where.
    Prt(String),
}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Frame(what) => write!(f, "cannot draw this frame: {what}"),
            Self::Prt(what) => write!(f, "cannot draw this .prt: {what}; bake the scene again"),
        }
    }
}

impl std::error::Error for Error {}
