//! What matters about a light to a bake: how much of it each band holds.

use crate::console::Console;
use crate::source::{self, ProbeSource, ReadOptions};
use anyhow::Result;
use probe_io::Environment;
use serde_json::json;
use sh_math::{Bands, Rgb};

/// Bands that a light is measured with at least.
const LEAST_BANDS: u32 = 16;

/// A light in numbers.
#[derive(Debug)]
pub(crate) struct LightFacts {
    pub(crate) name: String,
    pub(crate) lamps: usize,
    /// Share of the squared coefficients in each band.
    pub(crate) share: Vec<f64>,
    /// Norm of each band, the largest of the three channels.
    pub(crate) norms: Vec<f32>,
}

impl LightFacts {
    /// Loads a light, where one is named, and measures it with at least `bands` bands.
    pub(crate) fn of_option(
        probe: Option<&ProbeSource>,
        read: &ReadOptions,
        bands: u32,
        console: &Console,
    ) -> Result<Option<Self>> {
        probe.map(|probe| Self::of(&probe.load(read, console)?, bands)).transpose()
    }

    fn of(environment: &Environment, bands: u32) -> Result<Self> {
        let bands = source::bands(&bands.max(LEAST_BANDS).to_string()).map_err(crate::usage::Usage)?;
        let light = sh_math::project(bands, environment.samples());
        let squares = squares(bands, &light);
        let power: Vec<f64> = squares.iter().map(|square| square.iter().sum()).collect();
        let total: f64 = power.iter().sum();
        Ok(Self {
            name: environment.name.clone(),
            lamps: environment.lamps.len(),
            // A black light has no shares.
            share: power.iter().map(|p| if total > 0.0 { p / total } else { 0.0 }).collect(),
            norms: squares.iter().map(|square| square.iter().fold(0.0, |a: f64, &b| a.max(b)).sqrt() as f32).collect(),
        })
    }

    pub(crate) fn json(&self) -> serde_json::Value {
        json!({ "name": self.name, "lamps": self.lamps, "share_by_band": self.share, "norm_by_band": self.norms })
    }

    /// One sentence about what a number of bands holds.
    pub(crate) fn text(&self, bands: u32) -> String {
        let held: f64 = self.share.iter().take(bands as usize).sum();
        let (name, lamps, measured) = (&self.name, self.lamps, self.share.len());
        format!(
            "{name}: {lamps} lamp(s); {bands} bands hold {:.1} % of the power in the first {measured}",
            100.0 * held
        )
    }
}

/// Per band and channel: sum of the squared coefficients.
fn squares(bands: Bands, light: &Rgb) -> Vec<[f64; 3]> {
    let of_band = |l: usize| {
        let mut sums = [0.0; 3];
        for value in &light.values[l * l..(l + 1) * (l + 1)] {
            sums.iter_mut().zip(value).for_each(|(sum, &v)| *sum += f64::from(v) * f64::from(v));
        }
        sums
    };
    bands.degrees().map(of_band).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A white sky of radiance 1 has sqrt(4 pi) in band 0 and nothing above.
    #[test]
    fn a_white_sky_has_one_band() {
        let facts = LightFacts::of(&probe_io::builtin("white").unwrap(), 5).unwrap();
        assert!((f64::from(facts.norms[0]) - (4.0 * std::f64::consts::PI).sqrt()).abs() < 1e-3, "{:?}", facts.norms);
        assert!(facts.norms[1..].iter().all(|&n| n < 1e-3) && facts.share[0] > 0.999_99, "{:?}", facts.norms);
        let sky = LightFacts::of(&probe_io::builtin("sky").unwrap(), 5).unwrap();
        assert!(sky.share[0] < 0.99, "can fail: a sky with a sun is not white: {:?}", sky.share);
        assert!(sky.text(5).contains("16"), "{}", sky.text(5));
    }
}
