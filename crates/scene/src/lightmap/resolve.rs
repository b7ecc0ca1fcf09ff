//! Whether a sheet has enough texels for the charts in it, and how many it would need.

use super::chart::Charts;
use super::fault::{corners, doubled_area};
use crate::Scene;

/// Texels that a chart needs: two along each side, so that the filter has something to read between.
const FEWEST: f64 = 4.0;
/// Share of a mesh whose charts may be smaller: chips that show nowhere.
const CHIPS: f64 = 1e-3;

/// A chart as large as it is in space and in its sheet.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct ChartSize {
    /// Index into the meshes of the scene.
    pub(super) mesh: usize,
    /// Its first triangle.
    pub(super) triangle: usize,
    /// Area in space.
    pub(super) area: f64,
    /// Area in the sheet, in texels.
    pub(super) texels: f64,
}

impl ChartSize {
    /// By how much the sides of the sheet must grow for it to have enough texels; 1 or less where it has.
    fn growth(&self) -> f64 {
        (FEWEST / self.texels).sqrt()
    }
}

/// By how much the sides of a sheet of `width` by `height` texels must grow until each chart of the meshes in it has four texels, but for
/// chips that hold a thousandth of their mesh together; 1 or less where it is large enough. Charts without area are left out.
#[must_use]
pub fn growth(scene: &Scene, sheet: &[usize], [width, height]: [u32; 2]) -> f64 {
    let sizes = sizes(scene, sheet, f64::from(width) * f64::from(height));
    wanting(&sizes).iter().map(ChartSize::growth).fold(0.0, f64::max)
}

/// The charts that have too few texels, chips left out.
pub(super) fn too_small(sizes: &[ChartSize]) -> Vec<ChartSize> {
    wanting(sizes).into_iter().filter(|chart| chart.texels < FEWEST).collect()
}

/// Sizes of all charts of some meshes in a sheet of so many texels.
pub(super) fn sizes(scene: &Scene, sheet: &[usize], texels: f64) -> Vec<ChartSize> {
    let of_mesh = |&index: &usize| {
        let mesh = &scene.meshes[index];
        let charts = Charts::of(mesh);
        let mut sizes: Vec<Option<ChartSize>> = vec![None; charts.count as usize];
        for (triangle, &chart) in charts.of_triangle.iter().enumerate().filter(|_| !mesh.uv1.is_empty()) {
            let none = ChartSize { mesh: index, triangle, area: 0.0, texels: 0.0 };
            let size = sizes[chart as usize].get_or_insert(none);
            let placed = 0.5 * doubled_area(corners(mesh, triangle)).abs() * texels;
            size.area += mesh.area(triangle);
            size.texels += if placed.is_finite() { placed } else { 0.0 };
        }
        sizes.into_iter().flatten()
    };
    sheet.iter().flat_map(of_mesh).collect()
}

/// The charts that are to have texels: of each mesh all but the smallest, which hold next to nothing of it together.
fn wanting(sizes: &[ChartSize]) -> Vec<ChartSize> {
    let mut out = Vec::new();
    for mesh in sizes.chunk_by(|a, b| a.mesh == b.mesh) {
        let mut charts: Vec<ChartSize> = mesh.iter().copied().filter(|chart| chart.texels > 0.0).collect();
        charts.sort_by(|a, b| a.texels.total_cmp(&b.texels));
        let spared = CHIPS * mesh.iter().map(|chart| chart.area).sum::<f64>();
        let mut sum = 0.0;
        out.extend(charts.into_iter().skip_while(|chart| {
            sum += chart.area;
            sum <= spared
        }));
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Mesh;
    use glam::Vec2;

    /// Squares of the given sides in space and in the sheet, each a chart.
    fn squares(sides: &[(f32, f32)]) -> Scene {
        let mut mesh = Mesh::default();
        for (k, &(space, sheet)) in sides.iter().enumerate() {
            let v = mesh.positions.len() as u32;
            for at in [Vec2::ZERO, Vec2::X, Vec2::ONE, Vec2::Y] {
                mesh.positions.push((at * space).extend(k as f32));
                mesh.uv1.push(at * sheet + 0.25);
            }
            mesh.triangles.extend([[v, v + 1, v + 2], [v, v + 2, v + 3]]);
        }
        Scene { meshes: vec![mesh], ..Scene::default() }
    }

    /// A square of a tenth of the sheet has four texels in one of twenty: by hand.
    #[test]
    fn growth_is_that_of_the_smallest_chart() {
        let scene = squares(&[(1.0, 0.5), (0.2, 0.1)]);
        assert!((growth(&scene, &[0], [20, 20]) - 1.0).abs() < 1e-4);
        assert!((growth(&scene, &[0], [5, 5]) - 4.0).abs() < 1e-3);
        assert_eq!(too_small(&sizes(&scene, &[0], 19.0 * 19.0)).len(), 1);
        assert_eq!(too_small(&sizes(&scene, &[0], 21.0 * 21.0)).len(), 0, "can fail");
    }

    /// A chip of a ten-thousandth of the mesh asks for nothing; a hundred of them do.
    #[test]
    fn chips_are_spared() {
        let chip = (0.01, 0.005);
        assert!(growth(&squares(&[(1.0, 0.5), chip]), &[0], [20, 20]) < 1.0);
        let many: Vec<(f32, f32)> = std::iter::once((1.0, 0.5)).chain([chip; 100]).collect();
        assert!(growth(&squares(&many), &[0], [20, 20]) > 10.0);
    }
}
