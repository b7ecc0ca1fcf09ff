//! Tangents for normal maps, by MikkTSpace.

use bevy_mikktspace::{Geometry, TangentSpace, generate_tangents};
use glam::{Vec2, Vec3, Vec4};

use crate::normals::unit;
use crate::{Mesh, vertices};

/// Gives every vertex a unit tangent across its normal, along growing u of the texture coordinates of `uv_set`;
/// `w` is the sign for which w (normal x tangent) points to the top of the picture (falling v), as glTF wants.
/// Vertices whose triangles disagree are split. Returns false, changing nothing, where the mesh has no such
/// coordinates or the generator refuses it.
pub(crate) fn generate(mesh: &mut Mesh, uv_set: u8) -> bool {
    let uv = if uv_set == 0 { &mesh.uv0 } else { &mesh.uv1 };
    if uv.is_empty() {
        return false;
    }
    let mut corners = Corners { mesh, uv, tangents: vec![Vec4::ZERO; 3 * mesh.triangles.len()] };
    if generate_tangents(&mut corners).is_err() {
        return false;
    }
    let tangents = corners.tangents;
    split(mesh, &tangents);
    finish(mesh);
    true
}

/// Whether given tangents can be used as they are: finite, not zero, with a handedness; makes them unit and
/// perpendicular to the normals.
pub(crate) fn accept(mesh: &mut Mesh) -> bool {
    let good = |t: &Vec4| t.is_finite() && t.w.abs() > 0.5 && t.truncate().length() > 0.1;
    let accepted = mesh.tangents.iter().all(good);
    if accepted {
        finish(mesh);
    }
    accepted
}

/// One vertex per pair of old vertex and tangent.
fn split(mesh: &mut Mesh, tangents: &[Vec4]) {
    let mut made = std::collections::HashMap::new();
    let (mut kept, mut values) = (Vec::new(), Vec::new());
    for (corner, tangent) in tangents.iter().enumerate() {
        let vertex = &mut mesh.triangles[corner / 3][corner % 3];
        let old = *vertex;
        *vertex = *made.entry((old, tangent.to_array().map(f32::to_bits))).or_insert_with(|| {
            kept.push(old);
            values.push(*tangent);
            kept.len() as u32 - 1
        });
    }
    mesh.tangents.clear();
    vertices::select(mesh, &kept);
    mesh.tangents = values;
}

/// Makes tangents unit and perpendicular to the normals, with `w` = +1 or -1.
fn finish(mesh: &mut Mesh) {
    for (tangent, normal) in mesh.tangents.iter_mut().zip(&mesh.normals) {
        let across = tangent.truncate() - *normal * normal.dot(tangent.truncate());
        // Where the tangent runs along the normal, any perpendicular serves.
        let across = unit(across).filter(|_| across.length() > 1e-3).unwrap_or_else(|| normal.any_orthonormal_vector());
        *tangent = across.extend(if tangent.w < 0.0 { -1.0 } else { 1.0 });
    }
}

/// The mesh as the generator wants to see it.
struct Corners<'a> {
    mesh: &'a Mesh,
    uv: &'a [Vec2],
    tangents: Vec<Vec4>,
}

impl Corners<'_> {
    fn vertex(&self, face: usize, corner: usize) -> usize {
        self.mesh.triangles[face][corner] as usize
    }
}

impl Geometry for Corners<'_> {
    fn num_faces(&self) -> usize {
        self.mesh.triangles.len()
    }

    fn num_vertices_of_face(&self, _face: usize) -> usize {
        3
    }

    fn position(&self, face: usize, corner: usize) -> [f32; 3] {
        self.mesh.positions[self.vertex(face, corner)].to_array()
    }

    fn normal(&self, face: usize, corner: usize) -> [f32; 3] {
        self.mesh.normals[self.vertex(face, corner)].to_array()
    }

    fn tex_coord(&self, face: usize, corner: usize) -> [f32; 2] {
        self.uv[self.vertex(face, corner)].to_array()
    }

    fn set_tangent(&mut self, space: Option<TangentSpace>, face: usize, corner: usize) {
        let [x, y, z, w] = space.unwrap_or_default().tangent_encoded();
        // MikkTSpace takes v as growing upwards; in glTF it grows downwards, which turns the handedness round.
        self.tangents[3 * face + corner] = Vec3::new(x, y, z).extend(-w);
    }
}
