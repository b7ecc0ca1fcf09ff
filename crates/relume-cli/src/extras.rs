//! What is baked beside the transfer of the vertices, as typed.

use crate::console::Console;
use crate::draw::Window;
use crate::gloss::GlossOptions;
use crate::maps::{MapOptions, TEXELS};
use crate::settings::Storage;
use crate::source::{ProbeSource, ReadOptions};
use crate::usage::Usage;
use crate::volume::VolumeOptions;
use anyhow::Result;
use bake::{Extras, FixedLight};
use coeff_io::{Effect, Effects, Settings};
use scene::Scene;

/// Bytes of light maps that are worth a word before they are baked.
const MANY: u64 = 256 << 20;

/// Light maps, a volume, and whether light is in them.
#[derive(Debug, clap::Args)]
pub(crate) struct ExtraOptions {
    #[command(flatten, next_help_heading = "Light maps and transfer textures")]
    maps: MapOptions,
    #[command(flatten, next_help_heading = "Transfer textures and gloss")]
    pub(crate) gloss: GlossOptions,
    #[command(flatten, next_help_heading = "Irradiance volume")]
    volume: VolumeOptions,
    /// Whether light maps, volumes and glossy bounces answer to any light, or hold that of --probe: fixed takes a small part of the bytes. A fixed volume is
    /// for export: moving objects (render --visitor) want one that can be relit.
    #[arg(long, alias = "light", value_enum, default_value_t = LightMode::Relightable, help_heading = "Light probe")]
    lighting: LightMode,
    /// What is done against ringing of a fixed light; auto where not given.
    #[arg(long, value_enum, help_heading = "Light probe")]
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

/// In which textures light is kept beside the vertices.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Place {
    Vertices,
    Maps,
    /// Transfer textures of so many texels along a side where none are asked for.
    Transfer(u32),
}

impl ExtraOptions {
    /// The extras for a scene, which is unwrapped where its light-map coordinates do not serve; and the scene as the bake splits it, where the
    /// choice of storage found that.
    pub(crate) fn of(
        &self,
        scene: &mut Scene,
        storage: Storage,
        settings: &Settings,
        probe: Option<(&ProbeSource, &ReadOptions)>,
        console: &Console,
    ) -> Result<(Extras, Option<Scene>)> {
        let volume = self.volume.settings()?;
        let glossy = self.calls_for_gloss(scene, storage, settings)?;
        let (place, refined) = self.place(scene, storage, settings, glossy, console)?;
        if let (Place::Vertices, Some(option)) = (place, self.maps.typed()) {
            return Err(Usage(format!("{option} is for light maps: add --storage texture")).into());
        }
        if let (false, Some(option)) = (matches!(place, Place::Transfer(_)), self.gloss.typed_of_textures()) {
            return Err(Usage(format!("{option} is for transfer textures: add --storage transfer")).into());
        }
        if self.window.is_some() && self.lighting != LightMode::Fixed {
            return Err(Usage("--window is for a light that is baked in: add --lighting fixed".into()).into());
        }
        let light = self.fixed(place, settings.bands, probe, console)?;
        if light.is_some() && place == Place::Vertices && volume.is_none() && !glossy {
            return Err(Usage(
                "--lighting fixed is for light maps, volumes and glossy bounces: add --storage texture, --volume or --effects with glossy"
                    .into(),
            )
            .into());
        }
        if let (Some(light), true) = (&light, volume.is_some()) {
            console.notice(&format!("the volume will hold the light of {} alone: it lights no --visitor", light.name));
        }
        let maps = (place == Place::Maps).then(|| self.maps.settings(scene, console)).transpose()?;
        if let Some(maps) = &maps {
            let most = maps.most_bytes(light.is_none().then_some(settings.bands));
            let text = format!("light maps will take up to {} of the file", crate::columns::bytes(most));
            if most >= MANY { console.notice(&text) } else { console.detail(&text) }
        }
        let textures = match place {
            Place::Transfer(texels) => {
                let bent = !matches!(&settings.effects, Effects::Only(list) if !list.contains(&Effect::NormalMaps));
                Some(self.maps.textures(scene, &self.gloss, texels, bent, console)?)
            }
            Place::Vertices | Place::Maps => None,
        };
        Ok((Extras { maps, volume, light, textures, compression: self.gloss.compression() }, refined))
    }

    /// Whether the plan calls for gloss, where that decides something.
    fn calls_for_gloss(&self, scene: &Scene, storage: Storage, settings: &Settings) -> Result<bool> {
        if storage != Storage::Texture && self.lighting != LightMode::Fixed {
            return Ok(false);
        }
        let plan = bake::plan(scene, settings).map_err(crate::usage::bake_fault)?;
        Ok(plan.rows.iter().any(|row| row.effect == Effect::Glossy && row.simulate))
    }

    fn place(
        &self,
        scene: &Scene,
        storage: Storage,
        settings: &Settings,
        glossy: bool,
        console: &Console,
    ) -> Result<(Place, Option<Scene>)> {
        let of_maps = self.maps.typed_of_maps();
        let mut refined = None;
        let place = match storage {
            Storage::Vertex => Place::Vertices,
            Storage::Maps => Place::Maps,
            Storage::Texture if of_maps.is_some() || !glossy => Place::Maps,
            Storage::Texture => {
                console.notice("surfaces shine: transfer textures hold what they see (--storage maps for light maps)");
                Place::Transfer(TEXELS)
            }
            Storage::Transfer => match of_maps {
                Some(option) => return Err(Usage(format!("{option} is for light maps: use --storage maps")).into()),
                None => Place::Transfer(TEXELS),
            },
            Storage::Auto => {
                let progress = console.progress();
                let watched = crate::bake::watched(&progress);
                let (choice, split) =
                    bake::storage_watched(scene, settings, &watched).map_err(crate::usage::bake_fault)?;
                refined = split;
                match choice.texels {
                    Some(texels) => {
                        console.notice(&format!("storage: {}", choice.reason));
                        Place::Transfer(texels)
                    }
                    None => Place::Vertices,
                }
            }
        };
        Ok((place, refined))
    }

    /// The light that is baked in, if one is.
    fn fixed(
        &self,
        place: Place,
        bands: u32,
        probe: Option<(&ProbeSource, &ReadOptions)>,
        console: &Console,
    ) -> Result<Option<FixedLight>> {
        match (self.lighting, probe) {
            (LightMode::Relightable, _) => Ok(None),
            (LightMode::Fixed, None) => {
                Err(Usage("--lighting fixed bakes a light in: say which with --probe".into()).into())
            }
            (LightMode::Fixed, Some((probe, read))) => {
                let bands = relume::fixed_bands(bands, place == Place::Maps);
                let window = self.window.unwrap_or(Window::Auto).into();
                let light = relume::fixed_light(&probe.load(read, console)?, bands, window);
                Ok(Some(light.map_err(crate::usage::fault)?))
            }
        }
    }
}
