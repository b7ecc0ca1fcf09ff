//! Functions with an axis: the factors that convolution with a lobe puts on each band.

use crate::{Bands, evaluate};
use glam::Vec3;

/// Factor of band `l` for the clamped cosine divided by pi: `2 int_0^1 z P_l(z) dz` = 1, 2/3, 1/4, 0, -1/24, 0, 1/64, ...
///
/// Multiplying radiance coefficients by it gives those of irradiance / pi, the radiance of a white diffuse surface.
#[must_use]
pub fn clamped_cosine(l: usize) -> f64 {
    phong(1.0, l)
}

/// Factor of band `l` for the lobe `(s + 1) / (2 pi) max(0, cos)^s`, whose integral is 1; `exponent` s > -1.
///
/// `(s + 1) int_0^1 z^s P_l(z) dz`, from `I_l = I_(l-2) (s - l + 2) / (s + l + 1)`, `I_0 = 1`, `I_1 = (s + 1) / (s + 2)`.
#[must_use]
pub fn phong(exponent: f64, l: usize) -> f64 {
    let even = l.is_multiple_of(2);
    let first = if even { 1.0 } else { (exponent + 1.0) / (exponent + 2.0) };
    let degrees = (if even { 2 } else { 3 }..=l).step_by(2);
    degrees.fold(first, |value, k| value * (exponent - k as f64 + 2.0) / (exponent + k as f64 + 1.0))
}

/// Writes the transfer of an unshadowed white diffuse receiver with unit `normal`: the coefficients of
/// `max(0, normal . w) / pi`, so that its dot product with a light's coefficients is the outgoing radiance at albedo 1.
///
/// # Panics
/// When `out` is shorter than `bands.coefficients()`.
pub fn cosine_transfer(bands: Bands, normal: Vec3, out: &mut [f32]) {
    lobe(bands, 1.0, normal, out);
}

/// Writes the mean of every function over the hemisphere about a unit `normal`: the coefficients of `1 / (2 pi)` there and 0 below.
///
/// # Panics
/// When `out` is shorter than `bands.coefficients()`.
pub fn hemisphere_mean(bands: Bands, normal: Vec3, out: &mut [f32]) {
    lobe(bands, 0.0, normal, out);
}

/// The coefficients of the lobe of [`phong`] about a unit `axis`.
fn lobe(bands: Bands, exponent: f64, axis: Vec3, out: &mut [f32]) {
    evaluate(bands, axis, out);
    for l in bands.degrees() {
        let factor = phong(exponent, l) as f32;
        for value in &mut out[l * l..(l + 1) * (l + 1)] {
            *value *= factor;
        }
    }
}
