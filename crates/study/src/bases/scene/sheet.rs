//! A sheet of texels: where they lie, and their coefficients in a basis and an encoding.

use super::residual::five;
use bake::{Directional, SheetSettings};
use coeff_io::{Coding, Encoding, Layers, MapLight, curves};
use scene::Scene;
use scene::lightmap::{Charts, Texel, texels};
use sh_math::hemisphere::{Basis, HARMONICS};

/// One sheet of the comparison.
#[derive(Debug)]
pub(super) struct Plate {
    /// Texels along u and v.
    pub(super) size: [u32; 2],
    /// Whether light is kept for every normal.
    pub(super) is_bent: bool,
    /// Indices of its texels in what was found.
    pub(super) texels: Vec<usize>,
    /// The points that texels stand for, by row and column.
    points: Vec<Texel>,
    /// The chart of each texel that something is known of, else `u32::MAX`.
    charts: Vec<u32>,
}

impl Plate {
    /// # Panics
    /// When a texel lies outside of the sheet.
    pub(super) fn new(scene: &Scene, index: u32, sheet: &SheetSettings, found: &Directional) -> Self {
        let (width, height) = (sheet.width, sheet.height);
        let points = texels(scene, &sheet.meshes, width, height);
        let mut firsts = vec![(Charts { of_triangle: Vec::new(), count: 0 }, 0); scene.meshes.len()];
        let mut next = 0;
        for &mesh in &sheet.meshes {
            let charts = Charts::of(&scene.meshes[mesh]);
            let first = next;
            next += charts.count;
            firsts[mesh] = (charts, first);
        }
        let is_here = |index_of: &usize| found.texels[*index_of].sheet == index;
        let texels: Vec<usize> = (0..found.texels.len()).filter(is_here).collect();
        let mut charts = vec![u32::MAX; width as usize * height as usize];
        let mut plate = Self { size: [width, height], is_bent: sheet.directional, texels, points, charts: Vec::new() };
        for &texel in &plate.texels {
            let place = found.texels[texel].place;
            if let Some(point) = plate.point_at(place) {
                let (of_mesh, first) = &firsts[point.mesh as usize];
                charts[plate.index(place)] = first + of_mesh.of_triangle[point.triangle as usize];
            }
        }
        plate.charts = charts;
        plate
    }

    /// Index of a texel by its row and column.
    pub(super) fn index(&self, [row, column]: [u32; 2]) -> usize {
        row as usize * self.size[0] as usize + column as usize
    }

    fn point_at(&self, [row, column]: [u32; 2]) -> Option<&Texel> {
        let found = self.points.binary_search_by_key(&(row, column), |point| (point.row, point.column));
        found.ok().map(|index| &self.points[index])
    }

    /// The name of the mesh and the position of a texel.
    pub(super) fn point(&self, scene: &Scene, place: [u32; 2]) -> (String, [f32; 3]) {
        let Some(point) = self.point_at(place) else { return (String::new(), [f32::NAN; 3]) };
        let mesh = &scene.meshes[point.mesh as usize];
        let [u, v] = point.barycentrics;
        (mesh.name.clone(), mesh.position(point.triangle as usize, u, v).to_array())
    }

    /// The functions that the sheet holds where the maps are in `basis`: that of an ordinary light map where no normal
    /// map is.
    pub(super) fn held(&self, basis: Basis) -> Basis {
        if self.is_bent { basis } else { Basis::ModifiedH1 }
    }

    /// The coefficients of its texels, `[function][row][column][channel]`; 0 where nothing is known.
    pub(super) fn values(&self, held: Basis, found: &Directional) -> Vec<f32> {
        let rows = held.of_harmonics(five());
        let plane = self.charts.len();
        let mut values = vec![0.0; held.count() * plane * 3];
        for &texel in &self.texels {
            let texel = &found.texels[texel];
            for (k, row) in rows.iter().enumerate() {
                let start = (k * plane + self.index(texel.place)) * 3;
                values[start..start + 3].copy_from_slice(&product(row, &texel.coefficients));
            }
        }
        values
    }

    /// Coefficients of [`Plate::values`] in an encoding, with the curves that a bake of fixed light has.
    pub(super) fn encoded(&self, held: Basis, values: &[f32], encoding: Encoding) -> Layers {
        let light = MapLight::Fixed { probe: String::new(), bands: 5 };
        let curves = curves(held, &light);
        let coding = Coding { charts: &self.charts, curves: &curves, ..Coding::plain(encoding) };
        Layers::encode([self.size[0], self.size[1], held.count() as u32, 3], values, &coding).layers
    }
}

/// One coefficient of each channel.
fn product(row: &[f64; HARMONICS], signal: &[[f32; 3]; HARMONICS]) -> [f32; 3] {
    [0, 1, 2].map(|c| row.iter().zip(signal).map(|(factor, rgb)| factor * f64::from(rgb[c])).sum::<f64>() as f32)
}
