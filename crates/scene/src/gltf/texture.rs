//! Pictures of materials, each decoded once.

use std::collections::HashMap;

use ::gltf::json::extensions::texture::TextureTransform;
use ::gltf::json::texture::{Info, Texture as JsonTexture, WrappingMode};
use ::gltf::json::validation::Checked;
use ::gltf::json::{Index, Value};
use glam::{Affine2, Mat2, Vec2};

use super::document::Document;
use super::warn;
use crate::folder::Folder;
use crate::picture::Budget;
use crate::uri::{Uri, parse};
use crate::{Error, Report, Texture, TextureSlot, Wrap};

/// Extensions that name a source before the plain one, best first.
const SOURCES: [&str; 2] = ["EXT_texture_webp", "KHR_texture_basisu"];
/// Extensions that name a source in a format that is not read, and how to convert it.
const UNREAD: [(&str, &str); 2] = [
    ("EXT_texture_avif", "convert the pictures first: gltf-transform png IN.glb OUT.glb --formats \"*\""),
    ("MSFT_texture_dds", "save the textures as PNG or JPEG"),
];
const NOT_BASIS: &str = "convert the pictures first: gltf-transform ktxdecompress IN.glb OUT.glb";

/// What a picture is for: what stands in for one that cannot be read.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(super) enum Purpose {
    Color,
    Shine,
    Normals,
    Glow,
}

impl Purpose {
    fn stand_in(self) -> &'static str {
        match self {
            Self::Color | Self::Glow => "white is used",
            Self::Shine => "the surface counts as not metallic",
            Self::Normals => "the surface is smooth",
        }
    }
}

/// The textures of a scene while they grow.
pub(super) struct Pictures<'a> {
    pub(super) document: &'a Document<'a>,
    pub(super) report: &'a mut Report,
    pub(super) textures: Vec<Texture>,
    folder: &'a Folder,
    budget: Budget,
    /// By image: one of its textures, or why there is none.
    decoded: HashMap<usize, Result<u32, String>>,
    /// By image and wrapping.
    slots: HashMap<(usize, [Wrap; 2]), u32>,
    /// Warnings that were given, so that each is given once.
    told: Vec<(usize, Purpose)>,
    /// The first texture that nothing can stand in for.
    refusal: Option<Error>,
}

impl<'a> Pictures<'a> {
    pub(super) fn new(document: &'a Document<'a>, folder: &'a Folder, report: &'a mut Report) -> Self {
        Self {
            document,
            report,
            textures: Vec::new(),
            folder,
            budget: Budget::new(),
            decoded: HashMap::new(),
            slots: HashMap::new(),
            told: Vec::new(),
            refusal: None,
        }
    }

    /// The textures, or why the file is refused.
    pub(super) fn finish(self) -> Result<Vec<Texture>, Error> {
        self.report.warnings.extend(self.budget.into_notes());
        self.refusal.map_or(Ok(self.textures), Err)
    }

    /// A texture as a material uses it; none, with a warning, where it cannot be read.
    pub(super) fn slot(&mut self, info: &Info, purpose: Purpose) -> Option<TextureSlot> {
        let transform = info.extensions.as_ref().and_then(|e| e.texture_transform.as_ref());
        let (transform, set) = transform.map_or((Affine2::IDENTITY, None), transform_of);
        self.place(info.index, set.unwrap_or(info.tex_coord), transform, purpose)
    }

    pub(super) fn place(
        &mut self,
        texture: Index<JsonTexture>,
        uv_set: u32,
        transform: Affine2,
        purpose: Purpose,
    ) -> Option<TextureSlot> {
        let root = &self.document.root;
        let json = &root.textures[texture.value()];
        let wrap = json.sampler.map_or([Wrap::Repeat; 2], |sampler| {
            let sampler = &root.samplers[sampler.value()];
            [wrap_of(sampler.wrap_s), wrap_of(sampler.wrap_t)]
        });
        if uv_set > 1 {
            let what = format!("texture coordinates {uv_set} are not read, only sets 0 and 1; set 0 is used");
            warn(self.report, format!("textures[{}]", texture.value()), what);
        }
        let uv_set = if uv_set == 1 { 1 } else { 0 };
        let texture = self.texture(texture.value(), wrap, purpose)?;
        Some(TextureSlot { texture, uv_set, transform })
    }

    /// The first source of a texture that can be read.
    fn texture(&mut self, texture: usize, wrap: [Wrap; 2], purpose: Purpose) -> Option<u32> {
        let (sources, unread) = self.sources(texture);
        let mut failed = None;
        for (at, &image) in sources.iter().enumerate() {
            match self.image(image, wrap) {
                Ok(texture) => return Some(texture),
                Err(why) => {
                    let last = at + 1 == sources.len();
                    if last {
                        failed = Some(why.clone());
                    }
                    let instead = if last { purpose.stand_in() } else { "another source of the texture is used" };
                    self.tell(image, purpose, format!("{why}; {instead}"));
                }
            }
        }
        let basis = sources.len() == 1 && failed.as_deref().is_some_and(|why| why.contains("KTX2 file"));
        let unread = unread.filter(|_| sources.is_empty()).or(basis.then_some((SOURCES[1], NOT_BASIS)));
        match unread {
            Some((name, hint)) => {
                let object = format!("textures[{texture}]");
                let error = Error::unsupported(&self.document.file, object, format!("a picture of {name} alone"), hint);
                self.refusal.get_or_insert(error);
            }
            None if sources.is_empty() => {
                let what = format!("a texture without a source; {}", purpose.stand_in());
                warn(self.report, "textures", what);
            }
            None => {}
        }
        None
    }

    /// Images of a texture in the order in which they are tried, and an extension that names one that is not read.
    fn sources(&self, texture: usize) -> (Vec<usize>, Option<(&'static str, &'static str)>) {
        let json = &self.document.root.textures[texture];
        let others = json.extensions.as_ref().map(|extensions| &extensions.others);
        let count = self.document.root.images.len();
        let named = |name: &str| others?.get(name)?["source"].as_u64().map(|image| image as usize);
        let sources = SOURCES.iter().filter_map(|name| named(name)).chain([json.source.value()]);
        let unread = UNREAD.into_iter().find(|(name, _)| named(name).is_some());
        (sources.filter(|image| *image < count).collect(), unread)
    }

    fn tell(&mut self, image: usize, purpose: Purpose, what: String) {
        if !self.told.contains(&(image, purpose)) {
            self.told.push((image, purpose));
            warn(self.report, format!("images[{image}] {}", self.name(image)), what);
        }
    }

    fn name(&self, image: usize) -> String {
        let json = &self.document.root.images[image];
        let in_place = json.uri.as_ref().filter(|uri| !uri.starts_with("data:"));
        json.name.clone().or_else(|| in_place.cloned()).unwrap_or_else(|| format!("images[{image}]"))
    }

    /// The texture of a decoded image.
    fn image(&mut self, image: usize, wrap: [Wrap; 2]) -> Result<u32, String> {
        if let Some(texture) = self.slots.get(&(image, wrap)) {
            return Ok(*texture);
        }
        let next = self.textures.len() as u32;
        match self.decoded.get(&image) {
            Some(Ok(other)) => {
                let picture = self.textures[*other as usize].clone();
                self.textures.push(Texture { wrap, ..picture });
            }
            Some(Err(why)) => return Err(why.clone()),
            None => {
                let name = self.name(image);
                match self.file(image).and_then(|bytes| self.budget.decode(&name, &bytes)) {
                    Ok(picture) => self.textures.push(Texture { wrap, ..picture }),
                    Err(why) => {
                        self.decoded.insert(image, Err(why.clone()));
                        return Err(why);
                    }
                }
                self.decoded.insert(image, Ok(next));
            }
        }
        self.slots.insert((image, wrap), next);
        Ok(next)
    }

    /// The bytes of an image file.
    fn file(&self, image: usize) -> Result<Vec<u8>, String> {
        let json = &self.document.root.images[image];
        match (&json.uri, json.buffer_view) {
            (_, Some(view)) => self.document.view(view).map(<[u8]>::to_vec).map_err(|error| error.to_string()),
            (Some(uri), _) => match parse(uri)? {
                Uri::Data(bytes) => Ok(bytes),
                Uri::Relative(name) => self.folder.read(&name).map_err(|missing| missing.to_string()),
            },
            (None, None) => Err("has neither uri nor bufferView".into()),
        }
    }
}

fn wrap_of(mode: Checked<WrappingMode>) -> Wrap {
    match mode {
        Checked::Valid(WrappingMode::ClampToEdge) => Wrap::Clamp,
        Checked::Valid(WrappingMode::MirroredRepeat) => Wrap::Mirror,
        _ => Wrap::Repeat,
    }
}

fn transform_of(json: &TextureTransform) -> (Affine2, Option<u32>) {
    (affine(json.offset.0, json.rotation.0, json.scale.0), json.tex_coord)
}

/// The same from plain JSON; absent and odd members take their defaults.
pub(super) fn transform_of_json(json: &Value) -> (Affine2, Option<u32>) {
    let number = |value: &Value| value.as_f64().map(|x| x as f32);
    let pair = |key: &str, default: f32| {
        let value = json.get(key);
        [0, 1].map(|k| value.and_then(|v| number(v.get(k)?)).unwrap_or(default))
    };
    let rotation = json.get("rotation").and_then(number).unwrap_or(0.0);
    let set = json.get("texCoord").and_then(Value::as_u64).map(|set| u32::try_from(set).unwrap_or(u32::MAX));
    (affine(pair("offset", 0.0), rotation, pair("scale", 1.0)), set)
}

/// KHR_texture_transform: scale, then rotate counter-clockwise as seen on the picture (v downwards), then offset:
/// u' = ox + cos(r) su u + sin(r) sv v, v' = oy - sin(r) su u + cos(r) sv v.
fn affine(offset: [f32; 2], rotation: f32, scale: [f32; 2]) -> Affine2 {
    let (sin, cos) = (libm::sinf(rotation), libm::cosf(rotation));
    let turned = Mat2::from_cols(Vec2::new(cos, -sin) * scale[0], Vec2::new(sin, cos) * scale[1]);
    Affine2::from_mat2_translation(turned, Vec2::from(offset))
}
