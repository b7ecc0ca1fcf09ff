//! Windows: factors per band that keep a reconstruction from ringing below zero.
//!
//! A window is a convolution with the kernel `sum_l s_l (2l+1)/(4 pi) P_l`. Where that kernel is nowhere negative, no
//! non-negative light can be reconstructed negative. Renderers take the [`automatic`] window unless told otherwise.

mod kernel;
mod search;

use crate::{Bands, Rgb, zonal};

pub use kernel::non_negative;
pub use search::{find_lambda, minimum};

/// `1 / (1 + lambda l^2 (l+1)^2)`: the least bending of the sphere's function for its loss of detail.
#[must_use]
pub fn laplacian(lambda: f64, bands: Bands) -> Vec<f64> {
    let factor = |l: usize| {
        let eigenvalue = (l * (l + 1)) as f64;
        1.0 / (1.0 + lambda * eigenvalue * eigenvalue)
    };
    bands.degrees().map(factor).collect()
}

/// The light under its [`automatic`] window: the light itself where nothing rings.
#[must_use]
pub fn without_ringing(light: &Rgb) -> Rgb {
    light.windowed(&automatic(light))
}

/// The window that makes this light's reconstruction non-negative at the least error of its irradiance.
///
/// All ones where nothing rings; else [`laplacian`] with the smallest lambda, or [`non_negative`] where that errs less
/// (for a bare sun it always does) or where no lambda is enough.
#[must_use]
pub fn automatic(light: &Rgb) -> Vec<f64> {
    let fixed = non_negative(light.bands);
    let Some(lambda) = find_lambda(light) else {
        return fixed;
    };
    let searched = laplacian(lambda, light.bands);
    if irradiance_error(light, &searched) <= irradiance_error(light, &fixed) { searched } else { fixed }
}

/// Relative L2 error over the sphere that `window` puts on the irradiance of the band-limited `light`.
#[must_use]
pub fn irradiance_error(light: &Rgb, window: &[f64]) -> f64 {
    let (mut error, mut total) = (0.0, 0.0);
    for l in light.bands.degrees() {
        let rows = &light.values[l * l..(l + 1) * (l + 1)];
        let power: f64 = rows.as_flattened().iter().map(|&value| f64::from(value) * f64::from(value)).sum();
        let irradiance = power * zonal::clamped_cosine(l) * zonal::clamped_cosine(l);
        let lost = 1.0 - window.get(l).copied().unwrap_or(0.0);
        total += irradiance;
        error += irradiance * lost * lost;
    }
    if total > 0.0 { (error / total).sqrt() } else { 0.0 }
}
