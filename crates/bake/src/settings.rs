//! Presets and limits of the bake settings.

use crate::{Error, SettingField};
use coeff_io::{BandChoice, Bounces, Effect, Effects, Quality, Refine, Sampler, Settings};

/// Most bands that a bake may ask for: 1,024 coefficients per receiver and channel.
pub const MAX_BANDS: u32 = 32;
/// Most rays per receiver.
pub const MAX_RAYS: u32 = 1 << 16;
/// Fewest rays of the stratified sequence: below, none may lie above the horizon.
pub(crate) const MIN_STRATIFIED: u32 = 16;
/// Most bounces.
pub const MAX_BOUNCES: u32 = 10_000;

/// What the command line bakes by default: 5 bands to a relative error of 1 %.
#[must_use]
pub fn standard() -> Settings {
    Settings {
        bands: 5,
        band_choice: BandChoice::Exactly,
        light: Vec::new(),
        quality: Quality::Error(0.01),
        time: None,
        bounces: Bounces::Auto,
        refine: Refine::Auto,
        effects: Effects::Auto,
        sampler: Sampler::OwenSobol,
        seed: 0,
        // Sponza with all bounces keeps about 5 GiB.
        memory: 6 << 30,
    }
}

/// A quick look: 3 bands to a relative error of 5 %.
#[must_use]
pub fn preview() -> Settings {
    Settings { bands: 3, quality: Quality::Error(0.05), ..standard() }
}

/// For close looks: 8 bands to a relative error of 0.3 %.
#[must_use]
pub fn fine() -> Settings {
    Settings { bands: 8, quality: Quality::Error(0.003), ..standard() }
}

/// Checks every setting against its range.
///
/// # Errors
/// [`Error::Setting`] names the first setting that is outside its range.
pub fn check(settings: &Settings) -> Result<(), Error> {
    let refuse = |setting, value: String, allowed| Err(Error::Setting { setting, value, allowed });
    if settings.bands == 0 || settings.bands > MAX_BANDS {
        return refuse(SettingField::Bands, settings.bands.to_string(), "use 1 to 32");
    }
    check_light(settings)?;
    match settings.quality {
        Quality::Rays(n) if n == 0 || n > MAX_RAYS => {
            return refuse(SettingField::Rays, n.to_string(), "use 1 to 65536");
        }
        Quality::Rays(n) if n < MIN_STRATIFIED && settings.sampler == Sampler::Stratified => {
            return refuse(
                SettingField::Rays,
                n.to_string(),
                "the stratified sequence covers the whole sphere: use 16 or more",
            );
        }
        Quality::Error(e) if !(1e-4..=1.0).contains(&e) => {
            return refuse(SettingField::Error, e.to_string(), "use 0.0001 to 1");
        }
        Quality::Error(_) if settings.sampler != Sampler::OwenSobol => {
            let allowed = "only the Owen-scrambled Sobol sequence can go on until an error is met; give a fixed number of rays as well";
            return refuse(SettingField::Sampler, format!("{:?}", settings.sampler), allowed);
        }
        Quality::Rays(_) | Quality::Error(_) => {}
    }
    if let Effects::Only(list) = &settings.effects
        && list.contains(&Effect::Interreflection)
        && !list.contains(&Effect::Visibility)
    {
        return refuse(
            SettingField::Effects,
            "interreflection alone".into(),
            "bounces need to know what is seen: add visibility",
        );
    }
    if let Refine::Edge(length) = settings.refine
        && !(length > 0.0 && length.is_finite())
    {
        return refuse(SettingField::Refine, length.to_string(), "give a length above 0 in metres, auto or off");
    }
    match settings.bounces {
        Bounces::Fixed(n) if n > MAX_BOUNCES => refuse(SettingField::Bounces, n.to_string(), "use 0 to 10000, or auto"),
        Bounces::Fixed(_) | Bounces::Auto => Ok(()),
    }
}

fn check_light(settings: &Settings) -> Result<(), Error> {
    let light = &settings.light;
    let sound = light.iter().all(|norm| norm.is_finite() && *norm >= 0.0);
    if sound && (light.is_empty() || light.len() >= settings.bands as usize) {
        return Ok(());
    }
    let allowed = "give the norm of every band that is asked for, or none";
    Err(Error::Setting { setting: SettingField::Light, value: format!("a light of bands {light:?}"), allowed })
}
