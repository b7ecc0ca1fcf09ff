//! Triangles and vertex attributes of mesh primitives, in local space.

use ::gltf::json::mesh::{Mode, Primitive};
use ::gltf::json::validation::Checked;
use ::gltf::json::{Index, accessor::Accessor};
use ::gltf::mesh::Semantic;
use glam::{Vec2, Vec3, Vec4};

use super::document::Document;
use super::warn;
use crate::{Error, Mesh, Report};

/// The primitives of each mesh of the document, decoded and checked, whether or not a node shows them.
pub(super) fn read_all(
    document: &Document<'_>,
    default_material: u32,
    report: &mut Report,
) -> Result<Vec<Vec<Mesh>>, Error> {
    let mut meshes = Vec::with_capacity(document.root.meshes.len());
    for (m, mesh) in document.root.meshes.iter().enumerate() {
        let name = mesh.name.clone().unwrap_or_else(|| format!("meshes[{m}]"));
        let mut primitives = Vec::new();
        for (p, primitive) in mesh.primitives.iter().enumerate() {
            let reader = Reader { document, primitive, object: format!("meshes[{m}].primitives[{p}]") };
            if primitive.targets.is_some() {
                warn(report, &name, "morph targets are not applied; the base shape is used");
            }
            if let Some(mut read) = reader.read(report)? {
                read.name.clone_from(&name);
                read.material = primitive.material.map_or(default_material, |i| i.value() as u32);
                primitives.push(read);
            }
        }
        meshes.push(primitives);
    }
    Ok(meshes)
}

/// Reads one primitive.
struct Reader<'a> {
    document: &'a Document<'a>,
    primitive: &'a Primitive,
    /// Its place in the document.
    object: String,
}

impl Reader<'_> {
    /// The primitive as a mesh without name and material; `None`, with a warning, for points and lines.
    fn read(&self, report: &mut Report) -> Result<Option<Mesh>, Error> {
        let Checked::Valid(mode) = self.primitive.mode else {
            return Err(self.invalid("unknown mode"));
        };
        if matches!(mode, Mode::Points | Mode::Lines | Mode::LineLoop | Mode::LineStrip) {
            warn(report, &self.object, format!("{mode:?} have no surface and were left out"));
            return Ok(None);
        }
        let Some(positions) = self.accessor(Semantic::Positions) else {
            return Err(self.invalid("has no POSITION"));
        };
        let positions: Vec<Vec3> = self.document.floats::<3>(positions)?.into_iter().map(Vec3::from).collect();
        let count = positions.len();
        Ok(Some(Mesh {
            triangles: self.triangles(mode, count)?,
            normals: self.attribute(Semantic::Normals, count, |n: [f32; 3]| Vec3::from(n))?,
            tangents: self.attribute(Semantic::Tangents, count, |t: [f32; 4]| Vec4::from(t))?,
            uv0: self.attribute(Semantic::TexCoords(0), count, |t: [f32; 2]| Vec2::from(t))?,
            uv1: self.attribute(Semantic::TexCoords(1), count, |t: [f32; 2]| Vec2::from(t))?,
            colors: self.colors(count)?,
            positions,
            ..Mesh::default()
        }))
    }

    fn accessor(&self, semantic: Semantic) -> Option<Index<Accessor>> {
        self.primitive.attributes.get(&Checked::Valid(semantic)).copied()
    }

    /// One value per vertex, or none at all.
    fn attribute<const N: usize, T>(
        &self,
        semantic: Semantic,
        count: usize,
        convert: impl Fn([f32; N]) -> T,
    ) -> Result<Vec<T>, Error> {
        let Some(accessor) = self.accessor(semantic.clone()) else { return Ok(Vec::new()) };
        let values = self.document.floats::<N>(accessor)?;
        if values.len() != count {
            let what = format!("{} has {} elements, POSITION has {count}", semantic.to_string(), values.len());
            return Err(self.invalid(&what));
        }
        Ok(values.into_iter().map(convert).collect())
    }

    /// RGB or RGBA, linear (glTF 2.0, 3.9.2).
    fn colors(&self, count: usize) -> Result<Vec<Vec4>, Error> {
        let semantic = Semantic::Colors(0);
        match self.accessor(semantic.clone()).map(|a| self.document.components(a)) {
            Some(3) => self.attribute(semantic, count, |c: [f32; 3]| Vec3::from(c).extend(1.0)),
            _ => self.attribute(semantic, count, |c: [f32; 4]| Vec4::from(c)),
        }
    }

    /// Index triples; strips and fans become single triangles.
    fn triangles(&self, mode: Mode, vertices: usize) -> Result<Vec<[u32; 3]>, Error> {
        let indices = match self.primitive.indices {
            Some(accessor) => self.document.integers(accessor)?,
            None => (0..vertices as u32).collect(),
        };
        if let Some(at) = indices.iter().position(|&i| i as usize >= vertices) {
            return Err(self.invalid(&format!("index {} at {at}, but there are {vertices} vertices", indices[at])));
        }
        Ok(match mode {
            Mode::TriangleStrip => indices
                .windows(3)
                .enumerate()
                // Every other triangle of a strip runs backwards.
                .map(|(i, w)| if i % 2 == 0 { [w[0], w[1], w[2]] } else { [w[1], w[0], w[2]] })
                .collect(),
            Mode::TriangleFan => indices[indices.len().min(1)..].windows(2).map(|w| [indices[0], w[0], w[1]]).collect(),
            _ => indices.as_chunks::<3>().0.to_vec(),
        })
    }

    fn invalid(&self, what: &str) -> Error {
        self.document.invalid(self.object.as_str(), what)
    }
}
