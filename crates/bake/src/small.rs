//! Small objects of a scene, as cubes that hold their surfaces: even refinement of large triangles misses their shadows.

use crate::compress::eigen;
use crate::split::place_of;
use glam::{DVec3, Vec3};
use scene::{Mesh, Scene};
use std::collections::{BTreeMap, BTreeSet, HashMap};

/// Most points that the surface of one object is looked at; what takes more is very long and thin, and is left out.
const MOST_POINTS: usize = 1 << 16;
/// Most cubes of all objects; the smallest objects are left out where there would be more, as blades of a meadow.
const MOST_CUBES: usize = 1 << 22;
/// Cubes along the size of an object.
const CUBES: f32 = 2.0;

/// A cube of space that holds a part of an object.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Cube {
    pub(crate) centre: Vec3,
    /// Size of the whole object, metres: its width where it is long and thin, its shorter side where it is flat.
    pub(crate) size: f32,
    pub(crate) object: Object,
}

/// An object by its mesh and its first vertex there, which keeps its index when triangles are split.
pub(crate) type Object = [u32; 2];

impl Cube {
    /// Radius of the sphere around the cube.
    pub(crate) fn radius(&self) -> f32 {
        0.5 * 3.0f32.sqrt() / CUBES * self.size
    }
}

/// The cubes of all objects between two sizes whose material blocks light. An object is a connected component of a mesh.
pub(crate) fn cubes(scene: &Scene, blocks: &dyn Fn(usize) -> bool, [smallest, largest]: [f32; 2]) -> Vec<Cube> {
    let mut cubes = Vec::new();
    let mut smallest = smallest;
    for (m, mesh) in (0..).zip(&scene.meshes).filter(|(_, mesh)| blocks(mesh.material as usize)) {
        let first = first_vertices(mesh);
        let mut objects: BTreeMap<u32, Vec<u32>> = BTreeMap::new();
        for (t, triangle) in (0..).zip(&mesh.triangles) {
            objects.entry(first[triangle[0] as usize]).or_default().push(t);
        }
        for (first, triangles) in objects {
            let size = size(mesh, &triangles);
            if size >= smallest && size < largest {
                cubes.extend(cubes_of(mesh, &triangles, size, [m, first]));
                smallest = leave_out(&mut cubes, smallest, MOST_CUBES);
            }
        }
    }
    cubes
}

/// Leaves out the smallest objects until no more than `most` cubes are left; from which size on objects still count.
fn leave_out(cubes: &mut Vec<Cube>, mut smallest: f32, most: usize) -> f32 {
    while cubes.len() > most {
        smallest = 2.0 * cubes.iter().map(|cube| cube.size).fold(f32::INFINITY, f32::min);
        cubes.retain(|cube| cube.size >= smallest);
    }
    smallest
}

/// Of each vertex of a mesh the first one that it is connected with; vertices at one place are one.
pub(crate) fn first_vertices(mesh: &Mesh) -> Vec<u32> {
    let mut first_at = HashMap::new();
    let mut parent: Vec<u32> =
        (0..).zip(&mesh.positions).map(|(v, p)| *first_at.entry(place_of(*p)).or_insert(v)).collect();
    for &[a, b, c] in &mesh.triangles {
        for (a, b) in [(a, b), (b, c)] {
            let (a, b) = (root(&mut parent, a), root(&mut parent, b));
            parent[a.max(b) as usize] = a.min(b);
        }
    }
    (0..parent.len() as u32).map(|v| root(&mut parent, v)).collect()
}

fn root(parent: &mut [u32], mut v: u32) -> u32 {
    while parent[v as usize] != v {
        parent[v as usize] = parent[parent[v as usize] as usize];
        v = parent[v as usize];
    }
    v
}

/// The middle one of an object's three extents along its own axes, from the second moments of its surface.
fn size(mesh: &Mesh, triangles: &[u32]) -> f32 {
    let origin = mesh.positions[mesh.triangles[triangles[0] as usize][0] as usize];
    let (mut area, mut first, mut second) = (0.0, DVec3::ZERO, [0.0; 9]);
    for &t in triangles {
        let corners = mesh.triangles[t as usize].map(|v| (mesh.positions[v as usize] - origin).as_dvec3());
        let [a, b, c] = corners;
        let weight = 0.5 * (b - a).cross(c - a).length();
        let sum = a + b + c;
        area += weight;
        first += weight / 3.0 * sum;
        for (k, entry) in second.iter_mut().enumerate() {
            let product = |p: DVec3| p[k / 3] * p[k % 3];
            *entry += weight / 12.0 * (product(sum) + corners.into_iter().map(product).sum::<f64>());
        }
    }
    if area <= 0.0 {
        return 0.0;
    }
    let mean = first / area;
    let covariance: Vec<f64> =
        second.iter().enumerate().map(|(k, entry)| entry / area - mean[k / 3] * mean[k % 3]).collect();
    let (variances, _) = eigen::symmetric(&covariance, 3);
    // A line of length 1 has a variance of 1 / 12.
    (12.0 * variances[1].max(0.0)).sqrt() as f32
}

/// The cubes that the surface of an object passes through.
fn cubes_of(mesh: &Mesh, triangles: &[u32], size: f32, object: Object) -> Vec<Cube> {
    let edge = size / CUBES;
    let mut cells: BTreeSet<[i64; 3]> = BTreeSet::new();
    let mut points = 0;
    for &t in triangles {
        let [a, b, c] = longest_first(mesh.triangles[t as usize].map(|v| mesh.positions[v as usize]));
        let length = a.distance(b);
        let height = (b - a).cross(c - a).length() / length.max(f32::MIN_POSITIVE);
        let [along, across] = [length, height].map(|x| ((x / edge).ceil() as usize).max(1));
        points += along * across;
        if points > MOST_POINTS {
            return Vec::new();
        }
        for j in 0..across {
            let rise = (j as f32 + 0.5) / across as f32;
            let ends = [a.lerp(c, rise), b.lerp(c, rise)];
            let point = |i: usize| ends[0].lerp(ends[1], (i as f32 + 0.5) / along as f32);
            cells.extend((0..along).map(|i| (point(i) / edge).floor().to_array().map(|x| x as i64)));
        }
    }
    let centre = |cell: [i64; 3]| edge * (Vec3::from_array(cell.map(|x| x as f32)) + 0.5);
    cells.into_iter().map(|cell| Cube { centre: centre(cell), size, object }).collect()
}

/// The corners of a triangle, its longest edge first.
fn longest_first([a, b, c]: [Vec3; 3]) -> [Vec3; 3] {
    let [ab, bc, ca] = [a.distance_squared(b), b.distance_squared(c), c.distance_squared(a)];
    if ab >= bc && ab >= ca {
        [a, b, c]
    } else if bc >= ca {
        [b, c, a]
    } else {
        [c, a, b]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use scene::Material;

    /// A box of the given size, turned by an angle about z and then about x.
    fn turned_box(extent: Vec3, angle: f32) -> Scene {
        let corner = |i: u32| {
            let p = extent * (Vec3::new((i & 1) as f32, (i >> 1 & 1) as f32, (i >> 2) as f32) - 0.5);
            let turn = glam::Quat::from_rotation_x(angle) * glam::Quat::from_rotation_z(angle);
            turn * p + Vec3::new(30.0, -4.0, 7.0)
        };
        let quads = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
        let triangles = quads.into_iter().flat_map(|[a, b, c, d]| [[a, b, c], [a, c, d]]).collect();
        let mesh = Mesh { positions: (0..8).map(corner).collect(), triangles, ..Mesh::default() };
        Scene { meshes: vec![mesh], materials: vec![Material::default()], ..Scene::default() }
    }

    /// Variance of a box's surface along its middle axis, face by face; of a flat or thin one it tends to that of a line.
    fn middle_size(extent: [f64; 3]) -> f64 {
        let [x, y, z] = extent;
        // Faces across y lie at y / 2; the others spread evenly along y.
        let (across, along) = (2.0 * x * z, 2.0 * y * (x + z));
        (12.0 * (across * y * y / 4.0 + along * y * y / 12.0) / (across + along)).sqrt()
    }

    #[test]
    fn size_is_the_middle_extent_however_the_object_is_turned() {
        for extent in [[0.1, 0.1, 5.0], [0.03, 0.5, 0.7], [0.5, 0.5, 0.5]] {
            for angle in [0.0, 0.4, 1.1] {
                let scene = turned_box(Vec3::from_array(extent), angle);
                let found = f64::from(size(&scene.meshes[0], &(0..12).collect::<Vec<_>>()));
                let expected = middle_size(extent.map(f64::from));
                assert!((found / expected - 1.0).abs() < 1e-3, "{extent:?} at {angle}: {found}, expected {expected}");
                // Twin: the longest side is not it.
                assert!(extent[2] < 0.6 || (found / f64::from(extent[2]) - 1.0).abs() > 0.1);
            }
        }
    }

    /// Too many cubes cost the smallest objects theirs, whole, and what is as small is not taken after them.
    #[test]
    fn the_smallest_objects_are_left_out() {
        let of_size = |size: f32| (0..10).map(move |k| Cube { centre: Vec3::splat(k as f32), size, object: [0, 0] });
        let mut cubes: Vec<Cube> = [0.1, 0.15, 1.0, 3.0].into_iter().flat_map(of_size).collect();
        assert_eq!(leave_out(&mut cubes, 0.05, 25), 0.2);
        assert_eq!(cubes.len(), 20, "both below twice the smallest");
        // Twin: where there is room all stay.
        assert_eq!((leave_out(&mut cubes, 0.2, 20), cubes.len()), (0.2, 20));
    }

    /// Cubes cover the whole surface, however long and thin its triangles.
    #[test]
    fn cubes_cover_an_object() {
        let scene = turned_box(Vec3::new(0.1, 0.1, 5.0), 0.7);
        let cubes = cubes(&scene, &|_| true, [0.01, 1.0]);
        let [low, high] = [0, 4].map(|v| scene.meshes[0].positions[v]);
        for k in 0..=100 {
            let p = low.lerp(high, k as f32 / 100.0);
            let nearest = cubes.iter().map(|cube| cube.centre.distance(p)).fold(f32::INFINITY, f32::min);
            assert!(nearest < 2.0 * cubes[0].radius(), "{p} is {nearest} from the nearest cube");
        }
        assert!(cubes.len() < 1000, "{} cubes", cubes.len());
        assert!(super::cubes(&scene, &|_| false, [0.01, 1.0]).is_empty(), "what blocks no light has no cubes");
        assert!(super::cubes(&scene, &|_| true, [0.3, 1.0]).is_empty(), "it is smaller than that");
    }
}
