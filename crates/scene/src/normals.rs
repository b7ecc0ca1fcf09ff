//! Shading normals: generated where a mesh has none, mended where they are broken.

use glam::{DVec3, Vec3};

use crate::weld::{edges, half_edges, is_inner, weld};
use crate::{Mesh, vertices};

/// Normals this far from unit length are counted as repaired rather than as rounding.
const UNIT_TOLERANCE: f32 = 0.02;

/// Gives every vertex a normal; vertices at edges sharper than `crease_cosine` are split.
///
/// Within a smooth group around a vertex (triangles joined by edges whose dihedral angle has a cosine of at least
/// `crease_cosine`), the normal is the mean of the face normals weighted by the angle at the vertex
/// (Thuermer and Wuethrich 1998). Positions that coincide count as one vertex, whatever their other attributes.
/// Gives for each vertex of the result which one it was.
pub(crate) fn generate(mesh: &mut Mesh, crease_cosine: f64) -> Vec<u32> {
    let (_, welded) = weld(mesh.positions.iter().copied());
    let triangles: Vec<[u32; 3]> = mesh.triangles.iter().map(|t| t.map(|i| welded[i as usize])).collect();
    let faces: Vec<DVec3> = (0..mesh.triangles.len()).map(|t| face_normal(mesh, t)).collect();
    let mut groups = Groups::new(3 * triangles.len());
    for edge in edges(&half_edges(&triangles)).filter(|e| is_inner(e)) {
        let (a, b) = (edge[0].corner, edge[1].corner);
        if faces[a as usize / 3].dot(faces[b as usize / 3]) >= crease_cosine {
            // The start of one half edge is the end of the other.
            groups.join(a, next_corner(b));
            groups.join(next_corner(a), b);
        }
    }
    let mut sums = vec![DVec3::ZERO; 3 * triangles.len()];
    for corner in 0..sums.len() as u32 {
        let root = groups.root(corner);
        sums[root as usize] += faces[corner as usize / 3] * corner_angle(mesh, corner);
    }
    split(mesh, |corner| {
        let root = groups.root(corner);
        // Faces of a group that cancel out leave each its own normal.
        let fallback = faces[corner as usize / 3];
        (root, sums[root as usize].try_normalize().unwrap_or(fallback).as_vec3())
    })
}

/// Replaces the normals of the `missing` vertices by those that [`generate`] makes; the others stay.
pub(crate) fn complete(mesh: &mut Mesh, missing: &[bool], crease_cosine: f64) {
    let given = std::mem::take(&mut mesh.normals);
    let old = generate(mesh, crease_cosine);
    for (normal, old) in mesh.normals.iter_mut().zip(old) {
        if !missing[old as usize] {
            *normal = given[old as usize];
        }
    }
}

/// One vertex per pair of old vertex and smooth group, with that group's normal.
fn split(mesh: &mut Mesh, mut group_of: impl FnMut(u32) -> (u32, Vec3)) -> Vec<u32> {
    let mut made = std::collections::HashMap::new();
    let (mut kept, mut normals) = (Vec::new(), Vec::new());
    for t in 0..mesh.triangles.len() {
        for k in 0..3 {
            let old = mesh.triangles[t][k];
            let (root, normal) = group_of((3 * t + k) as u32);
            mesh.triangles[t][k] = *made.entry((old, root)).or_insert_with(|| {
                kept.push(old);
                normals.push(normal);
                kept.len() as u32 - 1
            });
        }
    }
    mesh.normals.clear();
    vertices::select(mesh, &kept);
    mesh.normals = normals;
    kept
}

/// Makes given normals unit; those that are zero, not finite or far from unit length are counted, and those without
/// a direction are replaced by the angle-weighted mean of the faces around. Returns the count.
pub(crate) fn mend(mesh: &mut Mesh) -> usize {
    let mut broken = vec![false; mesh.normals.len()];
    let mut repaired = 0;
    for (normal, broken) in mesh.normals.iter_mut().zip(&mut broken) {
        let is_unit = (normal.length() - 1.0).abs() <= UNIT_TOLERANCE;
        repaired += usize::from(!is_unit);
        match unit(*normal) {
            Some(unit) => *normal = unit,
            None => *broken = true,
        }
    }
    if broken.contains(&true) {
        replace(mesh, &broken);
    }
    repaired
}

fn replace(mesh: &mut Mesh, broken: &[bool]) {
    let mut sums = vec![DVec3::ZERO; broken.len()];
    for corner in 0..3 * mesh.triangles.len() as u32 {
        let vertex = mesh.triangles[corner as usize / 3][corner as usize % 3] as usize;
        if broken[vertex] {
            sums[vertex] += face_normal(mesh, corner as usize / 3) * corner_angle(mesh, corner);
        }
    }
    for (vertex, _) in broken.iter().enumerate().filter(|(_, broken)| **broken) {
        mesh.normals[vertex] = sums[vertex].try_normalize().unwrap_or(DVec3::Y).as_vec3();
    }
}

/// The vector at unit length, computed in f64 so that tiny and huge ones keep their direction.
pub(crate) fn unit(vector: Vec3) -> Option<Vec3> {
    vector.as_dvec3().try_normalize().map(|v| v.as_vec3())
}

fn face_normal(mesh: &Mesh, triangle: usize) -> DVec3 {
    let [a, b, c] = mesh.triangles[triangle].map(|i| mesh.positions[i as usize].as_dvec3());
    (b - a).cross(c - a).normalize_or_zero()
}

/// Angle of a triangle at a corner, radians.
fn corner_angle(mesh: &Mesh, corner: u32) -> f64 {
    let triangle = mesh.triangles[corner as usize / 3];
    let [a, b, c] = [0, 1, 2].map(|k| mesh.positions[triangle[(corner as usize % 3 + k) % 3] as usize].as_dvec3());
    let (ab, ac) = ((b - a).normalize_or_zero(), (c - a).normalize_or_zero());
    // Better than acos where the angle is small.
    libm::atan2(ab.cross(ac).length(), ab.dot(ac))
}

fn next_corner(corner: u32) -> u32 {
    corner / 3 * 3 + (corner % 3 + 1) % 3
}

/// Disjoint sets of triangle corners.
struct Groups(Vec<u32>);

impl Groups {
    fn new(corners: usize) -> Self {
        Self((0..corners as u32).collect())
    }

    fn root(&mut self, corner: u32) -> u32 {
        let mut at = corner;
        while self.0[at as usize] != at {
            // Path halving keeps the walks short.
            self.0[at as usize] = self.0[self.0[at as usize] as usize];
            at = self.0[at as usize];
        }
        at
    }

    fn join(&mut self, a: u32, b: u32) {
        let (a, b) = (self.root(a), self.root(b));
        self.0[a.max(b) as usize] = a.min(b);
    }
}
