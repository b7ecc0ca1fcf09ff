//! OpenEXR pictures: RGB or luminance of the first flat layer, mip level 0, through the `exr` crate.
//!
//! Blocks are unpacked one by one, so that what a block claims is checked before the crate allocates for it.

use crate::Layout;
use crate::error::Fault;
use crate::picture::{Picture, check_size};
use exr::block::UncompressedBlock;
use exr::block::chunk::{Chunk, CompressedBlock};
use exr::block::reader::{ChunksReader, Reader};
use exr::meta::attribute::{EnvironmentMap, SampleType};
use exr::meta::header::Header;
use exr::prelude::*;
use std::io::Cursor;

/// The first four bytes of every OpenEXR file.
pub(crate) const MAGIC: [u8; 4] = [0x76, 0x2f, 0x31, 0x01];

/// Most bytes that one block of pixels may unpack to: 256 lines (DWAB) of 16,384 pixels of 16 bytes.
const MAX_BLOCK_BYTES: usize = 1 << 26;

/// Reads a whole `.exr` file.
pub(crate) fn read(bytes: &[u8]) -> std::result::Result<Picture, Fault> {
    let reader = Reader::read_from_buffered(Cursor::new(bytes), false).map_err(fault)?;
    let layer = choose_layer(reader.headers())?;
    let blocks = reader.headers().iter().map(|header| header.chunk_count);
    check_blocks(blocks.fold(0, usize::saturating_add), bytes.len())?;
    let header = reader.headers()[layer].clone();
    check_header(&header, bytes.len())?;
    let mut warnings = Vec::new();
    if !is_rgb(&header) {
        warnings.push("the picture has only luminance: read as grey".to_owned());
    }
    let Vec2(width, height) = header.layer_size;
    Ok(Picture {
        width,
        height,
        pixels: read_pixels(reader, layer, &header)?,
        envmap: header_envmap(&header),
        warnings,
    })
}

/// Says an error of the `exr` crate in our words.
fn fault(error: exr::error::Error) -> Fault {
    match error {
        exr::error::Error::NotSupported(what) => Fault::Unsupported(format!("OpenEXR: {what}")),
        other => Fault::Invalid(format!("damaged OpenEXR file: {other}")),
    }
}

/// Whether the layer has a channel of this name.
fn has_channel(header: &Header, name: &str) -> bool {
    let mut channels = header.channels.list.iter();
    channels.any(|channel| channel.name.to_string() == name)
}

/// Whether the layer holds all three colours.
fn is_rgb(header: &Header) -> bool {
    ["R", "G", "B"].iter().all(|name| has_channel(header, name))
}

/// Whether the layer holds colours or luminance.
fn is_picture(header: &Header) -> bool {
    !header.deep && (is_rgb(header) || has_channel(header, "Y"))
}

/// The layer to read: the first one that holds a picture.
fn choose_layer(headers: &[Header]) -> std::result::Result<usize, Fault> {
    if let Some(layer) = headers.iter().position(is_picture) {
        return Ok(layer);
    }
    let names: Vec<String> = headers
        .iter()
        .flat_map(|header| header.channels.list.iter().take(8))
        .take(16)
        .map(|channel| channel.name.to_string())
        .collect();
    Err(Fault::Unsupported(format!("no flat layer with channels R, G, B or Y; found: {}", names.join(", "))))
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
    for channel in &header.channels.list {
        if channel.sampling != Vec2(1, 1) {
            return Err(Fault::Unsupported(format!("channel {} is subsampled; save as plain RGB", channel.name)));
        }
        if channel.sample_type == SampleType::U32 && ["R", "G", "B", "Y"].contains(&channel.name.to_string().as_str()) {
            return Err(Fault::Unsupported(format!("channel {} holds integers; save as half or float", channel.name)));
        }
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

/// Reads the blocks of the finest level of a layer into an upright picture.
fn read_pixels(
    reader: Reader<Cursor<&[u8]>>,
    layer: usize,
    header: &Header,
) -> std::result::Result<Vec<[f32; 3]>, Fault> {
    let mut chunks = reader
        .filter_chunks(false, |_, tile, block| block.layer == layer && tile.is_largest_resolution_level())
        .map_err(fault)?;
    let meta = chunks.meta_data().clone();
    let Vec2(width, height) = header.layer_size;
    let mut pixels = vec![[0.0f32; 3]; width * height];
    let mut filled = 0;
    for chunk in &mut chunks {
        let chunk = chunk.map_err(fault)?;
        check_chunk(&chunk, layer, header)?;
        let block = UncompressedBlock::decompress_chunk(chunk, &meta, false).map_err(fault)?;
        if block.index.level != Vec2(0, 0) {
            continue;
        }
        copy_block(&block, header, &mut pixels)?;
        filled += block.index.pixel_size.area();
    }
    if filled != width * height {
        let what = format!("blocks hold {filled} pixels, not {width} x {height}: parts are missing or double");
        return Err(Fault::Invalid(what));
    }
    Ok(pixels)
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

/// Copies the colours of a block into the picture.
fn copy_block(block: &UncompressedBlock, header: &Header, pixels: &mut [[f32; 3]]) -> std::result::Result<(), Fault> {
    let grey = !is_rgb(header);
    for line in block.lines(&header.channels) {
        let channel = &header.channels.list[line.location.channel];
        let slots = match channel.name.to_string().as_str() {
            "R" => 0..1,
            "G" if !grey => 1..2,
            "B" if !grey => 2..3,
            "Y" if grey => 0..3,
            _ => continue,
        };
        let values: Vec<f32> = match channel.sample_type {
            SampleType::F16 => {
                line.read_samples::<f16>().map(|v| v.map(f16::to_f32)).collect::<exr::error::Result<_>>()
            }
            _ => line.read_samples::<f32>().collect::<exr::error::Result<_>>(),
        }
        .map_err(fault)?;
        let Vec2(x, y) = line.location.position;
        let start = y * header.layer_size.width() + x;
        let row = pixels.get_mut(start..start + values.len());
        let row = row.ok_or_else(|| Fault::Invalid("a block lies outside the picture".to_owned()))?;
        for (pixel, value) in row.iter_mut().zip(values) {
            pixel[slots.clone()].fill(value);
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
