//! What can go wrong between plain data and pixels.

/// Why the GPU gave no picture; each message says what, where and what to do.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// The machine has no graphics driver that can be used.
    #[error(
        "no GPU adapter was found ({reason}); install a driver (for example `apt install mesa-vulkan-drivers`) or use the CPU renderer"
    )]
    NoAdapter {
        /// What the graphics library says.
        reason: String,
    },
    /// An adapter stands there but gives no device.
    #[error("the GPU adapter {adapter} gave no device: {reason}; update its driver or use the CPU renderer")]
    NoDevice {
        /// Name of the adapter.
        adapter: String,
        /// What the graphics library says.
        reason: String,
    },
    /// Something is larger than the adapter can hold.
    #[error("{what} needs {needed} {unit}, but this GPU allows {limit}; {advice}")]
    TooLarge {
        /// The object concerned.
        what: String,
        /// How much it needs.
        needed: u64,
        /// How much the adapter allows.
        limit: u64,
        /// Unit of both numbers.
        unit: &'static str,
        /// What to do.
        advice: &'static str,
    },
    /// The scene or the frame contradicts itself.
    #[error("{what} is not valid: {problem}")]
    Invalid {
        /// The object concerned.
        what: String,
        /// What is wrong with it and what to do.
        problem: String,
    },
    /// The device is gone: its driver was reset, or its owner destroyed it.
    #[error("the GPU device is lost: {reason}; open another device and another renderer")]
    DeviceLost {
        /// What the graphics library says.
        reason: String,
    },
    /// The driver failed while it worked.
    #[error("the GPU failed while {doing}: {reason}; try again or use the CPU renderer")]
    Gpu {
        /// What was being done.
        doing: &'static str,
        /// What the graphics library says.
        reason: String,
    },
}

impl Error {
    /// Fails with [`Error::TooLarge`] where `needed` exceeds `limit`.
    pub(crate) fn check_fits(
        what: impl FnOnce() -> String,
        needed: u64,
        limit: u64,
        unit: &'static str,
        advice: &'static str,
    ) -> Result<(), Self> {
        if needed <= limit { Ok(()) } else { Err(Self::TooLarge { what: what(), needed, limit, unit, advice }) }
    }

    /// An [`Error::Invalid`] about `what`.
    pub(crate) fn invalid(what: impl Into<String>, problem: impl Into<String>) -> Self {
        Self::Invalid { what: what.into(), problem: problem.into() }
    }
}
