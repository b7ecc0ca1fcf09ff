//! How a bake came to be: what was asked and what was reached.

use crate::{Effect, EffectCost};
use serde::{Deserialize, Serialize};

/// What the user asked the baker for.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Settings {
    /// Number of bands, or the most where fewer may do.
    pub bands: u32,
    /// Whether fewer bands may be baked.
    pub band_choice: BandChoice,
    /// Norm of each band of the light that the result is meant for, the largest of its channels; empty where none was named.
    pub light: Vec<f32>,
    /// When to stop tracing.
    pub quality: Quality,
    /// Seconds that were allowed, where the error asked for followed from them.
    pub time: Option<f32>,
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

/// Whether bands may be left out.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum BandChoice {
    /// As many as asked for.
    Exactly,
    /// Those whose absence would show: as many as asked for at most.
    Needed,
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
    /// What each effect took and what was saved, in the order of the plan.
    pub effects: Vec<EffectCost>,
    /// What light maps took and reached, where there are any.
    pub maps: Option<MapRecord>,
    /// What gloss and transfer textures took and reached, where there are any.
    pub gloss: Option<GlossRecord>,
    /// Error of the direct transfer between receivers, as renderers interpolate it, against the transfer measured at points
    /// there: median, 95th percentile, worst; none where it was not measured. In the supplement.
    #[serde(skip)]
    pub interpolation: Option<[f32; 3]>,
    /// Bound of what further bounces would add, against an open receiver, where bounces faded slowly and the tail of their series was summed
    /// in closed form; none where they ended by themselves or at a number asked for. In the supplement.
    #[serde(skip)]
    pub remainder: Option<f32>,
    /// A receiver at a corner of the triangle that holds the worst of those points. In the supplement.
    #[serde(skip)]
    pub worst_between: Option<u32>,
}

/// What gloss and transfer textures took and reached.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, Default)]
pub struct GlossRecord {
    /// Receivers of gloss at vertices.
    pub vertices: u64,
    /// Texels of the finest levels that a surface touches.
    pub texels: u64,
    /// Of these, those inside of bodies: they were filled from their own chart.
    pub inside: u64,
    /// Of those, the ones whose chart has nothing to fill them with: they took what the vertices around them take.
    pub unfilled: u64,
    /// Any-hit and closest-hit rays, which are also in those of the whole bake.
    pub rays: [u64; 2],
    /// Estimated error at texels, against that of an open point: median, 95th percentile, worst.
    pub error: [f32; 3],
    /// Relative error that compression added, root mean square over receivers: diffuse transfer, visibility, and bounces against all that arrives.
    pub compression: [f32; 3],
    /// Bytes that the same would take as f32 without compression, and that it takes.
    pub bytes: [u64; 2],
}

/// What light maps took and reached.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, Default)]
pub struct MapRecord {
    /// Texels that a surface touches.
    pub texels: u64,
    /// Of these, those inside of bodies: they were filled from their own chart.
    pub inside: u64,
    /// Of those, the ones whose chart has nothing to fill them with: they took what the vertices around them take.
    pub unfilled: u64,
    /// Estimated error of the irradiance in 3 bands over normals, against that of an open point: median, 95th percentile, worst.
    pub error: [f32; 3],
    /// Any-hit and closest-hit rays, which are also in those of the whole bake.
    pub rays: [u64; 2],
    /// Numbers beyond the range of the encoding, which were brought to its border.
    pub clipped: u64,
    /// Negative numbers where the encoding has none, which became 0.
    pub negative: u64,
}

/// Receivers that were found broken and mended: moved to where their surface comes out of the body, or from their neighbours.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, Default)]
pub struct RepairCounts {
    /// Inside geometry: less than half open, and more than half of what they see are the backs of surfaces.
    pub inside: u32,
    /// With a normal that is no direction or points behind the surface: it is replaced by that of the faces, or, where these
    /// have none, the neighbours' values are taken.
    pub bad_normals: u32,
    /// Of these, without a sound neighbour: left dark.
    pub unrepaired: u32,
}
