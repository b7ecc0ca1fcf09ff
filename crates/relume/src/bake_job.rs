//! A bake with all its outputs, step by step.

use crate::{BakeSettings, Error, LightMapOptions, TransferTextureOptions, Window, bake_within, fixed_light};
use bake::{Compression, Extras, Progress, ProgressFn, VolumeSettings};
use coeff_io::{Effect, Effects, Prt};
use probe_io::Environment;
use scene::Scene;
use std::borrow::Cow;
use std::ops::ControlFlow;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

/// A bake: scene, settings, and what is baked beside the transfer of the vertices.
///
/// ```
/// use relume::prelude::*;
///
/// let scene = load_scene("builtin:plane")?;
/// let settings = BakeSettings { quality: Quality::Rays(16), ..Preset::Draft.into() };
/// let prt = Bake::new(&scene).settings(settings).light_maps(LightMapOptions::new(32)).run()?;
/// assert_eq!(prt.maps.map(|maps| maps.sheets.len()), Some(1));
/// # Ok::<(), relume::Error>(())
/// ```
#[must_use = "nothing is baked before `run`"]
pub struct Bake<'a> {
    scene: &'a Scene,
    settings: BakeSettings,
    light_maps: Option<LightMapOptions>,
    transfer_textures: Option<TransferTextureOptions>,
    is_storage_automatic: bool,
    compression: Compression,
    volume: Option<VolumeSettings>,
    light: Option<&'a Environment>,
    time: Option<Duration>,
    progress: ProgressFn<'a>,
}

impl std::fmt::Debug for Bake<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Bake")
            .field("scene", &self.scene.name)
            .field("settings", &self.settings)
            .finish_non_exhaustive()
    }
}

impl<'a> Bake<'a> {
    /// A bake of the vertices with [`crate::Preset::Standard`].
    pub fn new(scene: &'a Scene) -> Self {
        let settings = bake::settings::standard();
        let progress = &|_: &Progress| ControlFlow::Continue(());
        Self {
            scene,
            settings,
            light_maps: None,
            transfer_textures: None,
            is_storage_automatic: false,
            compression: Compression::default(),
            volume: None,
            light: None,
            time: None,
            progress,
        }
    }

    /// With these settings, or with a preset.
    pub fn settings(self, settings: impl Into<BakeSettings>) -> Self {
        Self { settings: settings.into(), ..self }
    }

    /// And light maps; meshes without usable light-map coordinates are unwrapped.
    pub fn light_maps(self, options: LightMapOptions) -> Self {
        Self { light_maps: Some(options), ..self }
    }

    /// And transfer textures, which exclude light maps; meshes without usable light-map coordinates are unwrapped.
    pub fn transfer_textures(self, options: TransferTextureOptions) -> Self {
        Self { transfer_textures: Some(options), ..self }
    }

    /// And transfer textures where glossy surfaces call for them and nothing else was asked for, as the command line does by default.
    pub fn automatic_storage(self) -> Self {
        Self { is_storage_automatic: true, ..self }
    }

    /// How rows of glossy transfer are compressed.
    pub fn compression(self, compression: Compression) -> Self {
        Self { compression, ..self }
    }

    /// And an irradiance volume, which lights dynamic objects.
    pub fn volume(self, settings: VolumeSettings) -> Self {
        Self { volume: Some(settings), ..self }
    }

    /// Light maps, volume and glossy bounces hold this light only, and take a small part of the bytes.
    pub fn fixed_light(self, light: &'a Environment) -> Self {
        Self { light: Some(light), ..self }
    }

    /// The least error within this time instead of that of the settings. A first, coarse result is finished in any case.
    pub fn within(self, time: Duration) -> Self {
        Self { time: Some(time), ..self }
    }

    /// Calls `progress` while the bake runs, from several threads; `Break` cancels it.
    pub fn progress(self, progress: ProgressFn<'a>) -> Self {
        Self { progress, ..self }
    }

    /// Bakes.
    ///
    /// # Errors
    /// [`Error::Bake`], [`Error::Unwrap`], [`Error::UnknownMesh`] or [`Error::Bands`].
    pub fn run(self) -> Result<Prt, Error> {
        let mut scene = Cow::Borrowed(self.scene);
        let maps = match &self.light_maps {
            Some(options) => Some(options.settings(scene.to_mut(), &|_| ())?),
            None => None,
        };
        let (mut chosen, mut refined) = (None, None);
        if self.is_storage_automatic && maps.is_none() && self.transfer_textures.is_none() {
            let (choice, split) = bake::storage_watched(&scene, &self.settings, self.progress)?;
            chosen = choice.texels.map(|texels| chosen_textures(texels, &self.settings));
            refined = split;
        }
        let textures = match self.transfer_textures.as_ref().or(chosen.as_ref()) {
            Some(options) => Some(options.settings(scene.to_mut(), &|_| ())?),
            None => None,
        };
        let bands = fixed_bands(self.settings.bands, maps.is_some());
        let light = self.light.map(|light| fixed_light(light, bands, Window::Auto)).transpose()?;
        let extras = Extras { maps, textures, volume: self.volume, light, compression: self.compression };
        match (self.time, refined) {
            (Some(time), _) => run_within(&scene, &self.settings, &extras, time, self.progress),
            (None, Some(refined)) => Ok(bake::bake_refined(&refined, &self.settings, &extras, self.progress)?),
            (None, None) => Ok(bake::bake_with(&scene, &self.settings, &extras, self.progress)?),
        }
    }
}

/// Transfer textures with normal maps where the settings allow them.
fn chosen_textures(texels: u32, settings: &BakeSettings) -> TransferTextureOptions {
    let normal_maps = !matches!(&settings.effects, Effects::Only(list) if !list.contains(&Effect::NormalMaps));
    TransferTextureOptions { normal_maps, ..TransferTextureOptions::new(texels) }
}

/// Bands of a fixed light: glossy bounces take all bands that reach a product of two functions of `bands` bands, light maps the first.
pub fn fixed_bands(bands: u32, are_light_maps: bool) -> u32 {
    if are_light_maps { bands } else { 2 * bands - 1 }
}

/// Bakes with ever smaller errors; at the deadline the bake that runs is cancelled.
fn run_within(
    scene: &Scene,
    settings: &BakeSettings,
    extras: &Extras,
    time: Duration,
    progress: ProgressFn<'_>,
) -> Result<Prt, Error> {
    let settings = BakeSettings { time: Some(time.as_secs_f32()), ..settings.clone() };
    let deadline = Instant::now() + time;
    let has_result = AtomicBool::new(false);
    let keep = |_: &Prt| {
        has_result.store(true, Ordering::Relaxed);
        Ok::<(), Error>(())
    };
    let watch = |now: &Progress| {
        let is_over = has_result.load(Ordering::Relaxed) && Instant::now() >= deadline;
        if is_over { ControlFlow::Break(()) } else { progress(now) }
    };
    bake_within(scene, &settings, extras, deadline, &keep, &watch)
}
