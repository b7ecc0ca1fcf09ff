//! What matters about a light to a bake, in words: how much of it each band holds.

use crate::console::Console;
use crate::source::{ProbeSource, ReadOptions};
use crate::usage;
use anyhow::Result;
use probe_io::Environment;
use relume::LightSpectrum;
use serde_json::json;

/// A light in numbers.
#[derive(Debug)]
pub(crate) struct LightFacts {
    name: String,
    lamps: usize,
    spectrum: LightSpectrum,
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
        let spectrum = LightSpectrum::new(environment, bands).map_err(usage::fault)?;
        Ok(Self { name: environment.name.clone(), lamps: environment.lamps.len(), spectrum })
    }

    /// Norm of each band, the largest of the three channels.
    pub(crate) fn norms(&self) -> &[f32] {
        &self.spectrum.norms
    }

    pub(crate) fn json(&self) -> serde_json::Value {
        let (share, norms) = (&self.spectrum.share, &self.spectrum.norms);
        json!({ "name": self.name, "lamps": self.lamps, "share_by_band": share, "norm_by_band": norms })
    }

    /// One sentence about what a number of bands holds.
    pub(crate) fn text(&self, bands: u32) -> String {
        let held = self.spectrum.share_of_first(bands);
        let (name, lamps, measured) = (&self.name, self.lamps, self.spectrum.share.len());
        format!(
            "{name}: {lamps} lamp(s); {bands} bands hold {:.1} % of the power in the first {measured}",
            100.0 * held
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn text_names_the_bands_that_were_measured() {
        let sky = LightFacts::of(&probe_io::builtin("sky").unwrap(), 5).unwrap();
        assert!(sky.text(5).contains("16"), "{}", sky.text(5));
    }
}
