//! A picture as light: its pixels are chosen by the light they send.

use glam::Vec3;
use probe_io::{Layout, Probe};
use sampling::discrete::Table2d;
use std::f64::consts::{PI, TAU};

/// Share of a cell's weight that goes to the cells around it where pixels and cells do not line up: a bright pixel that
/// touches a cell between its points must not be rare there. More of it wastes samples beside the sun.
const SPREAD: f32 = 0.2;

/// A picture with the table of a panorama from which directions are drawn.
#[derive(Debug, Clone)]
pub(crate) struct ImageLight {
    radiance: Radiance,
    /// Columns of the table.
    width: usize,
    /// Cosine from +y at the upper edge of each row of the table, and at the end of the last.
    edges: Vec<f64>,
    /// Chooses a cell by |radiance| times solid angle; none where all is black.
    table: Option<Table2d>,
}

/// Where the radiance is looked up.
#[derive(Debug, Clone)]
enum Radiance {
    /// One value per cell of the table.
    Cells(Vec<[f32; 3]>),
    /// Another layout: its cells do not line up with the table's.
    Probe(Probe),
}

/// A direction to the light.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Sample {
    /// Unit.
    pub(crate) direction: Vec3,
    /// Radiance from there; negative where the picture is.
    pub(crate) radiance: Vec3,
    /// Density of the direction per solid angle.
    pub(crate) pdf: f32,
}

impl ImageLight {
    pub(crate) fn new(probe: &Probe) -> Self {
        let (height, width, radiance) = match probe.layout {
            Layout::Equirect => (probe.height, probe.width, Radiance::Cells(probe.pixels.clone())),
            _ => (probe.equivalent_rows(), 2 * probe.equivalent_rows(), Radiance::Probe(probe.clone())),
        };
        let edges = (0..=height).map(|row| libm::cos(PI * row as f64 / height as f64)).collect();
        let mut light = Self { radiance, width, edges, table: None };
        light.table = Table2d::new(width, &light.weights());
        light
    }

    fn height(&self) -> usize {
        self.edges.len() - 1
    }

    /// |radiance| times solid angle of each cell.
    fn weights(&self) -> Vec<f32> {
        let mut sizes = match &self.radiance {
            Radiance::Cells(cells) => cells.iter().map(size).collect(),
            Radiance::Probe(probe) => self.mean_sizes(probe),
        };
        for (row, sizes) in sizes.chunks_exact_mut(self.width).enumerate() {
            let solid_angle = self.solid_angle(row) as f32;
            sizes.iter_mut().for_each(|size| *size *= solid_angle);
        }
        sizes
    }

    /// Mean of |radiance| over each cell from 4 x 4 points, a part of it taken from the 3 x 3 cells around.
    fn mean_sizes(&self, probe: &Probe) -> Vec<f32> {
        let (width, height) = (self.width, self.height());
        let mut own = Vec::with_capacity(width * height);
        for cell in 0..width * height {
            let sum: f32 = (0..16)
                .map(|k| [f64::from(k % 4), f64::from(k / 4)].map(|v| (v + 0.5) / 4.0))
                .map(|inside| size(&probe.texel_radiance(self.direction([cell % width, cell / width], inside))))
                .sum();
            own.push(sum / 16.0);
        }
        let around = |column: usize, row: usize| {
            let rows = row.saturating_sub(1)..=(row + 1).min(height - 1);
            let of_row = |row: usize| (0..3).map(move |k| row * width + (column + width - 1 + k) % width);
            rows.flat_map(of_row).map(|cell| own[cell]).sum::<f32>() / 9.0
        };
        (0..own.len()).map(|cell| (1.0 - SPREAD) * own[cell] + SPREAD * around(cell % width, cell / width)).collect()
    }

    /// Solid angle of a cell of a row.
    fn solid_angle(&self, row: usize) -> f64 {
        TAU / self.width as f64 * (self.edges[row] - self.edges[row + 1])
    }

    /// Unit direction at a position inside a cell: the first share along the longitude, the second uniform in height.
    fn direction(&self, [column, row]: [usize; 2], inside: [f64; 2]) -> Vec3 {
        let y = self.edges[row] + (self.edges[row + 1] - self.edges[row]) * inside[1];
        let turn = (column as f64 + inside[0]) / self.width as f64 - 0.5;
        let (sin, cos) = libm::sincosf((TAU * turn) as f32);
        let r = (1.0 - y * y).max(0.0).sqrt() as f32;
        Vec3::new(-sin * r, y as f32, cos * r)
    }

    /// The cell that holds a unit direction.
    fn cell(&self, direction: Vec3) -> [usize; 2] {
        let y = f64::from(direction.y);
        let guess = libm::acosf(direction.y.clamp(-1.0, 1.0)) * (self.height() as f32 / std::f32::consts::PI);
        let mut row = (guess as usize).min(self.height() - 1);
        while row > 0 && y > self.edges[row] {
            row -= 1;
        }
        while row + 1 < self.height() && y < self.edges[row + 1] {
            row += 1;
        }
        let turn = f64::from(libm::atan2f(-direction.x, direction.z)) / TAU + 0.5;
        [((turn * self.width as f64) as usize).min(self.width - 1), row]
    }

    /// Radiance from a direction and the density with which [`Self::sample`] draws it.
    pub(crate) fn look(&self, direction: Vec3) -> (Vec3, f32) {
        let cell = self.cell(direction);
        let density = |table: &Table2d| table.probability(cell) / self.solid_angle(cell[1]);
        (self.radiance(cell, direction), self.table.as_ref().map_or(0.0, density) as f32)
    }

    /// A direction in proportion to |radiance|; none where all is black.
    pub(crate) fn sample(&self, u: [f64; 2]) -> Option<Sample> {
        let cell = self.table.as_ref()?.sample(u);
        let direction = self.direction(cell.position, cell.remapped);
        let pdf = (cell.probability / self.solid_angle(cell.position[1])) as f32;
        Some(Sample { direction, radiance: self.radiance(cell.position, direction), pdf })
    }

    fn radiance(&self, [column, row]: [usize; 2], direction: Vec3) -> Vec3 {
        Vec3::from_array(match &self.radiance {
            Radiance::Cells(cells) => cells[row * self.width + column],
            Radiance::Probe(probe) => probe.texel_radiance(direction),
        })
    }
}

/// Size of a radiance for the choice of directions: the sum of the channels' absolute values.
fn size(radiance: &[f32; 3]) -> f32 {
    radiance.iter().map(|v| v.abs()).sum()
}
