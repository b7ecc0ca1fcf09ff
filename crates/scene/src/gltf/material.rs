//! Materials and their pictures.

use std::collections::HashMap;

use ::gltf::json::extensions::texture::TextureTransform;
use ::gltf::json::material::{AlphaMode as JsonAlpha, Material as JsonMaterial};
use ::gltf::json::texture::{Info, Texture as JsonTexture, WrappingMode};
use ::gltf::json::validation::Checked;
use ::gltf::json::{Index, Value};
use glam::{Affine2, Mat2, Vec2, Vec3, Vec4};

use super::document::Document;
use super::warn;
use crate::folder::Folder;
use crate::picture::Budget;
use crate::uri::{Uri, parse};
use crate::{AlphaMode, Material, Report, Texture, TextureSlot, Wrap};

/// All materials of the document, and last the one for primitives without; and the textures that they use.
pub(super) fn read(document: &Document<'_>, folder: &Folder, report: &mut Report) -> (Vec<Material>, Vec<Texture>) {
    let mut pictures = Pictures {
        document,
        folder,
        report,
        budget: Budget::new(),
        decoded: HashMap::new(),
        slots: HashMap::new(),
        textures: Vec::new(),
    };
    let mut materials: Vec<Material> =
        document.root.materials.iter().enumerate().map(|(m, json)| pictures.material(m, json)).collect();
    // glTF 2.0, 3.9.1: the default material is white, and fully metallic by the default of its factor; taken as
    // diffuse here, as viewers do, since a scene without materials is meant to be seen.
    materials.push(Material { name: "default".into(), ..Material::default() });
    (materials, pictures.textures)
}

/// Decodes each picture once.
struct Pictures<'a> {
    document: &'a Document<'a>,
    folder: &'a Folder,
    report: &'a mut Report,
    budget: Budget,
    /// By image.
    decoded: HashMap<usize, Texture>,
    /// By image and wrapping.
    slots: HashMap<(usize, [Wrap; 2]), u32>,
    textures: Vec<Texture>,
}

impl Pictures<'_> {
    fn material(&mut self, m: usize, json: &JsonMaterial) -> Material {
        let pbr = &json.pbr_metallic_roughness;
        let extensions = json.extensions.as_ref();
        let strength = extensions.and_then(|e| e.emissive_strength.as_ref()).map_or(1.0, |e| e.emissive_strength.0);
        let transmission = extensions.and_then(|e| e.transmission.as_ref());
        let unlit = extensions.is_some_and(|e| e.unlit.is_some());
        let name = json.name.clone().unwrap_or_else(|| format!("materials[{m}]"));
        if transmission.is_some_and(|t| t.transmission_texture.is_some()) {
            warn(self.report, &name, "a transmission texture is not supported; the factor alone is used");
        }
        let cutoff = json.alpha_cutoff.map_or(0.5, |c| c.0);
        let base_color = Vec4::from(pbr.base_color_factor.0);
        if base_color != base_color.clamp(Vec4::ZERO, Vec4::ONE) {
            warn(self.report, &name, format!("base colour {base_color} is outside 0 to 1 and was clamped"));
        }
        Material {
            base_color: base_color.clamp(Vec4::ZERO, Vec4::ONE),
            base_color_texture: pbr.base_color_texture.as_ref().map(|info| self.slot(info)),
            metallic: if unlit { 0.0 } else { pbr.metallic_factor.0.clamp(0.0, 1.0) },
            roughness: if unlit { 1.0 } else { pbr.roughness_factor.0.clamp(0.0, 1.0) },
            metallic_roughness_texture: pbr.metallic_roughness_texture.as_ref().map(|info| self.slot(info)),
            normal_texture: json.normal_texture.as_ref().map(|normal| {
                // The crate keeps the extension of normal textures as plain JSON.
                let transform = normal.extensions.as_ref().and_then(|e| e.others.get("KHR_texture_transform"));
                let (transform, set) = transform.map_or((Affine2::IDENTITY, None), transform_of_json);
                self.place(normal.index, set.unwrap_or(normal.tex_coord), transform)
            }),
            normal_scale: json.normal_texture.as_ref().map_or(1.0, |n| n.scale),
            // KHR_materials_unlit: the base colour is all that is shown.
            emissive: if unlit {
                Vec3::ZERO
            } else {
                Vec3::from(json.emissive_factor.0).max(Vec3::ZERO) * strength.max(0.0)
            },
            emissive_texture: json.emissive_texture.as_ref().filter(|_| !unlit).map(|info| self.slot(info)),
            alpha: match json.alpha_mode {
                Checked::Valid(JsonAlpha::Mask) => AlphaMode::Mask(cutoff),
                Checked::Valid(JsonAlpha::Blend) => AlphaMode::Blend,
                _ => AlphaMode::Opaque,
            },
            double_sided: json.double_sided,
            transmission: transmission.filter(|_| !unlit).map_or(0.0, |t| t.transmission_factor.0.clamp(0.0, 1.0)),
            unlit,
            name,
        }
    }

    fn slot(&mut self, info: &Info) -> TextureSlot {
        let transform = info.extensions.as_ref().and_then(|e| e.texture_transform.as_ref());
        let (transform, set) = transform.map_or((Affine2::IDENTITY, None), transform_of);
        self.place(info.index, set.unwrap_or(info.tex_coord), transform)
    }

    fn place(&mut self, texture: Index<JsonTexture>, uv_set: u32, transform: Affine2) -> TextureSlot {
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
        let image = json.source.value();
        let next = self.textures.len() as u32;
        let index = *self.slots.entry((image, wrap)).or_insert(next);
        if index == next {
            let picture = self.picture(image);
            self.textures.push(Texture { wrap, ..picture });
        }
        TextureSlot { texture: index, uv_set, transform }
    }

    /// The decoded image, or white with a warning.
    fn picture(&mut self, image: usize) -> Texture {
        if image >= self.document.root.images.len() {
            // Only an extension names a source, in a format that is not read.
            warn(self.report, "textures", "a texture without a PNG or JPEG source; white is used");
            return Texture::white("no source");
        }
        if let Some(texture) = self.decoded.get(&image) {
            return texture.clone();
        }
        let json = &self.document.root.images[image];
        let in_place = json.uri.as_ref().filter(|uri| !uri.starts_with("data:"));
        let name = json.name.clone().or_else(|| in_place.cloned()).unwrap_or_else(|| format!("images[{image}]"));
        let decoded = self.file(image).and_then(|bytes| self.budget.decode(&name, &bytes));
        let texture = decoded.unwrap_or_else(|why| {
            warn(self.report, format!("images[{image}] {name}"), format!("{why}; white is used"));
            Texture::white(&name)
        });
        self.decoded.insert(image, texture.clone());
        texture
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
fn transform_of_json(json: &Value) -> (Affine2, Option<u32>) {
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
