//! What volume is wanted.

use crate::{Error, SettingField};
use glam::Vec3;

/// Most probes along an axis of the coarsest level.
pub(crate) const MOST_ALONG: u32 = 1024;
/// Most times that a cell is split.
pub(crate) const MOST_LEVELS: u32 = 6;
/// Texels along a side of the map of distances.
const RESOLUTIONS: std::ops::RangeInclusive<u32> = 2..=64;

/// What volume is wanted.
#[derive(Debug, Clone, PartialEq)]
pub struct VolumeSettings {
    /// Where it lies.
    pub place: VolumePlace,
    /// How far apart the probes of the coarsest level are.
    pub steps: VolumeSteps,
    /// How often a cell that surfaces come near is split into eight; 0 for an even grid, as in \[N\].
    pub levels: u32,
    /// Texels along a side of the octahedral map of distances, which tell what a probe cannot see.
    pub resolution: u32,
}

/// Where a volume lies.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum VolumePlace {
    /// Over the whole scene: its outermost probes stand 1/16 of a step inside of the box around it. Along an axis on which the scene
    /// is thinner than a step they stand a step apart.
    Auto,
    /// In this box.
    Box {
        /// Lowest corner, world space, metres.
        min: Vec3,
        /// Highest corner.
        max: Vec3,
    },
}

/// How far apart the probes of the coarsest level are.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum VolumeSteps {
    /// A sixteenth of the longest edge of the box.
    Auto,
    /// So many probes along x, y and z, 2 or more.
    Probes([u32; 3]),
    /// So many metres or slightly less, so that steps fit the box.
    Spacing(f32),
}

impl VolumeSettings {
    /// A sixteenth of the scene per step, not refined, distances by 32 x 32 directions: with half of them, what is nearer to the edge of a
    /// room than a sixth of a step takes light from behind a thin wall.
    #[must_use]
    pub fn standard() -> Self {
        Self { place: VolumePlace::Auto, steps: VolumeSteps::Auto, levels: 0, resolution: 32 }
    }

    /// Checks every setting against its range.
    ///
    /// # Errors
    /// [`Error::Setting`] names the first setting that is outside its range.
    pub fn check(&self) -> Result<(), Error> {
        let refuse = |setting, value: String, allowed| Err(Error::Setting { setting, value, allowed });
        match self.steps {
            VolumeSteps::Probes(counts) if counts.iter().any(|n| !(2..=MOST_ALONG).contains(n)) => {
                let [x, y, z] = counts;
                return refuse(SettingField::Volume, format!("{x}x{y}x{z}"), "use 2 to 1024 probes along each axis");
            }
            VolumeSteps::Spacing(step) if !(step > 0.0 && step.is_finite()) => {
                return refuse(SettingField::Volume, format!("{step}m"), "give a spacing above 0 in metres");
            }
            VolumeSteps::Auto | VolumeSteps::Probes(_) | VolumeSteps::Spacing(_) => {}
        }
        if let VolumePlace::Box { min, max } = self.place
            && !(min.is_finite() && max.is_finite() && (max - min).is_finite() && min.cmplt(max).all())
        {
            let allowed = "give two corners, the first below the second along every axis";
            return refuse(SettingField::VolumeBox, format!("{min} to {max}"), allowed);
        }
        if self.levels > MOST_LEVELS {
            return refuse(SettingField::VolumeLevels, self.levels.to_string(), "use 0 to 6");
        }
        if !RESOLUTIONS.contains(&self.resolution) {
            return refuse(SettingField::VolumeDistances, self.resolution.to_string(), "use 2 to 64");
        }
        Ok(())
    }
}
