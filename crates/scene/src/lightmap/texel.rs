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
    /// Weights of the second and third corner at the middle of the texel; where that lies outside, at the centroid of what the texel holds
    /// of the triangle.
    pub barycentrics: [f32; 2],
    /// Whether that is the middle itself; a texel at the border of a chart may have its middle outside. A point on the border itself would
    /// not do there: what stands on the edge of a surface hides half of what its inside sees.
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
        let (distance, nearest) = closest(placed, middle(column, row));
        let inner = (distance > 0.0).then(|| within(placed, column, row)).flatten();
        let [u, v] = inner.unwrap_or(nearest);
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

/// Weights of the second and third corner at the centroid of what a texel holds of a triangle; none where that has no area.
fn within(corners: [DVec2; 3], column: u32, row: u32) -> Option<[f64; 2]> {
    let low = DVec2::new(f64::from(column), f64::from(row));
    let mut outline = corners.to_vec();
    for (normal, border) in
        [(DVec2::X, low.x), (DVec2::NEG_X, -low.x - 1.0), (DVec2::Y, low.y), (DVec2::NEG_Y, -low.y - 1.0)]
    {
        outline = cut(&outline, normal, border);
    }
    let first = *outline.first()?;
    let (mut sum, mut total) = (DVec2::ZERO, 0.0);
    for pair in outline.windows(2).skip(1) {
        let area = doubled_area([first, pair[0], pair[1]]);
        sum += area * ((pair[0] - first) + (pair[1] - first)) / 3.0;
        total += area;
    }
    let at = first + sum / total;
    let [a, b, c] = corners;
    let whole = doubled_area(corners);
    let (u, v) = (doubled_area([a, at, c]) / whole, doubled_area([a, b, at]) / whole);
    // Rounding must not leave the triangle; what is no number fails here.
    (u >= 0.0 && v >= 0.0 && u + v <= 1.0).then_some([u, v])
}

/// The part of a convex outline where the product with `normal` is `border` or more.
fn cut(outline: &[DVec2], normal: DVec2, border: f64) -> Vec<DVec2> {
    let mut out = Vec::with_capacity(outline.len() + 1);
    for (k, &from) in outline.iter().enumerate() {
        let to = outline[(k + 1) % outline.len()];
        let (a, b) = (normal.dot(from) - border, normal.dot(to) - border);
        if a >= 0.0 {
            out.push(from);
        }
        if (a >= 0.0) != (b >= 0.0) {
            out.push(from + (to - from) * (a / (a - b)));
        }
    }
    out
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

    /// Every point lies in its texel, and where the middle lies in the triangle it is the point. The
    /// area of those is the triangle's but for half a texel along its edges.
    #[test]
    fn points_are_middles_or_lie_inside() {
        let scene = scene([Vec2::new(0.1, 0.15), Vec2::new(0.9, 0.3), Vec2::new(0.35, 0.85)]);
        let found = texels(&scene, &[0], 64, 32);
        let mut inside = 0.0;
        for texel in &found {
            let at = place(&scene, texel).as_dvec2() * DVec2::new(64.0, 32.0);
            let low = DVec2::new(f64::from(texel.column), f64::from(texel.row));
            let away = (at - (low + 0.5)).abs();
            assert!(away.max_element() <= 0.5 + 1e-4, "{texel:?} at {at}");
            let [u, v] = texel.barycentrics;
            assert!(u.min(v).min(1.0 - u - v) > 0.0, "inside of the triangle: {texel:?}");
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

    /// Against the mean of many points of what the texel holds of the triangle.
    #[test]
    fn a_border_texel_stands_for_what_it_holds() {
        let scene = scene([Vec2::new(0.07, 0.11), Vec2::new(0.93, 0.31), Vec2::new(0.37, 0.89)]);
        let found = texels(&scene, &[0], 16, 16);
        let corners = scene.meshes[0].uv1.clone();
        let side = |a: Vec2, b: Vec2, p: Vec2| (b - a).perp_dot(p - a) >= 0.0;
        let mut farthest = 0.0f32;
        for texel in found.iter().filter(|texel| !texel.is_middle) {
            let mut inside = Vec::new();
            for k in 0..200 * 200 {
                let part = (Vec2::new((k % 200) as f32, (k / 200) as f32) + 0.5) / 200.0;
                let at = (Vec2::new(texel.column as f32, texel.row as f32) + part) / 16.0;
                if (0..3).all(|i| side(corners[i], corners[(i + 1) % 3], at)) {
                    inside.push(at);
                }
            }
            if inside.len() > 400 {
                let mean = inside.iter().sum::<Vec2>() / inside.len() as f32;
                let off = 16.0 * (place(&scene, texel) - mean).length();
                assert!(off < 0.02, "{texel:?}: {off} texels");
                let middle = (Vec2::new(texel.column as f32, texel.row as f32) + 0.5) / 16.0;
                farthest = farthest.max(16.0 * (middle - mean).length());
            }
        }
        assert!(farthest > 0.3, "can fail: the middles are not where the means are");
    }

    #[test]
    fn triangles_without_area_have_no_texels() {
        assert_eq!(texels(&scene([Vec2::ZERO, Vec2::X, Vec2::X]), &[0], 8, 8), []);
        assert_eq!(texels(&scene([Vec2::NAN, Vec2::X, Vec2::Y]), &[0], 8, 8), []);
        assert_eq!(texels(&scene([Vec2::splat(3.0), Vec2::new(4.0, 3.0), Vec2::new(3.0, 4.0)]), &[0], 8, 8), []);
    }
}
