//! The typeface of plots: carried along, so that a plot looks the same on every machine.

use plotters::style::{FontStyle, register_font};
use std::sync::OnceLock;

/// The family name that plots use; browsers have one of their own for it.
pub(crate) const FAMILY: &str = "sans-serif";

/// Hands the typeface to the plotting library, once.
pub(crate) fn register() -> Result<(), super::Error> {
    static DONE: OnceLock<bool> = OnceLock::new();
    let done = DONE.get_or_init(|| register_font(FAMILY, FontStyle::Normal, dejavu::sans::regular()).is_ok());
    if *done { Ok(()) } else { Err(super::Error { what: "text", reason: "the typeface is no typeface".into() }) }
}
