//! Windows against ringing, and a light that is baked in.

use crate::Error;
use bake::FixedLight;
use probe_io::Environment;
use sh_math::{Bands, Rgb};

/// The window against ringing: a strong small light, cut off at few bands, is negative in places.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Window {
    /// No window: the light as its coefficients have it.
    None,
    /// The mildest window under which the light is nowhere negative; none where nothing rings.
    Auto,
}

impl Window {
    /// The windowed light.
    #[must_use]
    pub fn apply(self, light: &Rgb) -> Rgb {
        match self {
            Self::None => light.clone(),
            Self::Auto => sh_math::window::without_ringing(light),
        }
    }
}

/// The first `bands` bands of a light, windowed, to be baked in.
///
/// # Errors
/// [`Error::Bands`] where the spherical harmonics do not support so many bands.
pub fn fixed_light(environment: &Environment, bands: u32, window: Window) -> Result<FixedLight, Error> {
    let bands = Bands::new(bands).ok_or(Error::Bands { bands })?;
    let light = window.apply(&sh_math::project(bands, environment.samples()));
    Ok(FixedLight { name: environment.name.clone(), coefficients: light.values })
}
