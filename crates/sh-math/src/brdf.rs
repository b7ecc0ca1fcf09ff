//! What glTF's surfaces return of a white sky: its mirror, and what the diffuse part below keeps.
//!
//! glTF 2.0, appendix B: a dielectric is `mix(diffuse, specular, F)`, `F = 0.04 + 0.96 (1 - V.H)^5`; a metal is the same microfacets with
//! its colour for 0.04; both are mixed by metallic. With `F0 = 0.04 (1 - metallic) + base metallic` a surface under a white sky returns
//! `F0 A + B` by its mirror ([`environment_brdf`]) and `base (1 - metallic) (1 - T)` by its diffuse part ([`diffuse_loss`]).

/// Normal reflectance of dielectrics: refractive index 1.5.
pub const DIELECTRIC: f32 = 0.04;

/// Mean of [`diffuse_loss`] over a hemisphere of views, each by its cosine.
pub const MEAN_DIFFUSE_LOSS: f32 = 0.043_537;

/// `[power of roughness][j][i]`, i the power of `u = alpha / (alpha + cosine)`, j that of `1 - cosine` among 0, 1, 5 and 8.
type Fit = [[[f32; 4]; 4]; 3];

/// A + B. Least squares on 33 roughnesses by 53 cosines, weighted by min(1, cosine / 0.05): within 0.004 where the cosine is 0.1 or more, of
/// the integral of GGX with height-correlated Smith shadowing.
const WHITE: Fit = [
    [
        [1.0, -1.284, -13.606, 10.18],
        [0.0, 1.025, -2.369, -9.968],
        [0.001, -1.392, 20.213, 2.203],
        [-0.002, 1.65, -5.062, -1.634],
    ],
    [
        [0.117, 8.95, -16.426, -7.473],
        [-0.018, -0.008, 48.731, -17.998],
        [-1.417, -17.749, -17.165, 11.189],
        [1.391, 4.126, 1.235, 2.664],
    ],
    [
        [-0.635, 1.674, 12.911, -7.238],
        [-0.22, -6.286, -12.746, 7.508],
        [15.144, 1.73, -4.512, -6.068],
        [1.479, 1.645, -7.772, 3.257],
    ],
];
/// B, likewise.
const BIAS: Fit = [
    [
        [0.0, -0.706, -4.903, 0.192],
        [0.0, -0.05, -7.249, 1.173],
        [1.001, -3.534, 7.53, -4.614],
        [-0.001, 4.169, 4.732, 3.096],
    ],
    [
        [0.014, 1.479, 1.958, -2.707],
        [0.168, 10.236, 11.682, -14.919],
        [-1.469, -20.121, 10.623, 10.018],
        [1.535, 1.847, -10.369, -1.706],
    ],
    [
        [0.445, 1.101, -1.245, -0.264],
        [-1.67, -8.858, 10.662, -1.142],
        [18.236, 1.101, -10.553, -15.143],
        [7.577, -3.025, -0.115, 3.849],
    ],
];
/// `int (1 - V.H)^5 cos / pi` over directions of light, by powers of the cosine of the view: within 1e-5.
const GRAZING: [f32; 5] = [0.028_16, -0.0798, 0.086_27, -0.0434, 0.008_86];
/// A + B and B over a hemisphere of views, by powers of roughness: within 3e-4.
const MEAN_WHITE: [f32; 7] = [1.0, 0.0001, 0.0076, -0.3493, -2.9685, 4.2889, -1.5697];
const MEAN_BIAS: [f32; 7] = [0.0474, 0.0134, -0.1023, -0.7513, 2.2588, -2.193, 0.7299];

/// Scale A and bias B of the normal reflectance: the microfacets of GGX integrated over a white sky.
///
/// The split sum of Karis 2013 ("Real Shading in Unreal Engine 4") as a fit; `roughness` is perceptual, `cosine` that of normal and view,
/// both in [0, 1]. Light that a facet sends to another is lost, as in glTF's model.
#[must_use]
pub fn environment_brdf(roughness: f32, cosine: f32) -> [f32; 2] {
    let alpha = roughness * roughness;
    let u = alpha / (alpha + cosine).max(1e-6);
    let h = 1.0 - cosine;
    let fifth = (h * h) * (h * h) * h;
    let (shadow, grazing) = ([1.0, u, u * u, u * u * u], [1.0, h, fifth, fifth * (h * h) * h]);
    let powers = [1.0, roughness, alpha];
    let fit = |fit: &Fit| {
        let mut sum = 0.0;
        for (j, grazing) in grazing.iter().enumerate() {
            // Four at a time, which compilers make one of; their sum keeps its order.
            let factors: [f32; 4] =
                std::array::from_fn(|i| powers[0] * fit[0][j][i] + powers[1] * fit[1][j][i] + powers[2] * fit[2][j][i]);
            let terms: [f32; 4] = std::array::from_fn(|i| grazing * shadow[i] * factors[i]);
            terms.iter().for_each(|term| sum += term);
        }
        sum
    };
    let bias = fit(&BIAS).clamp(0.0, 1.0);
    [(fit(&WHITE) - bias).clamp(0.0, 1.0), bias]
}

/// T: the share of a white sky that the mirror of a dielectric takes from the diffuse part below, seen under `cosine` in [0, 1].
///
/// `int F(V.H) cos / pi` over directions of light. Roughness plays no part in it, since glTF takes F at the half vector of the macroscopic
/// directions; so it is 0.041 to 0.067.
#[must_use]
pub fn diffuse_loss(cosine: f32) -> f32 {
    DIELECTRIC + (1.0 - DIELECTRIC) * polynomial(&GRAZING, cosine)
}

/// The means of A and B over a hemisphere of views, each by its cosine: what a surface returns of a white sky to all sides.
#[must_use]
pub fn mean_environment_brdf(roughness: f32) -> [f32; 2] {
    let bias = polynomial(&MEAN_BIAS, roughness);
    [polynomial(&MEAN_WHITE, roughness) - bias, bias]
}

fn polynomial(factors: &[f32], x: f32) -> f32 {
    factors.iter().rev().fold(0.0, |sum, factor| sum * x + factor)
}
