//! Pictures of coefficients, one upon the other, as a file holds them.

use serde::{Deserialize, Serialize};

/// Layers of texels: `[layer][row][column][channel]`.
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
    /// The numbers.
    pub bytes: Vec<u8>,
}

/// How numbers of a layer are held.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Encoding {
    /// Little-endian f32.
    F32,
}

impl Encoding {
    /// The name as typed and printed, such as `f32`.
    #[must_use]
    pub fn id(self) -> &'static str {
        match self {
            Self::F32 => "f32",
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

    /// The first byte that contradicts the sizes and what is wrong there; none where all is sound. Sides and channels are taken
    /// for checked; nothing is allocated.
    pub(crate) fn fault(&self) -> Option<(usize, String)> {
        let sides = [self.width, self.height, self.channels].map(u64::from);
        let numbers = sides.iter().product::<u64>().checked_mul(u64::from(self.count));
        if numbers.and_then(|n| n.checked_mul(4)) != Some(self.bytes.len() as u64) {
            return Some((0, format!("{} bytes are not what its sizes demand", self.bytes.len())));
        }
        let sound = |b: &[u8]| f32::from_le_bytes([b[0], b[1], b[2], b[3]]).is_finite();
        let place = self.bytes.chunks_exact(4).position(|b| !sound(b))?;
        Some((4 * place, format!("number {place} is not finite")))
    }

    /// The numbers as f32: `[layer][row][column][channel]`.
    #[must_use]
    pub fn decode(&self) -> Vec<f32> {
        match self.encoding {
            Encoding::F32 => self.bytes.chunks_exact(4).map(|b| f32::from_le_bytes([b[0], b[1], b[2], b[3]])).collect(),
        }
    }
}
