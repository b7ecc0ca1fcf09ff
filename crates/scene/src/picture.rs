//! Decoding PNG and JPEG files within limits.

use std::io::Cursor;

use image::{ImageReader, Limits};

use crate::{Texture, Wrap};

/// Longest edge of a picture, texels.
const MAX_EDGE: u32 = 16_384;
/// Decoded bytes that all pictures of a scene may take whatever their files' sizes.
const FREE_BYTES: u64 = 512 << 20;
/// Decoded bytes per byte of file beyond that; real photographs reach about 60.
const BYTES_PER_FILE_BYTE: u64 = 200;

/// Memory that the pictures of one scene may still take, so that tiny files cannot ask for gigabytes.
#[derive(Debug)]
pub(crate) struct Budget(u64);

impl Budget {
    /// The budget of a fresh scene.
    pub(crate) fn new() -> Self {
        Self(FREE_BYTES)
    }

    /// Decodes a picture to 8-bit RGBA; says in one sentence why it cannot.
    pub(crate) fn decode(&mut self, name: &str, file: &[u8]) -> Result<Texture, String> {
        let allowed = self.0 + BYTES_PER_FILE_BYTE * file.len() as u64;
        let mut reader = ImageReader::new(Cursor::new(file)).with_guessed_format().map_err(|e| e.to_string())?;
        if reader.format().is_none() {
            return Err("neither PNG nor JPEG".into());
        }
        let mut limits = Limits::default();
        limits.max_image_width = Some(MAX_EDGE);
        limits.max_image_height = Some(MAX_EDGE);
        limits.max_alloc = Some(allowed);
        reader.limits(limits.clone());
        // The size is checked against the budget as RGBA before anything is decoded.
        let (width, height) = ImageReader::new(Cursor::new(file))
            .with_guessed_format()
            .map_err(|e| e.to_string())?
            .into_dimensions()
            .map_err(|e| e.to_string())?;
        let needed = 4 * u64::from(width) * u64::from(height);
        if width == 0 || height == 0 || width > MAX_EDGE || height > MAX_EDGE || needed > allowed {
            return Err(format!("{width} x {height} texels from {} bytes are refused as too large", file.len()));
        }
        let decoded = reader.decode().map_err(|e| e.to_string())?.into_rgba8();
        self.0 = allowed - needed;
        let (pixels, _) = decoded.as_chunks::<4>();
        Ok(Texture { name: name.into(), width, height, rgba: pixels.to_vec(), wrap: [Wrap::Repeat; 2] })
    }
}
