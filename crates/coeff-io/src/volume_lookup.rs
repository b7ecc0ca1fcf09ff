//! What a volume says of a point in space: the rule that every renderer follows.
//!
//! The leaf that holds the point is found from the coarsest level down; its eight probes count by trilinear weights. Where it is asked for,
//! each weight is multiplied by the probe's validity, by how likely the point is seen from the probe, and by how much the probe lies in front
//! of the surface; then all are divided by their sum. Where that vanishes the trilinear weights of valid probes hold, and where none is
//! valid, those of all.
//!
//! Seen or not is told by Chebyshev's bound, as in variance shadow maps: with mean m and mean square s of the distances along the way, of
//! what is seen at most `v / (v + (d - m)^2)` lies beyond d > m, where `v = s - m^2`. The bound is cubed, as light leaks where it is loose.
//! The point is asked for where it stands: moved along its normal, one beside a thin wall would be looked for on the other side. A surface
//! whose distance the map tells exactly is seen, since no spread counts as less than [`LEAST_DEVIATION`].

use crate::volume::FUNCTIONS;
use crate::{MapLight, Node, Volume, octahedral};
use glam::Vec3;
use sh_math::Bands;

/// Least standard deviation of a distance, as a share of the shortest edge of a cell: texels of the maps are no finer.
pub const LEAST_DEVIATION: f32 = 0.005;

/// Weight of a probe straight behind a surface; straight before it weighs 1 more.
pub const BEHIND: f32 = 0.2;

/// Below this sum of weights nothing is seen.
const VANISHING: f32 = 1e-20;

/// How probes are weighed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Lookup {
    /// By trilinear weights alone: light leaks through walls.
    Trilinear,
    /// By validity, visibility and side too.
    Visible,
}

/// The leaf that holds a point.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Cell {
    /// The probes at its corners, x fastest, then y, then z.
    pub probes: [u32; 8],
    /// Where the point lies between them, in [0, 1].
    pub place: Vec3,
    /// How often the coarsest cell was split.
    pub level: u32,
}

/// Probes and what each counts; the weights sum to 1.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Weights {
    /// Indices of probes.
    pub probes: [u32; 8],
    /// Their weights, none negative.
    pub weights: [f32; 8],
}

impl Weights {
    /// The coefficients of a point from those of all probes ([`Volume::lit`]): what a renderer sums once per point.
    ///
    /// # Panics
    /// When there are fewer probes than those of the volume.
    #[must_use]
    pub fn blend(&self, lit: &[[[f32; 3]; FUNCTIONS]]) -> [[f32; 3]; FUNCTIONS] {
        let mut sum = [[0.0; 3]; FUNCTIONS];
        for (probe, weight) in self.probes.into_iter().zip(self.weights).filter(|(_, weight)| *weight > 0.0) {
            for (sum, coefficient) in sum.iter_mut().zip(&lit[probe as usize]) {
                *sum = std::array::from_fn(|c| sum[c] + weight * coefficient[c]);
            }
        }
        sum
    }
}

/// Irradiance / pi at a unit normal in world axes, of blended coefficients; it may ring below zero.
#[must_use]
pub fn irradiance_at(coefficients: &[[f32; 3]; FUNCTIONS], normal: Vec3) -> [f32; 3] {
    let mut functions = [0.0; FUNCTIONS];
    sh_math::evaluate(Bands::new(3).expect("there are three bands"), normal, &mut functions);
    let mut sum = [0.0; 3];
    for (coefficient, function) in coefficients.iter().zip(functions) {
        sum = std::array::from_fn(|c| sum[c] + function * coefficient[c]);
    }
    sum
}

impl Volume {
    /// The leaf that holds a point (world space), which is brought to the border where it lies outside.
    #[must_use]
    pub fn cell(&self, point: Vec3) -> Cell {
        let mut corner = [0; 3];
        let mut place = Vec3::ZERO;
        for axis in 0..3 {
            let cells = self.cells[axis];
            let along = (point[axis] - self.origin[axis]) / self.spacing[axis];
            // A coordinate that is no number counts as 0: max gives the other of the two.
            let along = along.max(0.0).min(cells as f32);
            let cell = (along as u32).min(cells - 1);
            (corner[axis], place[axis]) = (cell as usize, along - cell as f32);
        }
        let mut node = (corner[2] * self.cells[1] as usize + corner[1]) * self.cells[0] as usize + corner[0];
        let mut level = 0;
        loop {
            match self.nodes[node] {
                Node::Leaf(probes) => return Cell { probes, place, level },
                Node::Split(first) => {
                    let half = Vec3::from_array(place.to_array().map(|p| if p >= 0.5 { 1.0 } else { 0.0 }));
                    node = first as usize + (half.x + 2.0 * half.y + 4.0 * half.z) as usize;
                    place = place * 2.0 - half;
                    level += 1;
                }
            }
        }
    }

    /// What each of the eight probes around a point (world space) counts, for a surface of the unit normal `normal` or for a point in free
    /// space.
    #[must_use]
    pub fn weights(&self, point: Vec3, normal: Option<Vec3>, lookup: Lookup) -> Weights {
        let cell = self.cell(point);
        let between = [1.0 - cell.place, cell.place];
        let trilinear: [f32; 8] = std::array::from_fn(|i| between[i & 1].x * between[i >> 1 & 1].y * between[i >> 2].z);
        let mut weights = trilinear;
        if lookup == Lookup::Visible {
            let edge = self.spacing.into_iter().fold(f32::INFINITY, f32::min) / (1_u32 << cell.level) as f32;
            let valid: [f32; 8] = std::array::from_fn(|i| trilinear[i] * self.validity[cell.probes[i] as usize]);
            weights = std::array::from_fn(|i| valid[i] * self.sight(cell.probes[i] as usize, point, normal, edge));
            // Written so that sums that are no numbers vanish too.
            let vanishes = |weights: &[f32; 8]| !weights.iter().sum::<f32>().ge(&VANISHING);
            if vanishes(&weights) {
                weights = if vanishes(&valid) { trilinear } else { valid };
            }
        }
        let sum: f32 = weights.iter().sum();
        Weights { probes: cell.probes, weights: weights.map(|weight| weight / sum) }
    }

    /// How far a probe counts for a surface at `point`: visibility times side.
    fn sight(&self, probe: usize, point: Vec3, normal: Option<Vec3>, edge: f32) -> f32 {
        let at = Vec3::from_array(self.positions[probe]);
        let side = normal.map_or(1.0, |normal| {
            let ahead = (at - point).normalize_or_zero().dot(normal) * 0.5 + 0.5;
            ahead * ahead + BEHIND
        });
        let way = point - at;
        let distance = way.length().min(self.reach);
        if self.resolution == 0 || distance <= 0.0 {
            return side;
        }
        let texels = 2 * self.resolution as usize * self.resolution as usize;
        let map = &self.distances[probe * texels..][..texels];
        let [mean, square] = octahedral::look_up(map, self.resolution, way);
        if distance <= mean {
            return side;
        }
        let deviation = LEAST_DEVIATION * edge;
        let variance = (square - mean * mean).max(deviation * deviation);
        let beyond = distance - mean;
        let seen = variance / (variance + beyond * beyond);
        side * seen * seen * seen
    }

    /// The coefficients of a probe under a light of `depth` or more coefficients in world axes (unused where the light is fixed):
    /// `[function][channel]` of irradiance / pi over world normals.
    #[must_use]
    pub fn coefficients(&self, probe: usize, light: &[[f32; 3]]) -> [[f32; 3]; FUNCTIONS] {
        let (depth, channels) = (self.light.depth(), self.channels as usize);
        let function = |k: usize| {
            let values = &self.values[(probe * FUNCTIONS + k) * depth * channels..][..depth * channels];
            let mut sum = [0.0; 3];
            for (i, texel) in values.chunks_exact(channels).enumerate() {
                let factor = match self.light {
                    MapLight::Fixed { .. } => [1.0; 3],
                    MapLight::Relightable { .. } => light[i],
                };
                sum = std::array::from_fn(|c| sum[c] + factor[c] * texel[c.min(channels - 1)]);
            }
            sum
        };
        std::array::from_fn(function)
    }

    /// [`Volume::coefficients`] of every probe.
    #[must_use]
    pub fn lit(&self, light: &[[f32; 3]]) -> Vec<[[f32; 3]; FUNCTIONS]> {
        (0..self.positions.len()).map(|probe| self.coefficients(probe, light)).collect()
    }

    /// Irradiance / pi at a point (world space) of a surface with the unit normal `normal`, by [`Lookup::Visible`]; it may ring below
    /// zero. \[N\] section 2.5.2.
    #[must_use]
    pub fn irradiance(&self, point: Vec3, normal: Vec3, light: &[[f32; 3]]) -> [f32; 3] {
        self.irradiance_by(Lookup::Visible, point, normal, light)
    }

    /// [`Volume::irradiance`] by a rule of choice.
    #[must_use]
    pub fn irradiance_by(&self, lookup: Lookup, point: Vec3, normal: Vec3, light: &[[f32; 3]]) -> [f32; 3] {
        let Weights { probes, weights } = self.weights(point, Some(normal), lookup);
        let lit = probes.map(|probe| self.coefficients(probe as usize, light));
        let eight = Weights { probes: [0, 1, 2, 3, 4, 5, 6, 7], weights };
        irradiance_at(&eight.blend(&lit), normal)
    }
}
