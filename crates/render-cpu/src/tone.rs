//! Tone curves and the encoding for the display.

use crate::Tonemap;

/// Scene-referred to display-referred, both linear; the result lies in [0, 1].
///
/// Reinhard et al. 2002 eq. (3) per channel; the filmic curve is Narkowicz' fit (2016) of the ACES reference curve.
pub fn curve(tonemap: Tonemap, x: f32) -> f32 {
    // `max` turns NaN into 0.
    let x = x.max(0.0);
    if x == f32::INFINITY {
        return 1.0;
    }
    // In f64: the square of the largest f32 is finite, and rounding does not make a curve fall.
    let wide = f64::from(x);
    match tonemap {
        Tonemap::None => x.min(1.0),
        Tonemap::Reinhard => (wide / (1.0 + wide)) as f32,
        Tonemap::Filmic => ((wide * (2.51 * wide + 0.03)) / (wide * (2.43 * wide + 0.59) + 0.14)).min(1.0) as f32,
    }
}

/// The sRGB value in [0, 1] of a linear one (IEC 61966-2-1).
pub fn srgb_encode(linear: f64) -> f64 {
    if linear <= 0.003_130_8 { 12.92 * linear } else { 1.055 * libm::pow(linear, 1.0 / 2.4) - 0.055 }
}

/// The linear value in [0, 1] of an sRGB one (IEC 61966-2-1).
pub fn srgb_decode(value: f64) -> f64 {
    if value <= 0.040_45 { value / 12.92 } else { libm::pow((value + 0.055) / 1.055, 2.4) }
}

/// Cells of the quantiser's table: narrower than any byte, so that at most one threshold lies in each.
const CELLS: usize = 4096;

/// Rounds linear display values to sRGB bytes without a power or a search per pixel.
#[derive(Debug, Clone)]
pub(crate) struct Quantiser {
    /// Least linear value of the byte after each; infinite after the last.
    next: [f32; 256],
    /// Byte of the least value in each cell; the last cell holds 1 only.
    first: Vec<u8>,
}

impl Quantiser {
    pub(crate) fn new() -> Self {
        let mut next = std::array::from_fn(|byte| at_least(srgb_decode((byte as f64 + 0.5) / 255.0)));
        next[255] = f32::INFINITY;
        let least = |cell: usize| cell as f32 / CELLS as f32;
        let first = (0..=CELLS).map(|cell| next.partition_point(|&next| next <= least(cell)) as u8).collect();
        Self { next, first }
    }

    /// The byte nearest to the sRGB value of a linear value in [0, 1].
    pub(crate) fn byte(&self, linear: f32) -> u8 {
        let byte = self.first[(linear * CELLS as f32) as usize];
        byte + u8::from(linear >= self.next[usize::from(byte)])
    }
}

/// The least f32 that is not below `x`.
fn at_least(x: f64) -> f32 {
    let rounded = x as f32;
    if f64::from(rounded) < x { rounded.next_up() } else { rounded }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bytes_are_the_rounded_srgb_values() {
        let quantiser = Quantiser::new();
        for i in 0..=1_000_000 {
            let linear = i as f32 / 1_000_000.0;
            let exact = (255.0 * srgb_encode(f64::from(linear)) + 0.5).floor();
            assert_eq!(f64::from(quantiser.byte(linear)), exact, "at {linear}");
        }
    }
}
