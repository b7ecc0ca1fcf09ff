//! Pictures of coefficients, one upon the other, as a file holds them.

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
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Encoding {
    /// Little-endian f32.
    F32,
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

    /// The numbers as f32: `[layer][row][column][channel]`.
    #[must_use]
    pub fn decode(&self) -> Vec<f32> {
        match self.encoding {
            Encoding::F32 => self.bytes.chunks_exact(4).map(|b| f32::from_le_bytes([b[0], b[1], b[2], b[3]])).collect(),
        }
    }
}
