//! Over which directions a receiver gathers, and which of its coefficients must be right.

use glam::Vec3;
use sh_math::product::triples;
use sh_math::{Bands, zonal};
use std::f64::consts::PI;

/// The directions that count, as the density of rays over them.
#[derive(Debug, Clone)]
pub(crate) enum Domain {
    /// The cosine over pi, above the tangent plane: the transfer of a diffuse surface.
    Cosine,
    /// Evenly above the tangent plane: radiance that arrives at a surface whose normal is still to be bent.
    Hemisphere(Judge),
    /// Evenly over all directions: radiance that arrives at a point in space.
    Sphere(Judge),
}

impl Domain {
    /// Mean of every basis function over the domain about +z, where nothing is in the way.
    pub(crate) fn open(&self, bands: Bands) -> Vec<f64> {
        self.open_about(bands, Vec3::Z).into_iter().map(f64::from).collect()
    }

    /// The same about a unit normal.
    pub(crate) fn open_about(&self, bands: Bands, normal: Vec3) -> Vec<f32> {
        let mut open = vec![0.0; bands.coefficients()];
        match self {
            Self::Cosine => zonal::cosine_transfer(bands, normal, &mut open),
            Self::Hemisphere(_) => zonal::hemisphere_mean(bands, normal, &mut open),
            Self::Sphere(_) => open[0] = (0.25 / PI).sqrt() as f32,
        }
        open
    }

    /// Solid angle that a mean over the domain is to be multiplied by; the cosine is no even measure, and has its 1/pi inside.
    pub(crate) fn solid_angle(&self) -> f64 {
        match self {
            Self::Cosine => 1.0,
            Self::Hemisphere(_) => 2.0 * PI,
            Self::Sphere(_) => 4.0 * PI,
        }
    }

    /// Coordinates in the unit disk that keep areas: directions that lie evenly in the domain lie evenly there.
    pub(crate) fn feet(&self, xs: &[f32], ys: &[f32], zs: &[f32]) -> [Vec<f32>; 2] {
        let scale = |z: f32| match self {
            Self::Cosine => 1.0,
            // Lambert's azimuthal map; over the whole sphere its border is the pole below.
            Self::Hemisphere(_) => 1.0 / (1.0 + z).max(1e-6).sqrt(),
            Self::Sphere(_) => 1.0 / (2.0 * (1.0 + z)).max(1e-6).sqrt(),
        };
        [xs, ys].map(|axis| axis.iter().zip(zs).map(|(x, &z)| x * scale(z)).collect())
    }

    /// The numbers whose error is told, from the coefficients in the local frame.
    pub(crate) fn judged(&self, local: &[f64]) -> Vec<f64> {
        match self {
            Self::Cosine => local.to_vec(),
            Self::Hemisphere(judge) | Self::Sphere(judge) => judge.judged(local),
        }
    }

    /// Norm of what one direction of weight 1 adds to the judged numbers.
    pub(crate) fn norm_of_direction(&self, bands: Bands) -> f64 {
        // The squares of the functions of a band add up to (2 l + 1) / (4 pi) in every direction.
        let norm = |coefficients: usize| (coefficients as f64 / (4.0 * PI)).sqrt();
        match self {
            Self::Cosine => norm(bands.coefficients()),
            Self::Hemisphere(judge) | Self::Sphere(judge) => {
                let square = |l: usize| zonal::clamped_cosine(l).powi(2) * (2 * l + 1) as f64 / (4.0 * PI);
                (0..Judge::FUNCTIONS).map(square).sum::<f64>().sqrt() * norm(judge.light.coefficients())
            }
        }
    }
}

/// Irradiance in 3 bands over normals, for every coefficient of the light: what of visibility alone is seen in the end.
#[derive(Debug, Clone)]
pub(crate) struct Judge {
    light: Bands,
    /// Which number, from which coefficient, with which factor.
    terms: Vec<(u32, u32, f64)>,
}

impl Judge {
    /// Bands over normals.
    const FUNCTIONS: usize = 3;

    /// For coefficients of visibility of `visibility` bands and a light of `light` bands.
    pub(crate) fn new(light: Bands, visibility: Bands) -> Self {
        let functions = Bands::new(Self::FUNCTIONS as u32).expect("three bands");
        let terms = triples(functions, light, visibility).into_iter().map(|t| {
            let band = t.a.isqrt() as usize;
            (t.a * light.coefficients() as u32 + t.b, t.c, t.value * zonal::clamped_cosine(band))
        });
        Self { light, terms: terms.collect() }
    }

    fn judged(&self, local: &[f64]) -> Vec<f64> {
        let mut out = vec![0.0; Self::FUNCTIONS * Self::FUNCTIONS * self.light.coefficients()];
        for &(to, from, factor) in &self.terms {
            out[to as usize] += factor * local[from as usize];
        }
        out
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn bands(n: u32) -> Bands {
        Bands::new(n).unwrap()
    }

    /// An open point under a light of radiance 1 takes irradiance pi for every normal that sees no ground: in 3 bands over normals
    /// constant, so the judged numbers of the constant light are its mean over the sphere.
    #[test]
    fn an_open_point_is_judged_as_the_sky() {
        let domain = Domain::Sphere(Judge::new(bands(4), bands(6)));
        let judged = domain.judged(&domain.open(bands(6)));
        // Mean over the sphere of Y_k Y_i: the identity over 4 pi, bands weighed by the cosine.
        for k in 0..9usize {
            for i in 0..16 {
                let expected = if k == i { zonal::clamped_cosine(k.isqrt()) / (4.0 * PI) } else { 0.0 };
                assert!((judged[k * 16 + i] - expected).abs() < 1e-8, "{k} {i}: {}", judged[k * 16 + i]);
            }
        }
    }

    /// Against the sum over one direction.
    #[test]
    fn no_direction_adds_more_than_its_norm() {
        let domain = Domain::Hemisphere(Judge::new(bands(5), bands(7)));
        let direction = glam::DVec3::new(0.36, -0.48, 0.8);
        let mut local = vec![0.0; 49];
        sh_math::evaluate_f64(bands(7), direction, &mut local);
        let norm = domain.judged(&local).iter().map(|x| x * x).sum::<f64>().sqrt();
        assert!((norm / domain.norm_of_direction(bands(7)) - 1.0).abs() < 1e-9);
    }
}
