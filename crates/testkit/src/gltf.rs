//! The surfaces of glTF 2.0 as appendix B writes them down, and what they return of a white sky by quadrature: an oracle for all that shines.

use crate::quadrature::gauss_legendre;
use std::f64::consts::PI;

/// Points of the rules along one axis.
const POINTS: usize = 160;

/// One channel of an opaque material.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Surface {
    /// Base colour, linear.
    pub base: f64,
    /// In [0, 1].
    pub metallic: f64,
    /// Perceptual, in [0, 1].
    pub roughness: f64,
}

impl Surface {
    /// `material = mix(dielectric_brdf, metal_brdf, metallic)` of two unit directions in a frame whose z is the normal; 0 below the surface.
    #[must_use]
    pub fn brdf(&self, view: [f64; 3], light: [f64; 3]) -> f64 {
        if view[2] <= 0.0 || light[2] <= 0.0 {
            return 0.0;
        }
        let sum: [f64; 3] = std::array::from_fn(|i| view[i] + light[i]);
        let length = sum.iter().map(|x| x * x).sum::<f64>().sqrt();
        let half = sum.map(|x| x / length);
        let facing: f64 = (0..3).map(|i| view[i] * half[i]).sum();
        let a2 = self.alpha().powi(2);
        let d = a2 / (PI * (half[2] * half[2] * (a2 - 1.0) + 1.0).powi(2));
        self.mixed(d * self.masking(view[2], light[2]), 1.0 / PI, facing)
    }

    /// Share of a white sky that a view of that cosine sees: the integral of BRDF times cosine, to about 1e-4.
    #[must_use]
    pub fn of_white_sky(&self, cosine: f64) -> f64 {
        let sine = (1.0 - cosine * cosine).sqrt();
        let a2 = self.alpha().powi(2);
        let unit: Vec<(f64, f64)> =
            gauss_legendre(POINTS).into_iter().map(|(x, w)| ((x + 1.0) / 2.0, w / 2.0)).collect();
        let mut sum = 0.0;
        for &(x, weight) in &unit {
            // Facets: their share by cumulated distribution, crowded at the tail; d(light) = 4 (v.h) d(facet).
            let share = 1.0 - (1.0 - x).powi(3);
            let cos = 1.0 / (1.0 + a2 * share / (1.0 - share)).sqrt();
            let density = weight * 3.0 * (1.0 - x).powi(2) / cos;
            for k in 0..POINTS {
                let turn = (PI * (k as f64 + 0.5) / POINTS as f64).cos();
                let facing = sine * (1.0 - cos * cos).sqrt() * turn + cosine * cos;
                let light = 2.0 * facing * cos - cosine;
                if facing > 0.0 && light > 0.0 {
                    let mirrored = 4.0 * facing * light * self.masking(cosine, light);
                    sum += density / POINTS as f64 * self.mixed(mirrored, 0.0, facing);
                }
                // The body: light of cosine x, uniform in its square.
                let between = sine * (1.0 - x * x).sqrt() * turn + cosine * x;
                let facing = ((1.0 + between) / 2.0).max(0.0).sqrt();
                sum += 2.0 * x * weight / POINTS as f64 * self.mixed(0.0, 1.0, facing);
            }
        }
        sum
    }

    /// The mean of [`Self::of_white_sky`] over views, each by its cosine: what a ball shows from afar.
    #[must_use]
    pub fn of_white_sky_on_average(&self) -> f64 {
        let views = gauss_legendre(24).into_iter().map(|(x, w)| ((x + 1.0) / 2.0, w));
        views.map(|(cosine, weight)| weight * cosine * self.of_white_sky(cosine)).sum()
    }

    /// Sharper ones are taken for this one.
    fn alpha(&self) -> f64 {
        (self.roughness * self.roughness).max(1e-3)
    }

    /// `V`, of height-correlated Smith shadowing.
    fn masking(&self, view: f64, light: f64) -> f64 {
        let a2 = self.alpha().powi(2);
        let root = |c: f64| (a2 + (1.0 - a2) * c * c).sqrt();
        0.5 / (light * root(view) + view * root(light))
    }

    /// Both kinds of the material from `D V` and the diffuse lobe, `facing` the cosine of view and half vector.
    fn mixed(&self, specular: f64, diffuse: f64, facing: f64) -> f64 {
        let schlick = (1.0 - facing.abs()).powi(5);
        let fresnel = 0.04 + (1.0 - 0.04) * schlick;
        let dielectric = diffuse * self.base * (1.0 - fresnel) + specular * fresnel;
        let metal = specular * (self.base + (1.0 - self.base) * schlick);
        dielectric + (metal - dielectric) * self.metallic
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::quadrature::sphere_quadrature;

    /// The rule of facets against a plain sum over directions of light.
    #[test]
    fn both_rules_agree() {
        for (metallic, roughness, cosine) in [(0.0, 0.5, 0.8), (1.0, 0.7, 0.3), (0.4, 1.0, 0.6)] {
            let surface = Surface { base: 0.6, metallic, roughness };
            let view = [(1.0f64 - cosine * cosine).sqrt(), 0.0, cosine];
            let sum = |surface: Surface| -> f64 {
                sphere_quadrature(500).into_iter().map(|(d, w)| w * surface.brdf(view, d) * d[2].max(0.0)).sum()
            };
            let (own, other) = (sum(surface), sum(Surface { base: 0.62, ..surface }));
            assert!((own - surface.of_white_sky(cosine)).abs() < 1e-3, "{own} {}", surface.of_white_sky(cosine));
            assert!((other - surface.of_white_sky(cosine)).abs() > 1e-3, "can fail");
        }
    }
}
