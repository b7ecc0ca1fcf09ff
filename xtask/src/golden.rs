//! Golden pictures: compares what is drawn today with what was found good, or accepts it by name.

use crate::run::{self as command, cargo};
use anyhow::Result;

/// What is done with the golden pictures.
#[derive(Debug, clap::Subcommand)]
pub(crate) enum Act {
    /// Draws the pictures and compares them with tests/golden.
    Check {
        /// Only this one.
        name: Option<String>,
    },
    /// Accepts what is drawn today as the golden picture of that name.
    Bless {
        /// Name of the picture, or all.
        name: String,
    },
}

/// Runs the test that owns the pictures; what differs is left in target/golden/current.
pub(crate) fn run(act: &Act) -> Result<()> {
    let (name, bless) = match act {
        Act::Check { name } => (name.as_deref(), false),
        Act::Bless { name } if name == "all" => (None, true),
        Act::Bless { name } => (Some(name.as_str()), true),
    };
    let mut settings = Vec::new();
    settings.extend(name.map(|name| ("RELUME_GOLDEN", name)));
    settings.extend(bless.then_some(("RELUME_BLESS", "1")));
    let test = ["test", "--release", "--package", "relume-cli", "--test", "golden", "--", "pictures_are_as_they_were"];
    command::run_with(&settings, &cargo(), &test)
}
