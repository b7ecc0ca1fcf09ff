//! Pictures of coefficients, one upon the other, as a file holds them.

use crate::block::{Bc1, Bc6h};
use crate::{block, eight_bits};
use half::f16;
use serde::{Deserialize, Serialize};

/// Layers of texels: `[layer][row][column][channel]`.
///
/// [`Layers::encode`] makes them, [`Layers::decode`] gives the numbers back; `docs/format.md` describes the bytes of each encoding.
#[derive(Debug, Clone, PartialEq)]
pub struct Layers {
    /// Texels along u.
    pub width: u32,
    /// Texels along v.
    pub height: u32,
    /// Number of layers.
    pub count: u32,
    /// 1 or 3.
    pub channels: u32,
    /// How the numbers are held.
    pub encoding: Encoding,
    /// The numbers, with all that is needed to decode them: their length is what the encoding costs.
    pub bytes: Vec<u8>,
}

/// How numbers of a layer are held.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Encoding {
    /// Little-endian f32.
    F32,
    /// Little-endian IEEE 754 half.
    F16,
    /// Eight bits between the least and the greatest number of each chart and layer.
    U8,
    /// Blocks of 4x4 texels in 8 bytes: BC1, also called DXT1, between the least and the greatest number of each layer and channel.
    Bc1,
    /// Blocks of 4x4 texels in 16 bytes: unsigned BC6H, above the least number of each layer.
    Bc6h,
}

impl Encoding {
    /// Every encoding, the most exact first.
    pub const ALL: [Self; 5] = [Self::F32, Self::F16, Self::U8, Self::Bc6h, Self::Bc1];

    /// The name as typed and printed, such as `bc6h`.
    #[must_use]
    pub fn id(self) -> &'static str {
        match self {
            Self::F32 => "f32",
            Self::F16 => "f16",
            Self::U8 => "u8",
            Self::Bc1 => "bc1",
            Self::Bc6h => "bc6h",
        }
    }
}

impl Layers {
    /// The numbers in [`Encoding::F32`].
    ///
    /// # Panics
    /// When there are not `count * height * width * channels` values.
    #[must_use]
    pub fn exact([width, height, count, channels]: [u32; 4], values: &[f32]) -> Self {
        let expected = [width, height, count, channels].map(|n| n as usize).iter().product::<usize>();
        assert_eq!(values.len(), expected, "one value per layer, texel and channel");
        let bytes = values.iter().flat_map(|value| value.to_le_bytes()).collect();
        Self { width, height, count, channels, encoding: Encoding::F32, bytes }
    }

    /// Texels of a layer.
    pub(crate) fn plane(&self) -> usize {
        self.width as usize * self.height as usize
    }

    /// Numbers of all layers; none where they are too many to count.
    fn numbers(&self) -> Option<usize> {
        let sizes = [self.width, self.height, self.count, self.channels];
        sizes.into_iter().try_fold(1_usize, |product, n| product.checked_mul(n as usize))
    }

    /// The first byte that contradicts the sizes and what is wrong there; none where all is sound. Sides and channels are taken
    /// for checked; nothing is allocated.
    pub(crate) fn fault(&self) -> Option<(usize, String)> {
        let expected = match self.encoding {
            Encoding::F32 => self.numbers().and_then(|n| n.checked_mul(4)),
            Encoding::F16 => self.numbers().and_then(|n| n.checked_mul(2)),
            Encoding::U8 => return eight_bits::fault(self),
            Encoding::Bc1 => block::length::<Bc1>(self),
            Encoding::Bc6h => block::length::<Bc6h>(self),
        };
        if expected != Some(self.bytes.len()) {
            return Some((0, format!("{} bytes are not what its sizes demand", self.bytes.len())));
        }
        let infinite = |step: usize, finite: fn(&[u8]) -> bool| self.bytes.chunks_exact(step).position(|b| !finite(b));
        match self.encoding {
            Encoding::F16 => infinite(2, |b| f16::from_le_bytes([b[0], b[1]]).is_finite())
                .map(|place| (2 * place, format!("number {place} is not finite"))),
            Encoding::Bc1 => block::fault::<Bc1>(self),
            Encoding::Bc6h => block::fault::<Bc6h>(self),
            _ => infinite(4, |b| f32_at(b, 0).is_finite())
                .map(|place| (4 * place, format!("number {place} is not finite"))),
        }
    }

    /// The numbers as f32: `[layer][row][column][channel]`.
    ///
    /// The same on every machine. Layers of a file were checked when it was read.
    ///
    /// # Panics
    /// When the bytes are not what sizes and encoding demand.
    #[must_use]
    pub fn decode(&self) -> Vec<f32> {
        (0..self.count).flat_map(|layer| self.decode_layer(layer)).collect()
    }

    /// The numbers of one layer as f32: `[row][column][channel]`, for sheets whose numbers together would take much memory.
    ///
    /// # Panics
    /// When there is no such layer, or the bytes are not what sizes and encoding demand.
    #[must_use]
    pub fn decode_layer(&self, layer: u32) -> Vec<f32> {
        assert!(layer < self.count, "there are {} layers, not {layer}", self.count);
        let numbers = self.plane() * self.channels as usize;
        let part = |bytes: usize| self.bytes[layer as usize * numbers * bytes..][..numbers * bytes].chunks_exact(bytes);
        match self.encoding {
            Encoding::F32 => part(4).map(|b| f32_at(b, 0)).collect(),
            Encoding::F16 => part(2).map(|b| f16::from_le_bytes([b[0], b[1]]).to_f32()).collect(),
            Encoding::U8 => eight_bits::decode(self, layer as usize),
            Encoding::Bc1 => block::decode::<Bc1>(self, layer as usize),
            Encoding::Bc6h => block::decode::<Bc6h>(self, layer as usize),
        }
    }
}

/// The f32 that begins at byte `at`.
pub(crate) fn f32_at(bytes: &[u8], at: usize) -> f32 {
    f32::from_le_bytes(std::array::from_fn(|i| bytes[at + i]))
}
