//! Where transfer is computed: the vertices of the scene, and the backs of two-sided surfaces.

use crate::start::{extent, rounding};
use glam::Vec3;
use raytrace::{Ray, offset_origin};
use scene::{Mesh, Scene};

/// No receiver.
pub(crate) const NONE: u32 = u32::MAX;

/// A point with a normal that gathers light.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Receiver {
    /// World space, metres; drawn in from open borders, so that a corner between two meshes is seen from inside.
    pub position: Vec3,
    /// The vertex itself, world space: what lies above its tangent plane can cast a shadow.
    pub vertex: Vec3,
    /// Unit shading normal: the cosine is taken about it.
    pub normal: Vec3,
    /// Unit normal of the surface itself: rays start off along it.
    pub geometric_normal: Vec3,
    /// Whether there is a normal at all; a receiver without one is repaired from its neighbours.
    pub sound: bool,
    /// Whether its surface neither scatters nor mirrors light, so that what arrives shows nowhere; set by the plan.
    pub dark: bool,
    /// How far rounding may put the surface off its plane, metres.
    pub rounding: f32,
}

/// All receivers of a scene. Vertex `v` of the flattened scene is receiver `v`.
#[derive(Debug, Clone)]
pub struct Receivers {
    /// The receivers; fronts first, then backs.
    pub list: Vec<Receiver>,
    /// Number of vertices of the scene, which are the first receivers.
    pub vertices: usize,
    /// Receivers that go into the file: fronts and the backs of two-sided materials.
    pub permanent: usize,
    /// Of each vertex the receiver on its back, or `u32::MAX`.
    pub back_of: Vec<u32>,
    /// Of each receiver the first of those at its near points; `u32::MAX` or missing where it has none.
    pub(crate) near_of: Vec<u32>,
    /// Of each cell the receivers on its front and its back; empty where no triangle has cells.
    pub(crate) cell_of: Vec<u32>,
    /// Normals that had to be replaced by those of the faces.
    pub replaced_normals: usize,
}

impl Receivers {
    /// Makes a receiver of every vertex, and one more for the back where a material is two-sided.
    #[must_use]
    pub fn of(scene: &Scene) -> Self {
        let mut all = Self {
            list: Vec::new(),
            vertices: 0,
            permanent: 0,
            back_of: Vec::new(),
            near_of: Vec::new(),
            cell_of: Vec::new(),
            replaced_normals: 0,
        };
        for mesh in &scene.meshes {
            all.add_mesh(mesh);
        }
        all.vertices = all.list.len();
        all.back_of = vec![NONE; all.vertices];
        let mut first = 0;
        for mesh in &scene.meshes {
            if scene.materials[mesh.material as usize].double_sided {
                for vertex in first..first + mesh.positions.len() {
                    all.add_back(vertex as u32);
                }
            }
            first += mesh.positions.len();
        }
        all.permanent = all.list.len();
        all
    }

    /// Adds receivers at what a receiver sees very near, for the time of the bake.
    pub(crate) fn add_near(&mut self, receiver: u32, points: impl Iterator<Item = Receiver>) {
        self.near_of.resize(self.list.len(), NONE);
        self.near_of[receiver as usize] = self.list.len() as u32;
        self.list.extend(points);
    }

    /// Adds the back of a vertex if it has none yet, and returns its receiver.
    pub(crate) fn add_back(&mut self, vertex: u32) -> u32 {
        if self.back_of[vertex as usize] == NONE {
            self.back_of[vertex as usize] = self.list.len() as u32;
            self.list.push(self.list[vertex as usize].back());
        }
        self.back_of[vertex as usize]
    }

    fn add_mesh(&mut self, mesh: &Mesh) {
        let faces = FaceSums::of(mesh);
        for vertex in 0..mesh.positions.len() {
            let shading = mesh.normals.get(vertex).copied();
            let at = mesh.positions[vertex];
            let (receiver, replaced) = Receiver::new(at, shading, faces.normal[vertex], faces.centre(vertex));
            self.replaced_normals += usize::from(replaced);
            self.list.push(receiver.of_extent(faces.extent));
        }
    }
}

impl Receiver {
    /// A receiver at a point of a mesh, with the sum of the normals of the faces around it and their middle; also whether
    /// the shading normal was no use and that of the faces took its place.
    pub(crate) fn new(at: Vec3, shading: Option<Vec3>, faces: Vec3, centre: Vec3) -> (Self, bool) {
        let geometric = faces.try_normalize();
        let shading = shading.and_then(|n| n.try_normalize());
        let (normal, replaced) = match (shading, geometric) {
            (Some(s), Some(g)) if s.dot(g) > 0.0 => (s, false),
            (_, Some(g)) => (g, true),
            (s, None) => (s.unwrap_or(Vec3::Y), false),
        };
        let geometric_normal = geometric.unwrap_or(normal);
        let receiver = Self {
            position: drawn_in(at, centre, geometric_normal),
            vertex: at,
            normal,
            geometric_normal,
            sound: shading.is_some() || geometric.is_some(),
            dark: false,
            rounding: rounding(at.abs(), geometric_normal),
        };
        (receiver, replaced)
    }

    /// The same on a mesh with these largest coordinates, from whose corners the point comes.
    pub(crate) fn of_extent(self, extent: Vec3) -> Self {
        Self { rounding: rounding(extent, self.geometric_normal), ..self }
    }

    /// The same at a share of the way to another.
    pub(crate) fn towards(&self, other: &Self, share: f32) -> Self {
        Self { position: self.position + share * (other.position - self.position), ..*self }
    }

    /// The ray from just above this receiver to above another, which it reaches at 1.
    pub(crate) fn way_to(&self, other: &Self) -> Ray {
        let [start, end] = [self, other].map(|one| offset_origin(one.position, self.geometric_normal));
        Ray { t_max: 1.0, ..Ray::new(start, end - start) }
    }

    /// The same point of the surface seen from behind.
    pub(crate) fn back(&self) -> Self {
        // Over a fold a front is drawn in to above the surface, which is below it on the back.
        let above = (self.position - self.vertex).dot(self.geometric_normal).max(0.0);
        Self {
            position: self.position - above * self.geometric_normal,
            normal: -self.normal,
            geometric_normal: -self.geometric_normal,
            ..*self
        }
    }
}

/// Share of the way from a vertex to the middle of its triangles by which a receiver on a border is drawn in.
/// Exactly on the border, rays towards a wall that stands there would start inside the wall.
const DRAW_IN: f32 = 1e-3;
/// The least that it is drawn in by, over its largest coordinate: far from the origin small steps are lost to rounding. Four times what rays
/// start off the surface by.
const LEAST: f32 = 1.0 / 524_288.0;

/// Draws a point in from the border of its mesh, but never below the surface.
fn drawn_in(position: Vec3, centre: Vec3, normal: Vec3) -> Vec3 {
    let way = centre - position;
    let sunk = way.dot(normal).min(0.0);
    let way = way - sunk * normal;
    // A triangle of few steps of its coordinates is not left.
    let least = (LEAST * position.abs().max_element() / way.length()).min(0.25);
    position + DRAW_IN.max(least) * way
}

/// Sums over the triangles around each vertex of a mesh.
pub(crate) struct FaceSums {
    /// Area-weighted normals.
    pub(crate) normal: Vec<Vec3>,
    /// Area-weighted centres, with the weight in `area`.
    centre: Vec<Vec3>,
    area: Vec<f32>,
    positions: Vec<Vec3>,
    pub(crate) extent: Vec3,
}

impl FaceSums {
    pub(crate) fn of(mesh: &Mesh) -> Self {
        let n = mesh.positions.len();
        let mut sums = Self {
            normal: vec![Vec3::ZERO; n],
            centre: vec![Vec3::ZERO; n],
            area: vec![0.0; n],
            extent: extent(mesh),
            positions: mesh.positions.clone(),
        };
        for triangle in &mesh.triangles {
            let [a, b, c] = triangle.map(|v| mesh.positions[v as usize]);
            let cross = (b - a).cross(c - a);
            let area = cross.length();
            for &v in triangle {
                let v = v as usize;
                sums.normal[v] += cross;
                // Relative to the vertex: far from the origin a sum of positions would lose digits.
                sums.centre[v] +=
                    area * ((a - mesh.positions[v]) + (b - mesh.positions[v]) + (c - mesh.positions[v])) / 3.0;
                sums.area[v] += area;
            }
        }
        sums
    }

    /// The receiver of a vertex of the mesh.
    pub(crate) fn receiver(&self, mesh: &Mesh, vertex: usize) -> Receiver {
        let shading = mesh.normals.get(vertex).copied();
        let (receiver, _) = Receiver::new(mesh.positions[vertex], shading, self.normal[vertex], self.centre(vertex));
        receiver.of_extent(self.extent)
    }

    pub(crate) fn centre(&self, vertex: usize) -> Vec3 {
        let at = self.positions[vertex];
        if self.area[vertex] > 0.0 { at + self.centre[vertex] / self.area[vertex] } else { at }
    }
}

/// Ids of the receivers in `range` along a Morton curve through their positions: neighbours see alike.
pub(crate) fn morton_order(list: &[Receiver], ids: impl Iterator<Item = u32>) -> Vec<u32> {
    let finite = || list.iter().map(|r| r.position).filter(|p| p.is_finite());
    let low = finite().fold(Vec3::INFINITY, Vec3::min);
    let size = (finite().fold(Vec3::NEG_INFINITY, Vec3::max) - low).max_element().max(f32::MIN_POSITIVE);
    let mut keyed: Vec<(u64, u32)> = ids
        .map(|id| {
            let cell =
                ((list[id as usize].position - low) / size * 2_097_151.0).clamp(Vec3::ZERO, Vec3::splat(2_097_151.0));
            (spread(cell.x as u64) | spread(cell.y as u64) << 1 | spread(cell.z as u64) << 2, id)
        })
        .collect();
    keyed.sort_unstable();
    keyed.into_iter().map(|(_, id)| id).collect()
}

/// Spreads 21 bits so that two zero bits follow each.
fn spread(x: u64) -> u64 {
    let mut x = x & 0x1f_ffff;
    for (shift, mask) in [
        (32, 0x1f_0000_0000_ffff),
        (16, 0x1f_0000_ff00_00ff),
        (8, 0x100f_00f0_0f00_f00f),
        (4, 0x10c3_0c30_c30c_30c3),
        (2, 0x1249_2492_4924_9249),
    ] {
        x = (x | x << shift) & mask;
    }
    x
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A quad folded along the diagonal from corner 0 to corner 2; its middle is off the plane of those corners'
    /// neighbours, above it for a positive `fold`.
    fn folded(fold: f32) -> Scene {
        let lift =
            |y| [Vec3::new(0.0, y, 0.0), Vec3::new(0.0, 0.0, 1.0), Vec3::new(1.0, y, 1.0), Vec3::new(1.0, 0.0, 0.0)];
        let mesh = Mesh {
            positions: lift(fold).to_vec(),
            normals: vec![Vec3::Y; 4],
            triangles: vec![[0, 1, 2], [0, 2, 3]],
            ..Mesh::default()
        };
        let material = scene::Material { double_sided: true, ..scene::Material::default() };
        Scene { meshes: vec![mesh], materials: vec![material], ..Scene::default() }
    }

    /// Height of a point above the folded quad, which is linear on either side of the diagonal.
    fn height(p: Vec3, fold: f32) -> f32 {
        p.y - fold * (1.0 - (p.x - p.z).abs())
    }

    fn worst_side(side: impl Fn(&Receiver) -> f32) -> f32 {
        let sink = |fold: f32| {
            let all = Receivers::of(&folded(fold));
            all.list.iter().map(|r| side(r) * height(r.position, fold)).fold(f32::INFINITY, f32::min)
        };
        sink(0.3).min(sink(-0.3))
    }

    #[test]
    fn receivers_stand_on_their_own_side_of_a_fold() {
        let worst = worst_side(|r| r.geometric_normal.y.signum());
        assert!(worst >= -1e-6, "a receiver is {worst} below the surface that it stands on");
    }

    /// Where the front was drawn in to is below the surface for the back.
    #[test]
    fn receivers_stand_on_their_own_side_of_a_fold_can_fail() {
        let fold = -0.3;
        let all = Receivers::of(&folded(fold));
        let fronts = &all.list[..all.vertices];
        let worst = fronts.iter().map(|r| -height(r.position, fold)).fold(f32::INFINITY, f32::min);
        assert!(worst < -1e-6, "a back at the place of its front must be seen to be below: {worst}");
    }
}
