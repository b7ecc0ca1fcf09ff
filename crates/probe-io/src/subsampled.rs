//! OpenEXR channels of fewer samples than pixels: the `exr` crate (1.74) refuses files that have any.
//!
//! The file is given to the crate with a sampling of 1 written over the true one, and blocks are unpacked here
//! with the crate's compressors, told the sizes that the blocks have in truth.

use crate::error::Fault;
use exr::compression::Compression;
use exr::meta::BlockDescription;
use exr::meta::attribute::{ChannelDescription, ChannelList, IntegerBounds, SampleType};
use exr::meta::header::Header;
use exr::prelude::Vec2;

/// Pixels per sample along x and y.
pub(crate) type Sampling = (usize, usize);

/// The sampling of every channel of every part, and a copy of the file that claims 1; nothing where all have 1, or where the
/// header cannot be followed and is left to the crate.
pub(crate) fn hide(bytes: &[u8]) -> Option<(Vec<u8>, Vec<Vec<Sampling>>)> {
    let version = u32::from_le_bytes(bytes.get(4..8)?.try_into().ok()?);
    let is_multi_part = version & 0x1000 != 0;
    let mut places = Vec::new();
    let mut parts = Vec::new();
    let mut at = 8;
    loop {
        let mut channels = Vec::new();
        while *bytes.get(at)? != 0 {
            let (_, kind) = (text(bytes, &mut at)?, text(bytes, &mut at)?);
            let size = usize::try_from(integer(bytes, &mut at)?).ok()?;
            let end = at.checked_add(size).filter(|end| *end <= bytes.len())?;
            if kind == b"chlist" {
                let mut inner = at;
                while inner < end && bytes[inner] != 0 {
                    text(bytes, &mut inner)?;
                    // Type, linearity and three bytes without meaning.
                    inner += 8;
                    places.push(inner);
                    let (x, y) = (integer(bytes, &mut inner)?, integer(bytes, &mut inner)?);
                    channels.push((usize::try_from(x).ok()?, usize::try_from(y).ok()?));
                }
            }
            at = end;
        }
        at += 1;
        parts.push(channels);
        if !is_multi_part || *bytes.get(at)? == 0 {
            break;
        }
    }
    if parts.iter().flatten().all(|sampling| *sampling == (1, 1)) {
        return None;
    }
    let mut copy = bytes.to_vec();
    for place in places {
        copy.get_mut(place..place + 8)?.copy_from_slice(&[1, 0, 0, 0, 1, 0, 0, 0]);
    }
    Some((copy, parts))
}

/// Bytes up to the next zero, and past it.
fn text<'a>(bytes: &'a [u8], at: &mut usize) -> Option<&'a [u8]> {
    let rest = bytes.get(*at..)?;
    let length = rest.iter().take(256).position(|b| *b == 0)?;
    *at += length + 1;
    Some(&rest[..length])
}

fn integer(bytes: &[u8], at: &mut usize) -> Option<i32> {
    let value = bytes.get(*at..at.checked_add(4)?)?.try_into().ok().map(i32::from_le_bytes);
    *at += 4;
    value
}

/// How many multiples of `step` there are from `start` on in `length` numbers.
pub(crate) fn samples(start: i32, length: usize, step: usize) -> usize {
    let (start, step) = (i64::from(start), step as i64);
    ((start + length as i64).div_euclid(step) - start.div_euclid(step)) as usize
        + usize::from(start.rem_euclid(step) == 0)
        - usize::from((start + length as i64).rem_euclid(step) == 0)
}

/// Refuses parts whose sampling has no meaning.
pub(crate) fn check(header: &Header, sampling: &[Sampling]) -> Result<(), Fault> {
    if header.channels.list.len() != sampling.len() || sampling.iter().any(|(x, y)| *x == 0 || *y == 0) {
        return Err(Fault::Invalid("damaged OpenEXR file: the sampling of a channel is 0".to_owned()));
    }
    if header.blocks != BlockDescription::ScanLines {
        return Err(Fault::Invalid("tiles with subsampled channels; save as lines or as plain RGB".to_owned()));
    }
    Ok(())
}

/// Unpacks a block of lines that begins at `first` (absolute) and has `size` pixels.
pub(crate) fn unpack(
    header: &Header,
    sampling: &[Sampling],
    first: Vec2<i32>,
    size: Vec2<usize>,
    packed: Vec<u8>,
) -> Result<Vec<u8>, Fault> {
    let channels = || header.channels.list.iter().zip(sampling);
    let line = |y: i32| -> usize {
        let sampled = channels().filter(|(_, (_, step))| y.rem_euclid(*step as i32) == 0);
        sampled.map(|(c, (step, _))| samples(first.x(), size.x(), *step) * c.sample_type.bytes_per_sample()).sum()
    };
    let bytes: usize = (0..size.y() as i32).map(|y| line(first.y() + y)).sum();
    if packed.len() == bytes {
        return Ok(packed);
    }
    let damaged = |error: exr::error::Error| Fault::Invalid(format!("damaged OpenEXR file: {error}"));
    match header.compression {
        // These do not ask what the bytes are: they stand for halves in one line.
        Compression::RLE | Compression::ZIP1 | Compression::ZIP16 if bytes > 0 => {
            let mut plain = header.clone();
            let channel = ChannelDescription::new("Y", SampleType::F16, false);
            plain.channels = ChannelList::new([channel].into_iter().collect());
            plain.layer_size = Vec2(bytes / 2, 1);
            let section = IntegerBounds::new((0, 0), (bytes / 2, 1));
            plain.compression.decompress_image_section_from_le(&plain, packed, section, false).map_err(damaged)
        }
        Compression::PIZ | Compression::PXR24 | Compression::DWAA(_) | Compression::DWAB(_) => {
            let (x, y) = (first.x(), first.y());
            let whole = |(sx, sy): &Sampling| {
                let (sx_signed, sy_signed) = (*sx as i32, *sy as i32);
                let starts = x.rem_euclid(sx_signed) == 0 && y.rem_euclid(sy_signed) == 0;
                starts && size.x().is_multiple_of(*sx) && size.y().is_multiple_of(*sy)
            };
            if !sampling.iter().all(whole) || !bytes.is_multiple_of(size.area()) {
                let what =
                    format!("{} with subsampled channels in odd sizes; save as ZIP or plain RGB", header.compression);
                return Err(Fault::Unsupported(what));
            }
            let mut true_header = header.clone();
            for (channel, (x, y)) in true_header.channels.list.iter_mut().zip(sampling) {
                channel.sampling = Vec2(*x, *y);
            }
            true_header.channels.bytes_per_pixel = bytes / size.area();
            let section = IntegerBounds { position: Vec2(0, 0), size };
            header.compression.decompress_image_section_from_le(&true_header, packed, section, false).map_err(damaged)
        }
        Compression::Uncompressed => Err(Fault::Invalid(format!("a block has {} bytes, not {bytes}", packed.len()))),
        other => Err(Fault::Unsupported(format!("{other} with subsampled channels; save as ZIP, PIZ or plain RGB"))),
    }
}

/// A channel of fewer samples than pixels.
#[derive(Debug)]
pub(crate) struct Plane {
    sampling: Sampling,
    /// The first pixel of the picture, absolute.
    first: (i32, i32),
    width: usize,
    height: usize,
    values: Vec<f32>,
}

impl Plane {
    /// A plane of zeros for a picture whose first pixel is `first`.
    pub(crate) fn new(sampling: Sampling, first: Vec2<i32>, size: Vec2<usize>) -> Plane {
        let (width, height) = (samples(first.x(), size.x(), sampling.0), samples(first.y(), size.y(), sampling.1));
        let values = vec![0.0; width * height];
        Plane { sampling, first: (first.x(), first.y()), width, height, values }
    }

    /// The row that holds the samples of a line of the picture.
    pub(crate) fn row(&mut self, line: usize) -> Option<&mut [f32]> {
        let row = samples(self.first.1, line, self.sampling.1);
        self.values.get_mut(row * self.width..(row + 1) * self.width)
    }

    /// The value at a pixel of the picture, linear between samples: chroma that never overshoots.
    pub(crate) fn at(&self, x: usize, y: usize) -> f32 {
        if self.values.is_empty() {
            return 0.0;
        }
        let (left, right, u) = between(self.first.0, x, self.sampling.0, self.width);
        let (top, bottom, v) = between(self.first.1, y, self.sampling.1, self.height);
        let value = |x: usize, y: usize| self.values[y * self.width + x];
        let mix = |a: f32, b: f32, share: f32| if share == 0.0 { a } else { a + (b - a) * share };
        mix(mix(value(left, top), value(right, top), u), mix(value(left, bottom), value(right, bottom), u), v)
    }
}

/// The samples before and after a pixel, and the share of the second.
fn between(first: i32, pixel: usize, step: usize, count: usize) -> (usize, usize, f32) {
    // Samples stand at multiples of the step; the first of them at or after the first pixel.
    let offset = (-i64::from(first)).rem_euclid(step as i64);
    let along = pixel as i64 - offset;
    let last = count - 1;
    if along < 0 {
        return (0, 0, 0.0);
    }
    let (low, rest) = (along as usize / step, along as usize % step);
    (low.min(last), (low + 1).min(last), rest as f32 / step as f32)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn samples_are_counted() {
        for (start, length, step) in [(0, 8, 2), (0, 7, 2), (1, 7, 2), (-3, 7, 2), (-3, 0, 3), (5, 1, 4), (4, 1, 4)] {
            let counted = (start..start + length as i32).filter(|x| x.rem_euclid(step) == 0).count();
            assert_eq!(samples(start, length, step as usize), counted, "{start} {length} {step}");
        }
    }

    #[test]
    fn planes_are_linear_between_samples() {
        // f(x, y) = 3 x - 2 y at even places of a window that begins at (-3, 1).
        let mut plane = Plane::new((2, 2), Vec2(-3, 1), Vec2(7, 6));
        for line in 0..6 {
            let y = line as i32 + 1;
            if y % 2 == 0 {
                let row = plane.row(line).expect("a row");
                assert_eq!(row.len(), 3);
                for (value, x) in row.iter_mut().zip([-2, 0, 2]) {
                    *value = (3 * x - 2 * y) as f32;
                }
            }
        }
        for (x, y) in [(1, 1), (2, 2), (3, 3), (4, 4), (5, 5)] {
            let expected = 3.0 * (x as f32 - 3.0) - 2.0 * (y as f32 + 1.0);
            assert!((plane.at(x, y) - expected).abs() < 1e-5, "({x}, {y}): {}", plane.at(x, y));
        }
        assert_eq!(plane.at(0, 0), plane.at(1, 1), "the border goes on");
    }
}
