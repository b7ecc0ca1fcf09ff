//! What the header chunk says of an irradiance volume, and how its cells lie in a chunk.

use crate::{Error, MapLight, Node, Volume};
use serde::{Deserialize, Serialize};

/// [`Volume`] without its arrays.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct VolumeHeader {
    /// Lowest corner, world space, metres.
    pub origin: [f32; 3],
    /// Edge of a cell of the coarsest level, metres.
    pub spacing: [f32; 3],
    /// Cells of the coarsest level along each axis.
    pub cells: [u32; 3],
    /// What the coefficients hold.
    pub light: MapLight,
    /// 1 or 3.
    pub channels: u32,
    /// Texels along a side of the octahedral maps of distances; 0 where there are none.
    pub resolution: u32,
    /// Longest distance that is told, metres.
    pub reach: f32,
}

/// The arrays of a [`Volume`] as they lie in the file.
#[derive(Default)]
pub(crate) struct VolumeArrays {
    pub(crate) nodes: Vec<[u32; 8]>,
    pub(crate) values: Vec<f32>,
    pub(crate) positions: Vec<[f32; 3]>,
    pub(crate) validity: Vec<f32>,
    pub(crate) distances: Vec<f32>,
}

impl VolumeArrays {
    fn is_empty(&self) -> bool {
        self.nodes.is_empty()
            && self.values.is_empty()
            && self.positions.is_empty()
            && self.validity.is_empty()
            && self.distances.is_empty()
    }

    /// Refuses arrays of a volume that the header does not name.
    ///
    /// # Errors
    /// `Invalid` at the header, which lies at `at`.
    pub(crate) fn check_absent(&self, at: u64) -> Result<(), Error> {
        if self.is_empty() {
            return Ok(());
        }
        Err(Error::invalid(at, "the file holds parts of a volume that the header does not name"))
    }
}

/// Marks a split cell where the first probe of a leaf stands.
const SPLIT: u32 = u32::MAX;

/// The cells as the file holds them: eight probes, or a mark, the first part and six zeros.
pub(crate) fn nodes_to_words(nodes: &[Node]) -> Vec<[u32; 8]> {
    let words = |node: &Node| match *node {
        Node::Split(first) => [SPLIT, first, 0, 0, 0, 0, 0, 0],
        Node::Leaf(probes) => probes,
    };
    nodes.iter().map(words).collect()
}

/// The inverse of [`nodes_to_words`]; a cell of other words becomes a leaf of probes that cannot exist.
fn nodes_of_words(words: Vec<[u32; 8]>) -> Vec<Node> {
    let node = |words: [u32; 8]| match words {
        [SPLIT, first, 0, 0, 0, 0, 0, 0] => Node::Split(first),
        probes => Node::Leaf(probes),
    };
    words.into_iter().map(node).collect()
}

impl VolumeHeader {
    /// The records of `volume`.
    pub(crate) fn of(volume: &Volume) -> Self {
        Self {
            origin: volume.origin,
            spacing: volume.spacing,
            cells: volume.cells,
            light: volume.light.clone(),
            channels: volume.channels,
            resolution: volume.resolution,
            reach: volume.reach,
        }
    }

    /// The volume with its arrays.
    pub(crate) fn join(self, arrays: VolumeArrays) -> Volume {
        Volume {
            origin: self.origin,
            spacing: self.spacing,
            cells: self.cells,
            nodes: nodes_of_words(arrays.nodes),
            light: self.light,
            channels: self.channels,
            values: arrays.values,
            positions: arrays.positions,
            validity: arrays.validity,
            distances: arrays.distances,
            resolution: self.resolution,
            reach: self.reach,
        }
    }
}
