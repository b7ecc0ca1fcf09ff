//! OpenEXR pictures: one flat layer, mip level 0, as the display window shows it, through the `exr` crate.
//!
//! Blocks are unpacked one by one, so that what a block claims is checked before the crate allocates for it.

use crate::Layout;
use crate::error::Fault;
use crate::layers::{self, Kind, PictureLayer};
use crate::picture::{Picture, check_size};
use crate::primaries::{ColorSpace, Primaries, REC_709, XYZ};
use crate::subsampled::{self, Plane, Sampling, samples};
use exr::block::chunk::{Chunk, CompressedBlock};
use exr::block::reader::{ChunksReader, Reader};
use exr::block::{BlockIndex, UncompressedBlock};
use exr::meta::attribute::{EnvironmentMap, SampleType};
use exr::meta::header::Header;
use exr::prelude::*;
use std::io::Cursor;

/// The first four bytes of every OpenEXR file.
pub(crate) const MAGIC: [u8; 4] = [0x76, 0x2f, 0x31, 0x01];

/// Most bytes that one block of pixels may unpack to: 256 lines (DWAB) of 16,384 pixels of 16 bytes.
const MAX_BLOCK_BYTES: usize = 1 << 26;

/// Reads a whole `.exr` file: the layer of this name, or the one that is most likely the picture.
pub(crate) fn read(bytes: &[u8], layer: Option<&str>) -> std::result::Result<Picture, Fault> {
    let hidden = subsampled::hide(bytes);
    let (bytes, sampling) = match &hidden {
        Some((copy, sampling)) => (copy.as_slice(), sampling.as_slice()),
        None => (bytes, [].as_slice()),
    };
    let reader = Reader::read_from_buffered(Cursor::new(bytes), false).map_err(fault)?;
    let (layer, told) = layers::choose(reader.headers(), layer)?;
    let blocks = reader.headers().iter().map(|header| header.chunk_count);
    check_blocks(blocks.fold(0, usize::saturating_add), bytes.len())?;
    let header = reader.headers()[layer.part].clone();
    check_header(&header, bytes.len())?;
    let mut warnings: Vec<String> = told.into_iter().collect();
    if layer.kind == Kind::Grey {
        warnings.push("the picture has only luminance: read as grey".to_owned());
    }
    let sampling = sampling.get(layer.part).filter(|all| all.iter().any(|one| *one != (1, 1)));
    let pixels = match sampling {
        None => read_pixels(reader, &layer, &header, None)?,
        Some(sampling) => {
            subsampled::check(&header, sampling)?;
            read_pixels(reader, &layer, &header, Some(sampling))?
        }
    };
    let Vec2(width, height) = header.shared_attributes.display_window.size;
    let pixels = display(pixels, &header, bytes.len(), &mut warnings)?;
    Ok(Picture { width, height, pixels, space: space(&header, layer.kind), envmap: header_envmap(&header), warnings })
}

/// What the numbers of the layer are.
fn space(header: &Header, kind: Kind) -> ColorSpace {
    let pair = |Vec2(x, y): Vec2<f32>| [f64::from(x), f64::from(y)];
    let stated = header.shared_attributes.chromaticities.map(|c| Primaries {
        red: pair(c.red),
        green: pair(c.green),
        blue: pair(c.blue),
        white: pair(c.white),
    });
    ColorSpace {
        primaries: if kind == Kind::Xyz { XYZ } else { stated.unwrap_or(REC_709) },
        adapted: header.own_attributes.adopted_neutral.map(pair),
        is_luminance_chroma: kind == Kind::LuminanceChroma,
    }
}

/// The pixels of the data window as the display window shows them: black where there are none.
fn display(
    pixels: Vec<[f32; 3]>,
    header: &Header,
    bytes: usize,
    warnings: &mut Vec<String>,
) -> std::result::Result<Vec<[f32; 3]>, Fault> {
    let (data, shown) = (header.data_window(), header.shared_attributes.display_window);
    if data == shown {
        return Ok(pixels);
    }
    let Vec2(width, height) = shown.size;
    check_size(width, height, bytes)?;
    let common = |axis: fn(Vec2<i32>) -> i32| {
        let bounds = |window: IntegerBounds| (i64::from(axis(window.position)), i64::from(axis(window.end())));
        let ((data_first, data_end), (first, end)) = (bounds(data), bounds(shown));
        (data_first.max(first), data_end.min(end))
    };
    let (left, right) = common(|v| v.x());
    let (top, bottom) = common(|v| v.y());
    if left >= right || top >= bottom {
        return Err(Fault::Invalid("no pixel of the data window lies in the display window".to_owned()));
    }
    let at = |window: IntegerBounds, x: i64, y: i64| {
        let (x, y) = (x - i64::from(window.position.x()), y - i64::from(window.position.y()));
        y as usize * window.size.x() + x as usize
    };
    let mut canvas = vec![[0.0f32; 3]; width * height];
    let length = (right - left) as usize;
    for y in top..bottom {
        let (from, to) = (at(data, left, y), at(shown, left, y));
        canvas[to..to + length].copy_from_slice(&pixels[from..from + length]);
    }
    let covered = length * (bottom - top) as usize;
    let Vec2(columns, rows) = data.size;
    if covered < canvas.len() {
        warnings.push(format!("the file holds {columns} x {rows} pixels of {width} x {height}; the others are black"));
    } else {
        warnings.push(format!(
            "pixels outside the display window ({width} x {height} of {columns} x {rows}) were left out"
        ));
    }
    Ok(canvas)
}

/// Says an error of the `exr` crate in our words.
fn fault(error: exr::error::Error) -> Fault {
    match error {
        exr::error::Error::NotSupported(what) => Fault::Unsupported(format!("OpenEXR: {what}")),
        other => Fault::Invalid(format!("damaged OpenEXR file: {other}")),
    }
}

/// Refuses sizes beyond what the file's length can justify, and pictures with parts left out.
fn check_header(header: &Header, bytes: usize) -> std::result::Result<(), Fault> {
    let Vec2(width, height) = header.layer_size;
    check_size(width, height, bytes)?;
    let Vec2(block_width, block_height) = header.max_block_pixel_size();
    let block =
        block_width.checked_mul(block_height).and_then(|pixels| pixels.checked_mul(header.channels.bytes_per_pixel));
    if block.is_none_or(|size| size > MAX_BLOCK_BYTES) {
        return Err(Fault::Invalid(format!(
            "blocks of {block_width} x {block_height} pixels with {} bytes each are too large",
            header.channels.bytes_per_pixel
        )));
    }
    Ok(())
}

/// Refuses more blocks than the file has room for: each has at least its place in the table.
fn check_blocks(count: usize, bytes: usize) -> std::result::Result<(), Fault> {
    if count.saturating_mul(8) <= bytes {
        return Ok(());
    }
    Err(Fault::Invalid(format!("{count} blocks do not fit into a file of {bytes} bytes")))
}

/// The layout that the `envmap` attribute states.
fn header_envmap(header: &Header) -> Option<Layout> {
    header.own_attributes.environment_map.map(|map| match map {
        EnvironmentMap::LatitudeLongitude => Layout::Equirect,
        EnvironmentMap::Cube => Layout::ExrCube,
    })
}

/// Reads the blocks of the finest level of a layer: its three channels, row by row from the top of the data window.
fn read_pixels(
    reader: Reader<Cursor<&[u8]>>,
    layer: &PictureLayer,
    header: &Header,
    sampling: Option<&Vec<Sampling>>,
) -> std::result::Result<Vec<[f32; 3]>, Fault> {
    let part = layer.part;
    let mut chunks = reader
        .filter_chunks(false, |_, tile, block| block.layer == part && tile.is_largest_resolution_level())
        .map_err(fault)?;
    let meta = chunks.meta_data().clone();
    let mut target = Target::new(layer, header, sampling);
    for chunk in &mut chunks {
        let chunk = chunk.map_err(fault)?;
        check_chunk(&chunk, part, header)?;
        let block = match sampling {
            None => UncompressedBlock::decompress_chunk(chunk, &meta, false).map_err(fault)?,
            Some(sampling) => decompress_lines(chunk, header, sampling)?,
        };
        if block.index.level == Vec2(0, 0) {
            target.copy(&block, header)?;
        }
    }
    target.finish(header.layer_size)
}

/// A block of lines with subsampled channels.
fn decompress_lines(
    chunk: Chunk,
    header: &Header,
    sampling: &[Sampling],
) -> std::result::Result<UncompressedBlock, Fault> {
    let tile = header.get_block_data_indices(&chunk.compressed_block).map_err(fault)?;
    let bounds = header.get_absolute_block_pixel_coordinates(tile).map_err(fault)?;
    bounds.validate(Some(header.layer_size)).map_err(fault)?;
    let CompressedBlock::ScanLine(block) = chunk.compressed_block else {
        return Err(Fault::Invalid("a tile in a picture of lines".to_owned()));
    };
    let first = bounds.position + header.own_attributes.layer_position;
    let data = subsampled::unpack(header, sampling, first, bounds.size, block.compressed_pixels_le)?;
    let position = bounds.position.to_usize("block position").map_err(fault)?;
    let index =
        BlockIndex { layer: chunk.layer_index, pixel_position: position, pixel_size: bounds.size, level: Vec2(0, 0) };
    Ok(UncompressedBlock { index, data })
}

/// Where the samples of blocks go.
struct Target {
    pixels: Vec<[f32; 3]>,
    /// For each channel of the file which of the three numbers it is; several for grey.
    slots: Vec<Vec<usize>>,
    /// Pixels per sample of each channel of the file.
    sampling: Vec<Sampling>,
    /// Channels of fewer samples, by number.
    planes: [Option<Plane>; 3],
    filled: usize,
}

impl Target {
    fn new(layer: &PictureLayer, header: &Header, sampling: Option<&Vec<Sampling>>) -> Target {
        let channels = header.channels.list.len();
        let sampling = sampling.cloned().unwrap_or_else(|| vec![(1, 1); channels]);
        let first = header.own_attributes.layer_position;
        let plane = |slot: usize| {
            let own = sampling[layer.channels[slot]];
            (own != (1, 1)).then(|| Plane::new(own, first, header.layer_size))
        };
        let slots = |channel: usize| (0..3).filter(|slot| layer.channels[*slot] == channel).collect();
        Target {
            pixels: vec![[0.0; 3]; header.layer_size.area()],
            slots: (0..channels).map(slots).collect(),
            planes: [plane(0), plane(1), plane(2)],
            sampling,
            filled: 0,
        }
    }

    /// Copies the samples of a block.
    fn copy(&mut self, block: &UncompressedBlock, header: &Header) -> std::result::Result<(), Fault> {
        let Vec2(left, top) = block.index.pixel_position;
        let Vec2(width, height) = block.index.pixel_size;
        let Vec2(first_x, first_y) = header.own_attributes.layer_position;
        let short = || Fault::Invalid("a block ends too early".to_owned());
        let mut rest = block.data.as_slice();
        for y in top..top + height {
            for (c, channel) in header.channels.list.iter().enumerate() {
                let (step_x, step_y) = self.sampling[c];
                if (i64::from(first_y) + y as i64).rem_euclid(step_y as i64) != 0 {
                    continue;
                }
                let count = samples(first_x.saturating_add(left as i32), width, step_x);
                let size = channel.sample_type.bytes_per_sample();
                let (line, after) = rest.split_at_checked(count * size).ok_or_else(short)?;
                rest = after;
                for slot in self.slots[c].clone() {
                    self.copy_line(line, channel.sample_type, slot, (left, y), header.layer_size.x())?;
                }
            }
        }
        self.filled += block.index.pixel_size.area();
        Ok(())
    }

    /// Copies the samples of one channel in one line.
    fn copy_line(
        &mut self,
        line: &[u8],
        kind: SampleType,
        slot: usize,
        (left, y): (usize, usize),
        width: usize,
    ) -> std::result::Result<(), Fault> {
        let outside = || Fault::Invalid("a block lies outside the picture".to_owned());
        let half = |b: &[u8; 2]| f16::from_ne_bytes(*b).to_f32();
        let full = |b: &[u8; 4]| f32::from_ne_bytes(*b);
        let values: Box<dyn Iterator<Item = f32>> = match kind {
            SampleType::F16 => Box::new(line.as_chunks::<2>().0.iter().map(half)),
            _ => Box::new(line.as_chunks::<4>().0.iter().map(full)),
        };
        if let Some(plane) = &mut self.planes[slot] {
            let row = plane.row(y).ok_or_else(outside)?;
            row.iter_mut().zip(values).for_each(|(target, value)| *target = value);
            return Ok(());
        }
        let row = self.pixels.get_mut(y * width + left..(y + 1) * width).ok_or_else(outside)?;
        row.iter_mut().zip(values).for_each(|(pixel, value)| pixel[slot] = value);
        Ok(())
    }

    /// The whole picture, with the channels of fewer samples spread over it.
    fn finish(mut self, size: Vec2<usize>) -> std::result::Result<Vec<[f32; 3]>, Fault> {
        let Vec2(width, height) = size;
        let filled = self.filled;
        if filled != width * height {
            let what = format!("blocks hold {filled} pixels, not {width} x {height}: parts are missing or double");
            return Err(Fault::Invalid(what));
        }
        for (slot, plane) in self.planes.iter().enumerate() {
            let Some(plane) = plane else { continue };
            for (i, pixel) in self.pixels.iter_mut().enumerate() {
                pixel[slot] = plane.at(i % width, i / width);
            }
        }
        Ok(self.pixels)
    }
}

/// Refuses blocks of other layers, and sizes within a block that its pixels cannot need.
///
/// DWA blocks begin with eleven 64-bit numbers. Numbers 1, 6, 7, 8 and 9 are sizes that the `exr` crate (1.74)
/// allocates as they stand: bytes of plain, of run-length-coded and of unpacked channels, and counts of AC and DC
/// coefficients. None exceeds twice the block's bytes with sides rounded up to 8 pixels.
fn check_chunk(chunk: &Chunk, layer: usize, header: &Header) -> std::result::Result<(), Fault> {
    let bytes = match &chunk.compressed_block {
        CompressedBlock::ScanLine(block) => &block.compressed_pixels_le,
        CompressedBlock::Tile(block) => &block.compressed_pixels_le,
        _ => return Err(Fault::Unsupported("a block of deep data".to_owned())),
    };
    if chunk.layer_index != layer {
        return Err(Fault::Invalid("a block belongs to another layer".to_owned()));
    }
    if !matches!(header.compression, Compression::DWAA(_) | Compression::DWAB(_)) {
        return Ok(());
    }
    let Vec2(width, height) = header.max_block_pixel_size();
    let needed = (width + 8) * (height + 8) * header.channels.bytes_per_pixel;
    let allowed = 2 * needed as u64 + 4096;
    for number in [1, 6, 7, 8, 9] {
        let claimed = bytes.get(8 * number..8 * number + 8).and_then(|b| b.try_into().ok());
        // A shorter block is left to the crate, which refuses or skips it.
        if claimed.is_some_and(|b| u64::from_le_bytes(b) > allowed) {
            return Err(Fault::Invalid(format!("damaged OpenEXR file: size {number} of a DWA block is out of range")));
        }
    }
    Ok(())
}

/// Encodes a picture as floats in ZIP blocks of 16 lines.
pub(crate) fn encode(width: usize, height: usize, pixels: &[[f32; 3]]) -> std::result::Result<Vec<u8>, Fault> {
    let channels = SpecificChannels::rgb(|Vec2(x, y): Vec2<usize>| {
        let [r, g, b] = pixels[y * width + x];
        (r, g, b)
    });
    let encoding =
        Encoding { compression: Compression::ZIP16, blocks: Blocks::ScanLines, line_order: LineOrder::Increasing };
    let layer = Layer::new((width, height), LayerAttributes::named(""), encoding, channels);
    let mut out = Cursor::new(Vec::new());
    let image = Image::from_layer(layer);
    image.write().non_parallel().to_buffered(&mut out).map_err(fault)?;
    Ok(out.into_inner())
}
