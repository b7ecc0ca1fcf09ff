//! Wrong usage that clap cannot see.

use std::fmt;

/// Wrong usage that only shows when a file is open; ends with exit code 2, as clap's own complaints do.
#[derive(Debug)]
pub(crate) struct Usage(pub(crate) String);

impl fmt::Display for Usage {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.0)
    }
}

impl std::error::Error for Usage {}

/// A number that is out of range is wrong usage; everything else is a failure.
pub(crate) fn fault(error: relume::Error) -> anyhow::Error {
    match error {
        relume::Error::Bands { .. } => Usage(error.to_string()).into(),
        relume::Error::Bake(error) => crate::bake::fault(error),
        other => other.into(),
    }
}
