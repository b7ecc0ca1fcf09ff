//! One light, seen by both sides: as coefficients and as a picture.

use probe_io::{Environment, Layout, Probe};
use sh_math::Rgb;

/// Rows of the picture: a texel of 0.7 degrees is flat to any band that is used here.
const ROWS: usize = 256;

/// The reconstruction of a light from few bands.
pub(crate) struct BandLight {
    /// Coefficients of the picture, texel by texel, so that both sides hold the same light to the last digits.
    pub(crate) coefficients: Rgb,
    /// The picture for the path tracer; negative where the reconstruction is.
    pub(crate) picture: reference::Light,
}

impl BandLight {
    /// The reconstruction of coefficients, as they are.
    pub(crate) fn new(light: &Rgb) -> Self {
        let blank =
            Probe { layout: Layout::Equirect, width: 2 * ROWS, height: ROWS, pixels: vec![[0.0; 3]; 2 * ROWS * ROWS] };
        let pixels: Vec<[f32; 3]> = blank.texels().map(|t| light.reconstruct(t.direction.as_vec3())).collect();
        let picture = reference::Light::from_equirect(2 * ROWS, pixels.clone()).expect("full rows of finite values");
        let image = Environment::from_image("bands", Probe { pixels, ..blank });
        Self { coefficients: sh_math::project(light.bands, image.samples()), picture }
    }
}
