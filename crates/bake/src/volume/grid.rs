//! The cells of the coarsest level.

use super::settings::{MOST_ALONG, VolumePlace, VolumeSettings, VolumeSteps};
use crate::{Error, SettingField};
use glam::{UVec3, Vec3};
use scene::Bounds;

/// Steps along the longest edge, where nothing is said.
const STEPS: f32 = 16.0;
/// Share of a step by which the outermost probes stand inside of the box around the scene: there walls are, and probes inside them.
const INSET: f32 = 1.0 / 16.0;

/// Cells of one size. Places are counted in steps of the finest level.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Grid {
    /// Lowest corner, world space, metres.
    pub(super) origin: Vec3,
    /// Edges of a cell, metres.
    pub(super) spacing: Vec3,
    pub(super) cells: [u32; 3],
    /// Times that a cell may be split.
    pub(super) levels: u32,
}

impl Grid {
    pub(super) fn of(scene: Option<Bounds>, settings: &VolumeSettings) -> Result<Self, Error> {
        settings.check()?;
        let (min, max, even) = match settings.place {
            VolumePlace::Box { min, max } => (min, max, (max - min).max_element() / STEPS),
            VolumePlace::Auto => around(scene, settings.steps)?,
        };
        let size = max - min;
        let cells = match settings.steps {
            VolumeSteps::Probes(counts) => counts.map(|n| n - 1),
            VolumeSteps::Auto => fitting(size, even),
            VolumeSteps::Spacing(step) => fitting(size, step),
        };
        if cells.iter().any(|&n| n >= MOST_ALONG) {
            let [x, y, z] = cells;
            let allowed = "at most 1023 are possible along an axis: use a wider spacing or a smaller box";
            return Err(Error::Setting {
                setting: SettingField::Volume,
                value: format!("{x} x {y} x {z} cells"),
                allowed,
            });
        }
        let spacing = size / UVec3::from_array(cells).as_vec3();
        Ok(Self { origin: min, spacing, cells, levels: settings.levels })
    }

    /// The point of a place, world space.
    pub(super) fn point(&self, place: UVec3) -> Vec3 {
        self.origin + self.spacing * place.as_vec3() / (1u32 << self.levels) as f32
    }

    /// Edges of a cell that was split so often, metres.
    pub(super) fn edges(&self, level: u32) -> Vec3 {
        self.spacing / (1u32 << level) as f32
    }
}

/// The box of a whole scene, and the step for where nothing is said.
fn around(scene: Option<Bounds>, steps: VolumeSteps) -> Result<(Vec3, Vec3, f32), Error> {
    let bounds = scene.filter(|b| b.size().is_finite() && b.size().max_element() > 0.0);
    let Some(bounds) = bounds else {
        let allowed = "the scene has no extent that a volume could fill: give the corners of a box";
        return Err(Error::Setting { setting: SettingField::Volume, value: "auto".into(), allowed });
    };
    let even = bounds.size().max_element() / STEPS;
    let one = |axis: usize| {
        let size = bounds.size()[axis];
        let (step, widened) = match steps {
            VolumeSteps::Auto => (even, even),
            VolumeSteps::Spacing(step) => (step, step),
            VolumeSteps::Probes(counts) => (size / (counts[axis] - 1) as f32, even),
        };
        if size < widened { 0.5 * (size - widened) } else { INSET * step }
    };
    let inset = Vec3::from_array(std::array::from_fn(one));
    Ok((bounds.min + inset, bounds.max - inset, even))
}

/// Cells along each axis, no longer than a step.
fn fitting(size: Vec3, step: f32) -> [u32; 3] {
    // Rounding is no reason for another cell.
    (size / step * 0.9999).ceil().max(Vec3::ONE).as_uvec3().to_array()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn grid(size: Vec3, steps: VolumeSteps) -> Result<Grid, Error> {
        let bounds = Bounds { min: Vec3::ZERO, max: size };
        Grid::of(Some(bounds), &VolumeSettings { steps, ..VolumeSettings::standard() })
    }

    #[test]
    fn a_scene_is_filled() {
        let auto = grid(Vec3::new(16.0, 8.0, 4.0), VolumeSteps::Auto).unwrap();
        assert_eq!(auto.cells, [16, 8, 4]);
        assert!(auto.origin.abs_diff_eq(Vec3::splat(1.0 / 16.0), 1e-6) && auto.spacing.max_element() <= 1.0);
        let last = auto.point(UVec3::from_array(auto.cells));
        assert!(last.abs_diff_eq(Vec3::new(16.0, 8.0, 4.0) - 1.0 / 16.0, 1e-5), "{last}");
        let counted = grid(Vec3::new(16.0, 8.0, 4.0), VolumeSteps::Probes([16, 16, 8])).unwrap();
        assert_eq!(counted.cells, [15, 15, 7]);
        let spaced = grid(Vec3::new(16.0, 8.0, 4.0), VolumeSteps::Spacing(3.0)).unwrap();
        assert_eq!(spaced.cells, [6, 3, 2]);
    }

    #[test]
    fn a_flat_scene_has_probes_on_both_sides() {
        for steps in [VolumeSteps::Auto, VolumeSteps::Probes([5, 2, 5]), VolumeSteps::Spacing(0.5)] {
            let flat = grid(Vec3::new(4.0, 0.0, 4.0), steps).unwrap();
            assert!(flat.origin.y < 0.0 && flat.point(UVec3::Y).y > 0.0, "{flat:?}");
        }
    }

    #[test]
    fn what_is_out_of_range_is_refused() {
        let sentence = |steps| grid(Vec3::new(4.0, 2.0, 4.0), steps).unwrap_err().to_string();
        assert!(sentence(VolumeSteps::Spacing(1e-6)).contains("wider spacing"));
        assert!(sentence(VolumeSteps::Spacing(0.0)).contains("above 0"));
        assert!(sentence(VolumeSteps::Spacing(f32::NAN)).contains("above 0"));
        assert!(sentence(VolumeSteps::Probes([1, 4, 4])).contains("2 to 1024"));
        let boxed = |min, max| {
            let place = VolumePlace::Box { min, max };
            VolumeSettings { place, ..VolumeSettings::standard() }.check().unwrap_err().to_string()
        };
        assert!(boxed(Vec3::ZERO, Vec3::new(1.0, 0.0, 1.0)).contains("volume box"));
        assert!(boxed(Vec3::ZERO, Vec3::splat(f32::INFINITY)).contains("volume box"));
        let deep = VolumeSettings { levels: 7, ..VolumeSettings::standard() };
        assert!(deep.check().unwrap_err().to_string().contains("0 to 6"));
        assert!(grid(Vec3::ZERO, VolumeSteps::Auto).unwrap_err().to_string().contains("no extent"));
    }
}
