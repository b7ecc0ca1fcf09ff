//! Keeps graphics drivers from writing to stderr while they are being looked for.

/// Runs `work`, during which nothing that other code writes to stderr is shown.
///
/// Mesa's layers complain there about a missing display, which no picture needs.
#[cfg(unix)]
pub(crate) fn silenced<T>(work: impl FnOnce() -> T) -> T {
    let Ok(restore) = Restore::new() else { return work() };
    let result = work();
    drop(restore);
    result
}

/// Elsewhere nothing complains.
#[cfg(not(unix))]
pub(crate) fn silenced<T>(work: impl FnOnce() -> T) -> T {
    work()
}

/// What stderr was before; it is so again when this goes, be it by a panic.
#[cfg(unix)]
struct Restore(std::os::fd::OwnedFd);

#[cfg(unix)]
impl Restore {
    fn new() -> std::io::Result<Self> {
        use std::os::fd::AsFd;
        let before = std::io::stderr().as_fd().try_clone_to_owned()?;
        let nothing = std::fs::OpenOptions::new().write(true).open("/dev/null")?;
        rustix::stdio::dup2_stderr(nothing)?;
        Ok(Self(before))
    }
}

#[cfg(unix)]
impl Drop for Restore {
    fn drop(&mut self) {
        let _ = rustix::stdio::dup2_stderr(&self.0);
    }
}
