//! What surfaces mirror: the model, and which materials do.

use scene::{Material, Scene};

/// Metallic share above which a material mirrors.
const METALLIC: f32 = 0.05;
/// Perceptual roughness below which a dielectric mirrors.
const SHINY: f32 = 0.6;

/// A family of lobes, radially symmetric about the mirror direction.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Lobe {
    /// In proportion to `cos^s`, `s = (1 / alpha^2 - 1) / 2`, `alpha` the square of the perceptual roughness.
    Phong,
    /// In proportion to `D(t/2) cos t`, D the normal distribution of GGX, t from the mirror direction.
    Ggx,
}

/// How light is mirrored.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Mirroring {
    /// What renderers draw, without bands: a lobe about the mirror direction, over its energy above the surface, times
    /// [`crate::directional_albedo`].
    Lobe(Lobe),
    /// GGX with height-correlated Smith shadowing and Schlick's Fresnel term (B. Walter et al. 2007; E. Heitz 2014).
    Microfacet,
}

/// What surfaces mirror; of a dielectric's light the diffuse part below gets what the mirror leaves, as glTF 2.0 has it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Gloss {
    /// The model.
    pub mirroring: Mirroring,
    /// One perceptual roughness in [0, 1] for all that shines, in place of the materials' own.
    pub roughness: Option<f32>,
    /// Whether normal maps bend the normal that mirrors; that of diffuse light is the world's choice.
    pub bent: bool,
}

impl Gloss {
    /// A model with the materials' own roughness and normal maps, as renderers draw it.
    #[must_use]
    pub fn new(mirroring: Mirroring) -> Self {
        Self { mirroring, roughness: None, bent: true }
    }
}

/// Whether each material mirrors anywhere: somewhat metallic, or smooth, in its factors and texels.
pub(crate) fn shining(scene: &Scene) -> Vec<bool> {
    scene.materials.iter().map(|material| shines(scene, material)).collect()
}

fn shines(scene: &Scene, material: &Material) -> bool {
    let shows = |[_, roughness, metallic, _]: [u8; 4]| {
        material.metallic * (f32::from(metallic) / 255.0) > METALLIC
            || material.roughness * (f32::from(roughness) / 255.0) < SHINY
    };
    let Some(slot) = material.metallic_roughness_texture else { return shows([255; 4]) };
    let texels = &scene.textures[slot.texture as usize].rgba;
    texels.iter().any(|texel| shows(*texel)) || (texels.is_empty() && shows([255; 4]))
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::Affine2;
    use scene::{Texture, TextureSlot};

    fn with_texels(metallic: f32, roughness: f32, rgba: Vec<[u8; 4]>) -> bool {
        let slot = TextureSlot { texture: 0, uv_set: 0, transform: Affine2::IDENTITY };
        let material = Material { metallic, roughness, metallic_roughness_texture: Some(slot), ..Material::default() };
        let texture = Texture { width: rgba.len() as u32, rgba, ..Texture::white("t") };
        let scene = Scene { textures: vec![texture], materials: vec![material], ..Scene::default() };
        shining(&scene)[0]
    }

    #[test]
    fn smooth_or_metal_texels_shine() {
        assert!(with_texels(0.0, 1.0, vec![[0, 255, 0, 255], [0, 20, 0, 255]]), "a smooth texel");
        assert!(with_texels(1.0, 1.0, vec![[0, 255, 0, 255], [0, 255, 255, 255]]), "a metal texel");
        assert!(!with_texels(1.0, 1.0, vec![[0, 255, 0, 255]]), "rough and no metal");
        let plain = |metallic, roughness| Material { metallic, roughness, ..Material::default() };
        let scene = Scene { materials: vec![plain(0.0, 0.59), plain(0.0, 0.61), plain(0.06, 1.0)], ..Scene::default() };
        assert_eq!(shining(&scene), [true, false, true]);
    }
}
