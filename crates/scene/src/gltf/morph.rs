//! Morph targets at rest: displacements by the default weights.

use ::gltf::json::accessor::Accessor;
use ::gltf::json::mesh::MorphTarget;
use ::gltf::json::scene::Node;
use ::gltf::json::{Index, mesh::Mesh as JsonMesh};
use glam::{Vec3, Vec4};

use super::document::Document;
use crate::{Error, Mesh};

/// The weights of a node's targets: its own, else those of its mesh, else none.
pub(super) fn weights<'a>(node: Option<&'a Node>, mesh: &'a JsonMesh) -> &'a [f32] {
    let own = node.and_then(|node| node.weights.as_deref()).filter(|weights| !weights.is_empty());
    own.or(mesh.weights.as_deref()).unwrap_or_default()
}

/// Adds `weight` times a target to positions, normals and the directions of tangents (glTF 2.0, 3.7.2.2).
pub(super) fn add(
    document: &Document<'_>,
    object: &str,
    target: &MorphTarget,
    weight: f32,
    mesh: &mut Mesh,
) -> Result<(), Error> {
    let read = |accessor: Option<Index<Accessor>>, count: usize| match accessor.filter(|_| count > 0) {
        Some(accessor) => displacements(document, object, accessor, count),
        None => Ok(Vec::new()),
    };
    let positions = read(target.positions, mesh.positions.len())?;
    mesh.positions.iter_mut().zip(positions).for_each(|(position, by)| *position += by * weight);
    let normals = read(target.normals, mesh.normals.len())?;
    mesh.normals.iter_mut().zip(normals).for_each(|(normal, by)| *normal += by * weight);
    let tangents = read(target.tangents, mesh.tangents.len())?;
    mesh.tangents.iter_mut().zip(tangents).for_each(|(tangent, by)| *tangent += (by * weight).extend(0.0));
    Ok(())
}

/// Makes normals and tangents unit again after all targets are in.
pub(super) fn finish(mesh: &mut Mesh) {
    for normal in &mut mesh.normals {
        *normal = normal.try_normalize().unwrap_or(*normal);
    }
    for tangent in &mut mesh.tangents {
        let along = tangent.truncate();
        *tangent = along.try_normalize().map_or(*tangent, |along| Vec4::from((along, tangent.w)));
    }
}

fn displacements(
    document: &Document<'_>,
    object: &str,
    accessor: Index<Accessor>,
    count: usize,
) -> Result<Vec<Vec3>, Error> {
    if accessor.value() >= document.root.accessors.len() {
        return Err(document.invalid(object, format!("a target names accessor {}, which is none", accessor.value())));
    }
    let values = document.floats::<3>(accessor)?;
    if values.len() != count {
        let what = format!("a target displaces {} vertices, but there are {count}", values.len());
        return Err(document.invalid(object, what));
    }
    Ok(values.into_iter().map(Vec3::from_array).collect())
}
