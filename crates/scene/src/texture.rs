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
        let columns = taps(uv.x, self.width, self.wrap[0]);
        let rows = taps(uv.y, self.height, self.wrap[1]);
        let upper =
            self.texel(columns.low, rows.low, srgb).lerp(self.texel(columns.high, rows.low, srgb), columns.share);
        let lower =
            self.texel(columns.low, rows.high, srgb).lerp(self.texel(columns.high, rows.high, srgb), columns.share);
        upper.lerp(lower, rows.share)
    }

    fn texel(&self, x: u32, y: u32, srgb: bool) -> Vec4 {
        let [r, g, b, a] = self.rgba[y as usize * self.width as usize + x as usize];
        let alpha = f32::from(a) / 255.0;
        if srgb {
            Vec4::new(linear_from_srgb(r), linear_from_srgb(g), linear_from_srgb(b), alpha)
        } else {
            Vec4::new(f32::from(r) / 255.0, f32::from(g) / 255.0, f32::from(b) / 255.0, alpha)
        }
    }
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
    let low = position.floor();
    Taps { low: wrapped(low, size, wrap), high: wrapped(low + 1.0, size, wrap), share: (position - low) as f32 }
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
