//! Ctrl-C: the first asks the work to stop, the second ends the program.

use anyhow::Result;
use std::ops::ControlFlow;
use std::sync::atomic::{AtomicBool, Ordering};

static ASKED: AtomicBool = AtomicBool::new(false);

/// Exit code of a program that Ctrl-C has ended, by the custom of shells.
const ENDED: i32 = 130;

/// From now on Ctrl-C is noted instead of ending the program.
pub(crate) fn watch() -> Result<()> {
    let note = || {
        if ASKED.swap(true, Ordering::Relaxed) {
            std::process::exit(ENDED);
        }
    };
    Ok(ctrlc::set_handler(note)?)
}

/// Whether a work that is under way should go on.
pub(crate) fn flow() -> ControlFlow<()> {
    if ASKED.load(Ordering::Relaxed) { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
}
