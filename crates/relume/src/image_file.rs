//! Image files: 8-bit PNG for the display, OpenEXR for linear radiance.

use crate::Error;
use coeff_io::replace;
use image::codecs::png::PngEncoder;
use image::{ExtendedColorType, ImageEncoder};
use render_cpu::Image;
use std::io::{self, Write};
use std::path::Path;

/// A format that images are written in.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ImageFormat {
    /// Display values, sRGB, 8 bits per channel.
    Png,
    /// Linear Rec. 709 radiance, 32-bit floats.
    Exr,
}

impl ImageFormat {
    /// The format that the extension of a file names, in any case of letters.
    ///
    /// # Errors
    /// [`Error::ImageFormat`] for another extension than `.png` and `.exr`.
    pub fn from_path(path: &Path) -> Result<Self, Error> {
        let extension = path.extension().map(|extension| extension.to_ascii_lowercase());
        match extension.as_ref().and_then(|extension| extension.to_str()) {
            Some("png") => Ok(Self::Png),
            Some("exr") => Ok(Self::Exr),
            _ => Err(Error::ImageFormat { path: path.to_owned() }),
        }
    }
}

/// Writes an image; the extension of the file chooses the format. The file is written whole or not at all.
///
/// # Errors
/// [`Error::ImageFormat`] for an unknown extension, [`Error::Write`] where the operating system refuses.
pub fn save_image(image: &Image, path: impl AsRef<Path>) -> Result<(), Error> {
    let path = path.as_ref();
    write_image(path, ImageFormat::from_path(path)?, [image.width, image.height], &image.linear, &image.display)
}

/// Writes one of the two forms of an image of `[width, height]` pixels, row by row from the top.
///
/// # Errors
/// [`Error::Write`] where the operating system refuses, [`Error::LightProbe`] where OpenEXR cannot hold the pixels.
pub fn write_image(
    path: &Path,
    format: ImageFormat,
    [width, height]: [u32; 2],
    linear: &[[f32; 3]],
    display: &[[u8; 4]],
) -> Result<(), Error> {
    let written = match format {
        ImageFormat::Png => write_png(path, [width, height], display),
        ImageFormat::Exr => {
            let bytes = probe_io::encode_exr(path, width as usize, height as usize, linear)?;
            replace(path, |file| file.write_all(&bytes))
        }
    };
    written.map_err(|source| Error::Write { path: path.to_owned(), source })
}

fn write_png(path: &Path, [width, height]: [u32; 2], display: &[[u8; 4]]) -> io::Result<()> {
    replace(path, |file| {
        let written =
            PngEncoder::new(file).write_image(display.as_flattened(), width, height, ExtendedColorType::Rgba8);
        written.map_err(io::Error::other)
    })
}
