//! All the light that falls on a scene from far away.

use crate::gauss::gauss5;
use crate::{Layout, Probe, equirect};
use glam::{DVec3, Vec3};
use std::f64::consts::{PI, TAU};

/// Distant light: a picture of the smooth part and a list of lamps that are too small for pixels.
#[derive(Debug, Clone)]
pub struct Environment {
    /// What the user called it: a path or `builtin:NAME`.
    pub name: String,
    /// The part that pixels can hold.
    pub image: Probe,
    /// Discs and points of light added to the picture.
    pub lamps: Vec<Lamp>,
}

/// A uniform disc of light in the sky, or a point where `half_angle` is 0.
#[derive(Debug, Clone, Copy)]
pub struct Lamp {
    /// From the scene to the lamp, unit.
    pub direction: Vec3,
    /// Angular radius, radians; 0 for a directional light.
    pub half_angle: f32,
    /// Irradiance on a surface that faces the lamp, RGB.
    pub irradiance: [f32; 3],
}

/// Pictures with fewer rows than this are cut finer for projection, so that even one pixel projects to eight
/// bands with an error below 1e-4.
const PROJECTION_ROWS: usize = 256;

/// A lamp's disc in a projection: bands of five Gauss-Legendre rings, and samples per ring, which leave no error
/// below degree 32 in the azimuth.
const LAMP_BANDS: usize = 2;
const LAMP_SPOKES: usize = 32;

/// Side of the grid over which a pixel of an analytic light is averaged.
const FUNCTION_SPLIT: usize = 4;

impl Environment {
    /// The same radiance from everywhere.
    pub fn constant(radiance: [f32; 3]) -> Environment {
        let image = Probe { layout: Layout::Equirect, width: 2, height: 1, pixels: vec![radiance; 2] };
        Environment::from_image("constant", image)
    }

    /// Only a picture, no lamps.
    pub fn from_image(name: &str, image: Probe) -> Environment {
        Environment { name: name.to_owned(), image, lamps: Vec::new() }
    }

    /// A panorama of `2 height` by `height` pixels from radiance by unit direction; each pixel is the mean
    /// over its solid angle on a 4 by 4 grid.
    pub fn from_function(name: &str, height: usize, radiance: impl Fn(DVec3) -> [f64; 3]) -> Environment {
        let height = height.max(1);
        let width = 2 * height;
        let mut pixels = Vec::with_capacity(width * height);
        for y in 0..height {
            for x in 0..width {
                pixels.push(pixel_mean(width, height, x, y, &radiance));
            }
        }
        let image = Probe { layout: Layout::Equirect, width, height, pixels };
        Environment::from_image(name, image)
    }

    /// Radiance from a unit direction: the picture, bilinear, and the discs of lamps; a point has no disc to see.
    pub fn radiance(&self, direction: Vec3) -> [f32; 3] {
        let mut sum = self.image.radiance(direction);
        for lamp in &self.lamps {
            if lamp.is_hit_by(direction) {
                let value = lamp.radiance();
                sum = std::array::from_fn(|c| sum[c] + value[c]);
            }
        }
        sum
    }

    /// Directions with radiance times solid angle whose sums are integrals over the sphere, for projection.
    pub fn samples(&self) -> impl Iterator<Item = (DVec3, [f64; 3])> + '_ {
        let split = PROJECTION_ROWS.div_ceil(self.image.equivalent_rows());
        let cells = self.image.cells(split).map(|texel| {
            let weight = |c: usize| f64::from(texel.radiance[c]) * texel.solid_angle;
            (texel.direction, std::array::from_fn(weight))
        });
        cells.chain(self.lamps.iter().flat_map(Lamp::samples))
    }
}

/// Mean radiance of a pixel of a panorama, each cell weighted by its solid angle.
fn pixel_mean(width: usize, height: usize, x: usize, y: usize, radiance: &impl Fn(DVec3) -> [f64; 3]) -> [f32; 3] {
    let rect = crate::patch::Rect::pixel(x, y);
    let mut sum = [0.0; 3];
    let mut total = 0.0;
    for k in 0..FUNCTION_SPLIT * FUNCTION_SPLIT {
        let cell = rect.cell(FUNCTION_SPLIT, k % FUNCTION_SPLIT, k / FUNCTION_SPLIT);
        let patch = equirect::patch(width, height, &cell);
        let value = radiance(patch.direction);
        sum = std::array::from_fn(|c| sum[c] + value[c] * patch.solid_angle);
        total += patch.solid_angle;
    }
    sum.map(|s| (s / total) as f32)
}

impl Lamp {
    /// Radiance of the disc, `E / (pi sin^2 half_angle)`; zero for a point, which has no area.
    pub fn radiance(&self) -> [f32; 3] {
        if self.half_angle <= 0.0 {
            return [0.0; 3];
        }
        let sin = libm::sin(f64::from(self.half_angle));
        self.irradiance.map(|e| (f64::from(e) / (PI * sin * sin)) as f32)
    }

    /// Whether a unit direction points into the disc.
    pub fn is_hit_by(&self, direction: Vec3) -> bool {
        if self.half_angle <= 0.0 {
            return false;
        }
        // |a - b|^2 = 4 sin^2(angle/2) keeps its digits for small discs, where the cosine is nearly 1.
        let chord = (direction - self.direction).as_dvec3().length_squared();
        let sin = libm::sin(0.5 * f64::from(self.half_angle));
        chord <= 4.0 * sin * sin
    }

    /// Solid angle of the disc, `2 pi (1 - cos half_angle)`.
    pub fn solid_angle(&self) -> f64 {
        let sin = libm::sin(0.5 * f64::from(self.half_angle));
        2.0 * TAU * sin * sin
    }

    /// Gauss-Legendre rings with equal spokes; a point is one sample that carries its irradiance.
    pub(crate) fn samples(&self) -> Vec<(DVec3, [f64; 3])> {
        let axis = self.direction.as_dvec3();
        if self.half_angle <= 0.0 {
            return vec![(axis, self.irradiance.map(f64::from))];
        }
        let sin = libm::sin(f64::from(self.half_angle));
        let radiance = self.irradiance.map(|e| f64::from(e) / (PI * sin * sin));
        let (tangent, bitangent) = axis.any_orthonormal_pair();
        // 1 - cos of the angle from the axis: solid angle is 2 pi times it.
        let band = self.solid_angle() / TAU / LAMP_BANDS as f64;
        let mut samples = Vec::with_capacity(5 * LAMP_BANDS * LAMP_SPOKES);
        for ring in 0..5 * LAMP_BANDS {
            let (node, share) = gauss5()[ring % 5];
            let below = band * ((ring / 5) as f64 + 0.5 + 0.5 * node);
            let solid_angle = TAU * band * 0.5 * share / LAMP_SPOKES as f64;
            let flat = libm::sqrt(below * (2.0 - below));
            for spoke in 0..LAMP_SPOKES {
                let (s, c) = libm::sincos(TAU * (spoke as f64 + 0.5) / LAMP_SPOKES as f64);
                let d = axis * (1.0 - below) + (tangent * c + bitangent * s) * flat;
                samples.push((d, radiance.map(|r| r * solid_angle)));
            }
        }
        samples
    }
}
