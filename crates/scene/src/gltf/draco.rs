//! Geometry compressed by Draco (KHR_draco_mesh_compression).

use std::collections::BTreeMap;

use ::gltf::json::mesh::Primitive;
use ::gltf::json::{Index, Value};
use draco_core::{DecodeLimits, DecoderBuffer, Mesh, MeshDecoder};

use super::MAX_ELEMENTS;
use super::document::Document;
use crate::Error;

const NAME: &str = "KHR_draco_mesh_compression";

/// Decoded geometry of one primitive.
pub(super) struct Geometry {
    mesh: Mesh,
    /// The decoder's number of each attribute, by its name in glTF.
    numbers: BTreeMap<String, u32>,
}

impl Geometry {
    /// Decodes a primitive; none where it is not compressed.
    pub(super) fn decode(document: &Document<'_>, primitive: &Primitive, object: &str) -> Result<Option<Self>, Error> {
        let Some(json) = primitive.extensions.as_ref().and_then(|e| e.others.get(NAME)) else { return Ok(None) };
        let object = format!("{object}.{NAME}");
        let view = json["bufferView"].as_u64().filter(|view| *view < document.root.buffer_views.len() as u64);
        let view = view.ok_or_else(|| document.invalid(&object, "its bufferView is missing or none of the file's"))?;
        let bytes = document.view(Index::new(view as u32))?;
        let limit = MAX_ELEMENTS as u64;
        let limits = DecodeLimits::default().with_max_points(limit).with_max_faces(limit);
        let mut mesh = Mesh::new();
        let decoded = MeshDecoder::new().decode(&mut DecoderBuffer::new(bytes).with_limits(limits), &mut mesh);
        decoded.map_err(|fault| document.invalid(&object, format!("the data cannot be decoded ({fault})")))?;
        if mesh.num_points() > MAX_ELEMENTS {
            return Err(document.invalid(object, format!("more than {MAX_ELEMENTS} vertices")));
        }
        let points = mesh.num_points() as u64;
        if mesh.faces().iter().flatten().any(|point| u64::from(point.0) >= points) {
            return Err(document.invalid(object, format!("an index beyond its {points} vertices")));
        }
        let attributes = json["attributes"].as_object();
        let numbers = attributes.into_iter().flatten().filter_map(|(name, id)| Some((name.clone(), number(id)?)));
        Ok(Some(Self { mesh, numbers: numbers.collect() }))
    }

    /// One value per vertex, integers as they are; none where the data lacks the attribute.
    pub(super) fn floats<const N: usize>(&self, name: &str) -> Option<Vec<[f32; N]>> {
        let attribute = self.mesh.attribute_by_unique_id(*self.numbers.get(name)?)?;
        let values = attribute.read_f32s(self.mesh.num_points(), N);
        Some(values.as_chunks::<N>().0.to_vec())
    }

    /// Triples of vertices.
    pub(super) fn triangles(&self) -> Vec<[u32; 3]> {
        self.mesh.faces().iter().map(|face| face.map(|point| point.0)).collect()
    }
}

fn number(id: &Value) -> Option<u32> {
    u32::try_from(id.as_u64()?).ok()
}
