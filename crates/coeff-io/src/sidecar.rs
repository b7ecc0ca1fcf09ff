//! The JSON files beside exported textures, and the readable form of a volume: what textures cannot say.

use crate::{Curve, Encoding, MapLight, Node, Volume};
use serde::{Deserialize, Serialize};

/// `maps.json`: all of light maps but their texels.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct MapsText {
    pub(crate) convention: String,
    /// By its id.
    pub(crate) basis: String,
    pub(crate) light: MapLight,
    pub(crate) sheets: Vec<SheetText>,
    pub(crate) sheet_of_mesh: Vec<Option<u32>>,
}

/// One sheet: a 2-D array with one layer per function and coefficient of the light.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct SheetText {
    pub(crate) file: String,
    pub(crate) width: u32,
    pub(crate) height: u32,
    pub(crate) layers: u32,
    pub(crate) channels: u32,
    /// That of the texture; eight bits become halves, as their charts have ranges of their own.
    pub(crate) encoding: Encoding,
    /// Per layer of blocks its curve and, per channel, the numbers that 0 and 1 stand for.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub(crate) ranges: Vec<(Curve, [[f32; 2]; 3])>,
}

/// `volume.json` beside nine 3-D textures.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct GridText {
    pub(crate) convention: String,
    pub(crate) origin: [f32; 3],
    pub(crate) step: [f32; 3],
    pub(crate) points: [u32; 3],
    /// One per function of 3 bands, irradiance / pi over world normals.
    pub(crate) files: [String; 9],
}

/// A [`Volume`] as text: its fields by their names.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct VolumeText {
    pub(crate) convention: String,
    origin: [f32; 3],
    spacing: [f32; 3],
    cells: [u32; 3],
    light: MapLight,
    channels: u32,
    resolution: u32,
    reach: f32,
    nodes: Vec<Node>,
    probes: Vec<ProbeText>,
}

/// A probe: `coefficients` is `[function of 9][depth][channel]`, `distances` `[row][column][mean, mean square]`, both without inner brackets.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct ProbeText {
    position: [f32; 3],
    validity: f32,
    coefficients: Vec<f32>,
    distances: Vec<f32>,
}

impl VolumeText {
    /// The text of a volume that is sound.
    pub(crate) fn of(volume: &Volume) -> Self {
        let each = |values: &[f32]| values.len() / volume.positions.len().max(1);
        let (values, distances) = (each(&volume.values), each(&volume.distances));
        let probe = |i: usize| ProbeText {
            position: volume.positions[i],
            validity: volume.validity[i],
            coefficients: volume.values[i * values..][..values].to_vec(),
            distances: volume.distances[i * distances..][..distances].to_vec(),
        };
        Self {
            convention: sh_math::CONVENTION.into(),
            origin: volume.origin,
            spacing: volume.spacing,
            cells: volume.cells,
            light: volume.light.clone(),
            channels: volume.channels,
            resolution: volume.resolution,
            reach: volume.reach,
            nodes: volume.nodes.clone(),
            probes: (0..volume.positions.len()).map(probe).collect(),
        }
    }

    /// The volume, unchecked; none where a probe has more or fewer numbers than the first.
    pub(crate) fn volume(self) -> Option<Volume> {
        let lengths = |probe: &ProbeText| (probe.coefficients.len(), probe.distances.len());
        let first = self.probes.first().map(lengths);
        if !self.probes.iter().all(|probe| Some(lengths(probe)) == first) {
            return None;
        }
        Some(Volume {
            origin: self.origin,
            spacing: self.spacing,
            cells: self.cells,
            nodes: self.nodes,
            light: self.light,
            channels: self.channels,
            values: self.probes.iter().flat_map(|probe| &probe.coefficients).copied().collect(),
            positions: self.probes.iter().map(|probe| probe.position).collect(),
            validity: self.probes.iter().map(|probe| probe.validity).collect(),
            distances: self.probes.iter().flat_map(|probe| &probe.distances).copied().collect(),
            resolution: self.resolution,
            reach: self.reach,
        })
    }
}
