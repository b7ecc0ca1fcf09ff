//! What the user sees: results on stdout; notices, progress and errors on stderr.

use crate::progress::{Progress, State, say};
use anyhow::Result;
use std::io::{self, Write};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::Instant;

/// How much is said.
#[derive(Debug)]
pub(crate) struct Console {
    quiet: bool,
    verbose: bool,
    began: Instant,
    /// How far the command is.
    state: Arc<Mutex<State>>,
    /// Notices that are kept instead of said.
    recorded: Option<Mutex<Vec<String>>>,
}

impl Console {
    /// For a command that began at a moment.
    pub(crate) fn new(quiet: bool, verbose: bool, began: Instant) -> Self {
        Self { quiet, verbose, began, state: Arc::new(Mutex::new(State::new(began))), recorded: None }
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

    fn line(&self, text: &str) {
        let text = visible(text);
        match &self.recorded {
            Some(lines) => lines.lock().unwrap_or_else(PoisonError::into_inner).push(text),
            None => say(&text),
        }
    }

    /// Shows how far the command is: a bar with the time left on a terminal, a line now and then elsewhere.
    pub(crate) fn progress(&self) -> Progress {
        Progress::new((!self.quiet).then(|| Arc::clone(&self.state)))
    }

    /// When the command began.
    pub(crate) fn began(&self) -> Instant {
        self.began
    }

    /// A console that keeps its notices instead of saying them.
    pub(crate) fn recorder(&self) -> Console {
        let recorded = Some(Mutex::new(Vec::new()));
        Console { recorded, state: Arc::clone(&self.state), ..*self }
    }

    /// What was noticed so far, where that is kept.
    pub(crate) fn recorded(self) -> Vec<String> {
        self.recorded.map_or_else(Vec::new, |lines| lines.into_inner().unwrap_or_else(PoisonError::into_inner))
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
