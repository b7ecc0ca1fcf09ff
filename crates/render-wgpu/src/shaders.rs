//! The shader modules: WGSL files put together, without any preprocessor.

/// A named module: its name in error messages and its whole text.
#[derive(Debug, Clone)]
pub(crate) struct Shader {
    pub(crate) name: &'static str,
    pub(crate) text: Cow<'static, str>,
}

/// Surfaces of one kind of diffuse light: without shine, and with a mirror of the light probe.
macro_rules! surfaces {
    ($name:literal, $($light:literal),+) => {
        [
            shader!(concat!("diffuse, ", $name), "view.wgsl", "surface.wgsl", $($light),+),
            shader!(
                concat!("shiny, ", $name),
                "view.wgsl", "equirect.wgsl", "brdf.wgsl", "surface.wgsl", "bend.wgsl", "shine.wgsl", "mirror.wgsl", $($light),+
            ),
        ]
    };
}

macro_rules! shader {
    ($name:expr, $($file:literal),+) => {
        Shader { name: $name, text: Cow::Borrowed(concat!($(include_str!(concat!("../shaders/", $file))),+)) }
    };
}

use crate::gloss::GlossKind;
use crate::gloss_text;
use coeff_io::GlossWay;
use sh_math::{Bands, hemisphere::Basis};
use std::borrow::Cow;

/// Dot products of transfer and light.
pub(crate) const RELIGHT: Shader = shader!("relight", "relight.wgsl");
/// Coefficients of light maps in the basis that is drawn.
pub(crate) const SHEET_FILL: Shader = shader!("sheet fill", "sheet_fill.wgsl");
/// Receivers of gloss and transfer textures under a light.
pub(crate) const GLOSS_ROWS: Shader = shader!("gloss rows", "gloss_rows.wgsl");
/// The light probe behind the scene.
pub(crate) const SKY: Shader = shader!("sky", "view.wgsl", "equirect.wgsl", "fullscreen.wgsl", "sky.wgsl");
/// Samples to pixels.
pub(crate) const RESOLVE: Shader = shader!("resolve", "fullscreen.wgsl", "post.wgsl", "resolve.wgsl");
/// The blur pyramid.
pub(crate) const BLOOM: Shader = shader!("bloom", "fullscreen.wgsl", "post.wgsl", "bloom.wgsl");
/// Tone curve and encoding.
pub(crate) const DISPLAY: Shader = shader!("display", "fullscreen.wgsl", "tone.wgsl", "display.wgsl");

/// The light of vertices, then of maps in each family of bases.
const SURFACES: [[Shader; 2]; 8] = [
    surfaces!("lit at vertices", "vertex_light.wgsl"),
    surfaces!("lit by spherical harmonics", "sheet.wgsl", "hemisphere_spherical.wgsl"),
    surfaces!("lit by Half-Life 2", "sheet.wgsl", "hemisphere_hl2.wgsl"),
    surfaces!("lit by hemispherical harmonics", "sheet.wgsl", "hemisphere_hsh.wgsl"),
    surfaces!("lit by Makhotkin", "sheet.wgsl", "hemisphere_makhotkin.wgsl"),
    surfaces!("lit by Zernike", "sheet.wgsl", "hemisphere_zernike.wgsl"),
    surfaces!("lit by H", "sheet.wgsl", "hemisphere_h.wgsl"),
    surfaces!("lit by modified H", "sheet.wgsl", "hemisphere_modified_h.wgsl"),
];

/// Surfaces that mirror the light probe (`shiny`) or do not, lit by a map in `basis` or by their vertices.
pub(crate) fn surface(shiny: bool, basis: Option<Basis>) -> Shader {
    let family = match basis {
        None => 0,
        Some(Basis::Sh4 | Basis::Sh9) => 1,
        Some(Basis::Hl2) => 2,
        Some(Basis::Hsh4 | Basis::Hsh9) => 3,
        Some(Basis::Makhotkin4 | Basis::Makhotkin9) => 4,
        Some(Basis::Zernike3 | Basis::Zernike6) => 5,
        Some(Basis::H4 | Basis::H6) => 6,
        Some(Basis::ModifiedH1 | Basis::ModifiedH4 | Basis::ModifiedH6) => 7,
    };
    SURFACES[family][usize::from(shiny)].clone()
}

/// Matt surfaces lit by their vertices, whose light a normal map bends.
pub(crate) const BENT: Shader =
    shader!("bent, lit at vertices", "view.wgsl", "surface.wgsl", "bend.wgsl", "vertex_light.wgsl", "bent.wgsl");

/// Surfaces with gloss or transfer textures, for files of so many bands of gloss.
pub(crate) fn glossy(kind: GlossKind, shiny: bool, bands: Option<Bands>) -> Shader {
    let plain = match kind {
        GlossKind::Diffuse => return DIFFUSE_TEXELS[usize::from(shiny)].clone(),
        GlossKind::Texels(GlossWay::Tp) => TEXELS_TP,
        GlossKind::Texels(GlossWay::Tpfl) => TEXELS_TPFL,
        GlossKind::Texels(GlossWay::Cache) => TEXELS_CACHE,
        GlossKind::Vertices(GlossWay::Tp) => VERTICES_TP,
        GlossKind::Vertices(GlossWay::Tpfl) => VERTICES_TPFL,
        GlossKind::Vertices(GlossWay::Cache) => VERTICES_CACHE,
    };
    let functions = bands.map_or(String::new(), gloss_text::functions);
    Shader { name: plain.name, text: Cow::Owned(functions + &plain.text) }
}

/// Surfaces of which a transfer texture holds the diffuse light alone: without shine, and with a mirror of the light probe.
const DIFFUSE_TEXELS: [Shader; 2] = surfaces!("lit by a transfer texture", "gloss_frame.wgsl", "transfer.wgsl");

/// Gloss in transfer textures, a product and a way.
macro_rules! texels {
    ($name:literal, $($way:literal),+) => {
        shader!(
            concat!("glossy texels, ", $name),
            "view.wgsl", "equirect.wgsl", "brdf.wgsl", "surface.wgsl", "bend.wgsl", "shine.wgsl", "gloss_frame.wgsl", "transfer.wgsl",
            "gloss.wgsl", "gloss_texels.wgsl", $($way),+
        )
    };
}

/// Gloss at vertices, a product and a way.
macro_rules! vertices {
    ($name:literal, $($way:literal),+) => {
        shader!(
            concat!("glossy vertices, ", $name),
            "view.wgsl", "equirect.wgsl", "brdf.wgsl", "surface.wgsl", "bend.wgsl", "shine.wgsl", "vertex_light.wgsl", "gloss_frame.wgsl",
            "gloss.wgsl", "gloss_vertices.wgsl", $($way),+
        )
    };
}

const TEXELS_CACHE: Shader = texels!("kept", "gloss_texels_cache.wgsl");
const TEXELS_TP: Shader = texels!("triple products", "gloss_texels_product.wgsl", "gloss_tp.wgsl");
const TEXELS_TPFL: Shader = texels!("matrix of the light", "gloss_texels_product.wgsl", "gloss_tpfl.wgsl");
const VERTICES_CACHE: Shader = vertices!("kept", "gloss_vertices_cache.wgsl");
const VERTICES_TP: Shader = vertices!("triple products", "gloss_vertices_product.wgsl", "gloss_tp.wgsl");
const VERTICES_TPFL: Shader = vertices!("matrix of the light", "gloss_vertices_product.wgsl", "gloss_tpfl.wgsl");

/// Every module of the renderer, for the tests that need no GPU.
#[cfg(test)]
pub(crate) fn all() -> Vec<Shader> {
    let others = [BENT, RELIGHT, SHEET_FILL, GLOSS_ROWS, SKY, RESOLVE, BLOOM, DISPLAY];
    let ways = GlossWay::ALL.into_iter().flat_map(|way| [GlossKind::Texels(way), GlossKind::Vertices(way)]);
    let kinds: Vec<GlossKind> = ways.collect();
    let glossy = (1..=8)
        .filter_map(Bands::new)
        .flat_map(|bands| kinds.iter().map(move |kind| glossy(*kind, true, Some(bands))).collect::<Vec<_>>());
    others.into_iter().chain(SURFACES.into_iter().flatten()).chain(DIFFUSE_TEXELS).chain(glossy).collect()
}

impl Shader {
    /// Compiles the module.
    pub(crate) fn module(&self, device: &wgpu::Device) -> wgpu::ShaderModule {
        device.create_shader_module(wgpu::ShaderModuleDescriptor {
            label: Some(self.name),
            source: wgpu::ShaderSource::Wgsl(Cow::Borrowed(&self.text)),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Parses and validates WGSL without a GPU.
    fn validate(text: &str) -> Result<(), String> {
        let module = naga::front::wgsl::parse_str(text).map_err(|error| error.emit_to_string(text))?;
        let flags = naga::valid::ValidationFlags::all();
        // Halves in pairs, which every Vulkan, Metal and DirectX device packs.
        let capabilities = naga::valid::Capabilities::default() | naga::valid::Capabilities::SHADER_FLOAT16_IN_FLOAT32;
        naga::valid::Validator::new(flags, capabilities)
            .validate(&module)
            .map(drop)
            .map_err(|error| error.emit_to_string(text))
    }

    #[test]
    fn every_module_is_valid() {
        for shader in all() {
            assert_eq!(validate(&shader.text), Ok(()), "{} must be valid WGSL", shader.name);
        }
    }

    #[test]
    fn validation_can_fail() {
        for shader in all() {
            let broken = shader.text.replace("vec2<i32>(at.clip.xy)", "vec2<i32>(at.clip.x)");
            let broken = broken.replace(": u32,", ": u32").replace("-> @location(0) vec4<f32>", "-> vec4<f32>");
            assert!(validate(&broken).is_err(), "{} with wrong types must be refused", shader.name);
        }
    }

    /// A file that no module holds would never be checked.
    #[test]
    fn every_file_is_part_of_a_module() {
        let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/shaders");
        for entry in std::fs::read_dir(folder).expect("the shaders stand beside src") {
            let path = entry.expect("a readable entry").path();
            let text = std::fs::read_to_string(&path).expect("a readable shader");
            let used = all().iter().any(|shader| shader.text.contains(&text));
            assert!(used, "{} belongs to a module", path.display());
        }
    }
}
