//! How much of a prefiltered reflection a surface returns.

use glam::Vec3;

/// Normal reflectance of dielectrics: refractive index 1.5.
const DIELECTRIC: f32 = 0.04;

/// Rows for 1, 1 - cosine and (1 - cosine)^4, columns for 1, roughness and roughness^2.
///
/// Least squares on 24 roughnesses from 0.05 to 1 by 40 cosines from 0.02 to 1, weighted by min(1, cosine / 0.2), to the
/// integral of GGX with height-correlated Smith shadowing: factor of the normal reflectance F0 in Schlick's formula.
const SCALE: [[f32; 3]; 3] = [[0.953, 0.517, -1.22], [0.253, -1.658, 1.728], [-1.353, 3.4, -1.725]];
/// The same for the part of Schlick's formula that does not depend on F0.
const BIAS: [[f32; 3]; 3] = [[0.015, -0.07, 0.06], [-0.113, 0.504, -0.42], [1.195, -2.859, 1.75]];

/// Scale and bias of the normal reflectance: the GGX BRDF integrated over a white environment.
///
/// The split sum of Karis 2013 ("Real Shading in Unreal Engine 4"), as a polynomial; `roughness` is perceptual, `cosine`
/// that of normal and view.
pub fn environment_brdf(roughness: f32, cosine: f32) -> [f32; 2] {
    let grazing = 1.0 - cosine;
    let rows = [1.0, grazing, (grazing * grazing) * (grazing * grazing)];
    let polynomial = |table: &[[f32; 3]; 3]| {
        let row = |[a, b, c]: [f32; 3]| a + roughness * (b + roughness * c);
        (rows[0] * row(table[0]) + rows[1] * row(table[1]) + rows[2] * row(table[2])).max(0.0)
    };
    [polynomial(&SCALE), polynomial(&BIAS)]
}

/// Share of the reflection that is returned, per channel.
pub(crate) fn reflectance(base: Vec3, metallic: f32, roughness: f32, cosine: f32) -> Vec3 {
    let normal_reflectance = Vec3::splat(DIELECTRIC * (1.0 - metallic)) + base * metallic;
    let [scale, bias] = environment_brdf(roughness, cosine);
    normal_reflectance * scale + bias
}
