//! Irradiance volumes: probes in space whose light moving objects take.

use crate::MapLight;
use serde::{Deserialize, Serialize};

/// Functions per probe: 3 bands.
pub(crate) const FUNCTIONS: usize = 9;

/// Most times that a cell may be split.
pub(crate) const DEEPEST: u8 = 20;

/// Cells in space with a probe at every corner, split finer where surfaces are near. \[N\] section 1.9.
///
/// The number of cells along an axis is of the coarsest level; a cell may be split into eight, again and again.
#[derive(Debug, Clone, PartialEq)]
pub struct Volume {
    /// Lowest corner, world space, metres.
    pub origin: [f32; 3],
    /// Edge of a cell of the coarsest level, metres.
    pub spacing: [f32; 3],
    /// Cells of the coarsest level along each axis.
    pub cells: [u32; 3],
    /// The cells: first those of the coarsest level (x fastest, then y, then z), then the parts of split ones, eight together in the
    /// same order.
    pub nodes: Vec<Node>,
    /// What the coefficients hold.
    pub light: MapLight,
    /// 1 or 3.
    pub channels: u32,
    /// `[probe][function of 9][depth][channel]`: irradiance / pi over world normals in 3 bands of spherical harmonics, so that the sum of
    /// coefficient times function at a normal is the radiance of a white surface.
    pub values: Vec<f32>,
    /// Where each probe looked from: its corner, or beside it where that is inside of something.
    pub positions: Vec<[f32; 3]>,
    /// 1 where a probe is good, less where it sees the insides of bodies.
    pub validity: Vec<f32>,
    /// `[probe][row][column][2]`: over the octahedral map of the sphere, mean distance and mean square distance to what is seen, metres,
    /// at most [`Volume::reach`].
    pub distances: Vec<f32>,
    /// Texels along a side of the octahedral map; 0 where no distances are told.
    pub resolution: u32,
    /// Longest distance that is told, metres.
    pub reach: f32,
}

/// A cell of a [`Volume`].
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Node {
    /// The first of its eight parts in [`Volume::nodes`].
    Split(u32),
    /// The probes at its corners, x fastest, then y, then z.
    Leaf([u32; 8]),
}
