//! The angular power spectrum of a light: how much of it each band holds.

use crate::Error;
use probe_io::Environment;
use sh_math::{Bands, Rgb};

/// Fewest bands that a light is measured with.
const MIN_BANDS: u32 = 16;

/// The angular power spectrum of a light.
#[derive(Debug, Clone, PartialEq)]
pub struct LightSpectrum {
    /// Share of the squared coefficients in each band; all 0 for a black light.
    pub share: Vec<f64>,
    /// Norm of the coefficients of each band, radiance, the largest of the three channels.
    pub norms: Vec<f32>,
}

impl LightSpectrum {
    /// Measures a light with `bands` bands, 16 at least.
    ///
    /// # Errors
    /// [`Error::Bands`] where the spherical harmonics do not support so many.
    pub fn new(environment: &Environment, bands: u32) -> Result<Self, Error> {
        let bands = bands.max(MIN_BANDS);
        let bands = Bands::new(bands).ok_or(Error::Bands { bands })?;
        let light = sh_math::project(bands, environment.samples());
        let squares = squares(bands, &light);
        let power: Vec<f64> = squares.iter().map(|square| square.iter().sum()).collect();
        let total: f64 = power.iter().sum();
        Ok(Self {
            share: power.iter().map(|p| if total > 0.0 { p / total } else { 0.0 }).collect(),
            norms: squares.iter().map(|square| square.iter().fold(0.0, |a: f64, &b| a.max(b)).sqrt() as f32).collect(),
        })
    }

    /// Share of the power that the first `bands` bands hold, of all bands that were measured.
    pub fn share_of_first(&self, bands: u32) -> f64 {
        self.share.iter().take(bands as usize).sum()
    }
}

/// Per band and channel: sum of the squared coefficients.
fn squares(bands: Bands, light: &Rgb) -> Vec<[f64; 3]> {
    let band_square = |l: usize| {
        let mut sums = [0.0; 3];
        for value in &light.values[l * l..(l + 1) * (l + 1)] {
            sums.iter_mut().zip(value).for_each(|(sum, &v)| *sum += f64::from(v) * f64::from(v));
        }
        sums
    };
    bands.degrees().map(band_square).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A white sky of radiance 1 has sqrt(4 pi) in band 0 and nothing above.
    #[test]
    fn white_sky_has_one_band() {
        let white = LightSpectrum::new(&probe_io::builtin("white").unwrap(), 5).unwrap();
        assert!((f64::from(white.norms[0]) - (4.0 * std::f64::consts::PI).sqrt()).abs() < 1e-3, "{:?}", white.norms);
        assert!(white.norms[1..].iter().all(|&n| n < 1e-3) && white.share[0] > 0.999_99, "{:?}", white.norms);
        assert_eq!(white.share.len(), 16, "16 bands at least");
        let sky = LightSpectrum::new(&probe_io::builtin("sky").unwrap(), 5).unwrap();
        assert!(sky.share[0] < 0.99, "can fail: a sky with a sun is not white: {:?}", sky.share);
        assert!((sky.share_of_first(16) - 1.0).abs() < 1e-12);
    }

    #[test]
    fn too_many_bands_are_refused() {
        let white = probe_io::builtin("white").unwrap();
        let too_many = Bands::MAX + 1;
        assert!(matches!(LightSpectrum::new(&white, too_many), Err(Error::Bands { bands }) if bands == too_many));
    }
}
