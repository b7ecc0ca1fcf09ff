//! Blocks of BC6H with unsigned halves: one or two lines in colour space, and three or four bits per texel along them.
//!
//! Written from the description of the format (\[D3D11\] BC6H format). Reserved modes are black.

use crate::bc6h_mode::{MODES, Mode, PLACES};
use crate::block::Texels;
use half::f16;

/// Ends of lines, `[end][channel]`; those of the second line are the third and fourth.
type Ends = [[u32; 3]; 4];

/// Which texels of a block lie on the second line, bit by texel, per partition.
const PARTITIONS: [u16; 32] = [
    0xCCCC, 0x8888, 0xEEEE, 0xECC8, 0xC880, 0xFEEC, 0xFEC8, 0xEC80, 0xC800, 0xFFEC, 0xFE80, 0xE800, 0xFFE8, 0xFF00,
    0xFFF0, 0xF000, 0xF710, 0x008E, 0x7100, 0x08CE, 0x008C, 0x7310, 0x3100, 0x8CCE, 0x088C, 0x3110, 0x6666, 0x366C,
    0x17E8, 0x0FF0, 0x718E, 0x399C,
];

/// The texel of the second line whose highest bit is left out, per partition; on the first line it is texel 0.
const ANCHORS: [usize; 32] =
    [15, 15, 15, 15, 15, 15, 15, 15, 15, 15, 15, 15, 15, 15, 15, 15, 15, 2, 8, 2, 2, 8, 8, 15, 2, 8, 2, 2, 8, 8, 2, 2];

/// Shares of the second end, of 64.
const WEIGHTS_3: [u32; 8] = [0, 9, 18, 27, 37, 46, 55, 64];
const WEIGHTS_4: [u32; 16] = [0, 4, 9, 13, 17, 21, 26, 30, 34, 38, 43, 47, 51, 55, 60, 64];

/// The texels of a block, brought into [0, 1]: what lies above is no share of a range.
pub(crate) fn decode(block: [u8; 16]) -> Texels {
    halves(block).map(|texel| texel.map(|bits| f16::from_bits(bits).to_f32().min(1.0)))
}

/// The bits of the halves of a block, `[texel][channel]`.
fn halves(block: [u8; 16]) -> [[u16; 3]; 16] {
    let bits = u128::from_le_bytes(block);
    let Some(number) = MODES.iter().position(|mode| (bits & ((1 << mode.width) - 1)) as u8 == mode.code) else {
        return [[0; 3]; 16];
    };
    let mode = &MODES[number];
    let header = if mode.two { 77 } else { 65 };
    let mut ends = Ends::default();
    for (i, (end, channel, bit)) in PLACES[number][..(header - mode.width) as usize].iter().enumerate() {
        let value = (bits >> (mode.width as usize + i) & 1) as u32;
        ends[usize::from(*end)][usize::from(*channel)] |= value << bit;
    }
    let ends = whole(ends, mode);
    let partition = if mode.two { (bits >> 77 & 31) as usize } else { 0 };
    let mut rest = bits >> if mode.two { 82 } else { 65 };
    std::array::from_fn(|texel| {
        let second = mode.two && PARTITIONS[partition] >> texel & 1 == 1;
        let anchor = texel == 0 || (mode.two && texel == ANCHORS[partition]);
        let width = if mode.two { 3 } else { 4 } - u32::from(anchor);
        let index = (rest & ((1 << width) - 1)) as usize;
        rest >>= width;
        let weight = if mode.two { WEIGHTS_3[index] } else { WEIGHTS_4[index] };
        let [a, b] = if second { [ends[2], ends[3]] } else { [ends[0], ends[1]] };
        std::array::from_fn(|c| {
            let mixed = (a[c] * (64 - weight) + b[c] * weight + 32) >> 6;
            ((mixed * 31) >> 6) as u16
        })
    })
}

/// The ends in 16 bits: differences are added to the first, then the range of the mode is stretched.
fn whole(ends: Ends, mode: &Mode) -> Ends {
    let mask = (1 << mode.bits) - 1;
    let mut full = ends;
    for (end, values) in full.iter_mut().enumerate() {
        for (channel, value) in values.iter_mut().enumerate() {
            if end > 0 && mode.transformed {
                let unused = 32 - mode.delta[channel];
                let difference = ((*value << unused) as i32) >> unused;
                *value = ends[0][channel].wrapping_add_signed(difference) & mask;
            }
            *value = match *value {
                value if mode.bits >= 15 => value,
                0 => 0,
                value if value == mask => 0xFFFF,
                value => ((value << 15) + 0x4000) >> (mode.bits - 1),
            };
        }
    }
    full
}

#[cfg(test)]
mod tests {
    use super::*;
    use block_compression::decode::decompress_blocks_as_rgba16f;
    use block_compression::{BC6HSettings, CompressionVariant};

    /// The decoder of another crate. Version 0.11 puts texels of three numbers where four belong; both are understood.
    fn theirs(block: [u8; 16]) -> [[u16; 3]; 16] {
        let mut out = [f16::from_bits(0x7777); 64];
        let variant = CompressionVariant::BC6H(BC6HSettings::basic());
        decompress_blocks_as_rgba16f(variant, 4, 4, &block, &mut out);
        let step = if out[12].to_bits() == 0x7777 { 3 } else { 4 };
        std::array::from_fn(|i| std::array::from_fn(|c| out[i / 4 * 16 + i % 4 * step + c].to_bits()))
    }

    /// Pseudo-random blocks: those of mode `number` where there is one.
    fn block(number: usize, seed: u64) -> [u8; 16] {
        let mut state = (seed * 64 + number as u64).wrapping_mul(0x9E37_79B9_7F4A_7C15) | 1;
        let mut next = || {
            state ^= state << 13;
            state ^= state >> 7;
            state ^= state << 17;
            u128::from(state)
        };
        let bits = next() << 64 | next();
        let mode = &MODES[number];
        (bits >> mode.width << mode.width | u128::from(mode.code)).to_le_bytes()
    }

    #[test]
    fn every_mode_is_decoded_as_another_decoder_does() {
        for number in 0..14 {
            for seed in 0..3000 {
                let block = block(number, seed);
                assert_eq!(halves(block), theirs(block), "mode {number}, seed {seed}");
            }
        }
    }

    /// Two texels of one block differ where a bit of its indices does.
    #[test]
    fn every_mode_is_decoded_as_another_decoder_does_can_fail() {
        for number in 0..14 {
            let mut changed = block(number, 0);
            changed[15] ^= 0x40;
            let same = (0..16).filter(|i| halves(changed)[*i] == theirs(block(number, 0))[*i]).count();
            assert!(same < 16, "mode {number}");
        }
    }

    /// Blocks by hand. Mode 11 (code 3) holds ends of ten bits: all ones are the largest half, and 0 is 0; mode 14 (code 15) holds
    /// sixteen bits, of which `x * 31 / 64` are the half.
    #[test]
    fn blocks_by_hand() {
        let largest = 3 | ((1_u128 << 60) - 1) << 5;
        assert_eq!(halves(largest.to_le_bytes()), [[0x7BFF; 3]; 16]);
        assert_eq!(halves(3_u128.to_le_bytes()), [[0; 3]; 16]);
        // Red alone, from 0 to the end: index 15 at the last texel, 0 elsewhere.
        let line = 3 | 1023_u128 << 35 | 15_u128 << 124;
        let texels = halves(line.to_le_bytes());
        assert_eq!((texels[15], texels[14]), ([0x7BFF, 0, 0], [0; 3]));
        // 0x8000 has its highest bit at 39 in mode 14, differences are 0: 0x8000 * 31 >> 6 = 0x3E00, which is 1.5.
        let whole = 15 | 1_u128 << 39;
        assert_eq!(halves(whole.to_le_bytes()), [[0x3E00, 0, 0]; 16]);
        assert_eq!(decode(whole.to_le_bytes())[0], [1.0, 0.0, 0.0]);
        for reserved in [0b10011_u128, 0b10111, 0b11011, 0b11111] {
            assert_eq!(halves((reserved | !31).to_le_bytes()), [[0; 3]; 16]);
        }
    }
}
