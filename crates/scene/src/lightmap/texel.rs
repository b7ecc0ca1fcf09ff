//! The points of surfaces that the texels of a sheet stand for.

use super::cover::cover;
use super::fault::{corners, doubled_area};
use crate::Scene;
use glam::DVec2;

/// A texel that a surface touches, and the point of the surface that it stands for.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Texel {
    /// From u = 0 on.
    pub column: u32,
    /// From v = 0 on.
    pub row: u32,
    /// Index into [`Scene::meshes`].
    pub mesh: u32,
    /// Index into [`crate::Mesh::triangles`].
    pub triangle: u32,
    /// Weights of the second and third corner at the point of the triangle that is nearest to the middle of the texel.
    pub barycentrics: [f32; 2],
    /// Whether that is the middle itself; a texel at the border of a chart may have its middle outside.
    pub is_middle: bool,
}

/// All texels of a sheet of `width` by `height` that the given meshes touch, row by row: also those that a chart only grazes, since the
/// filter reads them. Of several triangles in a texel the one nearest to its middle counts, and the first of those as near.
///
/// Triangles without area or with coordinates that are no numbers have none; what lies outside of the sheet is left out.
#[must_use]
pub fn texels(scene: &Scene, sheet: &[usize], width: u32, height: u32) -> Vec<Texel> {
    let scale = DVec2::new(f64::from(width), f64::from(height));
    let mut nearest = vec![Nearest::NOTHING; width as usize * height as usize];
    for &index in sheet {
        let mesh = &scene.meshes[index];
        for triangle in (0..mesh.triangles.len()).filter(|_| !mesh.uv1.is_empty()) {
            let placed = corners(mesh, triangle).map(|corner| corner * scale);
            let area = doubled_area(placed);
            if area == 0.0 || area.is_nan() {
                continue;
            }
            cover(placed, [width, height], &mut |column, row| {
                let best = &mut nearest[row as usize * width as usize + column as usize];
                if best.distance == 0.0 {
                    return;
                }
                let (distance, _) = closest(placed, middle(column, row));
                if distance < best.distance {
                    *best = Nearest { distance, mesh: index as u32, triangle: triangle as u32 };
                }
            });
        }
    }
    let touched = nearest.iter().enumerate().filter(|(_, best)| best.distance < f64::INFINITY);
    touched.map(|(k, best)| best.texel(scene, scale, k as u32 % width, k as u32 / width)).collect()
}

fn middle(column: u32, row: u32) -> DVec2 {
    DVec2::new(f64::from(column) + 0.5, f64::from(row) + 0.5)
}

/// The triangle that lies nearest to the middle of a texel.
#[derive(Clone, Copy)]
struct Nearest {
    /// Squared, in texels.
    distance: f64,
    mesh: u32,
    triangle: u32,
}

impl Nearest {
    const NOTHING: Self = Self { distance: f64::INFINITY, mesh: 0, triangle: 0 };

    fn texel(&self, scene: &Scene, scale: DVec2, column: u32, row: u32) -> Texel {
        let placed = corners(&scene.meshes[self.mesh as usize], self.triangle as usize).map(|corner| corner * scale);
        let (distance, [u, v]) = closest(placed, middle(column, row));
        Texel {
            column,
            row,
            mesh: self.mesh,
            triangle: self.triangle,
            barycentrics: [u as f32, v as f32],
            is_middle: distance == 0.0,
        }
    }
}

/// Squared distance of a point to a triangle with area, and the weights of the second and third corner at the nearest point.
fn closest(corners: [DVec2; 3], point: DVec2) -> (f64, [f64; 2]) {
    let [a, b, c] = corners;
    let area = doubled_area(corners);
    let (u, v) = (doubled_area([a, point, c]) / area, doubled_area([a, b, point]) / area);
    if u >= 0.0 && v >= 0.0 && u + v <= 1.0 {
        return (0.0, [u, v]);
    }
    let on_edge = |from: DVec2, to: DVec2| {
        let along = ((point - from).dot(to - from) / (to - from).length_squared()).clamp(0.0, 1.0);
        ((from + (to - from) * along).distance_squared(point), along)
    };
    let ((ab, s), (bc, t), (ca, r)) = (on_edge(a, b), on_edge(b, c), on_edge(c, a));
    if ab <= bc && ab <= ca {
        (ab, [s, 0.0])
    } else if bc <= ca {
        (bc, [1.0 - t, t])
    } else {
        (ca, [0.0, 1.0 - r])
    }
}

#[cfg(test)]
mod tests {
    use super::{Texel, texels};
    use crate::{Mesh, Scene};
    use glam::{DVec2, Vec2};

    fn scene(corners: [Vec2; 3]) -> Scene {
        let mesh = Mesh {
            positions: corners.map(|uv| uv.extend(0.0)).to_vec(),
            uv1: corners.to_vec(),
            triangles: vec![[0, 1, 2]],
            ..Mesh::default()
        };
        Scene { meshes: vec![mesh], ..Scene::default() }
    }

    fn place(scene: &Scene, texel: &Texel) -> Vec2 {
        let mesh = &scene.meshes[texel.mesh as usize];
        let [a, b, c] = mesh.triangles[texel.triangle as usize].map(|v| mesh.uv1[v as usize]);
        let [u, v] = texel.barycentrics;
        a + (b - a) * u + (c - a) * v
    }

    /// No point is farther from the middle of its texel than a corner, and where the middle lies in the triangle it is the point. The
    /// area of those is the triangle's but for half a texel along its edges.
    #[test]
    fn points_are_the_nearest_to_the_middles() {
        let scene = scene([Vec2::new(0.1, 0.15), Vec2::new(0.9, 0.3), Vec2::new(0.35, 0.85)]);
        let found = texels(&scene, &[0], 64, 32);
        let mut inside = 0.0;
        for texel in &found {
            let at = place(&scene, texel).as_dvec2() * DVec2::new(64.0, 32.0);
            let low = DVec2::new(f64::from(texel.column), f64::from(texel.row));
            let away = (at - (low + 0.5)).abs();
            assert!(away.length() <= 0.5f64.sqrt() + 1e-4, "{texel:?} at {at}");
            assert_eq!(texel.is_middle, away.max_element() < 1e-4, "{texel:?} at {at}");
            inside += f64::from(u8::from(texel.is_middle));
        }
        let exact = 0.5 * (0.8 * 0.7 - 0.15 * 0.25) * 64.0 * 32.0;
        assert!((inside - exact).abs() < 8.0, "{inside} texels, area {exact}");
        assert!(found.len() as f64 > exact + 30.0, "texels that the edges graze belong to it: {}", found.len());
    }

    #[test]
    fn texels_come_row_by_row_and_once() {
        let scene = scene([Vec2::ZERO, Vec2::X, Vec2::Y]);
        let found = texels(&scene, &[0], 8, 8);
        assert!(found.is_sorted_by_key(|texel| (texel.row, texel.column)));
        // The diagonal runs through 8 texels whose middles lie on it.
        assert_eq!(found.len(), 8 * 9 / 2);
    }

    #[test]
    fn triangles_without_area_have_no_texels() {
        assert_eq!(texels(&scene([Vec2::ZERO, Vec2::X, Vec2::X]), &[0], 8, 8), []);
        assert_eq!(texels(&scene([Vec2::NAN, Vec2::X, Vec2::Y]), &[0], 8, 8), []);
        assert_eq!(texels(&scene([Vec2::splat(3.0), Vec2::new(4.0, 3.0), Vec2::new(3.0, 4.0)]), &[0], 8, 8), []);
    }
}
