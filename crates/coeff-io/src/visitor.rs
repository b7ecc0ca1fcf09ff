//! A moving object in a baked scene: it takes its light from the scene's volume. \[N\] sections 1.9 and 2.4.
//!
//! A volume that can be relit holds transfer, so what a vertex of the object takes at its place and normal is a transfer vector like that of
//! any other vertex, and renderers draw it as such. The object neither shades itself nor what stands around it.

use crate::volume::FUNCTIONS;
use crate::volume_lookup::{Lookup, Weights};
use crate::{Geometry, MapLight, Mesh, Prt, TextureSlot, Volume};
use glam::{Affine3A, Vec3};
use sh_math::Bands;

/// Why an object cannot stand in a scene.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum VisitorError {
    /// The scene has no volume.
    #[error("the scene holds no irradiance volume to light a moving object with: bake it with a volume")]
    NoVolume,
    /// The light of the volume is fixed.
    #[error("the scene's volume holds the light of `{0}` alone: bake it without a fixed light for moving objects")]
    Fixed(String),
    /// The two files differ in what cannot be brought together.
    #[error("{0}")]
    Unlike(String),
}

impl Prt {
    /// This scene with an object in it, placed by `place` (a rotation, a uniform scale and a shift) and lit by the scene's volume.
    ///
    /// The object's own transfer, cameras and plan are left out.
    ///
    /// # Errors
    /// [`VisitorError`] where the scene has no volume that can be relit, or both together are larger than a file may be.
    pub fn with_visitor(&self, visitor: &Self, place: &Affine3A) -> Result<Self, VisitorError> {
        let volume = self.volume.as_ref().ok_or(VisitorError::NoVolume)?;
        match &volume.light {
            MapLight::Fixed { probe, .. } => return Err(VisitorError::Fixed(probe.clone())),
            MapLight::Relightable { bands } if *bands != self.transfer.bands => {
                let text =
                    format!("the volume answers to {bands} bands of light, the vertices to {}", self.transfer.bands);
                return Err(VisitorError::Unlike(text));
            }
            MapLight::Relightable { .. } => {}
        }
        let vertices = self.geometry.positions.len() + visitor.geometry.positions.len();
        let triangles = self.geometry.triangles.len() + visitor.geometry.triangles.len();
        if u32::try_from(vertices.max(triangles)).is_err() {
            return Err(VisitorError::Unlike(format!(
                "scene and object have {vertices} vertices and {triangles} triangles together"
            )));
        }
        let mut all = self.clone();
        all.add_geometry(&visitor.geometry, place);
        all.add_surfaces(visitor, self.geometry.positions.len() as u32, self.geometry.triangles.len() as u32);
        all.add_light(volume, visitor.geometry.positions.len());
        all.transfer.albedo.extend(&visitor.transfer.albedo);
        if let Some(maps) = &mut all.maps {
            maps.sheet_of_mesh.resize(all.meshes.len(), None);
        }
        if let Some(textures) = &mut all.transfer_textures {
            textures.sheet_of_mesh.resize(all.meshes.len(), None);
        }
        if let Some(vertices) = all.gloss.as_mut().and_then(|gloss| gloss.vertices.as_mut()) {
            vertices.first_row.resize(all.meshes.len(), None);
        }
        // The clusters of the scene say nothing of the object's vertices.
        all.compressed = None;
        Ok(all)
    }

    fn add_geometry(&mut self, visitor: &Geometry, place: &Affine3A) {
        let before = self.geometry.positions.len();
        let g = &mut self.geometry;
        let turned = |v: Vec3| place.transform_vector3(v).normalize_or(Vec3::Y);
        g.positions.extend(visitor.positions.iter().map(|&p| place.transform_point3(Vec3::from(p)).to_array()));
        g.normals.extend(visitor.normals.iter().map(|&n| turned(Vec3::from(n)).to_array()));
        let n = visitor.positions.len();
        let tangents: Vec<[f32; 4]> =
            visitor.tangents.iter().map(|&[x, y, z, w]| turned(Vec3::new(x, y, z)).extend(w).to_array()).collect();
        join(&mut g.tangents, &tangents, [before, n], [1.0, 0.0, 0.0, 1.0]);
        join(&mut g.uv0, &visitor.uv0, [before, n], [0.0; 2]);
        join(&mut g.uv1, &visitor.uv1, [before, n], [0.0; 2]);
        join(&mut g.colors, &visitor.colors, [before, n], [1.0; 4]);
        let shift = before as u32;
        g.triangles.extend(visitor.triangles.iter().map(|triangle| triangle.map(|vertex| vertex + shift)));
    }

    fn add_surfaces(&mut self, visitor: &Self, first_vertex: u32, first_triangle: u32) {
        let (materials, textures) = (self.materials.len() as u32, self.textures.len() as u32);
        let shifted =
            |slot: Option<TextureSlot>| slot.map(|slot| TextureSlot { texture: slot.texture + textures, ..slot });
        self.materials.extend(visitor.materials.iter().map(|material| {
            let mut material = material.clone();
            material.base_color_texture = shifted(material.base_color_texture);
            material.metallic_roughness_texture = shifted(material.metallic_roughness_texture);
            material.normal_texture = shifted(material.normal_texture);
            material.emissive_texture = shifted(material.emissive_texture);
            material
        }));
        self.textures.extend(visitor.textures.iter().cloned());
        self.meshes.extend(visitor.meshes.iter().map(|mesh| Mesh {
            material: mesh.material + materials,
            first_vertex: mesh.first_vertex + first_vertex,
            first_triangle: mesh.first_triangle + first_triangle,
            ..mesh.clone()
        }));
    }

    /// Appends the transfer of the last `count` vertices, as the volume has it.
    fn add_light(&mut self, volume: &Volume, count: usize) {
        let (coefficients, channels) =
            ((self.transfer.bands * self.transfer.bands) as usize, self.transfer.channels as usize);
        let first = self.geometry.positions.len() - count;
        for vertex in first..first + count {
            let point = Vec3::from(self.geometry.positions[vertex]);
            let normal = Vec3::from(self.geometry.normals[vertex]);
            let weights = volume.weights(point, Some(normal), Lookup::Visible);
            let row = transfer(volume, &weights, normal, coefficients, channels);
            self.transfer.values.extend(row);
        }
        if !self.transfer.openness.is_empty() {
            // How much of its surroundings an object of the volume sees is in its light alone; reflections take all.
            self.transfer.openness.resize(first + count, 1.0);
        }
    }
}

/// The transfer `[coefficient][channel]` of a point with a unit normal between probes.
fn transfer(volume: &Volume, weights: &Weights, normal: Vec3, coefficients: usize, channels: usize) -> Vec<f32> {
    let mut functions = [0.0; FUNCTIONS];
    sh_math::evaluate(Bands::new(3).expect("there are three bands"), normal, &mut functions);
    let own = volume.channels as usize;
    let mut row = vec![0.0; coefficients * channels];
    for (probe, weight) in weights.probes.into_iter().zip(weights.weights).filter(|(_, weight)| *weight > 0.0) {
        let values =
            &volume.values[probe as usize * FUNCTIONS * coefficients * own..][..FUNCTIONS * coefficients * own];
        for (function, values) in functions.iter().zip(values.chunks_exact(coefficients * own)) {
            for (out, value) in row.chunks_exact_mut(channels).zip(values.chunks_exact(own)) {
                for (c, out) in out.iter_mut().enumerate() {
                    *out += weight * function * value[c.min(own - 1)];
                }
            }
        }
    }
    row
}

/// Appends an attribute that either side may lack.
fn join<T: Copy>(own: &mut Vec<T>, other: &[T], [before, more]: [usize; 2], filler: T) {
    if own.is_empty() && other.is_empty() {
        return;
    }
    own.resize(before, filler);
    own.extend_from_slice(other);
    own.resize(before + more, filler);
}
