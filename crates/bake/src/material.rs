//! What a material can do to light at most, over all its texels and vertex colours: the facts that plans rest on.

use crate::albedo::{Albedo, Colors};
use glam::Vec4;
use scene::{AlphaMode, Material, Scene};
use sh_math::brdf::DIELECTRIC;

/// Perceptual roughness below which a dielectric shows a reflection that is worth drawing.
const SHINY: f32 = 0.6;
/// Metallic share above which a surface shows a reflection.
const METALLIC: f32 = 0.05;

/// Bounds over a whole material. A material that no triangle shows does nothing.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Facts {
    /// Diffuse albedo.
    pub(crate) albedo: Albedo,
    /// Whether rays stop at it.
    pub(crate) blocks: bool,
    /// Whether it blends or transmits.
    pub(crate) transmits: bool,
    /// Whether it stops a part of the light and passes another.
    pub(crate) translucent: bool,
    /// Largest share of light from behind that it hides: 1 where rays stop at it.
    pub(crate) opacity: f32,
    /// Whether light that passes through it takes its colour.
    pub(crate) stains: bool,
    /// Whether it has an alpha mask.
    pub(crate) masked: bool,
    /// Share of the mask's texels below the cutoff, at most; 0 only where no point of the surface can be missing.
    pub(crate) holes: f32,
    /// Whether it shows a reflection that is worth drawing.
    pub(crate) shines: bool,
    /// Whether it mirrors light in its colour: a coloured metal.
    pub(crate) tinted: bool,
    /// Largest reflectance at normal incidence.
    pub(crate) reflectance: f32,
    /// Whether it has a normal map that bends something.
    pub(crate) bumpy: bool,
    /// Mean sine of the angle by which its normal map bends: the share of a light from the side that this adds or takes.
    pub(crate) bend: f32,
    /// Largest radiance that it emits.
    pub(crate) emission: f32,
    /// Largest share of light that passes through.
    pub(crate) passes: f32,
}

impl Facts {
    /// Looks at every texel and vertex colour of one material.
    pub(crate) fn of(scene: &Scene, index: usize) -> Self {
        let material = &scene.materials[index];
        let albedo = Albedo::of(scene, index);
        if !shown(scene, index) {
            return Self::nothing(albedo);
        }
        let gloss = Colors::linear(scene, material.metallic_roughness_texture);
        let metallic = material.metallic * gloss.largest.z;
        let color = Colors::srgb(scene, material.base_color_texture).largest * material.base_color.truncate();
        let passed = passes(scene, material, index);
        let translucent = !material.blocks_rays() && passed > 0.0;
        let opacity = if translucent { opacity(scene, material, index) } else { 1.0 };
        let clear = material.transmission > 0.0 && !is_white(scene, material, index);
        let bend = mean_bend(scene, material);
        let glow = Colors::srgb(scene, material.emissive_texture).largest * material.emissive;
        Self {
            albedo,
            blocks: !translucent,
            transmits: !material.blocks_rays(),
            translucent: translucent && (opacity > 0.0 || clear),
            opacity,
            stains: translucent && clear && is_colored(scene, material, index),
            masked: material.is_masked(),
            holes: hole_share(scene, index),
            shines: metallic > METALLIC || material.roughness * gloss.smallest.y < SHINY,
            tinted: metallic > METALLIC && is_colored(scene, material, index),
            reflectance: DIELECTRIC.max(metallic * color.max_element()).min(1.0),
            bumpy: bend > 0.0,
            bend,
            emission: glow.max_element(),
            passes: passed,
        }
    }

    fn nothing(albedo: Albedo) -> Self {
        Self {
            albedo,
            blocks: false,
            transmits: false,
            translucent: false,
            opacity: 0.0,
            stains: false,
            masked: false,
            holes: 0.0,
            shines: false,
            tinted: false,
            reflectance: 0.0,
            bumpy: false,
            bend: 0.0,
            emission: 0.0,
            passes: 0.0,
        }
    }

    /// Whether light that falls on it from elsewhere meets it.
    pub(crate) fn scatters(&self) -> bool {
        self.blocks || self.translucent && self.opacity > 0.0
    }

    /// Whether a surface of this material scatters no light, whatever arrives.
    pub(crate) fn is_black(&self) -> bool {
        self.albedo.largest <= 0.0
    }
}

/// Share of the texels of a mask that lie below its cutoff where the vertices cover least. Where it is 0 no filtered
/// value lies below, so no point of the surface is missing.
pub(crate) fn hole_share(scene: &Scene, index: usize) -> f32 {
    let material = &scene.materials[index];
    let AlphaMode::Mask(cutoff) = material.alpha else { return 0.0 };
    let factor = material.base_color.w * vertex_alpha(scene, index);
    let missing = |alpha: f32| factor * alpha < cutoff;
    match material.base_color_texture.map(|slot| &scene.textures[slot.texture as usize]) {
        None => f32::from(u8::from(missing(1.0))),
        Some(texture) => {
            let count = texture.rgba.iter().filter(|texel| missing(f32::from(texel[3]) / 255.0)).count();
            count as f32 / texture.rgba.len().max(1) as f32
        }
    }
}

/// Mean sine of the angle between what a normal map says and the plain normal; texels within rounding of it count as plain.
fn mean_bend(scene: &Scene, material: &Material) -> f32 {
    let Some(slot) = material.normal_texture else { return 0.0 };
    let scale = f64::from(material.normal_scale);
    let sine = |texel: &[u8; 4]| {
        let [x, y, z] = [texel[0], texel[1], texel[2]].map(|value| 2.0 * f64::from(value) / 255.0 - 1.0);
        // 127 and 128 stand for 0.
        let [x, y] = [x, y].map(|value| if value.abs() < 1.1 / 255.0 { 0.0 } else { scale * value });
        let aside = x * x + y * y;
        let length = aside + z.max(0.0).powi(2);
        if length > 0.0 { (aside / length).sqrt() } else { 0.0 }
    };
    let texels = &scene.textures[slot.texture as usize].rgba;
    (texels.iter().map(sine).sum::<f64>() / texels.len().max(1) as f64) as f32
}

/// Largest share of light that passes through a surface that transmits or blends.
fn passes(scene: &Scene, material: &Material, index: usize) -> f32 {
    if material.alpha != AlphaMode::Blend {
        return material.transmission;
    }
    let texels = material.base_color_texture.map(|slot| &scene.textures[slot.texture as usize].rgba);
    let least = texels.and_then(|t| t.iter().map(|texel| texel[3]).min()).map_or(1.0, |a| f32::from(a) / 255.0);
    let covered = material.base_color.w * vertex_alpha(scene, index) * least;
    (1.0 - covered * (1.0 - material.transmission)).clamp(0.0, 1.0)
}

/// Largest share of light from behind that a surface that transmits or blends hides.
fn opacity(scene: &Scene, material: &Material, index: usize) -> f32 {
    let hidden = (1.0 - material.transmission).clamp(0.0, 1.0);
    if material.alpha != AlphaMode::Blend {
        return hidden;
    }
    let texels = material.base_color_texture.map(|slot| &scene.textures[slot.texture as usize].rgba);
    let most = texels.and_then(|t| t.iter().map(|texel| texel[3]).max()).map_or(1.0, |a| f32::from(a) / 255.0);
    let meshes = scene.meshes.iter().filter(|mesh| mesh.material as usize == index);
    let vertices = meshes.map(|m| if m.colors.is_empty() { 1.0 } else { m.colors.iter().fold(0.0, |a, c| c.w.max(a)) });
    (material.base_color.w * most * vertices.fold(0.0, f32::max)).clamp(0.0, 1.0) * hidden
}

/// Whether the base colour is white everywhere, so that nothing is absorbed of what it transmits.
fn is_white(scene: &Scene, material: &Material, index: usize) -> bool {
    let mut meshes = scene.meshes.iter().filter(|mesh| mesh.material as usize == index);
    let texels = material.base_color_texture.map(|slot| &scene.textures[slot.texture as usize].rgba);
    material.base_color.truncate().min_element() >= 1.0
        && texels.is_none_or(|texels| texels.iter().all(|texel| texel[..3] == [255; 3]))
        && meshes.all(|mesh| mesh.colors.iter().all(|color| color.truncate().min_element() >= 1.0))
}

/// The least alpha of the vertex colours of a material; 1 where there are none.
fn vertex_alpha(scene: &Scene, index: usize) -> f32 {
    let meshes = scene.meshes.iter().filter(|mesh| mesh.material as usize == index);
    meshes.flat_map(|mesh| &mesh.colors).map(|color| color.w).fold(1.0, f32::min)
}

/// Whether the base colour may differ between channels.
fn is_colored(scene: &Scene, material: &Material, index: usize) -> bool {
    let differs = |color: &Vec4| color.x != color.y || color.y != color.z;
    let mut meshes = scene.meshes.iter().filter(|mesh| mesh.material as usize == index);
    let grey = |texel: &[u8; 4]| texel[0] == texel[1] && texel[1] == texel[2];
    let texels = material.base_color_texture.map(|slot| &scene.textures[slot.texture as usize].rgba);
    differs(&material.base_color)
        || texels.is_some_and(|texels| !texels.iter().all(grey))
        || meshes.any(|mesh| mesh.colors.iter().any(differs))
}

fn shown(scene: &Scene, index: usize) -> bool {
    scene.meshes.iter().any(|mesh| mesh.material as usize == index && !mesh.triangles.is_empty())
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::{Affine2, Vec3, Vec4};
    use scene::{Mesh, Texture, TextureSlot};

    fn slot() -> Option<TextureSlot> {
        Some(TextureSlot { texture: 0, uv_set: 0, transform: Affine2::IDENTITY })
    }

    fn facts(material: Material, texels: &[[u8; 4]]) -> Facts {
        let mesh = Mesh { positions: vec![Vec3::ZERO; 3], triangles: vec![[0, 1, 2]], ..Mesh::default() };
        let texture = Texture { rgba: texels.to_vec(), width: texels.len() as u32, ..Texture::white("t") };
        let scene =
            Scene { meshes: vec![mesh], materials: vec![material], textures: vec![texture], ..Scene::default() };
        Facts::of(&scene, 0)
    }

    /// A mask whose every texel is there hides nothing; one texel below the cutoff is a hole.
    #[test]
    fn only_texels_below_the_cutoff_are_holes() {
        let leaf = || Material { alpha: AlphaMode::Mask(0.5), base_color_texture: slot(), ..Material::default() };
        assert_eq!(facts(leaf(), &[[255; 4], [0, 0, 0, 128]]).holes, 0.0);
        assert_eq!(facts(leaf(), &[[255; 4], [0, 0, 0, 127]]).holes, 0.5, "can fail");
        let thin = Material { base_color: Vec4::new(1.0, 1.0, 1.0, 0.25), ..leaf() };
        assert_eq!(facts(thin, &[[255; 4]]).holes, 1.0, "the factor alone is below the cutoff");
        let opaque = Material { alpha: AlphaMode::Opaque, ..leaf() };
        assert_eq!(facts(opaque, &[[0; 4]]).holes, 0.0, "an opaque material has no holes");
    }

    /// The texture tells where a surface is smooth or metal, not the factors.
    #[test]
    fn shine_is_found_in_the_texture() {
        let painted = |metallic, roughness| Material {
            metallic,
            roughness,
            metallic_roughness_texture: slot(),
            ..Material::default()
        };
        assert!(facts(painted(0.0, 1.0), &[[0, 255, 0, 255], [0, 20, 0, 255]]).shines, "a smooth texel");
        assert!(facts(painted(1.0, 1.0), &[[0, 255, 0, 255], [0, 255, 255, 255]]).shines, "a metal texel");
        assert!(!facts(painted(1.0, 1.0), &[[0, 255, 0, 255]]).shines, "can fail: rough and no metal");
    }

    /// A flat normal map bends nothing; one that leans by 45 degrees in half of its texels bends by half the sine.
    #[test]
    fn only_texels_that_lean_bend() {
        let bumpy = || Material { normal_texture: slot(), ..Material::default() };
        let flat = facts(bumpy(), &[[128, 128, 255, 255], [127, 128, 255, 255]]);
        assert!(!flat.bumpy && flat.bend == 0.0);
        let leaning = facts(bumpy(), &[[128, 128, 255, 255], [218, 128, 218, 255]]);
        assert!(leaning.bumpy && (leaning.bend - 0.5 * 0.5f32.sqrt()).abs() < 1e-3, "{}", leaning.bend);
        let scaled = Material { normal_scale: 0.0, ..bumpy() };
        assert!(!facts(scaled, &[[218, 128, 218, 255]]).bumpy);
    }

    #[test]
    fn a_black_emission_texture_emits_nothing() {
        let lamp = Material { emissive: Vec3::splat(3.0), emissive_texture: slot(), ..Material::default() };
        assert_eq!(facts(lamp.clone(), &[[0, 0, 0, 255]]).emission, 0.0);
        assert_eq!(facts(lamp, &[[255; 4]]).emission, 3.0, "can fail");
    }

    #[test]
    fn glass_passes_what_it_does_not_cover() {
        let pane = Material { alpha: AlphaMode::Blend, base_color: Vec4::splat(0.25), ..Material::default() };
        assert_eq!(facts(pane, &[[255; 4]]).passes, 0.75);
        let clear = Material { transmission: 0.9, ..Material::default() };
        assert_eq!(facts(clear, &[[255; 4]]).passes, 0.9);
    }
}
