//! Materials from the statements of MTL libraries.

use std::collections::HashMap;

use glam::{Affine2, Vec3};

use super::library::Source;
use super::map::Map;
use crate::folder::{Folder, Missing};
use crate::picture::Budget;
use crate::{AlphaMode, Material, Report, Texture, TextureSlot, Warning, Wrap};

/// Diffuse colour of faces without a material, and of materials that do not say.
const DEFAULT_DIFFUSE: f32 = 0.8;

/// All materials, and last the grey one for faces without; and the textures that they use.
pub(super) fn convert(materials: &[Source], folder: &Folder, report: &mut Report) -> (Vec<Material>, Vec<Texture>) {
    let mut pictures = Pictures { folder, report, budget: Budget::new(), slots: HashMap::new(), textures: Vec::new() };
    let mut converted: Vec<Material> = materials.iter().map(|m| pictures.material(m)).collect();
    converted.push(Material {
        name: "default".into(),
        base_color: Vec3::splat(DEFAULT_DIFFUSE).extend(1.0),
        ..Material::default()
    });
    let Pictures { report, budget, textures, .. } = pictures;
    report.warnings.extend(budget.into_notes());
    (converted, textures)
}

/// What makes two textures one: the folder of the library, colour and coverage file, channel, clamping.
type Key = (String, String, String, Option<char>, bool);

/// Decodes each picture once.
struct Pictures<'a> {
    folder: &'a Folder,
    report: &'a mut Report,
    budget: Budget,
    slots: HashMap<Key, u32>,
    textures: Vec<Texture>,
}

impl Pictures<'_> {
    fn material(&mut self, source: &Source) -> Material {
        let unsaid = if source.color_map.is_none() { DEFAULT_DIFFUSE } else { 1.0 };
        let stated = source.diffuse.unwrap_or(Vec3::splat(unsaid));
        let diffuse = stated.clamp(Vec3::ZERO, Vec3::ONE);
        if diffuse != stated {
            self.warn(&format!("{} (Kd {stated})", source.name), "a diffuse colour outside 0 to 1 was clamped");
        }
        if source.has_bump {
            self.warn(&source.name, "bump (height) maps are not supported and were ignored; use norm");
        }
        let opacity = self.opacity(source);
        // A picture of what glows shows as it is where no colour is said, as one of colours does.
        let glow = if source.emissive_map.is_some() { 1.0 } else { 0.0 };
        Material {
            name: source.name.clone(),
            base_color: diffuse.extend(opacity),
            metallic: source.metallic.unwrap_or(0.0).clamp(0.0, 1.0),
            roughness: roughness(source),
            alpha: match (opacity < 1.0, source.coverage_map.is_none()) {
                (true, _) => AlphaMode::Blend,
                (false, false) => AlphaMode::Mask(0.5),
                (false, true) => AlphaMode::Opaque,
            },
            base_color_texture: self.slot(source, source.color_map.as_ref(), source.coverage_map.as_ref()),
            normal_texture: self.slot(source, source.normal_map.as_ref(), None),
            normal_scale: source.normal_map.as_ref().map_or(1.0, |map| map.strength),
            emissive: source.emissive.unwrap_or(Vec3::splat(glow)).max(Vec3::ZERO),
            emissive_texture: self.slot(source, source.emissive_map.as_ref(), None),
            ..Material::default()
        }
    }

    /// `d`, else 1 - `Tr`. A material that nobody would see is as a rule one of a writer that means the opposite.
    fn opacity(&mut self, source: &Source) -> f32 {
        let (opacity, transparency) = (source.opacity, source.transparency);
        let material = format!("material {}", source.name);
        match (opacity, transparency) {
            (None, Some(tr)) if tr >= 1.0 => {
                self.warn(
                    &material,
                    "Tr 1 without d was taken as opaque, as MeshLab writes it; d 0 makes it invisible",
                );
                1.0
            }
            (Some(d), Some(tr)) if d <= 0.0 && tr <= 0.0 => {
                self.warn(&material, "d 0 and Tr 0 contradict each other; it was taken as opaque");
                1.0
            }
            (Some(d), _) if d <= 0.0 => {
                self.warn(&material, "d 0 makes it invisible");
                0.0
            }
            _ => opacity.or(transparency.map(|tr| 1.0 - tr)).unwrap_or(1.0).clamp(0.0, 1.0),
        }
    }

    /// The texture of a colour file and a coverage file, either of which may be missing.
    fn slot(&mut self, source: &Source, color: Option<&Map>, coverage: Option<&Map>) -> Option<TextureSlot> {
        let placed = color.or(coverage)?;
        for map in [color, coverage].into_iter().flatten() {
            for option in &map.left_out {
                let message = format!("the map option {option} is not supported and was left out");
                self.warn(&format!("material {}", source.name), &message);
            }
            if map.transform() != placed.transform() || map.clamp != placed.clamp {
                self.warn(
                    &format!("material {}", source.name),
                    "map_d lies as map_Kd does: its own -s, -o and -clamp were left out",
                );
            }
        }
        let file = |map: Option<&Map>| map.map(|map| map.file.clone()).unwrap_or_default();
        let channel = coverage.and_then(|map| map.channel);
        let key = (source.near.clone(), file(color), file(coverage), channel, placed.clamp);
        let next = self.textures.len() as u32;
        let index = *self.slots.entry(key).or_insert(next);
        if index == next {
            let texture = self.texture(source, &file(color), &file(coverage), channel);
            let wrap = [if placed.clamp { Wrap::Clamp } else { Wrap::Repeat }; 2];
            self.textures.push(Texture { wrap, ..texture });
        }
        // To the bit as without options where there are none.
        let is_plain = (placed.scale, placed.offset) == (glam::Vec2::ONE, glam::Vec2::ZERO);
        let transform = if is_plain { Affine2::IDENTITY } else { placed.transform() };
        Some(TextureSlot { texture: index, uv_set: 0, transform })
    }

    /// The colours of one file with the coverage of another.
    fn texture(&mut self, source: &Source, color: &str, coverage: &str, channel: Option<char>) -> Texture {
        let texture = self.picture(source, color);
        if coverage.is_empty() || (coverage == color && matches!(channel, None | Some('m'))) {
            return texture;
        }
        let mask = self.picture(source, coverage);
        with_coverage(texture, &mask, channel)
    }

    /// The decoded file, or white with a warning; white for an empty name.
    fn picture(&mut self, source: &Source, name: &str) -> Texture {
        if name.is_empty() {
            return Texture::white("white");
        }
        let object = format!("texture {name} of {}", source.name);
        let cut = super::text::before_hash(name);
        let found = self.folder.find(&source.near, name);
        let found =
            found.or_else(|missing| cut.and_then(|cut| self.folder.find(&source.near, cut).ok()).ok_or(missing));
        let read = match found {
            Ok((path, bytes)) => {
                if crate::folder::bare(&path) != crate::folder::bare(cut.unwrap_or(name)) {
                    self.warn(&object, "is not there; a file whose name has other capitals was taken");
                }
                self.budget.decode(name, &bytes)
            }
            Err(Missing::Io(_, error)) => Err(error.to_string()),
            Err(refused) => Err(refused.to_string()),
        };
        read.unwrap_or_else(|why| {
            self.warn(&object, &format!("{why}; white is used"));
            Texture::white(name)
        })
    }

    fn warn(&mut self, object: &str, message: &str) {
        self.report.warnings.push(Warning { object: object.into(), message: message.into() });
    }
}

/// Perceptual roughness: `Pr` where given; else from the Phong exponent Ns of a material that has highlights
/// (Ks not black), alpha^2 = 2 / (Ns + 2) (Walter et al. 2007) and roughness = sqrt(alpha); else 1.
fn roughness(source: &Source) -> f32 {
    if let Some(roughness) = source.roughness {
        return roughness.clamp(0.0, 1.0);
    }
    let shines = source.specular.is_some_and(|s| s.max_element() > 0.0) && source.illumination != Some(1);
    match source.exponent {
        Some(exponent) if shines => (2.0 / (exponent.max(0.0) + 2.0)).sqrt().sqrt(),
        _ => 1.0,
    }
}

/// The picture with a channel of `mask` as its fourth component: red, green, blue or matte (alpha), else the mean
/// brightness.
fn with_coverage(mut texture: Texture, mask: &Texture, channel: Option<char>) -> Texture {
    if mask.width > texture.width || mask.height > texture.height {
        texture = enlarged(&texture, mask.width, mask.height);
    }
    let (width, height) = (texture.width, texture.height);
    for (i, texel) in texture.rgba.iter_mut().enumerate() {
        let [x, y] = [i as u32 % width * mask.width / width, i as u32 / width * mask.height / height];
        let [r, g, b, a] = mask.rgba[(y * mask.width + x) as usize];
        texel[3] = match channel {
            Some('r') => r,
            Some('g') => g,
            Some('b') => b,
            Some('m') => a,
            _ => ([r, g, b].map(u16::from).iter().sum::<u16>() / 3) as u8,
        };
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
