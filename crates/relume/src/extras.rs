//! What is baked beside the transfer of the vertices, as typed.

use crate::console::Console;
use crate::draw::Window;
use crate::maps::MapOptions;
use crate::source::{ProbeSource, ReadOptions};
use crate::usage::Usage;
use crate::volume::VolumeOptions;
use anyhow::Result;
use bake::{Extras, FixedLight};
use probe_io::Environment;
use scene::Scene;
use sh_math::Bands;

/// Bytes of light maps that are worth a word before they are baked.
const MANY: u64 = 256 << 20;

/// Light maps, a volume, and whether light is in them.
#[derive(Debug, clap::Args)]
pub(crate) struct ExtraOptions {
    #[command(flatten)]
    maps: MapOptions,
    #[command(flatten)]
    volume: VolumeOptions,
    /// Whether light maps and volumes answer to any light, or hold that of --probe: fixed takes a small part of the bytes. A fixed volume is
    /// for export: moving objects (render --visitor) want one that can be relit.
    #[arg(long, value_enum, default_value_t = LightMode::Relightable)]
    light: LightMode,
    /// What is done against ringing of a fixed light; nothing where not given.
    #[arg(long, value_enum)]
    window: Option<Window>,
}

/// Whether light is baked in.
#[derive(Debug, Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
enum LightMode {
    /// Transfer: any light can be put on, and turned.
    Relightable,
    /// The light of --probe as it lies.
    Fixed,
}

impl ExtraOptions {
    /// The extras for a scene, which is unwrapped where its light-map coordinates do not serve.
    pub(crate) fn of(
        &self,
        scene: &mut Scene,
        in_texture: bool,
        bands: u32,
        probe: Option<(&ProbeSource, &ReadOptions)>,
        console: &Console,
    ) -> Result<Extras> {
        let volume = self.volume.settings()?;
        if let (false, Some(option)) = (in_texture, self.maps.typed()) {
            return Err(Usage(format!("{option} is for light maps: add --storage texture")).into());
        }
        if self.window.is_some() && self.light != LightMode::Fixed {
            return Err(Usage("--window is for a light that is baked in: add --light fixed".into()).into());
        }
        let light = match (self.light, probe) {
            (LightMode::Relightable, _) => None,
            (LightMode::Fixed, None) => {
                return Err(Usage("--light fixed bakes a light in: say which with --probe".into()).into());
            }
            (LightMode::Fixed, Some((probe, read))) => {
                Some(fixed_light(&probe.load(read, console)?, bands, self.window.unwrap_or(Window::None))?)
            }
        };
        if light.is_some() && !in_texture && volume.is_none() {
            return Err(
                Usage("--light fixed is for light maps and volumes: add --storage texture or --volume".into()).into()
            );
        }
        if let (Some(light), true) = (&light, volume.is_some()) {
            console.notice(&format!("the volume will hold the light of {} alone: it lights no --visitor", light.name));
        }
        let maps = in_texture.then(|| self.maps.settings(scene, console)).transpose()?;
        if let Some(maps) = &maps {
            let most = maps.most_bytes(light.is_none().then_some(bands));
            let text = format!("light maps will take up to {} of the file", crate::columns::bytes(most));
            if most >= MANY { console.notice(&text) } else { console.detail(&text) }
        }
        Ok(Extras { maps, volume, light })
    }
}

/// What so many bands hold of a light, to be baked in.
pub(crate) fn fixed_light(environment: &Environment, bands: u32, window: Window) -> Result<FixedLight> {
    let bands = Bands::new(bands).ok_or_else(|| Usage(format!("--bands {bands}: use 1 to 32")))?;
    let light = window.apply(&sh_math::project(bands, environment.samples()));
    Ok(FixedLight { name: environment.name.clone(), coefficients: light.values })
}
