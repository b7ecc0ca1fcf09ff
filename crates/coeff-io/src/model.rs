//! The in-memory form of a `.prt` file: it mirrors the file.

use crate::{Achieved, Codebooks, Gloss, Maps, Plan, Settings, Table, TransferTextures, Volume};
use serde::{Deserialize, Serialize};

/// A baked scene: all that a renderer needs, and how it came to be.
#[derive(Debug, Clone, PartialEq)]
pub struct Prt {
    /// The program and version that wrote it.
    pub generator: String,
    /// Id of the spherical harmonics convention (`sh_math::CONVENTION`).
    pub convention: String,
    /// The scene as the user named it.
    pub scene: String,
    /// World position of the zero of all coordinates here, metres: what was taken off before rounding to f32.
    pub origin: [f64; 3],
    /// What was asked for.
    pub settings: Settings,
    /// Which effects were simulated, and why.
    pub plan: Plan,
    /// What was reached.
    pub achieved: Achieved,
    /// Ranges of vertices and triangles with one material.
    pub meshes: Vec<Mesh>,
    /// Referred to by [`Mesh::material`].
    pub materials: Vec<Material>,
    /// Views of the scene; never empty.
    pub cameras: Vec<Camera>,
    /// Vertices and triangles of all meshes, one after the other.
    pub geometry: Geometry,
    /// How each vertex answers to light.
    pub transfer: Transfer,
    /// Referred to by [`TextureSlot::texture`].
    pub textures: Vec<Texture>,
    /// Directional light maps, where they were asked for.
    pub maps: Option<Maps>,
    /// An irradiance volume, where one was asked for.
    pub volume: Option<Volume>,
    /// What surfaces that shine need, where the plan calls for it.
    pub gloss: Option<Gloss>,
    /// Transfer at texels instead of vertices, where that was chosen.
    pub transfer_textures: Option<TransferTextures>,
    /// What clustered tables share.
    pub codebooks: Codebooks,
    /// The transfer of the vertices as the file holds it where it is clustered; `transfer.values` are what it says.
    pub compressed: Option<Table>,
}

/// A run of triangles with one material. The back of a two-sided mesh is a mesh of its own.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Mesh {
    /// Name of the object.
    pub name: String,
    /// Index into [`Prt::materials`].
    pub material: u32,
    /// First vertex in [`Geometry::positions`].
    pub first_vertex: u32,
    /// Number of vertices.
    pub vertices: u32,
    /// First triangle in [`Geometry::triangles`].
    pub first_triangle: u32,
    /// Number of triangles.
    pub triangles: u32,
}

/// Vertex attributes and triangles. Optional attributes are empty or as long as `positions`.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Geometry {
    /// World space, metres.
    pub positions: Vec<[f32; 3]>,
    /// Unit shading normals.
    pub normals: Vec<[f32; 3]>,
    /// Unit tangent and handedness; empty where no normal map is drawn.
    pub tangents: Vec<[f32; 4]>,
    /// First texture coordinates; may be empty.
    pub uv0: Vec<[f32; 2]>,
    /// Second texture coordinates; may be empty.
    pub uv1: Vec<[f32; 2]>,
    /// Linear vertex colours; may be empty (white).
    pub colors: Vec<[f32; 4]>,
    /// Indices into the whole of `positions`, counter-clockwise from the front.
    pub triangles: Vec<[u32; 3]>,
}

/// Transfer vectors of every vertex, without the vertex' own albedo.
///
/// Outgoing radiance of channel c at vertex v is
/// `albedo[v][c] * sum_i values[(v * bands^2 + i) * channels + min(c, channels - 1)] * light[i][c]`:
/// the cosine, the visibility, the bounces and 1/pi are inside.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Transfer {
    /// Number of bands; each receiver has `bands * bands` coefficients.
    pub bands: u32,
    /// 1 where colour cannot enter, else 3.
    pub channels: u32,
    /// `[vertex][coefficient][channel]`, f32.
    pub values: Vec<f32>,
    /// `[vertex][channel of 3]`: linear diffuse albedo sampled at the vertex (for exports; renderers sample textures).
    pub albedo: Vec<[f32; 3]>,
    /// Cosine-weighted share of the hemisphere that is open, per vertex in [0, 1]; empty where nothing is blocked.
    pub openness: Vec<f32>,
}

impl Transfer {
    /// The mean of the channels, for what asks for no colour: bands and values alone.
    #[must_use]
    pub fn grey(&self) -> Self {
        let channels = self.channels.max(1) as usize;
        let mean = |row: &[f32]| row.iter().sum::<f32>() * (1.0 / channels as f32);
        let values = self.values.chunks_exact(channels).map(mean).collect();
        Self { bands: self.bands, channels: 1, values, ..Self::default() }
    }
}

/// Surface properties in the metallic-roughness model of glTF 2.0, linear.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Material {
    /// Name of the material.
    pub name: String,
    /// Linear factor, multiplied onto texture and vertex colour.
    pub base_color: [f32; 4],
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
    pub emissive: [f32; 3],
    /// sRGB, multiplied onto `emissive`.
    pub emissive_texture: Option<TextureSlot>,
    /// How coverage is treated.
    pub alpha: AlphaMode,
    /// Whether the plan calls for a reflection on this material.
    pub specular: bool,
    /// Share of light that passes through.
    pub transmission: f32,
    /// Whether the base colour is shown as it is, whatever the light; in the supplement.
    #[serde(skip)]
    pub unlit: bool,
}

/// How the coverage of a surface is treated.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub enum AlphaMode {
    /// Coverage is ignored.
    Opaque,
    /// A point is there where coverage reaches the cutoff.
    Mask(f32),
    /// Coverage blends with what lies behind.
    Blend,
}

/// A texture as one material uses it.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct TextureSlot {
    /// Index into [`Prt::textures`].
    pub texture: u32,
    /// 0 or 1: which texture coordinates.
    pub uv_set: u8,
    /// Rows of the 2x3 matrix applied to (u, v, 1) before the look-up.
    pub transform: [[f32; 3]; 2],
}

/// An 8-bit picture, first row at v = 0.
#[derive(Debug, Clone, PartialEq)]
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
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Wrap {
    /// Tiles.
    Repeat,
    /// Tiles, every other one mirrored.
    Mirror,
    /// The border goes on.
    Clamp,
}

/// A perspective view.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Camera {
    /// Name, for `--camera`.
    pub name: String,
    /// Where it stands, metres.
    pub eye: [f32; 3],
    /// A point that it looks at.
    pub target: [f32; 3],
    /// Approximate up direction.
    pub up: [f32; 3],
    /// Full vertical angle of view, radians.
    pub vertical_fov: f32,
}
