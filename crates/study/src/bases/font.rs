//! The font of the plots: Hack (MIT and Bitstream Vera licence), which the program carries.

use plotters::style::{FontStyle, register_font};

/// The family that texts ask for; pictures get Hack under this name, an SVG the reader's own.
pub(crate) const FAMILY: &str = "monospace";

/// Makes the font known to the plotting library; false when it does not understand the file.
pub(crate) fn register() -> bool {
    register_font(FAMILY, FontStyle::Normal, epaint_default_fonts::HACK_REGULAR).is_ok()
}
