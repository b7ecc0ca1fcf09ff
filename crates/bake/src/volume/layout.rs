//! Where the probes stand, and whether there is memory for them.

use super::grid::Grid;
use super::settings::VolumeSettings;
use super::tree::Tree;
use super::{BANDS, REACH};
use crate::Error;
use crate::field::Field;
use crate::plan::Prepared;
use crate::world::World;
use coeff_io::{Plan, Settings};
use scene::Scene;

/// Bytes of a probe's position and validity.
const PLACE: u64 = 16;

/// The cells and their corners.
pub(super) struct Layout {
    pub(super) grid: Grid,
    pub(super) tree: Tree,
}

/// What a volume may take.
#[derive(Debug, Clone, Copy)]
pub(super) struct Room {
    /// Numbers of a probe beside its distances.
    numbers: u64,
    /// Bytes.
    left: u64,
}

impl Room {
    /// Beside the light between so many receivers.
    pub(super) fn of(plan: &Plan, settings: &Settings, receivers: usize, is_fixed: bool) -> Self {
        let (coefficients, channels) = ((plan.bands * plan.bands) as usize, plan.channels as usize);
        let numbers = u64::from(BANDS * BANDS) * if is_fixed { 3 } else { (coefficients * channels) as u64 };
        // Of all bounces together and of the last one.
        let held = 2 * Field::bytes(receivers, coefficients, channels);
        Self { numbers, left: settings.memory.saturating_sub(held) }
    }

    fn check(self, probes: u64, resolution: u32, more: u64) -> Result<(), Error> {
        let each = 4 * self.numbers + 8 * u64::from(resolution * resolution) + PLACE;
        let needed = probes * each + more;
        if needed > self.left {
            return Err(Error::VolumeMemory { probes, needed, left: self.left });
        }
        Ok(())
    }
}

impl Layout {
    pub(super) fn of(scene: &Scene, world: &World<'_>, wanted: &VolumeSettings, room: Room) -> Result<Self, Error> {
        let grid = Grid::of(scene.bounds(), wanted)?;
        room.check(grid.cells.map(|n| u64::from(n) + 1).iter().product(), wanted.resolution, 0)?;
        let tree = Tree::build(&grid, world)?;
        room.check(tree.probes.len() as u64, wanted.resolution, tree.bytes())?;
        Ok(Self { grid, tree })
    }

    /// Longest distance that is told, metres: any point that a probe may light is nearer.
    pub(super) fn reach(&self) -> f32 {
        REACH * self.grid.spacing.length()
    }
}

/// Refuses, before anything is baked, a volume that cannot be.
pub(crate) fn check(
    wanted: &VolumeSettings,
    scene: &Scene,
    prepared: &Prepared<'_>,
    settings: &Settings,
    is_fixed: bool,
) -> Result<(), Error> {
    let Prepared { world, receivers, plan, .. } = prepared;
    let room = Room::of(plan, settings, receivers.list.len(), is_fixed);
    Layout::of(scene, world, wanted, room).map(drop)
}
