//! Where light comes from: its coefficients times each axis, which turn a transfer into the mean direction of what it takes.

use crate::product::triples;
use crate::{Bands, Rgb};
use std::f64::consts::PI;

/// Weights of the channels of Rec. 709 in luminance.
pub const LUMINANCE: [f32; 3] = [0.2126, 0.7152, 0.0722];

/// Functions of the second band along x, y and z: `sqrt(3 / (4 pi)) (x, y, z)`.
const AXES: [u32; 3] = [3, 1, 2];

/// The luminance of `light` times the direction it comes from, x, y and z in the places of the channels.
///
/// The product of a transfer with these coefficients is `integral of T(w) L(w) w`, as that with the light is `integral of T(w) L(w)`;
/// their quotient is the mean direction of the light that a receiver takes, shorter than 1 the more it is spread. Exact for a transfer of
/// as many bands as the light has, but for the last band of the light that is left out.
#[must_use]
pub fn heading(light: &Rgb) -> Rgb {
    let mut sums = vec![[0.0f64; 3]; light.values.len()];
    let second = Bands::new(2).expect("two bands are few");
    let unit = (4.0 * PI / 3.0).sqrt();
    for triple in triples(second, light.bands, light.bands) {
        let Some(axis) = AXES.iter().position(|&function| function == triple.a) else { continue };
        let channels = light.values[triple.b as usize];
        let luminance: f32 = channels.iter().zip(LUMINANCE).map(|(value, weight)| value * weight).sum();
        sums[triple.c as usize][axis] += unit * triple.value * f64::from(luminance);
    }
    Rgb { bands: light.bands, values: sums.into_iter().map(|sum| sum.map(|x| x as f32)).collect() }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::evaluate;
    use glam::Vec3;

    /// Against a sum over many directions: light of three bands, taken by a transfer of three of the four bands it is given.
    #[test]
    fn heading_is_the_light_times_its_direction() {
        let bands = Bands::new(4).unwrap();
        let mut light = Rgb::black(bands);
        for (k, value) in light.values.iter_mut().take(9).enumerate() {
            *value = [1.0 + 0.3 * k as f32, 0.5 - 0.1 * k as f32, 0.2 * k as f32];
        }
        let found = heading(&light);
        let (count, mut sums) = (40_000, vec![[0.0f64; 3]; 16]);
        let golden = PI * (3.0 - 5f64.sqrt());
        for i in 0..count {
            let z = 1.0 - (2.0 * f64::from(i) + 1.0) / f64::from(count);
            let (sin, cos) = (golden * f64::from(i)).sin_cos();
            let radius = (1.0 - z * z).sqrt();
            let direction = Vec3::new((radius * cos) as f32, (radius * sin) as f32, z as f32);
            let mut y = [0.0; 16];
            evaluate(bands, direction, &mut y);
            let [r, g, b] = light.reconstruct(direction).map(f64::from);
            let luminance = 0.2126 * r + 0.7152 * g + 0.0722 * b;
            for (sum, y) in sums.iter_mut().zip(y) {
                for (sum, w) in sum.iter_mut().zip(direction.to_array()) {
                    *sum += luminance * f64::from(w * y) * 4.0 * PI / f64::from(count);
                }
            }
        }
        let worst = |a: &[[f32; 3]]| {
            let pairs = a.as_flattened().iter().zip(sums.as_flattened());
            pairs.map(|(a, b)| (f64::from(*a) - b).abs()).fold(0.0, f64::max)
        };
        assert!(worst(&found.values) < 2e-3, "{}", worst(&found.values));
        let turned: Vec<[f32; 3]> = found.values.iter().map(|[x, y, z]| [*y, *z, *x]).collect();
        assert!(worst(&turned) > 0.1, "can fail: axes in another order");
    }
}
