//! Plots of accuracy against price, as SVG text and as pixels.

mod axis;
pub mod chart;
pub(crate) mod font;
pub mod pixels;
mod words;

/// Why a plot or a picture could not be made.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("cannot draw {what}: {reason}; report this as a bug")]
pub struct Error {
    /// What was to be drawn.
    pub what: &'static str,
    /// What the library said.
    pub reason: String,
}
