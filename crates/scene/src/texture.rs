//! Looking a colour up in a picture.

use std::sync::LazyLock;

use glam::{Vec2, Vec4};

use crate::{Texture, Wrap};

/// Linear value of each sRGB byte. IEC 61966-2-1; through `libm`, so that it is the same on every machine.
static LINEAR_FROM_SRGB: LazyLock<[f32; 256]> = LazyLock::new(|| {
    std::array::from_fn(|i| {
        let encoded = i as f64 / 255.0;
        let linear = if encoded <= 0.04045 { encoded / 12.92 } else { libm::pow((encoded + 0.055) / 1.055, 2.4) };
        linear as f32
    })
});

/// Value in [0, 1] of each byte that is not encoded.
static LINEAR: [f32; 256] = linear();

const fn linear() -> [f32; 256] {
    let mut table = [0.0; 256];
    let mut i = 0;
    while i < 256 {
        table[i] = i as f32 / 255.0;
        i += 1;
    }
    table
}

/// Linear value in [0, 1] of one sRGB-encoded byte.
pub fn linear_from_srgb(byte: u8) -> f32 {
    LINEAR_FROM_SRGB[usize::from(byte)]
}

impl Texture {
    /// A picture of one texel that multiplies by one, standing in for a missing file.
    pub fn white(name: impl Into<String>) -> Self {
        Self { name: name.into(), width: 1, height: 1, rgba: vec![[255; 4]], wrap: [Wrap::Repeat; 2] }
    }

    /// Bilinear value at `uv` (texel centres at (i + 1/2) / n, v downwards), components in [0, 1].
    ///
    /// With `srgb` the colour is decoded before it is filtered; the fourth component is never decoded.
    /// Coordinates that are not finite read as 0.
    pub fn sample(&self, uv: Vec2, srgb: bool) -> Vec4 {
        let decode: &[f32; 256] = if srgb { &LINEAR_FROM_SRGB } else { &LINEAR };
        let value = |texel: [u8; 4]| {
            let [r, g, b, a] = texel.map(usize::from);
            Vec4::new(decode[r], decode[g], decode[b], LINEAR[a])
        };
        let ([[a, b], [c, d]], [x, y]) = self.around(uv);
        value(a).lerp(value(b), x).lerp(value(c).lerp(value(d), x), y)
    }

    /// The fourth component of [`Texture::sample`] alone, to the bit.
    pub fn sample_alpha(&self, uv: Vec2) -> f32 {
        let value = |texel: [u8; 4]| LINEAR[usize::from(texel[3])];
        let ([[a, b], [c, d]], [x, y]) = self.around(uv);
        lerp(lerp(value(a), value(b), x), lerp(value(c), value(d), x), y)
    }

    /// The four texels around `uv`, upper row first, and the shares of the second column and row.
    fn around(&self, uv: Vec2) -> ([[[u8; 4]; 2]; 2], [f32; 2]) {
        let columns = taps(uv.x, self.width, self.wrap[0]);
        let rows = taps(uv.y, self.height, self.wrap[1]);
        let row = |y: u32| {
            let first = y as usize * self.width as usize;
            [self.rgba[first + columns.low as usize], self.rgba[first + columns.high as usize]]
        };
        ([row(rows.low), row(rows.high)], [columns.share, rows.share])
    }
}

/// One component of a `lerp` of vectors.
fn lerp(from: f32, to: f32, share: f32) -> f32 {
    from * (1.0 - share) + to * share
}

/// Two neighbouring texels along one axis and the share of the second.
struct Taps {
    low: u32,
    high: u32,
    share: f32,
}

fn taps(coordinate: f32, size: u32, wrap: Wrap) -> Taps {
    let coordinate = if coordinate.is_finite() { f64::from(coordinate) } else { 0.0 };
    // In f64, so that a coordinate of many tiles keeps its place inside the tile.
    let position = coordinate * f64::from(size) - 0.5;
    if position.abs() < COUNTABLE {
        // The same with whole numbers, several times as fast: this is asked for every hit of a bake.
        let towards_zero = position as i64;
        let low = towards_zero - i64::from(towards_zero as f64 > position);
        let share = (position - low as f64) as f32;
        return Taps { low: wrapped_near(low, size, wrap), high: wrapped_near(low + 1, size, wrap), share };
    }
    let low = position.floor();
    Taps { low: wrapped(low, size, wrap), high: wrapped(low + 1.0, size, wrap), share: (position - low) as f32 }
}

/// Positions below this (2^51) are told apart by less than a texel.
const COUNTABLE: f64 = 2_251_799_813_685_248.0;

/// [`wrapped`] for texels that can be counted.
fn wrapped_near(texel: i64, size: u32, wrap: Wrap) -> u32 {
    let n = i64::from(size);
    if (0..n).contains(&texel) {
        return texel as u32;
    }
    let inside = match wrap {
        Wrap::Clamp => texel.clamp(0, n - 1),
        Wrap::Repeat => texel.rem_euclid(n),
        Wrap::Mirror => {
            let folded = texel.rem_euclid(2 * n);
            if folded < n { folded } else { 2 * n - 1 - folded }
        }
    };
    inside as u32
}

fn wrapped(texel: f64, size: u32, wrap: Wrap) -> u32 {
    let n = f64::from(size);
    let inside = match wrap {
        Wrap::Clamp => texel.clamp(0.0, n - 1.0),
        Wrap::Repeat => texel.rem_euclid(n),
        Wrap::Mirror => {
            let folded = texel.rem_euclid(2.0 * n);
            if folded < n { folded } else { 2.0 * n - 1.0 - folded }
        }
    };
    (inside as u32).min(size - 1)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A picture of random bytes.
    fn noise(width: u32, height: u32, wrap: Wrap) -> Texture {
        let mut state = 3u32;
        let mut byte = || {
            state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            (state >> 24) as u8
        };
        let rgba = (0..width * height).map(|_| std::array::from_fn(|_| byte())).collect();
        Texture { name: String::new(), width, height, rgba, wrap: [wrap; 2] }
    }

    /// Coordinates on and beside texels, in and far out of the picture, and some that are none.
    fn coordinates(size: u32) -> Vec<f32> {
        let steps = (-4 * size as i32..=4 * size as i32).map(|i| i as f32 * 0.37 / size as f32);
        let odd =
            [0.0, -0.0, 0.5, 1.0, -1.0, 1.0e6, -1.0e9, 3.0e17, -2.0e18, 1.0e30, f32::MAX, f32::NAN, f32::INFINITY];
        steps.chain(odd).collect()
    }

    /// [`Texture::sample`] in the plainest way: division and remainders of floating numbers.
    fn plain(texture: &Texture, uv: Vec2, srgb: bool) -> Vec4 {
        let value = |x: f64, y: f64| {
            let (x, y) = (wrapped(x, texture.width, texture.wrap[0]), wrapped(y, texture.height, texture.wrap[1]));
            let [r, g, b, a] = texture.rgba[(y * texture.width + x) as usize];
            let colour = |c: u8| if srgb { linear_from_srgb(c) } else { f32::from(c) / 255.0 };
            Vec4::new(colour(r), colour(g), colour(b), f32::from(a) / 255.0)
        };
        let position = |c: f32, n: u32| f64::from(if c.is_finite() { c } else { 0.0 }) * f64::from(n) - 0.5;
        let (x, y) = (position(uv.x, texture.width), position(uv.y, texture.height));
        let (left, top) = (x.floor(), y.floor());
        let (share_x, share_y) = ((x - left) as f32, (y - top) as f32);
        let upper = value(left, top).lerp(value(left + 1.0, top), share_x);
        let lower = value(left, top + 1.0).lerp(value(left + 1.0, top + 1.0), share_x);
        upper.lerp(lower, share_y)
    }

    /// How many of the samples of a picture differ by a bit from another's in the plain way.
    fn differing(fast: &Texture, slow: &Texture) -> usize {
        let mut differ = 0;
        for x in coordinates(fast.width) {
            for y in coordinates(fast.height) {
                for srgb in [false, true] {
                    let (uv, bits) = (Vec2::new(x, y), |v: Vec4| v.to_array().map(f32::to_bits));
                    let expected = plain(slow, uv, srgb);
                    let alpha_differs = fast.sample_alpha(uv).to_bits() != expected.w.to_bits();
                    differ += usize::from(bits(fast.sample(uv, srgb)) != bits(expected) || alpha_differs);
                }
            }
        }
        differ
    }

    #[test]
    fn samples_equal_the_plain_way_to_the_bit() {
        for wrap in [Wrap::Clamp, Wrap::Repeat, Wrap::Mirror] {
            for (width, height) in [(1, 1), (2, 3), (7, 16), (33, 5)] {
                let texture = noise(width, height, wrap);
                assert_eq!(differing(&texture, &texture), 0, "{wrap:?}, {width} x {height}");
            }
        }
    }

    #[test]
    fn equality_to_the_bit_can_fail() {
        let texture = noise(7, 16, Wrap::Repeat);
        assert!(differing(&texture, &noise(7, 16, Wrap::Mirror)) > 1_000, "another wrap shows");
        let mut other = texture.clone();
        other.rgba[20][3] ^= 1;
        assert!(differing(&texture, &other) > 100, "the last bit of one texel shows");
    }
}
