//! The coefficients of a coloured light.

use crate::Bands;
use crate::evaluate::visit;
use crate::rotate::Rotation;
use glam::{Quat, Vec3};

/// Light coefficients: of radiance, linear RGB, world axes unless rotated.
#[derive(Debug, Clone, PartialEq)]
pub struct Rgb {
    /// Number of bands.
    pub bands: Bands,
    /// `[coefficient][channel]`, `bands.coefficients()` rows.
    pub values: Vec<[f32; 3]>,
}

impl Rgb {
    /// No light.
    #[must_use]
    pub fn black(bands: Bands) -> Self {
        Self { bands, values: vec![[0.0; 3]; bands.coefficients()] }
    }

    /// The radiance that the coefficients describe along the unit vector `direction`; it may ring below zero.
    #[must_use]
    pub fn reconstruct(&self, direction: Vec3) -> [f32; 3] {
        let mut sum = [0.0; 3];
        visit(self.bands, direction.to_array(), |i, y| {
            for (channel, value) in sum.iter_mut().zip(self.values[i]) {
                *channel += value * y;
            }
        });
        sum
    }

    /// The light turned by `world_from_light`: what it sent along `d` it sends along `world_from_light * d`.
    #[must_use]
    pub fn rotated(&self, world_from_light: Quat) -> Self {
        let mut turned = self.clone();
        Rotation::new(self.bands, world_from_light).apply_interleaved(turned.values.as_flattened_mut(), 3);
        turned
    }

    /// Each band times its factor; bands beyond the end of `factors` become zero.
    #[must_use]
    pub fn windowed(&self, factors: &[f64]) -> Self {
        let mut windowed = self.clone();
        for l in self.bands.degrees() {
            let factor = factors.get(l).copied().unwrap_or(0.0) as f32;
            for value in &mut windowed.values[l * l..(l + 1) * (l + 1)] {
                *value = value.map(|channel| channel * factor);
            }
        }
        windowed
    }

    /// The light in exactly `bands` bands: the first of them, or all and black ones above.
    #[must_use]
    pub fn with_bands(&self, bands: Bands) -> Self {
        let mut light = self.truncated(bands);
        light.values.resize(bands.coefficients(), [0.0; 3]);
        Self { bands, ..light }
    }

    /// The first `bands` bands, or all of them when there are fewer.
    #[must_use]
    pub fn truncated(&self, bands: Bands) -> Self {
        let bands = bands.min(self.bands);
        Self { bands, values: self.values[..bands.coefficients()].to_vec() }
    }
}
