//! Which effects a bake simulates, and why: decided from the scene before any ray of the bake.

use serde::{Deserialize, Serialize};

/// One effect of light transport or of drawing.
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
    /// Which part of a reflection is blocked, and what the blocking surfaces send, by direction.
    Glossy,
    /// Tangents for normal-mapped reflections.
    NormalMaps,
    /// All the bands that were asked for.
    Bands,
    /// Light that surfaces emit, as drawn.
    Emission,
    /// Surfaces that let light through.
    Transmission,
    /// Objects that move: never simulated, but named.
    Motion,
}

impl Effect {
    /// Every effect, in the order of a plan.
    pub const ALL: [Self; 11] = [
        Self::Visibility,
        Self::Interreflection,
        Self::Color,
        Self::Masks,
        Self::Specular,
        Self::Glossy,
        Self::NormalMaps,
        Self::Bands,
        Self::Emission,
        Self::Transmission,
        Self::Motion,
    ];

    /// The name as typed and printed, such as `normal-maps`.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Visibility => "visibility",
            Self::Interreflection => "interreflection",
            Self::Color => "color",
            Self::Masks => "masks",
            Self::Specular => "specular",
            Self::Glossy => "glossy",
            Self::NormalMaps => "normal-maps",
            Self::Bands => "bands",
            Self::Emission => "emission",
            Self::Transmission => "transmission",
            Self::Motion => "motion",
        }
    }
}

/// Which effects a bake simulates, and why.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, Default)]
pub struct Plan {
    /// One row per effect, in the order of [`Effect::ALL`].
    pub rows: Vec<PlanRow>,
    /// What each mesh of the scene calls for.
    pub meshes: Vec<MeshPlan>,
    /// What a few receivers were found to see.
    pub survey: Survey,
    /// Receivers that are baked.
    pub receivers: u64,
    /// Receivers that something can stand above.
    pub shadowed_receivers: u64,
    /// Of these, on surfaces that neither scatter nor mirror light: nothing is traced for them.
    pub dark_receivers: u64,
    /// Bands of the transfer.
    pub bands: u32,
    /// Channels of the transfer.
    pub channels: u32,
    /// Most bounces that can change the result by more than the tolerance: a bound from the largest albedo.
    pub bounces: u32,
    /// Bounces that are expected to, from the mean albedo and the largest coverage that the survey saw.
    pub expected_bounces: u32,
}

/// The decision on one effect.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct PlanRow {
    /// The effect.
    pub effect: Effect,
    /// Whether it is simulated.
    pub simulate: bool,
    /// What is done, in a few words.
    pub decision: String,
    /// The facts that decided it, in one sentence.
    pub reason: String,
    /// Meshes, materials or nodes that call for it, at most a handful by name.
    pub called_for_by: Vec<String>,
    /// How many call for it.
    pub callers: u64,
    /// Estimated rays.
    pub rays: u64,
    /// Estimated bytes in the file.
    pub bytes: u64,
    /// Largest change of the radiance of a surface if the decision were wrong, against that of an open white surface under
    /// the same light; for emission against a sky of radiance 1.
    pub stake: f32,
    /// The same in one sentence.
    pub at_stake: String,
}

/// What one mesh calls for.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct MeshPlan {
    /// Index of the mesh in the file; its back, where it has one, is counted here too.
    pub mesh: u32,
    /// Receivers on it.
    pub receivers: u64,
    /// Of these, those that something can stand above.
    pub shadowed: u64,
    /// Effects that are simulated for it.
    pub effects: Vec<Effect>,
}

/// A look at a few receivers with few rays before the bake: facts for the plan, never part of the result.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, Default)]
pub struct Survey {
    /// Receivers looked at.
    pub receivers: u64,
    /// Rays traced for it.
    pub rays: u64,
    /// Share of their cosine-weighted hemispheres that is blocked: mean and largest.
    pub coverage: [f32; 2],
    /// Largest norm of each band of the direct transfer, over these receivers and an open one.
    pub band_norms: Vec<f32>,
}

/// What one effect took in a bake, and what the plan saved of it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub struct EffectCost {
    /// The effect.
    pub effect: Effect,
    /// Rays traced for it.
    pub rays: u64,
    /// Rays not traced, at least: those that every receiver would have taken without a plan.
    pub saved_rays: u64,
    /// Bytes in the file that are there for it.
    pub bytes: u64,
    /// Bytes that the file would have had more without a plan.
    pub saved_bytes: u64,
}
