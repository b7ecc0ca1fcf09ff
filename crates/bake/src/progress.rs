//! What a bake tells its caller while it runs.

/// How far a stage of the bake has come.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Progress {
    /// What is being computed.
    pub stage: Stage,
    /// Receivers (of the refinement: points between vertices; of a volume: probes) finished in this stage.
    pub done: u64,
    /// Receivers of this stage.
    pub total: u64,
    /// Rays traced since the bake began.
    pub rays: u64,
}

/// A stage of the bake.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Stage {
    /// The tree that rays walk, and what the plan needs to know.
    Preparation,
    /// Where the transfer bends between vertices.
    Refinement,
    /// What each receiver sees of the sky.
    Visibility,
    /// The same for the backs of surfaces and for surfaces very near to a receiver, where light reaches them.
    Helpers,
    /// What points between receivers see, to tell how far interpolation errs.
    Between,
    /// The n-th bounce, from 1.
    Bounce(u32),
    /// What surfaces that shine see.
    Gloss,
    /// What arrives at the texels of light maps and transfer textures.
    Texels,
    /// What arrives at the probes of a volume.
    Probes,
}

impl std::fmt::Display for Stage {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Preparation => write!(f, "preparation"),
            Self::Refinement => write!(f, "refinement"),
            Self::Visibility => write!(f, "visibility"),
            Self::Helpers => write!(f, "backs and near surfaces"),
            Self::Between => write!(f, "error between receivers"),
            Self::Bounce(n) => write!(f, "bounce {n}"),
            Self::Gloss => write!(f, "gloss"),
            Self::Texels => write!(f, "texels"),
            Self::Probes => write!(f, "probes"),
        }
    }
}
