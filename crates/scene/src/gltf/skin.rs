//! Skins at rest: vertices where their joints stand.

use glam::{DMat3, DMat4, Vec3};

use super::document::Document;
use crate::{Error, Mesh};

/// Which joints move each vertex, and by how much.
#[derive(Debug)]
pub(super) struct Influences {
    /// `[vertex][set]`: numbers of four joints, whole, and their weights.
    of_vertex: Vec<Vec<([f32; 4], [f32; 4])>>,
}

impl Influences {
    /// No joint for so many vertices.
    pub(super) fn new(count: usize) -> Self {
        Self { of_vertex: vec![Vec::new(); count] }
    }

    /// Adds a set of four joints for each vertex.
    pub(super) fn add(&mut self, joints: &[[f32; 4]], weights: &[[f32; 4]]) {
        for (vertex, (joints, weights)) in self.of_vertex.iter_mut().zip(joints.iter().zip(weights)) {
            vertex.push((*joints, *weights));
        }
    }

    /// Whether there is any set.
    pub(super) fn is_some(&self) -> bool {
        self.of_vertex.first().is_some_and(|sets| !sets.is_empty())
    }

    /// The mean of the joints' matrices for a vertex; the first joint's where all weights are zero.
    fn matrix(&self, vertex: usize, joints: &[DMat4]) -> Result<DMat4, String> {
        let (mut sum, mut total) = (DMat4::ZERO, 0.0);
        for (numbers, weights) in &self.of_vertex[vertex] {
            for (number, weight) in numbers.iter().zip(weights).filter(|(_, weight)| **weight > 0.0) {
                let joint = joints.get(*number as usize).ok_or_else(|| {
                    format!("vertex {vertex} hangs on joint {number}, but the skin has {}", joints.len())
                })?;
                sum += *joint * f64::from(*weight);
                total += f64::from(*weight);
            }
        }
        match total > 0.0 {
            true => Ok(sum * (1.0 / total)),
            false => joints.first().copied().ok_or_else(|| "the skin has no joints".to_owned()),
        }
    }
}

/// `world from mesh` of each joint of a skin: where the joint stands times its inverse bind matrix.
pub(super) fn joints(document: &Document<'_>, skin: usize, world: &[Option<DMat4>]) -> Result<Vec<DMat4>, Error> {
    let json = &document.root.skins[skin];
    let object = format!("skins[{skin}]");
    let binds = match json.inverse_bind_matrices {
        Some(accessor) => document.floats::<16>(accessor)?,
        None => vec![DMat4::IDENTITY.as_mat4().to_cols_array(); json.joints.len()],
    };
    if binds.len() < json.joints.len() {
        let what = format!("{} inverse bind matrices for {} joints", binds.len(), json.joints.len());
        return Err(document.invalid(object, what));
    }
    let joint = |(joint, bind): (&::gltf::json::Index<::gltf::json::Node>, &[f32; 16])| {
        let world = world[joint.value()].ok_or_else(|| {
            document.invalid(&object, format!("joint nodes[{}] has no sound transform", joint.value()))
        })?;
        Ok(world * DMat4::from_cols_array(&bind.map(f64::from)))
    };
    json.joints.iter().zip(&binds).map(joint).collect()
}

/// Takes a mesh to world space by its joints; the transform of the node that shows it does not count (glTF 2.0, 3.7.3.3).
///
/// Says what is wrong where a vertex hangs on a joint that is not there.
pub(super) fn pose(mesh: &mut Mesh, influences: &Influences, joints: &[DMat4]) -> Result<(), String> {
    let mut mirrored = 0usize;
    for vertex in 0..mesh.positions.len() {
        let matrix = influences.matrix(vertex, joints)?;
        let linear = DMat3::from_mat4(matrix);
        let side = if linear.determinant() < 0.0 { -1.0 } else { 1.0 };
        mirrored += usize::from(side < 0.0);
        let position = &mut mesh.positions[vertex];
        *position = matrix.transform_point3(position.as_dvec3()).as_vec3();
        if let Some(normal) = mesh.normals.get_mut(vertex) {
            *normal = super::place::turned_normal(linear, side, *normal);
        }
        if let Some(tangent) = mesh.tangents.get_mut(vertex) {
            let turned: Vec3 = (linear * tangent.truncate().as_dvec3()).normalize_or_zero().as_vec3();
            *tangent = turned.extend(tangent.w * side as f32);
        }
    }
    if 2 * mirrored > mesh.positions.len() {
        mesh.triangles.iter_mut().for_each(|t| t.swap(1, 2));
    }
    Ok(())
}
