//! Decoding PNG, JPEG, WebP and KTX2 files within limits.

use std::io::Cursor;

use basisu::{DecodeFlags, TargetFormat, Transcoder};
use image::{ImageReader, Limits};

use crate::{Texture, Warning, Wrap};

/// Longest edge of a picture that is kept, texels; longer ones are shrunk.
const MAX_EDGE: u32 = 16_384;
/// Decoded bytes of one picture before it is shrunk (2 GiB).
const PICTURE_BYTES: u64 = 2 << 30;
/// Decoded bytes that all pictures of a scene may take whatever their files' sizes (4 GiB).
const FREE_BYTES: u64 = 4 << 30;
/// Decoded bytes per byte of file beyond that; real photographs reach about 60.
const BYTES_PER_FILE_BYTE: u64 = 200;
/// Texels from which on a picture of one colour is kept as one texel.
const MANY_TEXELS: usize = 1 << 18;
/// How a KTX2 file begins.
const KTX2: &[u8] = b"\xABKTX 20\xBB\r\n\x1A\n";

/// Memory that the pictures of one scene may still take, so that tiny files cannot ask for all there is.
#[derive(Debug)]
pub(crate) struct Budget {
    bytes: u64,
    notes: Vec<Warning>,
}

impl Budget {
    /// The budget of a fresh scene.
    pub(crate) fn new() -> Self {
        Self { bytes: FREE_BYTES, notes: Vec::new() }
    }

    /// What was done to pictures to keep to the budget.
    pub(crate) fn into_notes(self) -> Vec<Warning> {
        self.notes
    }

    /// Decodes a picture to 8-bit RGBA; says in one sentence why it cannot.
    ///
    /// A picture that would take more than half of what is left is shrunk by halves, with a note.
    pub(crate) fn decode(&mut self, name: &str, file: &[u8]) -> Result<Texture, String> {
        self.bytes = self.bytes.saturating_add(BYTES_PER_FILE_BYTE * file.len() as u64);
        let (width, height, rgba) = if file.starts_with(KTX2) { transcode(file)? } else { decode(file)? };
        let mut picture = Texture { name: name.into(), width, height, rgba, wrap: [Wrap::Repeat; 2] };
        let first = picture.rgba[0];
        if picture.rgba.len() >= MANY_TEXELS && picture.rgba.iter().all(|texel| *texel == first) {
            // One texel looks the same, however it is filtered and wrapped.
            picture = Texture { width: 1, height: 1, rgba: vec![first], ..picture };
        }
        let taken = |picture: &Texture| 4 * picture.rgba.len() as u64;
        while picture.width.max(picture.height) > MAX_EDGE || picture.rgba.len() > 1 && taken(&picture) > self.bytes / 2
        {
            picture = halved(&picture);
        }
        if picture.rgba.len() > 1 && picture.width < width {
            let message = format!(
                "{width} x {height} texels are too many beside the other pictures; shrunk to {} x {}",
                picture.width, picture.height
            );
            self.notes.push(Warning { object: format!("picture {name}"), message });
        }
        self.bytes -= taken(&picture).min(self.bytes);
        Ok(picture)
    }
}

/// Width, height and texels.
type Decoded = (u32, u32, Vec<[u8; 4]>);

fn check_size(width: u32, height: u32, file: &[u8]) -> Result<(), String> {
    let needed = 4 * u64::from(width) * u64::from(height);
    if width == 0 || height == 0 || needed > PICTURE_BYTES {
        return Err(format!("{width} x {height} texels from {} bytes are refused as too large", file.len()));
    }
    Ok(())
}

fn decode(file: &[u8]) -> Result<Decoded, String> {
    let reader = || ImageReader::new(Cursor::new(file)).with_guessed_format().map_err(|e| e.to_string());
    if reader()?.format().is_none() {
        return Err("is neither PNG, JPEG, WebP nor KTX2".into());
    }
    // The size is checked as RGBA before anything is decoded.
    let (width, height) = reader()?.into_dimensions().map_err(|e| e.to_string())?;
    check_size(width, height, file)?;
    let mut limits = Limits::default();
    limits.max_alloc = Some(2 * PICTURE_BYTES);
    let mut reader = reader()?;
    reader.limits(limits);
    let decoded = reader.decode().map_err(|e| e.to_string())?.into_rgba8();
    Ok((width, height, decoded.as_chunks::<4>().0.to_vec()))
}

/// A KTX2 file of Basis Universal (KHR_texture_basisu).
fn transcode(file: &[u8]) -> Result<Decoded, String> {
    // The sizes stand at bytes 20 and 24 of the header.
    let word = |at: usize| file.get(at..).and_then(|b| b.first_chunk::<4>()).map_or(0, |b| u32::from_le_bytes(*b));
    let (width, height) = (word(20), word(24));
    check_size(width, height, file)?;
    if width.max(height) > MAX_EDGE || !ktx::is_sound(file) {
        return Err("this KTX2 file is no plain picture, or its parts lie outside of it".into());
    }
    let unread = |what: String| format!("this KTX2 file cannot be read as Basis Universal ({what})");
    let transcode = || Transcoder::new(file)?.transcode(0, TargetFormat::Rgba32, DecodeFlags::NONE);
    // The decoder indexes its tables unchecked where a stream contradicts itself.
    let bytes = std::panic::catch_unwind(transcode).map_err(|_| unread("the data contradict themselves".into()))?;
    let bytes = bytes.map_err(|error| unread(format!("{error:?}")))?;
    let texels = bytes.as_chunks::<4>().0.to_vec();
    if texels.len() as u64 != u64::from(width) * u64::from(height) {
        return Err(format!("this KTX2 file holds {} texels for {width} x {height}", texels.len()));
    }
    Ok((width, height, texels))
}

/// The frame of a KTX2 file (KTX 2.0, section 3).
mod ktx {
    /// Whether a file holds one picture, and each part that its header names lies in it.
    pub(super) fn is_sound(file: &[u8]) -> bool {
        let word =
            |at: usize| file.get(at..).and_then(|b| b.first_chunk::<4>()).map_or(u32::MAX, |b| u32::from_le_bytes(*b));
        let long =
            |at: usize| file.get(at..).and_then(|b| b.first_chunk::<8>()).map_or(u64::MAX, |b| u64::from_le_bytes(*b));
        let inside = |offset: u64, length: u64| offset.checked_add(length).is_some_and(|end| end <= file.len() as u64);
        // Depth, layers, faces, levels.
        let [depth, layers, faces, levels] = [28, 32, 36, 40].map(word);
        let plain = depth <= 1 && layers <= 1 && faces == 1 && levels <= 32;
        let descriptor = inside(u64::from(word(48)), u64::from(word(52)));
        let notes = inside(u64::from(word(56)), u64::from(word(60)));
        let tables = notes && inside(long(64), long(72));
        // At most 16 bytes for a block of 4 x 4 texels.
        let blocks = |at: usize| u64::from(word(at)).div_ceil(4);
        let most = 16 * blocks(20) * blocks(24);
        let level = |at: usize| inside(long(at), long(at + 8)) && long(at + 16) <= most;
        plain && descriptor && tables && (0..levels.max(1) as usize).all(|index| level(80 + 24 * index))
    }
}

/// The picture at half the width and height; means of the bytes as stored.
fn halved(picture: &Texture) -> Texture {
    let (width, height) = (picture.width.div_ceil(2), picture.height.div_ceil(2));
    let texel = |x: u32, y: u32| picture.rgba[y as usize * picture.width as usize + x as usize].map(u32::from);
    let mean = |x: u32, y: u32| {
        let [right, below] = [(2 * x + 1).min(picture.width - 1), (2 * y + 1).min(picture.height - 1)];
        let four = [texel(2 * x, 2 * y), texel(right, 2 * y), texel(2 * x, below), texel(right, below)];
        std::array::from_fn(|c| ((four.iter().map(|t| t[c]).sum::<u32>() + 2) / 4) as u8)
    };
    let rgba = (0..height).flat_map(|y| (0..width).map(move |x| (x, y))).map(|(x, y)| mean(x, y)).collect();
    Texture { name: picture.name.clone(), width, height, rgba, wrap: picture.wrap }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn png(width: u32, height: u32, value: impl Fn(u32, u32) -> u8) -> Vec<u8> {
        let mut bytes = Cursor::new(Vec::new());
        let picture = image::GrayImage::from_fn(width, height, |x, y| image::Luma([value(x, y)]));
        picture.write_to(&mut bytes, image::ImageFormat::Png).expect("a PNG");
        bytes.into_inner()
    }

    #[test]
    fn flat_pictures_are_one_texel() {
        let mut budget = Budget::new();
        let flat = budget.decode("flat", &png(1024, 512, |_, _| 7)).expect("a picture");
        assert_eq!((flat.width, flat.height, flat.rgba), (1, 1, vec![[7, 7, 7, 255]]));
        let spot = budget.decode("spot", &png(1024, 512, |x, y| u8::from(x + y == 0))).expect("a picture");
        assert_eq!((spot.width, spot.height), (1024, 512), "can fail: one other texel keeps it whole");
        assert!(budget.into_notes().is_empty());
    }

    #[test]
    fn pictures_beyond_the_budget_are_shrunk_and_told() {
        let file = png(256, 256, |x, _| if x < 128 { 10 } else { 200 });
        let mut wide = Budget { bytes: 1 << 20, notes: Vec::new() };
        let whole = wide.decode("two halves", &file).expect("a picture");
        assert_eq!((whole.width, wide.notes.len()), (256, 0), "can fail: with enough memory it stays");
        let mut tight = Budget { bytes: 0, notes: Vec::new() };
        let left = BYTES_PER_FILE_BYTE * file.len() as u64;
        let small = tight.decode("two halves", &file).expect("a picture");
        assert!(small.width < 256 && 4 * u64::from(small.width * small.height) <= left / 2, "{}", small.width);
        let row = &small.rgba[..small.width as usize];
        assert!(row[0] == [10, 10, 10, 255] && row[row.len() - 1] == [200, 200, 200, 255], "{row:?}");
        assert!(tight.notes[0].message.contains("256 x 256 texels"), "{:?}", tight.notes);
    }

    #[test]
    fn other_files_are_told_by_name() {
        let mut budget = Budget::new();
        assert!(budget.decode("x", b"abc").expect_err("no picture").contains("neither PNG"));
        let mut ktx = KTX2.to_vec();
        ktx.extend([0; 100]);
        assert!(budget.decode("x", &ktx).expect_err("no size").contains("0 x 0"));
        ktx[20] = 4;
        ktx[24] = 4;
        assert!(budget.decode("x", &ktx).expect_err("no data").contains("KTX2"));
    }
}
