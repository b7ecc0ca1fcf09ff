//! Where a smooth surface is cut in the sheet: both sides should show the same light.

use crate::Scene;
use crate::weld::{half_edges, weld};
use glam::{Vec2, Vec3};

/// Cosine of the largest angle between the shading normals of two sides that count as one smooth surface: 8 degrees.
const SMOOTH: f32 = 0.99;
/// More triangles than this at one edge are no surface.
const MOST_SIDES: usize = 8;

/// One side of a [`Seam`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SeamSide {
    /// Index into [`Scene::meshes`].
    pub mesh: u32,
    /// Light-map coordinates of the two ends.
    pub ends: [Vec2; 2],
}

/// An edge that two triangles share in space but not in the sheet, or that lies between meshes; the ends of both sides are in one order.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Seam {
    /// The two sides.
    pub sides: [SeamSide; 2],
}

/// Seams between the given meshes, whatever sheets they lie in, where the surface is smooth across.
///
/// Edges are found by the positions of their ends, which must be equal to the bit, as loaders leave them.
#[must_use]
pub fn seams(scene: &Scene, meshes: &[usize]) -> Vec<Seam> {
    let with_coordinates = || meshes.iter().copied().filter(|&m| !scene.meshes[m].uv1.is_empty());
    let (_, welded) = weld(with_coordinates().flat_map(|m| scene.meshes[m].positions.iter().copied()));
    let (mut triangles, mut sources, mut first) = (Vec::new(), Vec::new(), 0);
    for m in with_coordinates() {
        for (t, triangle) in (0u32..).zip(&scene.meshes[m].triangles) {
            triangles.push(triangle.map(|v| welded[first + v as usize]));
            sources.push((m as u32, t));
        }
        first += scene.meshes[m].positions.len();
    }
    let edges = half_edges(&triangles);
    let side =
        |half: &crate::weld::HalfEdge| Side::of(scene, sources[half.corner as usize / 3], half.corner % 3, half.rising);
    let mut seams = Vec::new();
    for group in edges.chunk_by(|a, b| (a.low, a.high) == (b.low, b.high)) {
        if group.len() > MOST_SIDES {
            continue;
        }
        let sides: Vec<Side> = group.iter().map(side).collect();
        for (i, a) in sides.iter().enumerate() {
            let others =
                sides[i + 1..].iter().filter(|b| b.rising != a.rising && a.is_smooth_with(b) && a.is_cut_from(b));
            seams.extend(others.map(|b| Seam { sides: [a.place, b.place] }));
        }
    }
    seams
}

/// A triangle at an edge, from the end with the lower number to the other.
struct Side {
    place: SeamSide,
    normals: [Vec3; 2],
    rising: bool,
}

impl Side {
    fn of(scene: &Scene, (mesh, triangle): (u32, u32), corner: u32, rising: bool) -> Self {
        let m = &scene.meshes[mesh as usize];
        let corners = m.triangles[triangle as usize];
        let (from, to) = (corners[corner as usize] as usize, corners[(corner as usize + 1) % 3] as usize);
        let [low, high] = if rising { [from, to] } else { [to, from] };
        Self {
            place: SeamSide { mesh, ends: [m.uv1[low], m.uv1[high]] },
            normals: [low, high].map(|v| m.normals[v]),
            rising,
        }
    }

    fn is_smooth_with(&self, other: &Self) -> bool {
        self.normals.iter().zip(other.normals).all(|(a, b)| a.dot(b) >= SMOOTH)
    }

    fn is_cut_from(&self, other: &Self) -> bool {
        self.place != other.place
    }
}

#[cfg(test)]
mod tests {
    use super::seams;
    use crate::{Mesh, Scene};
    use glam::{Vec2, Vec3};

    /// An open tube of flat quads about y with smooth normals, unrolled along u, cut at angle 0.
    fn tube(quads: u32, smooth: bool) -> Mesh {
        let mut mesh = Mesh::default();
        for quad in 0..quads {
            let angle = |k: u32| std::f32::consts::TAU * (k % quads) as f32 / quads as f32;
            let middle = std::f32::consts::TAU * (quad as f32 + 0.5) / quads as f32;
            for (k, y) in [(quad, 0.0), (quad + 1, 0.0), (quad + 1, 1.0), (quad, 1.0)] {
                let a = angle(k);
                mesh.positions.push(Vec3::new(a.cos(), y, -a.sin()));
                let n = if smooth { a } else { middle };
                mesh.normals.push(Vec3::new(n.cos(), 0.0, -n.sin()));
                mesh.uv1.push(Vec2::new(k as f32 / quads as f32 * 0.8 + 0.1, y * 0.8 + 0.1));
            }
            let v = 4 * quad;
            mesh.triangles.extend([[v, v + 1, v + 2], [v, v + 2, v + 3]]);
        }
        mesh
    }

    #[test]
    fn a_tube_is_cut_once() {
        let scene = Scene { meshes: vec![tube(12, true)], ..Scene::default() };
        let found = seams(&scene, &[0]);
        assert_eq!(found.len(), 1, "{found:?}");
        let [a, b] = found[0].sides;
        assert!((a.ends[0].x - b.ends[0].x).abs() > 0.7 && a.ends[0].y == b.ends[0].y, "{found:?}");
    }

    /// With edges that are meant to be seen nothing is to be joined.
    #[test]
    fn hard_edges_are_no_seams() {
        let scene = Scene { meshes: vec![tube(12, false)], ..Scene::default() };
        assert_eq!(seams(&scene, &[0]).len(), 0);
    }

    /// Two meshes that continue each other, in sheets of their own with the same coordinates.
    #[test]
    fn meshes_are_joined() {
        let mut upper = tube(8, true);
        upper.positions.iter_mut().for_each(|p| p.y += 1.0);
        let scene = Scene { meshes: vec![tube(8, true), upper], ..Scene::default() };
        let between =
            seams(&scene, &[0, 1]).into_iter().filter(|seam| seam.sides[0].mesh != seam.sides[1].mesh).count();
        assert_eq!(between, 8);
    }
}
