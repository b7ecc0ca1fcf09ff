//! How a bake came to be: what was asked, what was decided, what was reached.

use serde::{Deserialize, Serialize};

/// What the user asked the baker for.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Settings {
    /// Number of bands.
    pub bands: u32,
    /// When to stop tracing.
    pub quality: Quality,
    /// How often light may bounce.
    pub bounces: Bounces,
    /// Whether large triangles are split before the bake.
    pub refine: Refine,
    /// Which effects may be simulated.
    pub effects: Effects,
    /// Which sequence the rays follow.
    pub sampler: Sampler,
    /// Seed of everything random.
    pub seed: u64,
    /// Bytes that caches may take.
    pub memory: u64,
}

/// When the rays of a receiver suffice.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub enum Quality {
    /// A fixed number of rays per receiver.
    Rays(u32),
    /// Relative error of the transfer vector, against that of an open receiver.
    Error(f32),
}

/// How often light may bounce.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Bounces {
    /// Until the next bounce changes less than the tolerance.
    Auto,
    /// Exactly so often.
    Fixed(u32),
}

/// Whether large triangles are split, so that their vertices can hold shadows.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub enum Refine {
    /// The mesh stays as it is: one receiver per vertex of the file.
    Off,
    /// As evenly as the scene's own triangles allow.
    Auto,
    /// Until no edge is longer than this, metres.
    Edge(f32),
}

/// Which effects may be simulated.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub enum Effects {
    /// Those that the scene calls for.
    Auto,
    /// All, called for or not.
    All,
    /// Just these.
    Only(Vec<Effect>),
}

/// One effect of light transport.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub enum Effect {
    /// Shadows: rays decide what a receiver sees.
    Visibility,
    /// Light that bounces between surfaces.
    Interreflection,
    /// Transfer in three channels.
    Color,
    /// Alpha masks that rays may pass.
    Masks,
    /// Reflections on materials that shine.
    Specular,
    /// Tangents for normal-mapped reflections.
    NormalMaps,
    /// Light that surfaces emit, as drawn.
    Emission,
    /// Surfaces that let light through.
    Transmission,
}

/// The sequence that the rays of a receiver follow.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Sampler {
    /// Owen-scrambled Sobol points, cosine-weighted; can go on.
    OwenSobol,
    /// Fibonacci lattice with a random shift, cosine-weighted; best at a fixed number.
    Fibonacci,
    /// Jittered grid over the sphere, as the first paper has it.
    Stratified,
}

/// Which effects a bake simulates, and why.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, Default)]
pub struct Plan {
    /// One row per effect, in the order of [`Effect`].
    pub rows: Vec<PlanRow>,
    /// Receivers that are baked.
    pub receivers: u64,
    /// Receivers that something can stand above.
    pub shadowed_receivers: u64,
    /// Channels of the transfer.
    pub channels: u32,
    /// Most bounces that can change the result by more than the tolerance.
    pub bounces: u32,
}

/// The decision on one effect.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct PlanRow {
    /// The effect.
    pub effect: Effect,
    /// Whether it is simulated.
    pub simulate: bool,
    /// The facts that decided it, in one sentence.
    pub reason: String,
    /// Objects that call for it, at most a handful by name.
    pub called_for_by: Vec<String>,
    /// Estimated rays.
    pub rays: u64,
    /// Estimated bytes in the file.
    pub bytes: u64,
}

/// What a bake reached and what it took.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, Default)]
pub struct Achieved {
    /// Estimated relative error of the direct transfer over receivers: median, 95th percentile, worst.
    pub error: [f32; 3],
    /// Receiver with the worst error.
    pub worst_receiver: u32,
    /// Any-hit rays traced.
    pub visibility_rays: u64,
    /// Closest-hit rays traced.
    pub bounce_rays: u64,
    /// Bounces simulated.
    pub bounces: u32,
    /// Relative change of each bounce.
    pub bounce_changes: Vec<f32>,
    /// Receivers that needed repair.
    pub repairs: RepairCounts,
}

/// Receivers that were found broken and mended from their neighbours.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, Default)]
pub struct RepairCounts {
    /// Inside geometry: almost all that they see are the backs of surfaces.
    pub inside: u32,
    /// With a normal that is no direction or points behind the surface: it is replaced by that of the faces, or, where these
    /// have none, the neighbours' values are taken.
    pub bad_normals: u32,
    /// Of these, without a sound neighbour: left dark.
    pub unrepaired: u32,
}
