//! What a bake tells its caller while it runs.

/// How far a stage of the bake has come.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Progress {
    /// What is being computed.
    pub stage: Stage,
    /// Receivers finished in this stage.
    pub done: u64,
    /// Receivers of this stage.
    pub total: u64,
    /// Rays traced since the bake began.
    pub rays: u64,
}

/// A stage of the bake.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Stage {
    /// What each receiver sees of the sky.
    Visibility,
    /// The same for the backs of surfaces that light reaches.
    Backs,
    /// The n-th bounce, from 1.
    Bounce(u32),
}

impl std::fmt::Display for Stage {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Visibility => write!(f, "visibility"),
            Self::Backs => write!(f, "backs of surfaces"),
            Self::Bounce(n) => write!(f, "bounce {n}"),
        }
    }
}
