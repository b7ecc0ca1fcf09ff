//! Ctrl-C, a request to terminate, and the end of the time that was given: the program leaves at once, whatever it is doing.
//!
//! No work needs to be asked whether it should go on, not even that of libraries: results are written beside their place and renamed,
//! so that a program that leaves takes what is unfinished with it.

use crate::progress;
use anyhow::Result;
use signal_hook::consts::{SIGINT, SIGTERM};
use signal_hook::flag;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread;
use std::time::{Duration, Instant};

/// Exit code of a program that a second Ctrl-C has ended, by the custom of shells.
const ENDED: i32 = 130;

/// Time between two looks for a signal.
const LOOK_EVERY: Duration = Duration::from_millis(20);

/// What is said when the program leaves with a result; none where there is none yet.
static HELD: Mutex<Held> = Mutex::new(Held { lines: None, over: false });

struct Held {
    lines: Option<Vec<String>>,
    /// Whether the command has all that it wanted.
    over: bool,
}

/// From now on Ctrl-C and a request to terminate let the program leave; a second Ctrl-C ends it whatever happens.
pub(crate) fn watch() -> Result<()> {
    let asked = Arc::new(AtomicBool::new(false));
    // The order matters: the first signal finds the flag down, and raises it.
    flag::register_conditional_shutdown(SIGINT, ENDED, Arc::clone(&asked))?;
    for signal in [SIGINT, SIGTERM] {
        flag::register(signal, Arc::clone(&asked))?;
    }
    thread::Builder::new().name("signals".into()).spawn(move || {
        while !asked.load(Ordering::Relaxed) {
            thread::sleep(LOOK_EVERY);
        }
        leave("interrupted");
    })?;
    Ok(())
}

/// Keeps what is to be said when the program leaves from now on: there is a result.
pub(crate) fn hold(lines: Vec<String>) {
    let mut held = HELD.lock().unwrap_or_else(PoisonError::into_inner);
    held.lines = Some(lines);
}

/// The command has all that it wanted and speaks for itself: the end of the time comes too late.
pub(crate) fn over() {
    let mut held = HELD.lock().unwrap_or_else(PoisonError::into_inner);
    held.over = true;
}

/// Leaves at a moment, or as soon as there is a result after it.
pub(crate) fn leave_at(deadline: Instant) -> Result<()> {
    thread::Builder::new().name("deadline".into()).spawn(move || {
        thread::sleep(deadline.saturating_duration_since(Instant::now()));
        loop {
            let held = HELD.lock().unwrap_or_else(PoisonError::into_inner);
            if held.over {
                return;
            }
            let result = held.lines.is_some();
            drop(held);
            if result {
                leave("time is up");
            }
            thread::sleep(LOOK_EVERY);
        }
    })?;
    Ok(())
}

/// Ends the program with what is there: a success where a result is held.
fn leave(why: &str) {
    // Kept to the end, so that the command does not speak at the same time.
    let mut held = HELD.lock().unwrap_or_else(PoisonError::into_inner);
    if held.over && why == "time is up" {
        return;
    }
    coeff_io::abandon();
    progress::clear();
    match held.lines.take() {
        Some(lines) => {
            progress::say(&format!("{why}: the last result stays"));
            lines.iter().for_each(|line| progress::say(line));
            std::process::exit(0);
        }
        None => {
            progress::say(&format!("error: {why}: the work was cancelled; no file is left half written"));
            std::process::exit(1);
        }
    }
}
