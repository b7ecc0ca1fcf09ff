//! What a material can reflect at most, and on average, over all its texels and vertex colours.

use glam::Vec3;
use scene::{Scene, Texture, TextureSlot, linear_from_srgb};

/// Difference between channels from which an albedo counts as coloured; below one step of 8 bits.
const COLORED: f32 = 2e-3;

/// Bounds of the diffuse albedo of a material. Too much costs bytes, too little would cost light, so products of
/// texture, tint and factor are bounded by the products of their bounds.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Albedo {
    pub(crate) mean: f32,
    pub(crate) largest: f32,
    /// Largest difference between two channels of the mean.
    pub(crate) spread: f32,
    pub(crate) colored: bool,
}

impl Albedo {
    /// Looks at every texel and every vertex colour of a material that some mesh uses.
    pub(crate) fn of(scene: &Scene, index: usize) -> Self {
        let mut meshes = scene.meshes.iter().filter(|m| m.material as usize == index).peekable();
        if meshes.peek().is_none() {
            return Self { mean: 0.0, largest: 0.0, spread: 0.0, colored: false };
        }
        let material = &scene.materials[index];
        let texels = Colors::srgb(scene, material.base_color_texture);
        let metal = Colors::linear(scene, material.metallic_roughness_texture);
        let mut tints = Colors::default();
        for mesh in meshes {
            tints.add_all(mesh.colors.iter().map(|c| c.truncate()));
            if mesh.colors.is_empty() {
                tints.add_all([Vec3::ONE].into_iter());
            }
        }
        let factor = material.base_color.truncate();
        let dielectric = |blue: f32| 1.0 - material.metallic * blue;
        let largest = factor * texels.largest * tints.largest * dielectric(metal.smallest.z);
        let mean = factor * texels.mean() * tints.mean() * dielectric(metal.mean().z);
        Self {
            mean: mean.clamp(Vec3::ZERO, Vec3::ONE).element_sum() / 3.0,
            largest: largest.max_element().clamp(0.0, 1.0),
            spread: mean.max_element() - mean.min_element(),
            // Coloured metal scatters nothing, so its colour is none of an albedo.
            colored: largest.max_element() > 0.0 && (is_colored(factor) || texels.colored || tints.colored),
        }
    }
}

/// What a list of colours spans.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Colors {
    sum: glam::DVec3,
    count: f64,
    pub(crate) smallest: Vec3,
    pub(crate) largest: Vec3,
    colored: bool,
}

impl Default for Colors {
    fn default() -> Self {
        let (smallest, largest) = (Vec3::INFINITY, Vec3::ZERO);
        Self { sum: glam::DVec3::ZERO, count: 0.0, smallest, largest, colored: false }
    }
}

impl Colors {
    /// All texels of a colour, linear; white where there is no texture.
    pub(crate) fn srgb(scene: &Scene, slot: Option<TextureSlot>) -> Self {
        Self::of_texture(scene, slot, srgb)
    }

    /// All texels of numbers that are stored as they are; ones where there is no texture.
    pub(crate) fn linear(scene: &Scene, slot: Option<TextureSlot>) -> Self {
        Self::of_texture(scene, slot, linear)
    }

    /// All texels; white where there is no texture.
    fn of_texture(scene: &Scene, slot: Option<TextureSlot>, decode: fn([u8; 4]) -> Vec3) -> Self {
        let mut colors = Self::default();
        match slot.map(|s| &scene.textures[s.texture as usize]) {
            Some(Texture { rgba, .. }) => colors.add_all(rgba.iter().map(|&t| decode(t))),
            None => colors.add_all([Vec3::ONE].into_iter()),
        }
        colors
    }

    fn add_all(&mut self, colors: impl Iterator<Item = Vec3>) {
        for color in colors {
            self.sum += color.as_dvec3();
            self.count += 1.0;
            self.smallest = self.smallest.min(color);
            self.largest = self.largest.max(color);
            self.colored |= is_colored(color);
        }
    }

    fn mean(&self) -> Vec3 {
        (self.sum / self.count.max(1.0)).as_vec3()
    }
}

fn is_colored(color: Vec3) -> bool {
    color.max_element() - color.min_element() > COLORED
}

fn srgb([r, g, b, _]: [u8; 4]) -> Vec3 {
    Vec3::new(linear_from_srgb(r), linear_from_srgb(g), linear_from_srgb(b))
}

fn linear([r, g, b, _]: [u8; 4]) -> Vec3 {
    Vec3::new(f32::from(r), f32::from(g), f32::from(b)) / 255.0
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::{Affine2, Vec4};
    use scene::{Material, Mesh, Wrap};

    fn scene(material: Material, textures: Vec<Texture>, colors: Vec<Vec4>) -> Scene {
        let mesh = Mesh { positions: vec![Vec3::ZERO; 3], triangles: vec![[0, 1, 2]], colors, ..Mesh::default() };
        Scene { meshes: vec![mesh], materials: vec![material], textures, ..Scene::default() }
    }

    fn texture(rgba: &[[u8; 4]]) -> Texture {
        Texture { rgba: rgba.to_vec(), width: rgba.len() as u32, wrap: [Wrap::Repeat; 2], ..Texture::white("t") }
    }

    fn slot(texture: u32) -> Option<TextureSlot> {
        Some(TextureSlot { texture, uv_set: 0, transform: Affine2::IDENTITY })
    }

    /// glTF's metallic factor is 1 unless said otherwise; the texture says where metal is.
    #[test]
    fn metal_factor_with_a_dielectric_texture_reflects() {
        let material = Material { metallic: 1.0, metallic_roughness_texture: slot(0), ..Material::default() };
        let dielectric = Albedo::of(&scene(material.clone(), vec![texture(&[[0, 255, 0, 255]])], Vec::new()), 0);
        assert_eq!(dielectric.largest, 1.0, "blue 0 is no metal");
        let metal = Albedo::of(&scene(material, vec![texture(&[[0, 255, 255, 255]])], Vec::new()), 0);
        assert_eq!(metal.largest, 0.0, "blue 1 is metal: can fail");
    }

    /// The first vertex colour and the first texel are black; the others are not.
    #[test]
    fn one_black_corner_hides_no_color() {
        let material = Material { base_color_texture: slot(0), ..Material::default() };
        let colors = vec![Vec4::new(0.0, 0.0, 0.0, 1.0), Vec4::new(1.0, 0.1, 0.1, 1.0), Vec4::ONE];
        let texels = texture(&[[0, 0, 0, 255], [255, 255, 255, 255]]);
        let albedo = Albedo::of(&scene(material, vec![texels], colors), 0);
        assert!(albedo.colored && albedo.largest == 1.0, "{albedo:?}");
    }
}
