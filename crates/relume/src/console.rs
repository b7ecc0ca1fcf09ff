//! What the user sees: results on stdout; notices, progress and errors on stderr.

use anyhow::Result;
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use std::io::{self, IsTerminal, Write};
use std::sync::Mutex;
use std::time::{Duration, Instant};

/// Time between two lines of progress where there is no terminal.
const LINE_EVERY: Duration = Duration::from_secs(5);

/// How much is said.
#[derive(Debug)]
pub(crate) struct Console {
    quiet: bool,
    verbose: bool,
}

impl Console {
    pub(crate) fn new(quiet: bool, verbose: bool) -> Self {
        Self { quiet, verbose }
    }

    /// Prints a result on stdout.
    pub(crate) fn print(&self, text: &str) -> Result<()> {
        let mut out = io::stdout().lock();
        out.write_all(visible(text).as_bytes())?;
        if !text.ends_with('\n') {
            out.write_all(b"\n")?;
        }
        Ok(out.flush()?)
    }

    /// Tells something that the user should know.
    pub(crate) fn notice(&self, text: &str) {
        if !self.quiet {
            self.line(text);
        }
    }

    /// Tells what is typed next.
    pub(crate) fn next(&self, command: &str) {
        self.notice(&format!("next: {command}"));
    }

    /// Tells something that only `-v` asks for.
    pub(crate) fn detail(&self, text: &str) {
        if self.verbose {
            self.line(text);
        }
    }

    /// Tells on one line why the command failed.
    pub(crate) fn error(&self, error: &anyhow::Error) {
        let text = format!("{error:#}");
        let text = text.split_whitespace().collect::<Vec<_>>().join(" ");
        self.line(&format!("error: {text}"));
    }

    /// A lost stderr is no reason to stop.
    fn line(&self, text: &str) {
        let _ = writeln!(io::stderr(), "{}", visible(text));
    }

    /// Shows how far a long work is: a bar with rate and time left on a terminal, a line now and then elsewhere.
    pub(crate) fn progress(&self) -> Progress {
        let shown = !self.quiet;
        let bar = (shown && io::stderr().is_terminal()).then(|| {
            let bar = ProgressBar::with_draw_target(Some(0), ProgressDrawTarget::stderr());
            let style = ProgressStyle::with_template("{msg} {wide_bar} {percent}%  {per_sec}  {eta} left");
            // The template is a constant; a wrong one would only cost the looks.
            bar.set_style(style.unwrap_or_else(|_| ProgressStyle::default_bar()));
            bar
        });
        let lines = Mutex::new(Lines { stage: String::new(), began: Instant::now(), said: Instant::now() });
        Progress { lines: shown && bar.is_none(), bar, state: lines }
    }
}

/// The text with the control characters of names escaped; ends of lines and tabs are our own.
fn visible(text: &str) -> String {
    text.split_inclusive(['\n', '\t'])
        .map(|part| match part.strip_suffix(['\n', '\t']) {
            Some(start) => scene::printable(start) + &part[start.len()..],
            None => scene::printable(part),
        })
        .collect()
}

/// Whether `error` means that the reader of our output has gone away.
pub(crate) fn is_broken_pipe(error: &anyhow::Error) -> bool {
    error.downcast_ref::<io::Error>().is_some_and(|e| e.kind() == io::ErrorKind::BrokenPipe)
}

/// The progress of one command; may be told from any thread.
#[derive(Debug)]
pub(crate) struct Progress {
    bar: Option<ProgressBar>,
    lines: bool,
    state: Mutex<Lines>,
}

#[derive(Debug)]
struct Lines {
    stage: String,
    began: Instant,
    said: Instant,
}

impl Progress {
    /// `done` of `total` of a stage are finished; a new stage name starts the clock anew.
    pub(crate) fn set(&self, stage: &str, done: u64, total: u64) {
        // A panic elsewhere is no reason for another one here.
        let mut state = self.state.lock().unwrap_or_else(std::sync::PoisonError::into_inner);
        let now = Instant::now();
        let new = state.stage != stage;
        if new {
            *state = Lines { stage: stage.to_owned(), began: now, said: now };
        }
        if let Some(bar) = &self.bar {
            if new {
                bar.reset();
                bar.set_message(stage.to_owned());
            }
            bar.set_length(total);
            bar.set_position(done);
        } else if self.lines && (new || now - state.said >= LINE_EVERY) {
            state.said = now;
            let _ = writeln!(io::stderr(), "{}", line(stage, done, total, now - state.began));
        }
    }
}

impl Drop for Progress {
    fn drop(&mut self) {
        if let Some(bar) = &self.bar {
            bar.finish_and_clear();
        }
    }
}

/// One line of progress, with rate and time left once there is something to reckon from.
fn line(stage: &str, done: u64, total: u64, spent: Duration) -> String {
    if done == 0 || spent < LINE_EVERY {
        return format!("{stage}: {done} of {total}");
    }
    let rate = done as f64 / spent.as_secs_f64();
    let left = total.saturating_sub(done) as f64 / rate;
    format!("{stage}: {done} of {total}, {rate:.0}/s, {left:.0} s left")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn control_characters_of_names_do_not_reach_the_terminal() {
        assert_eq!(visible("a\u{1b}[2J:\tb\r\nc\n"), "a\\u{1b}[2J:\tb\\r\nc\n");
        assert_eq!(visible("no end"), "no end");
    }

    #[test]
    fn lines_tell_rate_and_time_left() {
        assert_eq!(line("rays", 0, 10, Duration::ZERO), "rays: 0 of 10");
        assert_eq!(line("rays", 200, 1000, Duration::from_secs(10)), "rays: 200 of 1000, 20/s, 40 s left");
    }
}
