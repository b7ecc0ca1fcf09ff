//! Pictures for the page: the baked scene under the light, and the error of each receiver as colour.

use crate::plot::pixels::Pixels;
use coeff_io::{AlphaMode, Prt, Transfer};
use glam::Vec3;
use probe_io::Environment;
use render_cpu::{Frame, Renderer, Tonemap};

/// Columns and rows of the pictures.
const SIZE: [u32; 2] = [400, 225];
/// Samples along each side of a pixel.
const SUPERSAMPLE: u32 = 2;
/// Mean luminance that the baked picture is exposed to, before the tone curve.
const MEAN_LUMINANCE: f64 = 0.22;
/// Errors of the two ends of a map: dark and bright.
pub(super) const RANGE: [f32; 2] = [1e-4, 1e-1];
/// Colours of a map from the small to the large error, sRGB; each is lighter than the one before.
pub(super) const RAMP: [[u8; 3]; 6] =
    [[24, 18, 60], [70, 30, 120], [150, 42, 121], [222, 82, 88], [250, 151, 74], [252, 236, 160]];

/// The baked scene from its first camera: exposed to a fixed mean, with a window where the light would ring.
///
/// # Errors
/// As the renderer has it.
pub(super) fn baked(prt: &Prt, environment: &Environment) -> Result<Pixels, render_cpu::Error> {
    let renderer = Renderer::new(prt, environment)?;
    let mut frame = frame(prt);
    let covered = coverage(prt)?;
    let image = renderer.draw(&frame)?;
    let luminance = |&[r, g, b]: &[f32; 3]| f64::from(0.2126 * r.max(0.0) + 0.7152 * g.max(0.0) + 0.0722 * b.max(0.0));
    let lit = image.linear.iter().zip(&covered).filter(|(_, covered)| **covered > 0.5).map(|(p, _)| luminance(p));
    let (sum, count) = lit.fold((0.0, 0.0), |(sum, count), l| (sum + l, count + 1.0));
    if sum > 0.0 {
        frame.exposure_ev = (MEAN_LUMINANCE * count / sum).log2().clamp(-30.0, 30.0) as f32;
    }
    frame.tonemap = Tonemap::Filmic;
    let image = renderer.draw(&frame)?;
    Ok(Pixels { width: image.width, height: image.height, rgba: image.display })
}

/// The error of each receiver as colour from the first camera, on a logarithmic scale over [`RANGE`]; where nothing
/// stands there is no colour.
///
/// # Errors
/// As the renderer has it.
pub(super) fn map(prt: &Prt, errors: &[f32]) -> Result<Pixels, render_cpu::Error> {
    let [low, high] = RANGE;
    let scale = |e: f32| ((e.max(low) / low).ln() / (high / low).ln()).clamp(0.0, 1.0);
    let drawn = drawn_plainly(prt, errors.iter().map(|&e| [scale(e), 1.0, 0.0]))?;
    let colour = |&[value, covered, _]: &[f32; 3]| {
        if covered <= 0.0 {
            return [0; 4];
        }
        let [r, g, b] = ramp(value / covered);
        [r, g, b, (255.0 * covered.clamp(0.0, 1.0) + 0.5) as u8]
    };
    Ok(Pixels { width: SIZE[0], height: SIZE[1], rgba: drawn.iter().map(colour).collect() })
}

/// Share of each pixel that the scene covers.
fn coverage(prt: &Prt) -> Result<Vec<f32>, render_cpu::Error> {
    let white = prt.geometry.positions.iter().map(|_| [0.0, 1.0, 0.0]);
    Ok(drawn_plainly(prt, white)?.iter().map(|p| p[1]).collect())
}

/// Draws three numbers per vertex as they are: white, opaque surfaces without reflections under a white sky, and a
/// transfer of one band that turns this light into the numbers.
fn drawn_plainly(prt: &Prt, values: impl Iterator<Item = [f32; 3]>) -> Result<Vec<[f32; 3]>, render_cpu::Error> {
    let light = Environment::constant([1.0; 3]);
    // Radiance 1 from everywhere has the coefficient sqrt(4 pi).
    let unit = (4.0 * std::f64::consts::PI).sqrt() as f32;
    let values = values.flat_map(|v| v.map(|x| x / unit)).collect();
    let mut plain = prt.clone();
    plain.transfer = Transfer { bands: 1, channels: 3, values, albedo: prt.transfer.albedo.clone(), openness: vec![] };
    plain.geometry.colors.clear();
    plain.textures.clear();
    for material in &mut plain.materials {
        material.base_color = [1.0; 4];
        material.base_color_texture = None;
        material.metallic = 0.0;
        material.metallic_roughness_texture = None;
        material.normal_texture = None;
        material.emissive = [0.0; 3];
        material.emissive_texture = None;
        material.alpha = AlphaMode::Opaque;
        material.specular = false;
        material.transmission = 0.0;
    }
    Ok(Renderer::new(&plain, &light)?.draw(&Frame { sky: false, ..frame(prt) })?.linear)
}

fn frame(prt: &Prt) -> Frame {
    Frame { supersample: SUPERSAMPLE, ..Frame::plain(prt.cameras[0].clone(), SIZE[0], SIZE[1]) }
}

/// Steps between two colours of the ramp: few colours make small pictures, and the eye tells no more apart.
const STEPS: f32 = 4.0;

/// The colour of a value in [0, 1].
fn ramp(value: f32) -> [u8; 3] {
    let place = (value.clamp(0.0, 1.0) * (RAMP.len() - 1) as f32 * STEPS).round() / STEPS;
    let below = (place as usize).min(RAMP.len() - 2);
    let [a, b] = [RAMP[below], RAMP[below + 1]].map(|c| Vec3::from(c.map(f32::from)));
    a.lerp(b, place - below as f32).to_array().map(|v| (v + 0.5) as u8)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Every covered pixel of a map of equal errors has the colour of that error.
    #[test]
    fn a_map_shows_the_error() {
        let prt = crate::cost::sample::prt();
        for (error, colour) in [(1e-6, RAMP[0]), (1.0, RAMP[5]), (10f32.powf(-2.8), RAMP[2])] {
            let map = map(&prt, &vec![error; prt.geometry.positions.len()]).unwrap();
            let covered: Vec<_> = map.rgba.iter().filter(|p| p[3] == 255).collect();
            assert!(covered.len() > 10_000, "the scene must fill the picture: {}", covered.len());
            let off = |p: &[u8; 4]| (0..3).map(|c| p[c].abs_diff(colour[c])).max().unwrap();
            assert!(covered.iter().all(|p| off(p) <= 1), "{error}: {:?} is not {colour:?}", covered[0]);
        }
    }

    /// Another error is another colour.
    #[test]
    fn a_map_shows_the_error_can_fail() {
        assert_ne!(ramp(0.2), ramp(0.25));
        assert_eq!([ramp(-1.0), ramp(2.0)], [RAMP[0], RAMP[5]]);
    }
}
