//! Materials of MTL libraries.

use std::collections::HashMap;

use glam::{Affine2, Vec3};

use crate::folder::Folder;
use crate::picture::Budget;
use crate::{AlphaMode, Material, Report, Texture, TextureSlot, Warning};

/// Diffuse colour of faces without a material, and of materials that do not say.
const DEFAULT_DIFFUSE: f32 = 0.8;

/// Reads the library `name`, or each library of a list of names; what is missing or broken becomes a warning.
pub(super) fn library(folder: &Folder, name: &str, warnings: &mut Vec<Warning>) -> tobj::MTLLoadResult {
    let text = match folder.read(name) {
        Ok(bytes) => String::from_utf8_lossy(&bytes).into_owned(),
        Err(missing) => {
            let read = |part: &str| folder.read(part).ok().map(|b| String::from_utf8_lossy(&b).into_owned());
            let parts: Vec<String> = name.split_whitespace().filter_map(read).collect();
            if parts.is_empty() {
                warnings.push(Warning { object: format!("mtllib {name}"), message: missing.to_string() });
            }
            parts.join("\n")
        }
    };
    let cleaned = clean(&text, name, warnings);
    tobj::load_mtl_buf(&mut cleaned.as_bytes())
}

/// A copy in which every statement is one that the parser reads without an error or a panic.
fn clean(text: &str, library: &str, warnings: &mut Vec<Warning>) -> String {
    let mut cleaned = String::with_capacity(text.len());
    for (line, statement) in text.lines().enumerate() {
        let statement = statement.trim();
        let (keyword, rest) = statement.split_once(char::is_whitespace).unwrap_or((statement, ""));
        let kept = match keyword {
            "" => continue,
            _ if keyword.starts_with('#') => continue,
            "Ka" | "Kd" | "Ks" | "Ke" => color(rest).map(|[r, g, b]| format!("{r} {g} {b}")),
            "Ns" | "Ni" | "d" | "Tr" | "Pr" | "Pm" => number(rest).map(|x| x.to_string()),
            "illum" => rest.split_whitespace().next().and_then(|w| w.parse::<u8>().ok()).map(|x| x.to_string()),
            "newmtl" => Some(rest.trim().to_owned()).filter(|name| !name.is_empty()),
            _ if is_map(keyword) => Some(file_name(rest)).filter(|name| !name.is_empty()),
            // Everything else has no meaning here.
            _ => continue,
        };
        match kept {
            Some(kept) => cleaned.push_str(&format!("{} {kept}\n", spelled(keyword))),
            None => {
                let message = format!("line {}: {statement:?} cannot be read and was ignored", line + 1);
                warnings.push(Warning { object: format!("mtllib {library}"), message });
            }
        }
    }
    cleaned
}

fn is_map(keyword: &str) -> bool {
    let lower = keyword.to_ascii_lowercase();
    matches!(lower.as_str(), "map_kd" | "map_d" | "map_bump" | "bump" | "norm" | "map_ke")
}

/// The keyword as the parser knows it.
fn spelled(keyword: &str) -> &str {
    match keyword.to_ascii_lowercase().as_str() {
        "map_kd" => "map_Kd",
        "map_d" => "map_d",
        "map_ke" => "map_Ke",
        "map_bump" | "bump" => "bump",
        "norm" => "norm",
        _ => keyword,
    }
}

/// Three finite numbers, or one for all three.
fn color(text: &str) -> Option<[f32; 3]> {
    let words: Vec<f32> = text.split_whitespace().map_while(|w| w.parse().ok()).take(3).collect();
    let color = match words[..] {
        [grey] => [grey; 3],
        [r, g, b] => [r, g, b],
        _ => return None,
    };
    color.iter().all(|c| c.is_finite()).then_some(color)
}

/// The first finite number, after options such as `-halo`.
fn number(text: &str) -> Option<f32> {
    text.split_whitespace().find_map(|w| w.parse::<f32>().ok()).filter(|x| x.is_finite())
}

/// The file name after the options of a map statement; names may hold spaces.
fn file_name(text: &str) -> String {
    let mut words = text.split_whitespace().peekable();
    while words.next_if(|w| w.starts_with('-')).is_some() {
        while words
            .next_if(|w| w.parse::<f32>().is_ok() || matches!(*w, "on" | "off" | "r" | "g" | "b" | "m" | "l" | "z"))
            .is_some()
        {}
    }
    words.collect::<Vec<_>>().join(" ")
}

/// All materials, and last the grey one for faces without; and the textures that they use.
pub(super) fn convert(
    materials: &[tobj::Material],
    folder: &Folder,
    report: &mut Report,
) -> (Vec<Material>, Vec<Texture>) {
    let mut pictures = Pictures { folder, report, budget: Budget::new(), slots: HashMap::new(), textures: Vec::new() };
    let mut converted: Vec<Material> = materials.iter().map(|m| pictures.material(m)).collect();
    converted.push(Material {
        name: "default".into(),
        base_color: Vec3::splat(DEFAULT_DIFFUSE).extend(1.0),
        ..Material::default()
    });
    (converted, pictures.textures)
}

/// Decodes each picture once.
struct Pictures<'a> {
    folder: &'a Folder,
    report: &'a mut Report,
    budget: Budget,
    /// By colour and coverage file.
    slots: HashMap<(String, String), u32>,
    textures: Vec<Texture>,
}

impl Pictures<'_> {
    fn material(&mut self, source: &tobj::Material) -> Material {
        let map = |name: &Option<String>| name.clone().unwrap_or_default();
        let other = |key: &str| source.unknown_param.get(key);
        let (color_map, coverage_map) = (map(&source.diffuse_texture), map(&source.dissolve_texture));
        let unsaid = if color_map.is_empty() { DEFAULT_DIFFUSE } else { 1.0 };
        let stated = source.diffuse.map_or(Vec3::splat(unsaid), Vec3::from);
        let diffuse = stated.clamp(Vec3::ZERO, Vec3::ONE);
        if diffuse != stated {
            self.warn(&source.name, &format!("diffuse colour {stated} is outside 0 to 1 and was clamped"));
        }
        let opacity = source.dissolve.or_else(|| other("Tr").and_then(|t| Some(1.0 - t.parse::<f32>().ok()?)));
        let opacity = opacity.unwrap_or(1.0).clamp(0.0, 1.0);
        if source.normal_texture.is_some() {
            self.warn(&source.name, "bump (height) maps are not supported and were ignored; use norm");
        }
        Material {
            name: source.name.clone(),
            base_color: diffuse.extend(opacity),
            metallic: other("Pm").and_then(|x| x.parse().ok()).unwrap_or(0.0f32).clamp(0.0, 1.0),
            roughness: roughness(source),
            alpha: match (opacity < 1.0, coverage_map.is_empty()) {
                (true, _) => AlphaMode::Blend,
                (false, false) => AlphaMode::Mask(0.5),
                (false, true) => AlphaMode::Opaque,
            },
            base_color_texture: self.slot(&source.name, &color_map, &coverage_map),
            normal_texture: other("norm").and_then(|name| self.slot(&source.name, name, "")),
            emissive: source.emissive.map_or(Vec3::ZERO, Vec3::from).max(Vec3::ZERO),
            emissive_texture: other("map_Ke").and_then(|name| self.slot(&source.name, name, "")),
            ..Material::default()
        }
    }

    /// The texture of a colour file and a coverage file, either of which may be empty.
    fn slot(&mut self, material: &str, color: &str, coverage: &str) -> Option<TextureSlot> {
        if color.is_empty() && coverage.is_empty() {
            return None;
        }
        let next = self.textures.len() as u32;
        let index = *self.slots.entry((color.to_owned(), coverage.to_owned())).or_insert(next);
        if index == next {
            let mut texture = self.picture(material, color);
            if !coverage.is_empty() && coverage != color {
                let mask = self.picture(material, coverage);
                texture = with_coverage(texture, &mask);
            }
            self.textures.push(texture);
        }
        Some(TextureSlot { texture: index, uv_set: 0, transform: Affine2::IDENTITY })
    }

    /// The decoded file, or white with a warning; white for an empty name.
    fn picture(&mut self, material: &str, name: &str) -> Texture {
        if name.is_empty() {
            return Texture::white("white");
        }
        let file = self.folder.read(name).map_err(|missing| missing.to_string());
        file.and_then(|bytes| self.budget.decode(name, &bytes)).unwrap_or_else(|why| {
            self.warn(&format!("texture {name} of {material}"), &format!("{why}; white is used"));
            Texture::white(name)
        })
    }

    fn warn(&mut self, object: &str, message: &str) {
        self.report.warnings.push(Warning { object: object.into(), message: message.into() });
    }
}

/// Perceptual roughness: `Pr` where given; else from the Phong exponent Ns of a material that has highlights
/// (Ks not black), alpha^2 = 2 / (Ns + 2) (Walter et al. 2007) and roughness = sqrt(alpha); else 1.
fn roughness(source: &tobj::Material) -> f32 {
    if let Some(roughness) = source.unknown_param.get("Pr").and_then(|x| x.parse::<f32>().ok()) {
        return roughness.clamp(0.0, 1.0);
    }
    let shines = source.specular.is_some_and(|s| s.iter().any(|c| *c > 0.0)) && source.illumination_model != Some(1);
    match source.shininess {
        Some(exponent) if shines => (2.0 / (exponent.max(0.0) + 2.0)).sqrt().sqrt(),
        _ => 1.0,
    }
}

/// The picture with the mean brightness of `mask` as its fourth component.
fn with_coverage(mut texture: Texture, mask: &Texture) -> Texture {
    if mask.width > texture.width || mask.height > texture.height {
        texture = enlarged(&texture, mask.width, mask.height);
    }
    let (width, height) = (texture.width, texture.height);
    for (i, texel) in texture.rgba.iter_mut().enumerate() {
        let [x, y] = [i as u32 % width * mask.width / width, i as u32 / width * mask.height / height];
        let [r, g, b, _] = mask.rgba[(y * mask.width + x) as usize].map(u16::from);
        texel[3] = ((r + g + b) / 3) as u8;
    }
    texture
}

/// The picture on a larger grid, each texel repeated.
fn enlarged(texture: &Texture, width: u32, height: u32) -> Texture {
    let (width, height) = (width.max(texture.width), height.max(texture.height));
    let texel = |i: u32| {
        let [x, y] = [i % width * texture.width / width, i / width * texture.height / height];
        texture.rgba[(y * texture.width + x) as usize]
    };
    Texture { width, height, rgba: (0..width * height).map(texel).collect(), ..texture.clone() }
}
