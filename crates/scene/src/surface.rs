//! What a surface is made of at one point of a triangle.

use glam::{Vec2, Vec3, Vec4};

use crate::{AlphaMode, Material, Mesh, Scene, TextureSlot};

impl Material {
    /// Whether a ray stops here: surfaces that blend or transmit let a share of its light pass.
    pub fn blocks_rays(&self) -> bool {
        self.alpha != AlphaMode::Blend && self.transmission <= 0.0
    }

    /// Whether single points of the surface can be missing (alpha mask).
    pub fn is_masked(&self) -> bool {
        matches!(self.alpha, AlphaMode::Mask(_))
    }
}

impl TextureSlot {
    /// Coordinates in the picture of the mesh's coordinates `uv`.
    pub fn place(&self, uv: Vec2) -> Vec2 {
        self.transform.transform_point2(uv)
    }
}

/// Weights (1 - u - v, u, v) applied to one attribute of a triangle's corners.
macro_rules! interpolate {
    ($values:expr, $triangle:expr, $u:expr, $v:expr) => {{
        let [a, b, c] = $triangle.map(|i| $values[i as usize]);
        a * (1.0 - $u - $v) + b * $u + c * $v
    }};
}

impl Mesh {
    /// World position of the point with barycentrics `u`, `v` (p = (1-u-v)a + ub + vc).
    pub fn position(&self, triangle: usize, u: f32, v: f32) -> Vec3 {
        interpolate!(self.positions, self.triangles[triangle], u, v)
    }

    /// Interpolated shading normal, unit.
    pub fn normal(&self, triangle: usize, u: f32, v: f32) -> Vec3 {
        let normal: Vec3 = interpolate!(self.normals, self.triangles[triangle], u, v);
        normal.try_normalize().unwrap_or_else(|| self.face_normal(triangle))
    }

    /// Unit normal of the triangle's plane, on the side from which it is counter-clockwise.
    pub fn face_normal(&self, triangle: usize) -> Vec3 {
        let [a, b, c] = self.triangles[triangle].map(|i| self.positions[i as usize].as_dvec3());
        (b - a).cross(c - a).normalize_or_zero().as_vec3()
    }

    /// Area of a triangle in square metres.
    pub fn area(&self, triangle: usize) -> f64 {
        let [a, b, c] = self.triangles[triangle].map(|i| self.positions[i as usize].as_dvec3());
        0.5 * (b - a).cross(c - a).length()
    }

    /// Texture coordinates of set 0 or 1; (0, 0) where the mesh has no such set.
    pub fn uv(&self, set: u8, triangle: usize, u: f32, v: f32) -> Vec2 {
        let values = if set == 0 { &self.uv0 } else { &self.uv1 };
        if values.is_empty() { Vec2::ZERO } else { interpolate!(values, self.triangles[triangle], u, v) }
    }

    /// Linear vertex colour; white where the mesh has none.
    pub fn color(&self, triangle: usize, u: f32, v: f32) -> Vec4 {
        if self.colors.is_empty() { Vec4::ONE } else { interpolate!(self.colors, self.triangles[triangle], u, v) }
    }
}

impl Scene {
    /// Material of a mesh.
    pub fn material(&self, mesh: usize) -> &Material {
        &self.materials[self.meshes[mesh].material as usize]
    }

    /// Linear base colour (factor, texture and vertex colour) and alpha at a point of a triangle.
    pub fn base_color(&self, mesh: usize, triangle: usize, u: f32, v: f32) -> Vec4 {
        let material = self.material(mesh);
        let texel = self.slot(material.base_color_texture, mesh, triangle, u, v, true);
        material.base_color * self.meshes[mesh].color(triangle, u, v) * texel
    }

    /// Diffuse albedo, base colour times (1 - metallic), each channel in [0, 1].
    pub fn albedo(&self, mesh: usize, triangle: usize, u: f32, v: f32) -> Vec3 {
        let material = self.material(mesh);
        let base = self.base_color(mesh, triangle, u, v).truncate();
        let metallic = if material.metallic > 0.0 {
            material.metallic * self.slot(material.metallic_roughness_texture, mesh, triangle, u, v, false).z
        } else {
            0.0
        };
        (base * (1.0 - metallic)).clamp(Vec3::ZERO, Vec3::ONE)
    }

    /// Whether a surface is there: 1 where opaque, 0 or 1 where masked, alpha in [0, 1] where it blends.
    pub fn coverage(&self, mesh: usize, triangle: usize, u: f32, v: f32) -> f32 {
        match self.material(mesh).alpha {
            AlphaMode::Opaque => 1.0,
            AlphaMode::Mask(cutoff) => f32::from(u8::from(self.alpha(mesh, triangle, u, v) >= cutoff)),
            AlphaMode::Blend => self.alpha(mesh, triangle, u, v).clamp(0.0, 1.0),
        }
    }

    /// The alpha of [`Scene::base_color`] alone, to the bit: masks ask for it with every ray that meets them.
    fn alpha(&self, mesh: usize, triangle: usize, u: f32, v: f32) -> f32 {
        let material = self.material(mesh);
        let texel = material.base_color_texture.map_or(1.0, |slot| {
            let uv = slot.place(self.meshes[mesh].uv(slot.uv_set, triangle, u, v));
            self.textures[slot.texture as usize].sample_alpha(uv)
        });
        material.base_color.w * self.meshes[mesh].color(triangle, u, v).w * texel
    }

    /// Unit shading normal at a point of a triangle as the material's normal map bends it; unbent where there is none, or no tangents.
    ///
    /// `tangent * x + handedness * (normal x tangent) * y + normal * z`, where the map's green points up.
    pub fn bent_normal(&self, mesh: usize, triangle: usize, u: f32, v: f32) -> Vec3 {
        let (material, mesh_data) = (self.material(mesh), &self.meshes[mesh]);
        let normal = mesh_data.normal(triangle, u, v);
        if material.normal_texture.is_none() || mesh_data.tangents.is_empty() {
            return normal;
        }
        let map = self.slot(material.normal_texture, mesh, triangle, u, v, false).truncate() * 2.0 - 1.0;
        let tangent: Vec4 = interpolate!(mesh_data.tangents, mesh_data.triangles[triangle], u, v);
        let along = tangent.truncate();
        let across = normal.cross(along) * if tangent.w < 0.0 { -1.0 } else { 1.0 };
        let bent = (along * map.x + across * map.y) * material.normal_scale + normal * map.z;
        bent.try_normalize().unwrap_or(normal)
    }

    /// Metallic share and perceptual roughness at a point of a triangle, in [0, 1].
    pub fn shine(&self, mesh: usize, triangle: usize, u: f32, v: f32) -> [f32; 2] {
        let material = self.material(mesh);
        let texel = self.slot(material.metallic_roughness_texture, mesh, triangle, u, v, false);
        [material.metallic * texel.z, material.roughness * texel.y].map(|share| share.clamp(0.0, 1.0))
    }

    /// Linear radiance that a point of a triangle emits.
    pub fn emission(&self, mesh: usize, triangle: usize, u: f32, v: f32) -> Vec3 {
        let material = self.material(mesh);
        material.emissive * self.slot(material.emissive_texture, mesh, triangle, u, v, true).truncate()
    }

    fn slot(&self, slot: Option<TextureSlot>, mesh: usize, triangle: usize, u: f32, v: f32, srgb: bool) -> Vec4 {
        let Some(slot) = slot else { return Vec4::ONE };
        let uv = slot.place(self.meshes[mesh].uv(slot.uv_set, triangle, u, v));
        self.textures[slot.texture as usize].sample(uv, srgb)
    }
}
