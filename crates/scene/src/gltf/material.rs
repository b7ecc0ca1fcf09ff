//! Materials.

use ::gltf::json::material::{AlphaMode as JsonAlpha, Material as JsonMaterial};
use ::gltf::json::validation::Checked;
use glam::{Affine2, Vec3, Vec4};

use super::document::Document;
use super::texture::{Pictures, Purpose, transform_of_json};
use super::{specular_glossiness, warn};
use crate::folder::Folder;
use crate::{AlphaMode, Error, Material, Report, Texture, TextureSlot};

/// All materials of the document, and last the one for primitives without; and the textures that they use.
pub(super) fn read(
    document: &Document<'_>,
    folder: &Folder,
    report: &mut Report,
) -> Result<(Vec<Material>, Vec<Texture>), Error> {
    let mut pictures = Pictures::new(document, folder, report);
    let all = document.root.materials.iter().enumerate();
    let mut materials: Vec<Material> = all.map(|(m, json)| material(&mut pictures, m, json)).collect();
    // glTF 2.0, 3.9.1: the default material is white, and fully metallic by the default of its factor; taken as
    // diffuse here, as viewers do, since a scene without materials is meant to be seen.
    materials.push(Material { name: "default".into(), ..Material::default() });
    Ok((materials, pictures.finish()?))
}

/// Colour and finish of a material.
pub(super) struct Paint {
    pub(super) base_color: Vec4,
    pub(super) base_color_texture: Option<TextureSlot>,
    pub(super) metallic: f32,
    pub(super) roughness: f32,
    pub(super) metallic_roughness_texture: Option<TextureSlot>,
}

fn material(pictures: &mut Pictures<'_>, m: usize, json: &JsonMaterial) -> Material {
    let extensions = json.extensions.as_ref();
    let name = json.name.clone().unwrap_or_else(|| format!("materials[{m}]"));
    let cutoff = json.alpha_cutoff.map_or(0.5, |c| c.0);
    let alpha = match json.alpha_mode {
        Checked::Valid(JsonAlpha::Mask) => AlphaMode::Mask(cutoff),
        Checked::Valid(JsonAlpha::Blend) => AlphaMode::Blend,
        _ => AlphaMode::Opaque,
    };
    if extensions.is_some_and(|e| e.unlit.is_some()) {
        return unlit(pictures, json, Material { name, alpha, double_sided: json.double_sided, ..Material::default() });
    }
    let strength = extensions.and_then(|e| e.emissive_strength.as_ref()).map_or(1.0, |e| e.emissive_strength.0);
    let transmission = extensions.and_then(|e| e.transmission.as_ref());
    if transmission.is_some_and(|t| t.transmission_texture.is_some()) {
        warn(pictures.report, &name, "a transmission texture is not supported; the factor alone is used");
    }
    let paint = match extensions.and_then(|e| e.pbr_specular_glossiness.as_ref()) {
        Some(json) => specular_glossiness::convert(pictures, &name, json),
        None => metallic_roughness(pictures, &name, json),
    };
    Material {
        base_color: paint.base_color,
        base_color_texture: paint.base_color_texture,
        metallic: paint.metallic,
        roughness: paint.roughness,
        metallic_roughness_texture: paint.metallic_roughness_texture,
        normal_texture: json.normal_texture.as_ref().and_then(|normal| {
            // The crate keeps the extension of normal textures as plain JSON.
            let transform = normal.extensions.as_ref().and_then(|e| e.others.get("KHR_texture_transform"));
            let (transform, set) = transform.map_or((Affine2::IDENTITY, None), transform_of_json);
            pictures.place(normal.index, set.unwrap_or(normal.tex_coord), transform, Purpose::Normals)
        }),
        normal_scale: json.normal_texture.as_ref().map_or(1.0, |n| n.scale),
        emissive: Vec3::from(json.emissive_factor.0).max(Vec3::ZERO) * strength.max(0.0),
        emissive_texture: json.emissive_texture.as_ref().and_then(|info| pictures.slot(info, Purpose::Glow)),
        alpha,
        double_sided: json.double_sided,
        transmission: transmission.map_or(0.0, |t| t.transmission_factor.0.clamp(0.0, 1.0)),
        unlit: false,
        name,
    }
}

fn metallic_roughness(pictures: &mut Pictures<'_>, name: &str, json: &JsonMaterial) -> Paint {
    let pbr = &json.pbr_metallic_roughness;
    let base_color_texture = pbr.base_color_texture.as_ref().and_then(|info| pictures.slot(info, Purpose::Color));
    let shine = pbr.metallic_roughness_texture.as_ref();
    let metallic_roughness_texture = shine.and_then(|info| pictures.slot(info, Purpose::Shine));
    // A picture that cannot be read most often says "not metallic"; the factor alone, 1 by default, says metal.
    let lost = shine.is_some() && metallic_roughness_texture.is_none();
    Paint {
        base_color: base_color(pictures, name, json),
        base_color_texture,
        metallic: if lost { 0.0 } else { pbr.metallic_factor.0.clamp(0.0, 1.0) },
        roughness: pbr.roughness_factor.0.clamp(0.0, 1.0),
        metallic_roughness_texture,
    }
}

/// KHR_materials_unlit: the base colour is all that is shown.
fn unlit(pictures: &mut Pictures<'_>, json: &JsonMaterial, material: Material) -> Material {
    let texture = json.pbr_metallic_roughness.base_color_texture.as_ref();
    let base_color_texture = texture.and_then(|info| pictures.slot(info, Purpose::Color));
    Material { base_color: base_color(pictures, &material.name, json), base_color_texture, unlit: true, ..material }
}

fn base_color(pictures: &mut Pictures<'_>, name: &str, json: &JsonMaterial) -> Vec4 {
    within(pictures, name, "base colour", Vec4::from(json.pbr_metallic_roughness.base_color_factor.0))
}

/// A colour clamped to [0, 1], with a warning where it was outside.
pub(super) fn within(pictures: &mut Pictures<'_>, name: &str, what: &str, color: Vec4) -> Vec4 {
    let clamped = color.clamp(Vec4::ZERO, Vec4::ONE);
    if color != clamped {
        warn(pictures.report, name, format!("{what} {color} is outside 0 to 1 and was clamped"));
    }
    clamped
}
