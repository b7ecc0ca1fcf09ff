//! KHR_materials_pbrSpecularGlossiness, converted to metallic-roughness.
//!
//! The extension gives the diffuse colour d and the reflectance at normal incidence s; a surface scatters
//! d (1 - max s). The metallic model scatters 0.96 b (1 - m) and reflects 0.04 (1 - m) + b m. Both pairs are equal
//! for the root m of a quadratic in the brightness of d and s, as the extension's own notes on conversion have it;
//! the base colour b is then taken from d where m is small, and from s where it is large.

use ::gltf::json::extensions::material::PbrSpecularGlossiness;
use glam::{Vec2, Vec3, Vec4};

use super::material::{Paint, within};
use super::texture::{Pictures, Purpose};
use super::warn;
use crate::texture::linear_from_srgb;
use crate::{Texture, TextureSlot};

/// Reflectance of a dielectric in the metallic model.
const DIELECTRIC: f32 = 0.04;
/// Reflectance up to which a surface counts as dielectric.
const MOST_DIELECTRIC: f32 = 0.05;

/// Colour and finish of a material with the extension.
pub(super) fn convert(pictures: &mut Pictures<'_>, name: &str, json: &PbrSpecularGlossiness) -> Paint {
    let diffuse = within(pictures, name, "diffuse colour", Vec4::from(json.diffuse_factor.0));
    let specular = within(pictures, name, "specular colour", Vec3::from(json.specular_factor.0).extend(1.0)).truncate();
    let glossiness = json.glossiness_factor.0.clamp(0.0, 1.0);
    let color = json.diffuse_texture.as_ref().and_then(|info| pictures.slot(info, Purpose::Color));
    let shine = json.specular_glossiness_texture.as_ref().and_then(|info| pictures.slot(info, Purpose::Shine));
    let lost = json.specular_glossiness_texture.is_some() && shine.is_none();
    let factors = Factors {
        diffuse,
        // The default factor of 1 is meant to be multiplied by a picture: alone it is a mirror.
        specular: if lost { Vec3::splat(DIELECTRIC) } else { specular },
        glossiness,
    };
    match (color, shine) {
        (None, None) => {
            let (base, metallic) = solve(diffuse.truncate(), factors.specular);
            factors.paint(base, None, metallic)
        }
        (Some(_), None) if factors.specular.max_element() <= MOST_DIELECTRIC => {
            factors.paint(solve(diffuse.truncate(), factors.specular).0, color, 0.0)
        }
        _ => textured(pictures, name, &factors, color, shine),
    }
}

/// What the pictures are multiplied by.
struct Factors {
    diffuse: Vec4,
    specular: Vec3,
    glossiness: f32,
}

impl Factors {
    /// A paint whose finish is the same everywhere.
    fn paint(&self, base: Vec3, base_color_texture: Option<TextureSlot>, metallic: f32) -> Paint {
        Paint {
            base_color: base.extend(self.diffuse.w),
            base_color_texture,
            metallic,
            roughness: 1.0 - self.glossiness,
            metallic_roughness_texture: None,
        }
    }
}

/// A paint whose finish varies: new pictures, texel by texel.
fn textured(
    pictures: &mut Pictures<'_>,
    name: &str,
    factors: &Factors,
    color: Option<TextureSlot>,
    shine: Option<TextureSlot>,
) -> Paint {
    let placed = |slot: TextureSlot| {
        let texture = &pictures.textures[slot.texture as usize];
        (slot.uv_set, slot.transform, texture.wrap)
    };
    let mut color_on_grid = color;
    if let (Some(a), Some(b)) = (color, shine)
        && placed(a) != placed(b)
    {
        let what =
            "diffuse and specular-glossiness textures lie differently; the metallic share follows the second alone";
        warn(pictures.report, name, what);
        color_on_grid = None;
    }
    let grid = Grid::new(&pictures.textures, factors, color_on_grid, shine);
    let ([width, height], made) = (grid.size, grid.texels());
    let Some(slot) = shine.or(color) else { return factors.paint(Vec3::ONE, None, 0.0) };
    let mut add = |suffix: &str, rgba: Vec<[u8; 4]>| {
        let wrap = pictures.textures[slot.texture as usize].wrap;
        let texture = Texture { name: format!("{name} ({suffix})"), width, height, rgba, wrap };
        pictures.textures.push(texture);
        TextureSlot { texture: pictures.textures.len() as u32 - 1, ..slot }
    };
    let finish = Some(add("metallic-roughness", made.iter().map(|texel| texel.finish()).collect()));
    let dielectric = made.iter().all(|texel| texel.metallic == 0.0);
    let (base_color, base_color_texture) = if color.is_some() && (dielectric || color_on_grid.is_none()) {
        // The picture stays as it is: what all texels share goes into the factor.
        let kept = made.iter().map(|texel| f64::from(texel.kept)).sum::<f64>() / made.len().max(1) as f64;
        ((factors.diffuse.truncate() * kept as f32).min(Vec3::ONE).extend(factors.diffuse.w), color)
    } else {
        (Vec4::ONE, Some(add("base colour", made.iter().map(Made::color).collect())))
    };
    Paint { base_color, base_color_texture, metallic: 1.0, roughness: 1.0, metallic_roughness_texture: finish }
}

/// Texels at which both pictures are looked up.
struct Grid<'a> {
    size: [u32; 2],
    factors: &'a Factors,
    color: Option<&'a Texture>,
    shine: Option<&'a Texture>,
}

/// One converted texel.
struct Made {
    base: Vec4,
    metallic: f32,
    roughness: f32,
    /// Share of the diffuse colour that the base colour of a dielectric keeps.
    kept: f32,
}

impl<'a> Grid<'a> {
    fn new(
        textures: &'a [Texture],
        factors: &'a Factors,
        color: Option<TextureSlot>,
        shine: Option<TextureSlot>,
    ) -> Self {
        let of = |slot: Option<TextureSlot>| slot.map(|slot| &textures[slot.texture as usize]);
        let (color, shine) = (of(color), of(shine));
        let largest = |edge: fn(&Texture) -> u32| color.into_iter().chain(shine).map(edge).max().unwrap_or(1);
        Self { size: [largest(|t| t.width), largest(|t| t.height)], factors, color, shine }
    }

    fn texels(&self) -> Vec<Made> {
        let [width, height] = self.size;
        let size = Vec2::new(width as f32, height as f32);
        let places = (0..height).flat_map(|y| (0..width).map(move |x| Vec2::new(x as f32, y as f32)));
        places.map(|place| self.texel((place + 0.5) / size)).collect()
    }

    fn texel(&self, uv: Vec2) -> Made {
        let look = |texture: Option<&Texture>| texture.map_or(Vec4::ONE, |texture| texture.sample(uv, true));
        let diffuse = self.factors.diffuse * look(self.color);
        let shine = look(self.shine);
        let specular = self.factors.specular * shine.truncate();
        let (base, metallic) = solve(diffuse.truncate(), specular);
        let roughness = 1.0 - self.factors.glossiness * shine.w;
        Made { base: base.extend(diffuse.w), metallic, roughness, kept: kept(specular) }
    }
}

impl Made {
    /// sRGB colour and coverage.
    fn color(&self) -> [u8; 4] {
        let [r, g, b, a] = self.base.to_array();
        [srgb(r), srgb(g), srgb(b), byte(a)]
    }

    /// Green is roughness, blue is metallic.
    fn finish(&self) -> [u8; 4] {
        [255, byte(self.roughness), byte(self.metallic), 255]
    }
}

/// Base colour and metallic share of a diffuse and a specular colour.
fn solve(diffuse: Vec3, specular: Vec3) -> (Vec3, f32) {
    let body = diffuse * kept(specular);
    let (dark, bright) = (brightness(body), brightness(specular));
    if bright <= MOST_DIELECTRIC {
        return (body.min(Vec3::ONE), 0.0);
    }
    // 0.04 m^2 + (body + specular - 0.08) m + 0.04 - specular = 0
    let b = dark + bright - 2.0 * DIELECTRIC;
    let root = (b * b - 4.0 * DIELECTRIC * (DIELECTRIC - bright)).max(0.0).sqrt();
    let metallic = ((root - b) / (2.0 * DIELECTRIC)).clamp(0.0, 1.0);
    let from_body = body / (1.0 - metallic).max(1e-6);
    let from_specular = (specular - DIELECTRIC * (1.0 - metallic)) / metallic.max(1e-6);
    let base = from_body.min(Vec3::ONE).lerp(from_specular, metallic * metallic);
    (base.clamp(Vec3::ZERO, Vec3::ONE), metallic)
}

/// What is left of a diffuse colour beside a specular one, in the metallic model's terms.
fn kept(specular: Vec3) -> f32 {
    (1.0 - specular.max_element()) / (1.0 - DIELECTRIC)
}

/// How bright a linear colour looks.
fn brightness(color: Vec3) -> f32 {
    (color * color).dot(Vec3::new(0.299, 0.587, 0.114)).sqrt()
}

fn byte(value: f32) -> u8 {
    (value.clamp(0.0, 1.0) * 255.0 + 0.5) as u8
}

/// The sRGB byte whose linear value is nearest.
fn srgb(linear: f32) -> u8 {
    let (mut low, mut high) = (0u8, 255u8);
    while high - low > 1 {
        let middle = low + (high - low) / 2;
        if linear_from_srgb(middle) <= linear { low = middle } else { high = middle }
    }
    if linear - linear_from_srgb(low) <= linear_from_srgb(high) - linear { low } else { high }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// What each model makes of grey: scattered share, reflectance at normal incidence.
    fn metallic_model((base, metallic): (Vec3, f32)) -> [f32; 2] {
        [0.96 * base.x * (1.0 - metallic), 0.04 * (1.0 - metallic) + base.x * metallic]
    }

    #[test]
    fn greys_scatter_and_reflect_as_before() {
        for d in [0.0, 0.02, 0.3, 0.8, 1.0] {
            for s in [0.04, 0.1, 0.3, 0.6, 0.95, 1.0] {
                let got = metallic_model(solve(Vec3::splat(d), Vec3::splat(s)));
                let expected = [d * (1.0 - s), s];
                for (got, expected) in got.iter().zip(expected) {
                    assert!((got - expected).abs() < 2e-3, "diffuse {d}, specular {s}: {got} for {expected}");
                }
            }
        }
        let swapped = metallic_model(solve(Vec3::splat(0.3), Vec3::splat(0.8)));
        assert!((swapped[0] - 0.8 * 0.7).abs() > 0.1, "can fail: diffuse and specular exchanged");
    }

    #[test]
    fn common_dielectrics_keep_their_colour() {
        let red = Vec3::new(0.8, 0.1, 0.1);
        let (base, metallic) = solve(red, Vec3::splat(0.04));
        assert!(base.abs_diff_eq(red, 1e-6) && metallic == 0.0, "{base} {metallic}");
        let (gold, metal) = solve(Vec3::ZERO, Vec3::new(1.0, 0.77, 0.34));
        assert!(gold.abs_diff_eq(Vec3::new(1.0, 0.77, 0.34), 1e-4) && metal > 0.999, "{gold} {metal}");
    }

    #[test]
    fn bytes_survive_decoding_and_encoding() {
        assert!((0..=255).all(|byte| srgb(linear_from_srgb(byte)) == byte));
    }
}
