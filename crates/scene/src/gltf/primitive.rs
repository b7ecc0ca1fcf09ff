//! Triangles and vertex attributes of mesh primitives, in local space.

use ::gltf::json::mesh::{Mode, Primitive as JsonPrimitive};
use ::gltf::json::validation::Checked;
use ::gltf::json::{Index, accessor::Accessor};
use ::gltf::mesh::Semantic;
use glam::{Vec2, Vec3, Vec4};

use super::document::Document;
use super::draco::Geometry;
use super::skin::Influences;
use super::{morph, warn};
use crate::{Error, Mesh, Report};

/// A primitive as the file has it, before nodes pose it.
pub(super) struct Primitive<'a> {
    pub(super) mesh: Mesh,
    /// Which joints move its vertices; none where it is rigid.
    pub(super) influences: Option<Influences>,
    json: &'a JsonPrimitive,
    object: String,
}

impl Primitive<'_> {
    /// The mesh with its morph targets mixed in.
    pub(super) fn morphed(&self, document: &Document<'_>, weights: &[f32]) -> Result<Mesh, Error> {
        let mut mesh = self.mesh.clone();
        let targets = self.json.targets.iter().flatten().zip(weights);
        let mixed: Vec<_> = targets.filter(|(_, weight)| weight.is_finite() && **weight != 0.0).collect();
        for (target, weight) in &mixed {
            morph::add(document, &self.object, target, **weight, &mut mesh)?;
        }
        if !mixed.is_empty() {
            morph::finish(&mut mesh);
        }
        Ok(mesh)
    }
}

/// The primitives of each mesh of the document, decoded and checked, whether or not a node shows them.
pub(super) fn read_all<'a>(
    document: &'a Document<'_>,
    default_material: u32,
    report: &mut Report,
) -> Result<Vec<Vec<Primitive<'a>>>, Error> {
    let mut meshes = Vec::with_capacity(document.root.meshes.len());
    for (m, mesh) in document.root.meshes.iter().enumerate() {
        let name = mesh.name.clone().unwrap_or_else(|| format!("meshes[{m}]"));
        let mut primitives = Vec::new();
        for (p, json) in mesh.primitives.iter().enumerate() {
            let object = format!("meshes[{m}].primitives[{p}]");
            let Some(mode) = mode_of(document, json, &object, report)? else { continue };
            let geometry = match Geometry::decode(document, json, &object) {
                Err(error) if has_plain_data(document, json) => {
                    warn(report, &object, format!("{error}; the data without compression are used"));
                    None
                }
                decoded => decoded?,
            };
            let reader = Reader { document, json, geometry, object };
            let mut mesh = reader.read(mode)?;
            mesh.name.clone_from(&name);
            mesh.material = json.material.map_or(default_material, |i| i.value() as u32);
            let influences = if document.root.skins.is_empty() { None } else { reader.influences(&mesh)? };
            primitives.push(Primitive { mesh, influences, json, object: reader.object });
        }
        meshes.push(primitives);
    }
    Ok(meshes)
}

/// How a primitive makes triangles; `None`, with a warning, for points and lines.
fn mode_of(
    document: &Document<'_>,
    json: &JsonPrimitive,
    object: &str,
    report: &mut Report,
) -> Result<Option<Mode>, Error> {
    let Checked::Valid(mode) = json.mode else {
        return Err(document.invalid(object, "unknown mode"));
    };
    if matches!(mode, Mode::Points | Mode::Lines | Mode::LineLoop | Mode::LineStrip) {
        warn(report, object, format!("{mode:?} have no surface and were left out"));
        return Ok(None);
    }
    Ok(Some(mode))
}

/// Whether a compressed primitive also has its positions as they are, for loaders that cannot decompress.
fn has_plain_data(document: &Document<'_>, json: &JsonPrimitive) -> bool {
    let position = json.attributes.get(&Checked::Valid(Semantic::Positions));
    position.is_some_and(|accessor| document.root.accessors[accessor.value()].buffer_view.is_some())
}

/// Reads one primitive.
struct Reader<'a, 'b> {
    document: &'a Document<'b>,
    json: &'a JsonPrimitive,
    /// Its data where they are compressed.
    geometry: Option<Geometry>,
    /// Its place in the document.
    object: String,
}

impl Reader<'_, '_> {
    /// The primitive as a mesh without name and material.
    fn read(&self, mode: Mode) -> Result<Mesh, Error> {
        let Some(positions) = self.values(Semantic::Positions)? else {
            return Err(self.invalid("has no POSITION"));
        };
        let positions: Vec<Vec3> = positions.into_iter().map(Vec3::from_array).collect();
        let count = positions.len();
        Ok(Mesh {
            triangles: self.triangles(mode, count)?,
            normals: self.attribute(Semantic::Normals, count, |n: [f32; 3]| Vec3::from(n))?,
            tangents: self.attribute(Semantic::Tangents, count, |t: [f32; 4]| Vec4::from(t))?,
            uv0: self.attribute(Semantic::TexCoords(0), count, |t: [f32; 2]| Vec2::from(t))?,
            uv1: self.attribute(Semantic::TexCoords(1), count, |t: [f32; 2]| Vec2::from(t))?,
            colors: self.colors(count)?,
            positions,
            ..Mesh::default()
        })
    }

    /// All sets of joints and weights; none where there is no set.
    fn influences(&self, mesh: &Mesh) -> Result<Option<Influences>, Error> {
        let count = mesh.positions.len();
        let mut influences = Influences::new(count);
        for set in 0.. {
            let joints = self.attribute(Semantic::Joints(set), count, |j: [f32; 4]| j)?;
            let weights = self.attribute(Semantic::Weights(set), count, |w: [f32; 4]| w)?;
            if joints.is_empty() || weights.is_empty() {
                break;
            }
            influences.add(&joints, &weights);
        }
        Ok(influences.is_some().then_some(influences))
    }

    fn accessor(&self, semantic: Semantic) -> Option<Index<Accessor>> {
        self.json.attributes.get(&Checked::Valid(semantic)).copied()
    }

    /// The values of an attribute; none where the primitive lacks it.
    fn values<const N: usize>(&self, semantic: Semantic) -> Result<Option<Vec<[f32; N]>>, Error> {
        let Some(accessor) = self.accessor(semantic.clone()) else { return Ok(None) };
        match self.geometry.as_ref().and_then(|geometry| geometry.floats::<N>(&semantic.to_string())) {
            Some(values) => self.document.normalized(accessor, values).map(Some),
            None => self.document.floats::<N>(accessor).map(Some),
        }
    }

    /// One value per vertex, or none at all.
    fn attribute<const N: usize, T>(
        &self,
        semantic: Semantic,
        count: usize,
        convert: impl Fn([f32; N]) -> T,
    ) -> Result<Vec<T>, Error> {
        let Some(values) = self.values::<N>(semantic.clone())? else { return Ok(Vec::new()) };
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
        if let Some(geometry) = &self.geometry {
            return Ok(geometry.triangles());
        }
        let indices = match self.json.indices {
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
