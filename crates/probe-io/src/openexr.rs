//! OpenEXR pictures: RGB or luminance of the first flat layer, mip level 0, through the `exr` crate.

use crate::Layout;
use crate::error::Fault;
use crate::picture::{Picture, check_size};
use exr::block::reader::Reader;
use exr::meta::attribute::{EnvironmentMap, SampleType};
use exr::meta::header::Header;
use exr::prelude::*;
use std::io::Cursor;

/// The first four bytes of every OpenEXR file.
pub(crate) const MAGIC: [u8; 4] = [0x76, 0x2f, 0x31, 0x01];

/// Most bytes that one block of pixels may unpack to: 32 lines of 16,384 pixels of 8 floats, doubled.
const MAX_BLOCK_BYTES: usize = 1 << 25;

/// Reads a whole `.exr` file.
pub(crate) fn read(bytes: &[u8]) -> std::result::Result<Picture, Fault> {
    let reader = Reader::read_from_buffered(Cursor::new(bytes), false).map_err(fault)?;
    let header = choose_layer(reader.headers())?;
    check_header(header, bytes.len())?;
    let envmap = header_envmap(header);
    let is_rgb = has_channel(header, "R");
    let Vec2(width, height) = header.layer_size;
    let pixels = if is_rgb { read_rgb(reader)? } else { read_luminance(reader)? };
    let mut warnings = Vec::new();
    if !is_rgb {
        warnings.push("the picture has only luminance: read as grey".to_owned());
    }
    Ok(Picture { width, height, pixels, envmap, warnings })
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

/// Whether the layer holds colours or luminance.
fn is_picture(header: &Header) -> bool {
    let has = |name| has_channel(header, name);
    !header.deep && (has("R") && has("G") && has("B") || has("Y"))
}

/// The layer to read: the first one that holds a picture, which is also the one that the crate will choose.
fn choose_layer(headers: &[Header]) -> std::result::Result<&Header, Fault> {
    if let Some(header) = headers.iter().find(|header| is_picture(header)) {
        return Ok(header);
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
    // Each block has at least its place in the table and a size.
    if header.chunk_count.saturating_mul(8) > bytes {
        return Err(Fault::Invalid(format!("{} blocks do not fit into a file of {bytes} bytes", header.chunk_count)));
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

/// The layout that the `envmap` attribute states.
fn header_envmap(header: &Header) -> Option<Layout> {
    header.own_attributes.environment_map.map(|map| match map {
        EnvironmentMap::LatitudeLongitude => Layout::Equirect,
        EnvironmentMap::Cube => Layout::ExrCube,
    })
}

/// An upright picture while it is being filled.
#[derive(Debug)]
struct Canvas {
    width: usize,
    pixels: Vec<[f32; 3]>,
}

impl Canvas {
    fn new(Vec2(width, height): Vec2<usize>) -> Canvas {
        Canvas { width, pixels: vec![[0.0; 3]; width * height] }
    }

    fn set(&mut self, Vec2(x, y): Vec2<usize>, value: [f32; 3]) {
        if let Some(pixel) = self.pixels.get_mut(y * self.width + x) {
            *pixel = value;
        }
    }
}

/// Reads R, G and B; half and integer samples become floats.
fn read_rgb(reader: Reader<Cursor<&[u8]>>) -> std::result::Result<Vec<[f32; 3]>, Fault> {
    let image = exr::prelude::read()
        .no_deep_data()
        .largest_resolution_level()
        .rgb_channels(
            |size, _| Canvas::new(size),
            |canvas: &mut Canvas, at, (r, g, b): (f32, f32, f32)| canvas.set(at, [r, g, b]),
        )
        .first_valid_layer()
        .all_attributes()
        .non_parallel()
        .from_chunks(reader)
        .map_err(fault)?;
    Ok(image.layer_data.channel_data.pixels.pixels)
}

/// Reads Y as grey.
fn read_luminance(reader: Reader<Cursor<&[u8]>>) -> std::result::Result<Vec<[f32; 3]>, Fault> {
    let image = exr::prelude::read()
        .no_deep_data()
        .largest_resolution_level()
        .specific_channels()
        .required("Y")
        .collect_pixels(|size, _| Canvas::new(size), |canvas: &mut Canvas, at, (y,): (f32,)| canvas.set(at, [y; 3]))
        .first_valid_layer()
        .all_attributes()
        .non_parallel()
        .from_chunks(reader)
        .map_err(fault)?;
    Ok(image.layer_data.channel_data.pixels.pixels)
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
