//! Names of settings, for errors.

/// A setting of a bake or of one of its outputs.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum SettingField {
    /// Number of bands.
    Bands,
    /// Norms of the bands of the light that the result is meant for.
    Light,
    /// Fixed number of rays per receiver.
    Rays,
    /// Relative error of each receiver.
    Error,
    /// Sequence of the rays.
    Sampler,
    /// Effects that may be simulated.
    Effects,
    /// Subdivision of large triangles.
    Refine,
    /// Number of bounces.
    Bounces,
    /// Where coefficients are stored.
    Storage,
    /// A light that is baked in.
    FixedLight,
    /// Texels of atlas pages.
    Texels,
    /// Texels around a chart.
    Dilation,
    /// Meshes of atlas pages.
    Pages,
    /// Probes of a volume, or their spacing.
    Volume,
    /// Corners of a volume.
    VolumeBox,
    /// Levels of a volume.
    VolumeLevels,
    /// Directions in which a probe of a volume stores distances.
    VolumeDistances,
}

impl std::fmt::Display for SettingField {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(match self {
            Self::Bands => "bands",
            Self::Light => "light",
            Self::Rays => "rays",
            Self::Error => "error",
            Self::Sampler => "sampler",
            Self::Effects => "effects",
            Self::Refine => "refine",
            Self::Bounces => "bounces",
            Self::Storage => "storage",
            Self::FixedLight => "fixed light",
            Self::Texels => "texels",
            Self::Dilation => "dilation",
            Self::Pages => "atlas pages",
            Self::Volume => "volume",
            Self::VolumeBox => "volume box",
            Self::VolumeLevels => "volume levels",
            Self::VolumeDistances => "volume distances",
        })
    }
}
