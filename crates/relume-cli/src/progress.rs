//! One bar for a whole command on a terminal, a line now and then elsewhere.

use crate::meter::{Meter, Reading, in_words};
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use std::io::{self, IsTerminal, Write};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

/// Time between two lines of progress where there is no terminal.
const LINE_EVERY: Duration = Duration::from_secs(5);

/// Commands that are done by then say nothing of their progress.
const QUIET_FOR: Duration = Duration::from_millis(500);

/// Steps of the bar.
const STEPS: f64 = 1_000.0;

/// The bar that is on the terminal, so that whoever writes can make room.
static SHOWN: Mutex<Option<ProgressBar>> = Mutex::new(None);

/// A panic elsewhere is no reason for another one here.
fn locked<T>(state: &Mutex<T>) -> MutexGuard<'_, T> {
    state.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Writes a line on stderr, above the bar where there is one. A lost stderr is no reason to stop.
pub(crate) fn say(text: &str) {
    let write = || {
        let _ = writeln!(io::stderr(), "{text}");
    };
    match &*locked(&SHOWN) {
        Some(bar) => bar.suspend(write),
        None => write(),
    }
}

/// Takes the bar off the terminal.
pub(crate) fn clear() {
    if let Some(bar) = locked(&SHOWN).take() {
        bar.finish_and_clear();
    }
}

/// How far a command is, told from any thread; while it lives the bar is on the terminal.
#[derive(Debug)]
pub(crate) struct Progress {
    state: Option<Arc<Mutex<State>>>,
}

/// What is known of the command, whoever tells of it.
#[derive(Debug)]
pub(crate) struct State {
    meter: Meter,
    began: Instant,
    said: Option<Instant>,
}

impl State {
    pub(crate) fn new(began: Instant) -> State {
        State { meter: Meter::new(began), began, said: None }
    }
}

impl Progress {
    /// Shows nothing where no state is given.
    pub(crate) fn new(state: Option<Arc<Mutex<State>>>) -> Progress {
        Progress { state }
    }

    /// Says which stages will come, with about how long each takes against the others.
    pub(crate) fn expect(&self, stages: &[(&str, f64)]) {
        if let Some(state) = &self.state {
            locked(state).meter.expect(stages);
        }
    }

    /// `done` of `total` of a stage are finished.
    pub(crate) fn set(&self, stage: &str, done: u64, total: u64) {
        self.tell(stage, stage, if total > 0 { done as f64 / total as f64 } else { 0.0 });
    }

    /// A share of a stage is finished; `text` says what is going on.
    pub(crate) fn tell(&self, stage: &str, text: &str, share: f64) {
        let Some(state) = &self.state else { return };
        let mut state = locked(state);
        let now = Instant::now();
        let reading = state.meter.set(stage, share, now);
        if io::stderr().is_terminal() {
            draw(text, reading);
        } else if now.saturating_duration_since(state.began) >= QUIET_FOR
            && (reading.new || state.said.is_none_or(|said| now.saturating_duration_since(said) >= LINE_EVERY))
        {
            state.said = Some(now);
            drop(state);
            say(&line(text, reading));
        }
    }
}

impl Drop for Progress {
    fn drop(&mut self) {
        if self.state.is_some() {
            clear();
        }
    }
}

/// Puts a reading into the bar.
fn draw(text: &str, reading: Reading) {
    let mut shown = locked(&SHOWN);
    let bar = shown.get_or_insert_with(|| {
        let bar = ProgressBar::with_draw_target(Some(STEPS as u64), ProgressDrawTarget::stderr());
        let style = ProgressStyle::with_template("{msg} {wide_bar} {percent} %{prefix}");
        // The template is a constant; a wrong one would only cost the looks.
        bar.set_style(style.unwrap_or_else(|_| ProgressStyle::default_bar()));
        bar
    });
    if bar.message() != text {
        bar.set_message(text.to_owned());
    }
    bar.set_prefix(reading.left.map_or(String::new(), |left| format!(", {} left", in_words(left))));
    bar.set_position((STEPS * reading.share) as u64);
}

/// One line of progress: the share of the whole command, and the time left of it once that can be told.
fn line(text: &str, reading: Reading) -> String {
    let percent = 100.0 * reading.share;
    match reading.left {
        Some(left) => format!("{text}: {percent:.0} % done, {} left", in_words(left)),
        None => format!("{text}: {percent:.0} % done"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_tell_share_and_time_left() {
        let reading = Reading { share: 0.204, left: None, new: true };
        assert_eq!(line("visibility", reading), "visibility: 20 % done");
        let reading = Reading { left: Some(Duration::from_secs(40)), ..reading };
        assert_eq!(line("visibility", reading), "visibility: 20 % done, 40 s left");
    }
}
