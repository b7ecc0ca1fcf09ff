//! Many copies of a node's mesh (EXT_mesh_gpu_instancing).

use ::gltf::json::accessor::Accessor;
use ::gltf::json::scene::Node;
use ::gltf::json::{Index, Value};
use glam::{DMat4, DQuat, DVec3};

use super::document::Document;
use crate::Error;

const NAME: &str = "EXT_mesh_gpu_instancing";

/// `node from instance` of each copy that a node shows; none where it shows its mesh once.
pub(super) fn transforms(document: &Document<'_>, n: usize, node: &Node) -> Result<Option<Vec<DMat4>>, Error> {
    let Some(json) = node.extensions.as_ref().and_then(|e| e.others.get(NAME)) else { return Ok(None) };
    let object = format!("nodes[{n}].{NAME}");
    let Some(attributes) = json["attributes"].as_object().filter(|attributes| !attributes.is_empty()) else {
        return Err(document.invalid(object, "has no attributes"));
    };
    let accessor = |name: &str, value: &Value| -> Result<Index<Accessor>, Error> {
        let count = document.root.accessors.len();
        let index = value.as_u64().filter(|index| *index < count as u64);
        let index = index.ok_or_else(|| document.invalid(&object, format!("{name}: {value} of {count} accessors")))?;
        Ok(Index::new(index as u32))
    };
    // An attribute of an application's own counts the copies too.
    let mut counts = Vec::new();
    for (name, value) in attributes {
        counts.push(document.count(accessor(name, value)?));
    }
    let count = counts[0];
    if let Some(other) = counts.iter().find(|other| **other != count) {
        return Err(document.invalid(object, format!("attributes of {count} and {other} copies")));
    }
    let given = |name: &str| attributes.get(name).map(|value| accessor(name, value)).transpose();
    let vectors = |name: &str, default: DVec3| -> Result<Vec<DVec3>, Error> {
        Ok(match given(name)? {
            Some(accessor) => document.floats::<3>(accessor)?.iter().map(|v| DVec3::from(v.map(f64::from))).collect(),
            None => vec![default; count],
        })
    };
    let rotations: Vec<DQuat> = match given("ROTATION")? {
        Some(accessor) => document.floats::<4>(accessor)?.into_iter().map(rotation).collect(),
        None => vec![DQuat::IDENTITY; count],
    };
    let (translations, scales) = (vectors("TRANSLATION", DVec3::ZERO)?, vectors("SCALE", DVec3::ONE)?);
    let parts = translations.into_iter().zip(rotations).zip(scales);
    Ok(Some(parts.map(|((t, r), s)| DMat4::from_scale_rotation_translation(s, r, t)).collect()))
}

/// A quaternion of any length, quantised or not; none where it is zero.
fn rotation(xyzw: [f32; 4]) -> DQuat {
    let quaternion = DQuat::from_array(xyzw.map(f64::from));
    if quaternion.length() > 1e-6 { quaternion.normalize() } else { DQuat::IDENTITY }
}
