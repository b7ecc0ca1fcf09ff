//! Why a bake could not be made.

use crate::SettingField;

/// What stopped a bake; the message says what, where and what to do.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// The scene holds nothing that can be baked.
    #[error("scene '{scene}' has no triangles: there is nothing to bake; check that the file holds meshes")]
    EmptyScene {
        /// Name of the scene.
        scene: String,
    },
    /// The scene is so small that squares of areas vanish in single precision.
    #[error("scene '{scene}' is {size} m across, too small for single precision; scale it up to at least {least} m")]
    TooSmall {
        /// Name of the scene.
        scene: String,
        /// Its largest extent, metres.
        size: String,
        /// The least that can be baked, metres.
        least: &'static str,
    },
    /// The scene is larger than the indices of the file allow.
    #[error("scene '{scene}' has {count} {what}, but a .prt file holds at most {limit}; split the scene")]
    TooLarge {
        /// Name of the scene.
        scene: String,
        /// What there is too much of.
        what: &'static str,
        /// How many there are.
        count: usize,
        /// How many there may be.
        limit: usize,
    },
    /// A setting is outside its range.
    #[error("setting '{setting}' is {value}: {allowed}")]
    Setting {
        /// Which one.
        setting: SettingField,
        /// The value given.
        value: String,
        /// What is allowed, as a sentence.
        allowed: &'static str,
    },
    /// The coefficients do not fit into the memory allowed.
    #[error(
        "the transfer of {receivers} receivers needs {needed} bytes, more than the {allowed} allowed; use fewer bands or allow more memory"
    )]
    Memory {
        /// Receivers of the scene.
        receivers: usize,
        /// Bytes that the coefficients take.
        needed: u64,
        /// Bytes that were allowed.
        allowed: u64,
    },
    /// Light maps or transfer textures do not fit into the memory allowed.
    #[error(
        "maps and gloss of {texels} texels and vertices need {needed} bytes, more than the {allowed} allowed; use fewer texels, fewer bands, a fixed light, or allow more memory"
    )]
    MapMemory {
        /// Texels that surfaces touch.
        texels: usize,
        /// Bytes that are needed at once.
        needed: u64,
        /// Bytes that were allowed.
        allowed: u64,
    },
    /// The probes of a volume do not fit into the memory that the light between surfaces leaves.
    #[error(
        "the volume of {probes} probes needs {needed} bytes, more than the {left} that are left; use a wider spacing, fewer levels or allow more memory"
    )]
    VolumeMemory {
        /// Probes of the volume.
        probes: u64,
        /// Bytes that they take.
        needed: u64,
        /// Bytes that were left.
        left: u64,
    },
    /// The progress callback asked to stop.
    #[error("the bake was cancelled; no file was written")]
    Cancelled,
}
