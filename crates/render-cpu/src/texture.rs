//! Reading 8-bit pictures between their texels.

use coeff_io::{Geometry, Texture, TextureSlot, Wrap};
use glam::{Vec2, Vec4};

/// Linear values of the 256 sRGB codes.
#[derive(Debug, Clone)]
pub(crate) struct SrgbTable([f32; 256]);

impl SrgbTable {
    /// IEC 61966-2-1.
    pub(crate) fn new() -> Self {
        Self(std::array::from_fn(|code| crate::tone::srgb_decode(code as f64 / 255.0) as f32))
    }
}

/// How the bytes of a picture become numbers; alpha is always linear.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Encoding<'a> {
    Linear,
    Srgb(&'a SrgbTable),
}

/// The bilinear value of a slot at interpolated texture coordinates; white where the picture has no texels.
pub(crate) fn read(texture: &Texture, slot: &TextureSlot, uv: Vec2, encoding: Encoding<'_>) -> Vec4 {
    if texture.rgba.is_empty() {
        return Vec4::ONE;
    }
    let rows = slot.transform.map(|[a, b, c]| a * uv.x + b * uv.y + c);
    let (columns, fx) = neighbours(rows[0], texture.width, texture.wrap[0]);
    let (lines, fy) = neighbours(rows[1], texture.height, texture.wrap[1]);
    let texel = |i: usize, j: usize| decode(texture.rgba[lines[j] * texture.width as usize + columns[i]], encoding);
    let top = texel(0, 0).lerp(texel(1, 0), fx);
    let bottom = texel(0, 1).lerp(texel(1, 1), fx);
    top.lerp(bottom, fy)
}

/// Texture coordinates of set 0 or 1 between three vertices; (0, 0) where the geometry has none.
pub(crate) fn coordinates(geometry: &Geometry, uv_set: u8, vertices: [usize; 3], weights: [f32; 3]) -> Vec2 {
    let set = if uv_set == 0 { &geometry.uv0 } else { &geometry.uv1 };
    if set.is_empty() {
        return Vec2::ZERO;
    }
    (0..3).map(|i| Vec2::from(set[vertices[i]]) * weights[i]).sum()
}

/// The two texels around a coordinate along one axis and the share of the second.
pub(crate) fn neighbours(coordinate: f32, size: u32, wrap: Wrap) -> ([usize; 2], f32) {
    let x = coordinate * size as f32 - 0.5;
    if !x.is_finite() {
        return ([0, 0], 0.0);
    }
    let floor = x.floor();
    // The cast saturates, so that coordinates beyond i64 still name a texel.
    let first = floor as i64;
    ([wrapped(first, size, wrap), wrapped(first.saturating_add(1), size, wrap)], x - floor)
}

fn wrapped(index: i64, size: u32, wrap: Wrap) -> usize {
    let n = i64::from(size);
    let inside = match wrap {
        Wrap::Repeat => index.rem_euclid(n),
        Wrap::Clamp => index.clamp(0, n - 1),
        Wrap::Mirror => {
            let k = index.rem_euclid(2 * n);
            if k < n { k } else { 2 * n - 1 - k }
        }
    };
    inside as usize
}

fn decode(texel: [u8; 4], encoding: Encoding<'_>) -> Vec4 {
    let alpha = f32::from(texel[3]) / 255.0;
    match encoding {
        Encoding::Linear => Vec4::from(texel.map(f32::from)) / 255.0,
        Encoding::Srgb(SrgbTable(table)) => {
            Vec4::new(table[usize::from(texel[0])], table[usize::from(texel[1])], table[usize::from(texel[2])], alpha)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn wrapping_goes_on_beyond_the_border() {
        let row = |wrap| (-3..6).map(|i| wrapped(i, 3, wrap)).collect::<Vec<_>>();
        assert_eq!(row(Wrap::Repeat), [0, 1, 2, 0, 1, 2, 0, 1, 2]);
        assert_eq!(row(Wrap::Mirror), [2, 1, 0, 0, 1, 2, 2, 1, 0]);
        assert_eq!(row(Wrap::Clamp), [0, 0, 0, 0, 1, 2, 2, 2, 2]);
    }
}
