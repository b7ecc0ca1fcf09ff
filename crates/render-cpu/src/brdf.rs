//! How much of a prefiltered reflection a surface returns.

use glam::Vec3;

/// Normal reflectance of dielectrics: refractive index 1.5.
const DIELECTRIC: f32 = 0.04;

/// Scale and bias of the normal reflectance: the GGX BRDF integrated over a white environment.
///
/// Karis 2014, "Physically Based Shading on Mobile" (a fit after Lazarov 2013); `roughness` is perceptual, `cosine` that of normal and view.
pub fn environment_brdf(roughness: f32, cosine: f32) -> [f32; 2] {
    let r0 = 1.0 - roughness;
    let r1 = 0.0425 - 0.0275 * roughness;
    let r2 = 1.04 - 0.572 * roughness;
    let r3 = 0.022 * roughness - 0.04;
    let g = (r0 * r0).min(libm::exp2f(-9.28 * cosine)) * r0 + r1;
    [r2 - 1.04 * g, r3 + 1.04 * g]
}

/// Share of the reflection that is returned, per channel.
pub(crate) fn reflectance(base: Vec3, metallic: f32, roughness: f32, cosine: f32) -> Vec3 {
    let normal_reflectance = Vec3::splat(DIELECTRIC * (1.0 - metallic)) + base * metallic;
    let [scale, bias] = environment_brdf(roughness, cosine);
    normal_reflectance * scale + bias
}
