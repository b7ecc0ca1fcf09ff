//! Pixels in memory, encoded for a file or for a page.

use super::Error;
use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use image::codecs::jpeg::JpegEncoder;
use image::codecs::png::{CompressionType, FilterType, PngEncoder};
use image::{ExtendedColorType, ImageEncoder};

/// Quality of photographs on a page, 1 to 100.
const JPEG_QUALITY: u8 = 82;

/// A picture of 8 bits per channel, row by row from the top.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Pixels {
    /// Columns.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// sRGB with straight coverage.
    pub rgba: Vec<[u8; 4]>,
}

impl Pixels {
    /// The bytes of a PNG file.
    ///
    /// # Errors
    /// [`Error`] where the number of pixels does not fit the size.
    pub fn png(&self) -> Result<Vec<u8>, Error> {
        self.check("a PNG picture")?;
        let mut bytes = Vec::new();
        let encoder = PngEncoder::new_with_quality(&mut bytes, CompressionType::Best, FilterType::Adaptive);
        encoder
            .write_image(self.rgba.as_flattened(), self.width, self.height, ExtendedColorType::Rgba8)
            .map_err(|error| Error { what: "a PNG picture", reason: error.to_string() })?;
        Ok(bytes)
    }

    /// The encoders would panic where the number of pixels does not fit.
    fn check(&self, what: &'static str) -> Result<(), Error> {
        let expected = self.width as usize * self.height as usize;
        if self.rgba.len() == expected {
            return Ok(());
        }
        let (width, height, pixels) = (self.width, self.height, self.rgba.len());
        Err(Error { what, reason: format!("{pixels} pixels are not {width} by {height}") })
    }

    /// The picture as the text of a `src` attribute: a PNG, which keeps every pixel and its coverage.
    ///
    /// # Errors
    /// As [`Pixels::png`].
    pub fn png_uri(&self) -> Result<String, Error> {
        Ok(format!("data:image/png;base64,{}", STANDARD.encode(self.png()?)))
    }

    /// The picture as the text of a `src` attribute: a JPEG, which is small for a rendered view; coverage is dropped.
    ///
    /// # Errors
    /// As [`Pixels::png`].
    pub fn jpeg_uri(&self) -> Result<String, Error> {
        self.check("a JPEG picture")?;
        let rgb: Vec<u8> = self.rgba.iter().flat_map(|&[r, g, b, _]| [r, g, b]).collect();
        let mut bytes = Vec::new();
        JpegEncoder::new_with_quality(&mut bytes, JPEG_QUALITY)
            .write_image(&rgb, self.width, self.height, ExtendedColorType::Rgb8)
            .map_err(|error| Error { what: "a JPEG picture", reason: error.to_string() })?;
        Ok(format!("data:image/jpeg;base64,{}", STANDARD.encode(bytes)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn checker() -> Pixels {
        let rgba = (0..12u8).map(|i| [20 * i, 255 - 20 * i, i % 2 * 255, if i < 6 { 255 } else { 0 }]).collect();
        Pixels { width: 4, height: 3, rgba }
    }

    fn decoded(uri: &str) -> image::RgbaImage {
        let text = uri.strip_prefix("data:image/png;base64,").unwrap();
        image::load_from_memory(&STANDARD.decode(text).unwrap()).unwrap().to_rgba8()
    }

    /// The decoder of another crate reads back every pixel.
    #[test]
    fn a_png_in_a_page_keeps_every_pixel() {
        let picture = checker();
        assert_eq!(decoded(&picture.png_uri().unwrap()).into_raw(), picture.rgba.as_flattened());
    }

    #[test]
    fn a_png_in_a_page_keeps_every_pixel_can_fail() {
        let mut other = checker();
        other.rgba[5][2] ^= 1;
        assert_ne!(decoded(&other.png_uri().unwrap()).into_raw(), checker().rgba.as_flattened());
    }

    #[test]
    fn wrong_sizes_are_refused() {
        let wrong = Pixels { width: 5, ..checker() };
        assert!(wrong.png().unwrap_err().to_string().contains("PNG"));
    }
}
