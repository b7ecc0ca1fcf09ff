//! How much of a prefiltered reflection a surface returns.

use glam::Vec3;
use sh_math::brdf::DIELECTRIC;
pub use sh_math::brdf::environment_brdf;

/// Share of the reflection that is returned, per channel.
pub(crate) fn reflectance(base: Vec3, metallic: f32, roughness: f32, cosine: f32) -> Vec3 {
    let normal_reflectance = Vec3::splat(DIELECTRIC * (1.0 - metallic)) + base * metallic;
    let [scale, bias] = environment_brdf(roughness, cosine);
    normal_reflectance * scale + bias
}
