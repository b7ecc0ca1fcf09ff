//! KTX 2.0 without supercompression and mip levels. Read by the crate `ktx2`, whose records make the file too.

use crate::Error;
use crate::texels::{Extent, TexelFormat, Texels};
use ktx2::dfd::{Basic, Block};
use ktx2::{Header, Index, LevelIndex, Reader};

/// Who wrote it, as the format wants to be told.
const WRITER: &[u8] = b"KTXwriter\0relume\0";

/// The bytes of a file.
pub(crate) fn write(texels: &Texels) -> Result<Vec<u8>, Error> {
    let unsupported = |e| Error::Unsupported(format!("KTX cannot describe these texels: {e:?}"));
    let (basic, type_size) = Basic::from_format(texels.format.vulkan()).map_err(unsupported)?;
    let descriptor = Block::Basic(basic).to_vec();
    let descriptor_at = Header::LENGTH + LevelIndex::LENGTH;
    let notes_at = descriptor_at + 4 + descriptor.len();
    let notes = (4 + WRITER.len()).next_multiple_of(4);
    // Texels begin at a multiple of their block, which is a power of two here, and of 4.
    let at = (notes_at + notes).next_multiple_of(texels.format.block().1.max(4) as usize);
    let header = Header {
        format: Some(texels.format.vulkan()),
        type_size,
        pixel_width: texels.width,
        pixel_height: texels.height,
        pixel_depth: if let Extent::Depth(depth) = texels.extent { depth } else { 0 },
        layer_count: if let Extent::Layers(layers) = texels.extent { layers } else { 0 },
        face_count: 1,
        level_count: 1,
        supercompression_scheme: None,
        index: Index {
            dfd_byte_offset: descriptor_at as u32,
            dfd_byte_length: 4 + descriptor.len() as u32,
            kvd_byte_offset: notes_at as u32,
            kvd_byte_length: notes as u32,
            sgd_byte_offset: 0,
            sgd_byte_length: 0,
        },
    };
    let length = texels.bytes.len() as u64;
    let level = LevelIndex { byte_offset: at as u64, byte_length: length, uncompressed_byte_length: length };
    let mut bytes = header.as_bytes().to_vec();
    bytes.extend(level.as_bytes());
    bytes.extend((4 + descriptor.len() as u32).to_le_bytes());
    bytes.extend(descriptor);
    bytes.extend((WRITER.len() as u32).to_le_bytes());
    bytes.extend(WRITER);
    bytes.resize(at, 0);
    bytes.extend(&texels.bytes);
    Ok(bytes)
}

/// Reads a file of [`write`].
pub(crate) fn read(bytes: &[u8]) -> Result<Texels, Error> {
    let reader =
        Reader::new(bytes).map_err(|e| Error::invalid(0, format!("this is no KTX2 file that can be read: {e}")))?;
    let header = reader.header();
    let format = header.format.and_then(TexelFormat::of_vulkan);
    let format = format.ok_or_else(|| Error::Unsupported(format!("texels of {:?} are not read", header.format)))?;
    if header.supercompression_scheme.is_some() || header.level_count > 1 || header.face_count != 1 {
        return Err(Error::Unsupported("the KTX2 file is compressed once more, or has mip levels or faces".into()));
    }
    let extent = match header.pixel_depth {
        0 => Extent::Layers(header.layer_count.max(1)),
        depth => Extent::Depth(depth),
    };
    let level = reader.levels().next().map_or(&[][..], |level| level.data);
    Ok(Texels { width: header.pixel_width, height: header.pixel_height, extent, format, bytes: level.to_vec() })
}
