//! What is wrong with light-map coordinates, triangle by triangle.

use super::chart::Charts;
use super::cover::cover;
use crate::{Mesh, Scene};
use glam::DVec2;

/// How far outside of the unit square coordinates may lie, and how far triangles may run into each other: a hundredth of a texel of
/// a sheet of 1024, so that rounding is no fault.
const TOLERANCE: f64 = 1e-5;
/// Thinner triangles have no area to speak of: sixteen steps of a coordinate near 1.
const THINNEST: f64 = 1e-6;
/// Most cells along a side of the grid in which overlaps are looked for.
const MOST_CELLS: f64 = 1024.0;

/// A triangle whose light-map coordinates do not serve.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Fault {
    /// Index into [`Scene::meshes`].
    pub mesh: usize,
    /// Index into [`Mesh::triangles`]; of a mesh without coordinates its first.
    pub triangle: usize,
    /// What is wrong.
    pub kind: FaultKind,
}

/// What can be wrong with a triangle in a sheet.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum FaultKind {
    /// The mesh has no second texture coordinates.
    Missing,
    /// A coordinate is no number.
    NotFinite,
    /// A corner lies outside of the unit square; the corner.
    Outside([f32; 2]),
    /// No area: its texels hold no light of its own.
    Flat,
    /// It lies the other way round than most of its chart: the chart is folded there.
    Folded,
    /// It lies upon another triangle of the same sheet: they would share their light.
    Overlaps {
        /// Mesh of the other.
        mesh: usize,
        /// The other triangle.
        triangle: usize,
    },
    /// Its chart has so few texels that they cannot hold what lies on it.
    Tiny(f64),
    /// Less than a texel lies between its chart and another: their light mixes.
    Touches {
        /// Mesh of the other.
        mesh: usize,
        /// First triangle of the other chart.
        triangle: usize,
    },
    /// The meshes use so small a share of their sheet.
    Sparse(f64),
}

impl std::fmt::Display for FaultKind {
    fn fmt(&self, out: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Missing => write!(out, "there are no second texture coordinates"),
            Self::NotFinite => write!(out, "a coordinate is no number"),
            Self::Outside([u, v]) => write!(out, "a corner lies at ({u}, {v}), outside of the unit square"),
            Self::Flat => write!(out, "it has no area in the sheet"),
            Self::Folded => write!(out, "it lies the other way round than its chart"),
            Self::Overlaps { mesh, triangle } => write!(out, "it lies upon triangle {triangle} of mesh {mesh}"),
            Self::Tiny(texels) => write!(out, "its chart has {texels:.1} texels, of the four that it needs"),
            Self::Touches { mesh, triangle } => {
                write!(out, "its chart has no free texel to that of triangle {triangle} of mesh {mesh}")
            }
            Self::Sparse(share) => write!(out, "the meshes use {:.1} % of their sheet", 100.0 * share),
        }
    }
}

/// The faults of some meshes that share a sheet: for each triangle the first that is found, in the order of [`FaultKind`]. Overlaps
/// are told of the later triangle; one that is at fault already is not compared with further ones.
#[must_use]
pub fn faults(scene: &Scene, sheet: &[usize]) -> Vec<Fault> {
    let mut faults = Vec::new();
    let mut sound = Vec::new();
    for &index in sheet {
        let mesh = &scene.meshes[index];
        if mesh.uv1.is_empty() {
            let first =
                (!mesh.triangles.is_empty()).then_some(Fault { mesh: index, triangle: 0, kind: FaultKind::Missing });
            faults.extend(first);
            continue;
        }
        for (triangle, is_folded) in turned(mesh).into_iter().enumerate() {
            let place = Place { mesh: index, triangle, corners: corners(mesh, triangle) };
            match alone(&place.corners).or(is_folded.then_some(FaultKind::Folded)) {
                Some(kind) => faults.push(Fault { mesh: index, triangle, kind }),
                None => sound.push(place),
            }
        }
    }
    overlaps(&sound, &mut faults);
    faults.sort_by_key(|fault| (fault.mesh, fault.triangle));
    faults
}

/// A triangle in a sheet.
struct Place {
    mesh: usize,
    triangle: usize,
    corners: [DVec2; 3],
}

/// Corners of a triangle in the sheet.
pub(super) fn corners(mesh: &Mesh, triangle: usize) -> [DVec2; 3] {
    mesh.triangles[triangle].map(|v| mesh.uv1[v as usize].as_dvec2())
}

/// Twice the area, negative where the corners run clockwise.
pub(super) fn doubled_area([a, b, c]: [DVec2; 3]) -> f64 {
    (b - a).perp_dot(c - a)
}

/// Share of the unit square that the triangles of a mesh take, those upon each other counted each; 0 without coordinates.
#[must_use]
pub fn share(mesh: &Mesh) -> f64 {
    let placed = (0..mesh.triangles.len()).filter(|_| !mesh.uv1.is_empty());
    let areas = placed.map(|triangle| 0.5 * doubled_area(corners(mesh, triangle)).abs());
    areas.filter(|area| area.is_finite()).fold(0.0, |sum, area| sum + area)
}

/// What is wrong with a triangle whatever lies around it.
fn alone(corners: &[DVec2; 3]) -> Option<FaultKind> {
    if !corners.iter().all(|corner| corner.is_finite()) {
        return Some(FaultKind::NotFinite);
    }
    let is_outside = |p: &&DVec2| p.min_element() < -TOLERANCE || p.max_element() > 1.0 + TOLERANCE;
    if let Some(corner) = corners.iter().find(is_outside) {
        return Some(FaultKind::Outside(corner.as_vec2().to_array()));
    }
    (thickness(corners) < THINNEST).then_some(FaultKind::Flat)
}

/// The shortest altitude of a triangle.
fn thickness(corners: &[DVec2; 3]) -> f64 {
    let [a, b, c] = *corners;
    let longest = (b - a).length().max((c - b).length()).max((a - c).length());
    if longest > 0.0 { doubled_area(*corners).abs() / longest } else { 0.0 }
}

/// Whether each triangle lies the other way round than the larger part of its chart, by area. A chart that is mirrored as a whole
/// is in order.
fn turned(mesh: &Mesh) -> Vec<bool> {
    let charts = Charts::of(mesh);
    let areas: Vec<f64> = (0..mesh.triangles.len()).map(|t| doubled_area(corners(mesh, t))).collect();
    let mut sums = vec![0.0; charts.count as usize];
    for (&chart, &area) in charts.of_triangle.iter().zip(&areas).filter(|(_, area)| area.is_finite()) {
        sums[chart as usize] += area;
    }
    charts.of_triangle.iter().zip(&areas).map(|(&chart, &area)| area * sums[chart as usize] < 0.0).collect()
}

/// Finds triangles that lie upon earlier ones, in a grid over all of them. Those that do are not compared with later ones, so that no
/// heap of triangles fills a cell, however high; very uneven density can.
fn overlaps(places: &[Place], faults: &mut Vec<Fault>) {
    let corners = || places.iter().flat_map(|place| place.corners);
    let low = corners().fold(DVec2::ONE, DVec2::min);
    let extent = (corners().fold(DVec2::ZERO, DVec2::max) - low).max(DVec2::splat(THINNEST));
    let cells = (places.len() as f64).sqrt().ceil().clamp(1.0, MOST_CELLS);
    let size = [cells as u32; 2];
    let mut grid: Vec<Vec<u32>> = vec![Vec::new(); (size[0] * size[1]) as usize];
    let mut touched = Vec::new();
    for (index, place) in places.iter().enumerate() {
        touched.clear();
        let placed = place.corners.map(|corner| (corner - low) / extent * cells);
        cover(placed, size, &mut |x, y| touched.push((y * size[0] + x) as usize));
        let mut around = touched.iter().flat_map(|&cell| &grid[cell]);
        let found = around.find(|&&other| intersect(&place.corners, &places[other as usize].corners));
        if let Some(&other) = found {
            let Place { mesh, triangle, .. } = places[other as usize];
            let kind = FaultKind::Overlaps { mesh, triangle };
            faults.push(Fault { mesh: place.mesh, triangle: place.triangle, kind });
        } else {
            touched.iter().for_each(|&cell| grid[cell].push(index as u32));
        }
    }
}

/// Whether two triangles run into each other by more than the tolerance, or an eighth of the thinner one: no edge of either has the
/// other beyond it.
fn intersect(a: &[DVec2; 3], b: &[DVec2; 3]) -> bool {
    let tolerance = TOLERANCE.min(thickness(a).min(thickness(b)) / 8.0);
    let apart = |a: &[DVec2; 3], b: &[DVec2; 3]| {
        let outward = -doubled_area(*a).signum();
        (0..3).any(|k| {
            let edge = a[(k + 1) % 3] - a[k];
            let normal = edge.perp() * (outward / edge.length());
            b.iter().all(|&p| normal.dot(p - a[k]) > -tolerance)
        })
    };
    !apart(a, b) && !apart(b, a)
}

#[cfg(test)]
mod tests {
    use super::{Fault, FaultKind, faults, intersect};
    use crate::{Mesh, Scene};
    use glam::{DVec2, Vec2};

    /// A plane of `n` by `n` quads over the middle half of the sheet.
    fn plane(n: u32) -> Mesh {
        let mut mesh = Mesh::default();
        for i in 0..(n + 1) * (n + 1) {
            let at = Vec2::new((i % (n + 1)) as f32, (i / (n + 1)) as f32) / n as f32;
            mesh.positions.push(at.extend(0.0));
            mesh.uv1.push(0.25 + 0.5 * at);
        }
        for k in 0..n * n {
            let a = k % n + k / n * (n + 1);
            mesh.triangles.extend([[a, a + 1, a + n + 2], [a, a + n + 2, a + n + 1]]);
        }
        mesh
    }

    fn scene(meshes: Vec<Mesh>) -> Scene {
        Scene { meshes, ..Scene::default() }
    }

    #[test]
    fn a_plane_is_in_order_also_mirrored() {
        let mut mirrored = plane(9);
        mirrored.uv1.iter_mut().for_each(|uv| uv.x = 1.0 - uv.x);
        assert_eq!(faults(&scene(vec![plane(9)]), &[0]), []);
        assert_eq!(faults(&scene(vec![mirrored]), &[0]), []);
    }

    #[test]
    fn each_fault_is_named_with_its_triangle() {
        let mut mesh = plane(4);
        // The last vertex belongs to the last quad alone.
        let last = mesh.uv1.len() - 1;
        mesh.uv1[last] = Vec2::new(0.75, 1.25);
        let told = faults(&scene(vec![mesh.clone()]), &[0]);
        let outside = |triangle| Fault { mesh: 0, triangle, kind: FaultKind::Outside([0.75, 1.25]) };
        assert_eq!(told, [outside(30), outside(31)]);
        mesh.uv1[last] = Vec2::new(f32::NAN, 0.5);
        let kinds: Vec<FaultKind> = faults(&scene(vec![mesh.clone()]), &[0]).iter().map(|fault| fault.kind).collect();
        assert_eq!(kinds, [FaultKind::NotFinite; 2]);
        mesh.uv1[last] = mesh.uv1[last - 1];
        let kinds: Vec<FaultKind> = faults(&scene(vec![mesh.clone()]), &[0]).iter().map(|fault| fault.kind).collect();
        assert_eq!(kinds, [FaultKind::Flat]);
        mesh.uv1.clear();
        let missing = [Fault { mesh: 0, triangle: 0, kind: FaultKind::Missing }];
        assert_eq!(faults(&scene(vec![mesh]), &[0]), missing);
    }

    /// A vertex drawn across its neighbours folds the triangles around it.
    #[test]
    fn folds_are_found() {
        let mut mesh = plane(4);
        let middle = 12;
        mesh.uv1[middle] += Vec2::new(0.2, 0.0);
        let told = faults(&scene(vec![mesh]), &[0]);
        assert!(told.iter().any(|fault| fault.kind == FaultKind::Folded), "{told:?}");
    }

    /// Two planes in one sheet lie upon each other; apart, or in sheets of their own, they do not.
    #[test]
    fn overlaps_are_found_within_a_sheet() {
        let both = scene(vec![plane(5), plane(7)]);
        let told = faults(&both, &[0, 1]);
        assert_eq!(told.len(), 2 * 49, "every triangle of the second");
        assert!(told.iter().all(|fault| fault.mesh == 1 && matches!(fault.kind, FaultKind::Overlaps { mesh: 0, .. })));
        assert_eq!(faults(&both, &[1]), []);
        let mut beside = plane(7);
        beside.uv1.iter_mut().for_each(|uv| *uv = *uv * 0.4 - 0.1);
        assert_eq!(faults(&scene(vec![plane(5), beside]), &[0, 1]), []);
    }

    /// Also where all lie in a single spot, smaller than the tolerance of larger ones.
    #[test]
    fn every_triangle_of_a_heap_is_told() {
        let mut mesh = plane(1);
        mesh.triangles = vec![[0, 1, 3]; 20_000];
        assert_eq!(faults(&scene(vec![mesh.clone()]), &[0]).len(), 19_999);
        mesh.uv1.iter_mut().for_each(|uv| *uv = 0.5 + *uv * 1e-5);
        assert_eq!(faults(&scene(vec![mesh]), &[0]).len(), 19_999);
    }

    #[test]
    fn touching_is_no_overlap() {
        let a = [DVec2::ZERO, DVec2::X, DVec2::Y];
        let moved = |by: DVec2| [DVec2::X + by, DVec2::ONE + by, DVec2::Y + by];
        assert!(!intersect(&a, &moved(DVec2::ZERO)));
        assert!(!intersect(&a, &moved(DVec2::splat(-0.5e-5))));
        assert!(intersect(&a, &moved(DVec2::splat(-2e-5))));
        assert!(intersect(&a, &a));
    }
}
