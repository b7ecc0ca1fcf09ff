//! Blocks of BC1 (DXT1): two colours of 5, 6 and 5 bits, and two bits per texel that mix them.

use crate::block::Texels;

/// The texels of a block, each channel in [0, 1]; the transparent black of blocks of three colours is black.
///
/// Mixtures are those of real numbers; graphics hardware may round them to eight bits.
pub(crate) fn decode(block: [u8; 8]) -> Texels {
    let ends = [u16::from_le_bytes([block[0], block[1]]), u16::from_le_bytes([block[2], block[3]])];
    let [a, b] = ends.map(rgb);
    let mix = |x: f32, y: f32, of: f32| std::array::from_fn(|c| (a[c] * x + b[c] * y) / of);
    let colors = if ends[0] > ends[1] {
        [a, b, mix(2.0, 1.0, 3.0), mix(1.0, 2.0, 3.0)]
    } else {
        [a, b, mix(1.0, 1.0, 2.0), [0.0; 3]]
    };
    let codes = u32::from_le_bytes([block[4], block[5], block[6], block[7]]);
    std::array::from_fn(|i| colors[(codes >> (2 * i) & 3) as usize])
}

fn rgb(color: u16) -> [f32; 3] {
    [f32::from(color >> 11) / 31.0, f32::from(color >> 5 & 63) / 63.0, f32::from(color & 31) / 31.0]
}

#[cfg(test)]
mod tests {
    use super::*;
    use block_compression::CompressionVariant;
    use block_compression::decode::decompress_blocks_as_rgba8;

    /// The decoder of another crate rounds to eight bits.
    #[test]
    fn blocks_are_decoded_as_another_decoder_does() {
        let mut seed = 1_u64;
        for _ in 0..5000 {
            seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            let block = (seed ^ seed >> 31).to_le_bytes();
            let mut theirs = [0; 64];
            decompress_blocks_as_rgba8(CompressionVariant::BC1, 4, 4, &block, &mut theirs);
            for (i, texel) in decode(block).iter().enumerate() {
                for c in 0..3 {
                    let other = f32::from(theirs[4 * i + c]);
                    assert!((texel[c] * 255.0 - other).abs() <= 1.0, "{block:?}: {texel:?}, not {other}");
                }
            }
        }
    }

    #[test]
    fn blocks_by_hand() {
        // Red above black: four colours, codes 0, 1, 2, 3 in the first row.
        let texels = decode([0x00, 0xF8, 0, 0, 0b1110_0100, 0, 0, 0]);
        assert_eq!(texels[..4], [[1.0, 0.0, 0.0], [0.0; 3], [2.0 / 3.0, 0.0, 0.0], [1.0 / 3.0, 0.0, 0.0]]);
        // Black below white: three colours and black.
        let texels = decode([0, 0, 0xFF, 0xFF, 0b1110_0100, 0, 0, 0]);
        assert_eq!(texels[..4], [[0.0; 3], [1.0; 3], [0.5; 3], [0.0; 3]]);
    }
}
