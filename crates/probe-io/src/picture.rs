//! Linear pictures in files: read by what the bytes are, written beside and then renamed.

use crate::error::{Error, Fault};
use crate::primaries::ColorSpace;
use crate::{openexr, rgbe};
use std::path::{Path, PathBuf};

/// A picture as it stands in a file, not checked for what radiance may be.
#[derive(Debug)]
pub(crate) struct Picture {
    /// Columns.
    pub(crate) width: usize,
    /// Rows.
    pub(crate) height: usize,
    /// Linear, row by row from the top.
    pub(crate) pixels: Vec<[f32; 3]>,
    /// What the three numbers of a pixel are.
    pub(crate) space: ColorSpace,
    /// The layout that the file's `envmap` attribute states.
    pub(crate) envmap: Option<crate::Layout>,
    /// Notes for the user.
    pub(crate) warnings: Vec<String>,
}

/// Most pixels that any file may hold: 16,384 by 8,192.
const MAX_PIXELS: usize = 1 << 27;

/// Pixels that a file may claim whatever its length: 8,192 by 4,096, which take 400 MB.
const FREE_PIXELS: usize = 1 << 25;

/// Pixels per byte that a longer file may claim; run lengths and deflate of pictures stay far below.
const PIXELS_PER_BYTE: usize = 64;

/// Refuses sizes that a file of this length cannot mean, before anything is allocated for them.
pub(crate) fn check_size(width: usize, height: usize, bytes: usize) -> Result<(), Fault> {
    let allowed = FREE_PIXELS.max(bytes.saturating_mul(PIXELS_PER_BYTE)).min(MAX_PIXELS);
    match width.checked_mul(height) {
        Some(0) => Err(Fault::Invalid(format!("the picture is empty ({width} x {height})"))),
        Some(pixels) if pixels <= allowed => Ok(()),
        _ => Err(Fault::Invalid(format!(
            "{width} x {height} pixels are more than a file of {bytes} bytes may hold here ({allowed})"
        ))),
    }
}

/// Reads a `.hdr` or `.exr` file, told apart by its first bytes; where it has several layers, the one of this name.
pub(crate) fn open(path: &Path, layer: Option<&str>) -> Result<Picture, Error> {
    let bytes = std::fs::read(path).map_err(|source| Error::Io { doing: "read", path: path.to_path_buf(), source })?;
    let read = match bytes.get(..4) {
        Some(start) if start == openexr::MAGIC => openexr::read(&bytes, layer),
        Some([b'#', b'?', ..]) => match layer {
            None => rgbe::read(&bytes),
            Some(name) => Err(Fault::Invalid(format!("there is no layer {name:?}: a Radiance picture has none"))),
        },
        _ => Err(Fault::Invalid("neither an OpenEXR nor a Radiance picture (.exr, .hdr)".to_owned())),
    };
    read.map_err(|fault| fault.at(path))
}

/// Reads width, height and linear Rec. 709 pixels (rows from the top) of a `.hdr` or `.exr` file, as they stand:
/// negative and not finite values too.
///
/// # Errors
/// Where the file cannot be read, is damaged, or holds no RGB or luminance picture.
pub fn read_picture(path: &Path) -> Result<(usize, usize, Vec<[f32; 3]>), Error> {
    let mut picture = open(path, None)?;
    picture.space.undo_chroma(&mut picture.pixels);
    picture.space.convert(&mut picture.pixels);
    Ok((picture.width, picture.height, picture.pixels))
}

/// Writes linear RGB pixels (rows from the top) as a Radiance picture, 8 bits of mantissa.
///
/// # Errors
/// Where the pixels do not fill the size, or the system refuses.
pub fn write_hdr(path: &Path, width: usize, height: usize, pixels: &[[f32; 3]]) -> Result<(), Error> {
    check_shape(path, width, height, pixels)?;
    write_beside(path, &rgbe::encode(width, height, pixels))
}

/// Writes linear RGB pixels (rows from the top) as an OpenEXR picture of 32-bit floats, losslessly compressed.
///
/// # Errors
/// Where the pixels do not fill the size, or the system refuses.
pub fn write_exr(path: &Path, width: usize, height: usize, pixels: &[[f32; 3]]) -> Result<(), Error> {
    write_beside(path, &encode_exr(path, width, height, pixels)?)
}

/// The bytes of [`write_exr`], for whoever writes the file itself; `path` is named in errors.
///
/// # Errors
/// Where the pixels do not fill the size.
pub fn encode_exr(path: &Path, width: usize, height: usize, pixels: &[[f32; 3]]) -> Result<Vec<u8>, Error> {
    check_shape(path, width, height, pixels)?;
    openexr::encode(width, height, pixels).map_err(|fault| fault.at(path))
}

/// Refuses a picture whose pixels do not fill it.
fn check_shape(path: &Path, width: usize, height: usize, pixels: &[[f32; 3]]) -> Result<(), Error> {
    if width > 0 && height > 0 && width.checked_mul(height) == Some(pixels.len()) {
        return Ok(());
    }
    let what = format!("{} pixels do not fill {width} x {height}", pixels.len());
    Err(Fault::Invalid(what).at(path))
}

/// Writes the bytes under a name beside the target and renames, so that a half-written file is never seen.
fn write_beside(path: &Path, bytes: &[u8]) -> Result<(), Error> {
    let mut name = path.as_os_str().to_owned();
    name.push(format!(".{}.part", std::process::id()));
    let part = PathBuf::from(name);
    let written = std::fs::write(&part, bytes).and_then(|()| std::fs::rename(&part, path));
    written.map_err(|source| {
        // The part may not exist; the first error is the one that matters.
        let _ = std::fs::remove_file(&part);
        Error::Io { doing: "write", path: path.to_path_buf(), source }
    })
}
