//! The options for what is baked beside the transfer of the vertices.

use crate::console::Console;
use crate::draw::Window;
use crate::source::{self, ProbeSource, ReadOptions};
use crate::usage::Usage;
use crate::volume::VolumeOptions;
use anyhow::Result;
use bake::{Extras, FixedLight};

/// What is wanted beside the vertices, as typed.
#[derive(Debug, clap::Args)]
pub(crate) struct ExtrasOptions {
    #[command(flatten)]
    volume: VolumeOptions,
    /// Bake this light into the volume: it is then smaller, and can be lit by nothing else.
    #[arg(long, value_name = "PROBE", value_parser = source::probe, requires = "volume")]
    fixed_light: Option<ProbeSource>,
    /// Smooths the light of --fixed-light so that its few bands do not ring below zero.
    #[arg(long, value_enum, default_value_t = Window::None, requires = "fixed_light")]
    fixed_window: Window,
}

impl ExtrasOptions {
    /// What is wanted, with a light of so many bands.
    pub(crate) fn extras(&self, bands: u32, read: &ReadOptions, console: &Console) -> Result<Extras> {
        let light = self.fixed_light.as_ref().map(|probe| self.light(probe, bands, read, console)).transpose()?;
        Ok(Extras { volume: self.volume.settings()?, light, ..Extras::default() })
    }

    fn light(&self, probe: &ProbeSource, bands: u32, read: &ReadOptions, console: &Console) -> Result<FixedLight> {
        let environment = probe.load(read, console)?;
        let bands = source::bands(&bands.to_string()).map_err(Usage)?;
        let light = self.fixed_window.apply(&sh_math::project(bands, environment.samples()));
        Ok(FixedLight { name: environment.name, coefficients: light.values })
    }
}
