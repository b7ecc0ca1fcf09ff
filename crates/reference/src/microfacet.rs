//! Microfacets of GGX: Heitz' visible normals, height-correlated shadowing, and what they reflect of a white sky.

use crate::lobe::{alpha_of, cell};
use glam::Vec3;
use rayon::prelude::*;
use std::f32::consts::{PI, TAU};
use std::sync::LazyLock;

/// Entries of the table of [`directional_albedo`] by roughness, and by the root of the cosine.
const ROWS: usize = 33;
/// Points along each side of the square of an entry's sum.
const SIDE: usize = 64;
/// Least cosine of the view.
const LEAST_COSINE: f32 = 1e-4;

/// Facets of one roughness seen from one direction; local z is the normal.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Facets {
    alpha: f32,
    /// Unit, towards the eye, above the surface.
    view: Vec3,
}

impl Facets {
    pub(crate) fn new(alpha: f32, view: Vec3) -> Self {
        Self { alpha, view: Vec3::new(view.x, view.y, view.z.max(LEAST_COSINE)).normalize() }
    }

    /// `D G2 / (4 cos view)`, the BRDF times the cosine of `light` without the Fresnel term, `D G1 / (4 cos view)`, the density of
    /// [`Self::sample`], and the cosine of facet and view.
    pub(crate) fn at(&self, light: Vec3) -> [f32; 3] {
        let half = (self.view + light).normalize_or_zero();
        if light.z <= 0.0 || half.z <= 0.0 {
            return [0.0, 0.0, 1.0];
        }
        let a = self.alpha * self.alpha;
        let base = half.z * half.z * a + half.x * half.x + half.y * half.y;
        let density = a / (PI * base * base) / (4.0 * self.view.z);
        let [seen, lit] = [self.hidden(self.view), self.hidden(light)];
        [density / (1.0 + seen + lit), density / (1.0 + seen), self.view.dot(half)]
    }

    /// Smith's Lambda.
    fn hidden(&self, d: Vec3) -> f32 {
        let slope = self.alpha * self.alpha * (d.x * d.x + d.y * d.y) / (d.z * d.z);
        0.5 * ((1.0 + slope).sqrt() - 1.0)
    }

    /// A direction of light, mirrored at a visible facet; it may lie below (J. Dupuy and A. Benyoub 2023, "Sampling Visible GGX
    /// Normals with Spherical Caps").
    pub(crate) fn sample(&self, [u, v]: [f32; 2]) -> Vec3 {
        let stretched = (self.view * Vec3::new(self.alpha, self.alpha, 1.0)).normalize();
        let (sin, cos) = libm::sincosf(TAU * u);
        let z = (1.0 - v) * (1.0 + stretched.z) - stretched.z;
        let radius = (1.0 - z * z).max(0.0).sqrt();
        let sum = Vec3::new(radius * cos, radius * sin, z) + stretched;
        let facet = (sum * Vec3::new(self.alpha, self.alpha, 1.0)).normalize_or(Vec3::Z);
        (facet * (2.0 * self.view.dot(facet)) - self.view).normalize()
    }

    /// Factor of the normal reflectance, and the rest, that Schlick's formula has under a white sky: a sum over visible facets.
    fn white(&self) -> [f32; 2] {
        let (mut scale, mut bias) = (0.0, 0.0);
        for k in 0..SIDE * SIDE {
            let square = [k % SIDE, k / SIDE].map(|i| (i as f32 + 0.5) / SIDE as f32);
            let light = self.sample(square);
            let [reflected, density, cosine] = self.at(light);
            if density > 0.0 {
                let (share, rest) = (reflected / density, schlick(cosine));
                scale += f64::from(share * (1.0 - rest));
                bias += f64::from(share * rest);
            }
        }
        [scale, bias].map(|sum| (sum / (SIDE * SIDE) as f64) as f32)
    }
}

/// `(1 - cosine)^5`.
pub(crate) fn schlick(cosine: f32) -> f32 {
    let grazing = (1.0 - cosine).clamp(0.0, 1.0);
    grazing * grazing * (grazing * grazing) * grazing
}

static WHITE: LazyLock<Vec<[f32; 2]>> = LazyLock::new(|| {
    let entry = |i: usize| {
        let [roughness, root] = [i / ROWS, i % ROWS].map(|k| k as f32 / (ROWS - 1) as f32);
        let cosine = (root * root).max(LEAST_COSINE);
        Facets::new(alpha_of(roughness), Vec3::new((1.0 - cosine * cosine).sqrt(), 0.0, cosine)).white()
    };
    (0..ROWS * ROWS).into_par_iter().map(entry).collect()
});

/// Share of a white sky that GGX with height-correlated Smith shadowing and Schlick's Fresnel term reflects, per channel, from a table
/// of its integral.
///
/// `f0` is the reflectance at normal incidence, `roughness` perceptual in [0, 1], `cosine` that of normal and view in [0, 1].
#[must_use]
pub fn directional_albedo(f0: Vec3, roughness: f32, cosine: f32) -> Vec3 {
    let (row, down) = cell(f64::from(roughness), ROWS);
    let (column, along) = cell(f64::from(cosine.max(0.0).sqrt()), ROWS);
    let read = |k: usize| {
        let at = |row: usize, column: usize| WHITE[row * ROWS + column][k];
        let line = |row: usize| at(row, column) + along * (at(row, column + 1) - at(row, column));
        line(row) + down * (line(row + 1) - line(row))
    };
    f0 * read(0) + read(1)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The BRDF times cosine over all directions of light, by a rule that knows nothing of facets.
    fn by_light(roughness: f32, cosine: f32, f0: f32) -> f64 {
        let facets = Facets::new(alpha_of(roughness), Vec3::new((1.0 - cosine * cosine).sqrt(), 0.0, cosine));
        testkit::quadrature::sphere_quadrature(600)
            .into_iter()
            .filter(|(d, _)| d[2] > 0.0)
            .map(|(d, weight)| {
                let [reflected, _, facing] = facets.at(glam::DVec3::from(d).as_vec3());
                weight * f64::from(reflected * (f0 + (1.0 - f0) * schlick(facing)))
            })
            .sum()
    }

    #[test]
    fn table_is_the_integral() {
        for roughness in [0.4, 0.66, 1.0] {
            for cosine in [0.05, 0.3, 0.72, 1.0] {
                for f0 in [0.04, 1.0] {
                    let read = directional_albedo(Vec3::splat(f0), roughness, cosine).x;
                    testkit::assert_close!(
                        read,
                        by_light(roughness, cosine, f0),
                        4e-3,
                        0.0,
                        "{roughness} {cosine} {f0}"
                    );
                }
            }
        }
        let other = directional_albedo(Vec3::ONE, 0.9, 0.3).x;
        assert!(!testkit::close(f64::from(other), by_light(0.6, 0.3, 1.0), 4e-3, 0.0), "can fail");
    }

    /// Light and eye change places.
    #[test]
    fn facets_are_reciprocal() {
        let [a, b] = [Vec3::new(0.6, 0.0, 0.8), Vec3::new(-0.3, 0.5, 0.4).normalize()];
        for alpha in [0.05, 0.3, 1.0] {
            let forth = Facets::new(alpha, a).at(b)[0] / b.z;
            let back = Facets::new(alpha, b).at(a)[0] / a.z;
            testkit::assert_close!(forth, back, 0.0, 1e-5);
            let bare = [Facets::new(alpha, a).at(b)[1] / b.z, Facets::new(alpha, b).at(a)[1] / a.z];
            assert!(
                alpha < 0.1 || !testkit::close(f64::from(bare[0]), f64::from(bare[1]), 0.0, 1e-5),
                "can fail: one-sided shadowing"
            );
        }
    }
}
