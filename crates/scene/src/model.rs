//! What a scene is, after loading.

use std::path::PathBuf;

use glam::{Affine2, Vec2, Vec3, Vec4};

/// A whole scene in world space, in linear colour and metres.
#[derive(Debug, Clone, Default)]
pub struct Scene {
    /// What the user called it: a file path or `builtin:NAME`.
    pub name: String,
    /// World coordinates, metres, of the point that all positions here are relative to: zero unless the file's
    /// geometry lies so far from its origin that f32 would lose digits.
    pub origin: [f64; 3],
    /// One per primitive of each instance.
    pub meshes: Vec<Mesh>,
    /// Referred to by [`Mesh::material`]; never empty where there is a mesh.
    pub materials: Vec<Material>,
    /// Referred to by [`TextureSlot::texture`].
    pub textures: Vec<Texture>,
    /// Views that the file defines.
    pub cameras: Vec<Camera>,
    /// Lights that the file defines; read and reported, not baked.
    pub lights: Vec<PunctualLight>,
    /// Names of the meshes that the file's animations or skins move; they are placed as the file has them at rest.
    pub moving: Vec<String>,
    /// What was noticed and mended while loading.
    pub report: Report,
    /// The files that the scene consists of, its own first: buffers, libraries and pictures that it names and that are there.
    pub files: Vec<PathBuf>,
}

/// One triangle mesh with one material. Attribute vectors are either empty or as long as `positions`.
#[derive(Debug, Clone, Default)]
pub struct Mesh {
    /// Name of the node or object in the file.
    pub name: String,
    /// Index into [`Scene::materials`].
    pub material: u32,
    /// World space, metres, relative to [`Scene::origin`].
    pub positions: Vec<Vec3>,
    /// Unit shading normals; never empty after loading.
    pub normals: Vec<Vec3>,
    /// Unit tangent and handedness (`w` = ±1); present where the material has a normal map.
    pub tangents: Vec<Vec4>,
    /// First texture coordinates.
    pub uv0: Vec<Vec2>,
    /// Second texture coordinates (light maps).
    pub uv1: Vec<Vec2>,
    /// Linear vertex colours, multiplied onto the base colour.
    pub colors: Vec<Vec4>,
    /// Counter-clockwise from the front; every index is valid and no triangle has zero area.
    pub triangles: Vec<[u32; 3]>,
}

/// Surface properties in the metallic-roughness model of glTF 2.0.
#[derive(Debug, Clone)]
pub struct Material {
    /// Name in the file.
    pub name: String,
    /// Linear factor multiplied onto texture and vertex colour.
    pub base_color: Vec4,
    /// sRGB colour and coverage.
    pub base_color_texture: Option<TextureSlot>,
    /// 0 dielectric, 1 metal.
    pub metallic: f32,
    /// Perceptual roughness.
    pub roughness: f32,
    /// Green is roughness, blue is metallic.
    pub metallic_roughness_texture: Option<TextureSlot>,
    /// Tangent-space normals, green up.
    pub normal_texture: Option<TextureSlot>,
    /// Scale of the x and y of the normal map.
    pub normal_scale: f32,
    /// Radiance that the surface emits.
    pub emissive: Vec3,
    /// sRGB, multiplied onto `emissive`.
    pub emissive_texture: Option<TextureSlot>,
    /// How coverage is treated.
    pub alpha: AlphaMode,
    /// Whether the back reflects and is drawn.
    pub double_sided: bool,
    /// Share of light that passes through (KHR_materials_transmission).
    pub transmission: f32,
    /// Whether the camera sees the base colour as radiance, whatever the light (KHR_materials_unlit). Other surfaces
    /// see a matte surface of the base colour.
    pub unlit: bool,
}

impl Default for Material {
    fn default() -> Self {
        Self {
            name: String::new(),
            base_color: Vec4::ONE,
            base_color_texture: None,
            metallic: 0.0,
            roughness: 1.0,
            metallic_roughness_texture: None,
            normal_texture: None,
            normal_scale: 1.0,
            emissive: Vec3::ZERO,
            emissive_texture: None,
            alpha: AlphaMode::Opaque,
            double_sided: false,
            transmission: 0.0,
            unlit: false,
        }
    }
}

/// How the coverage of a surface is treated.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum AlphaMode {
    /// Coverage is ignored.
    Opaque,
    /// A point is there where coverage reaches the cutoff.
    Mask(f32),
    /// Coverage blends with what lies behind.
    Blend,
}

/// A texture as one material uses it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TextureSlot {
    /// Index into [`Scene::textures`].
    pub texture: u32,
    /// 0 or 1: which texture coordinates.
    pub uv_set: u8,
    /// Applied to the coordinates before the look-up (KHR_texture_transform).
    pub transform: Affine2,
}

/// Decoded 8-bit picture, first row at v = 0.
#[derive(Debug, Clone)]
pub struct Texture {
    /// Name or file of the picture.
    pub name: String,
    /// Columns.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// RGBA, row by row, as stored (sRGB encoded for colours).
    pub rgba: Vec<[u8; 4]>,
    /// Behaviour outside [0, 1] along u and v.
    pub wrap: [Wrap; 2],
}

/// What a texture shows outside [0, 1].
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Wrap {
    /// Tiles.
    Repeat,
    /// Tiles, every other one mirrored.
    Mirror,
    /// The border goes on.
    Clamp,
}

/// A perspective view.
#[derive(Debug, Clone)]
pub struct Camera {
    /// Name in the file.
    pub name: String,
    /// Where it stands, metres, relative to [`Scene::origin`].
    pub eye: Vec3,
    /// A point that it looks at.
    pub target: Vec3,
    /// Approximate up direction.
    pub up: Vec3,
    /// Full vertical angle of view, radians.
    pub vertical_fov: f32,
}

/// A light of KHR_lights_punctual.
#[derive(Debug, Clone)]
pub struct PunctualLight {
    /// Name in the file.
    pub name: String,
    /// Kind with its own data.
    pub kind: LightKind,
    /// World position, metres, relative to [`Scene::origin`].
    pub position: Vec3,
    /// Direction in which it shines, unit.
    pub direction: Vec3,
    /// Linear colour times intensity, in the units of glTF.
    pub intensity: Vec3,
}

/// Shape of a punctual light.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum LightKind {
    /// Infinitely far, lux.
    Directional,
    /// From a point, candela.
    Point,
    /// A cone from a point, candela; half angles in radians.
    Spot {
        /// Where the fall-off begins.
        inner: f32,
        /// Where it is dark.
        outer: f32,
    },
}

/// What a loader noticed.
#[derive(Debug, Clone, Default)]
pub struct Report {
    /// One sentence each: what, where, what was done.
    pub warnings: Vec<Warning>,
    /// Zero-area triangles that were dropped.
    pub degenerate_triangles: usize,
    /// Vertices that no triangle used, dropped.
    pub unused_vertices: usize,
    /// Vertices that equalled another in every attribute, merged.
    pub duplicate_vertices: usize,
    /// Normals generated or repaired.
    pub generated_normals: usize,
}

/// A defect that did not stop the load.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Warning {
    /// The object, material or file concerned.
    pub object: String,
    /// What was found and what was done.
    pub message: String,
}
