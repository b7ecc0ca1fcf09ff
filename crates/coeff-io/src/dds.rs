//! DDS with the header of DirectX 10. Written byte by byte, read by the crate `ddsfile`.

use crate::Error;
use crate::texels::{Extent, TexelFormat, Texels};
use ddsfile::{D3D10ResourceDimension, Dds};

/// The bytes of a file.
pub(crate) fn write(texels: &Texels) -> Vec<u8> {
    let (side, block) = texels.format.block();
    let depth = if let Extent::Depth(depth) = texels.extent { Some(depth) } else { None };
    // Caps, height, width, pixel format; depth; pitch of a row of texels or size of a picture of blocks.
    let flags = 0x1007 | if depth.is_some() { 0x80_0000 } else { 0 } | if side > 1 { 0x8_0000 } else { 0x8 };
    let pitch = if side > 1 { texels.plane().unwrap_or(0) as u32 } else { texels.width * block };
    let mut words = vec![0x2053_4444, 124, flags, texels.height, texels.width, pitch, depth.unwrap_or(0), 0];
    words.extend([0; 11]);
    // Pixel format: its size, "FourCC", DX10.
    words.extend([32, 0x4, u32::from_le_bytes(*b"DX10"), 0, 0, 0, 0, 0]);
    // Caps: texture, and complex where it is more than one picture; caps2: volume.
    let complex = if texels.extent == Extent::Layers(1) { 0 } else { 0x8 };
    words.extend([0x1000 | complex, if depth.is_some() { 0x20_0000 } else { 0 }, 0, 0, 0]);
    let layers = if let Extent::Layers(layers) = texels.extent { layers } else { 1 };
    // Format, dimension (3 a picture, 4 a box), flags, layers, alpha mode: unknown.
    words.extend([texels.format.dxgi() as u32, if depth.is_some() { 4 } else { 3 }, 0, layers, 0]);
    let mut bytes: Vec<u8> = words.into_iter().flat_map(u32::to_le_bytes).collect();
    bytes.extend(&texels.bytes);
    bytes
}

/// Reads a file of [`write`].
pub(crate) fn read(bytes: &[u8]) -> Result<Texels, Error> {
    let dds = Dds::read(bytes).map_err(|e| Error::invalid(0, format!("this is no DDS file that can be read: {e}")))?;
    let header10 = dds.header10.as_ref().ok_or_else(|| Error::Unsupported("the DDS file has no DX10 header".into()))?;
    let format = TexelFormat::of_dxgi(header10.dxgi_format)
        .ok_or_else(|| Error::Unsupported(format!("texels of {:?} are not read", header10.dxgi_format)))?;
    if dds.get_num_mipmap_levels() > 1 {
        return Err(Error::Unsupported("the DDS file has mip levels".into()));
    }
    let extent = match header10.resource_dimension {
        D3D10ResourceDimension::Texture3D => Extent::Depth(dds.get_depth()),
        _ => Extent::Layers(dds.get_num_array_layers()),
    };
    Ok(Texels { width: dds.get_width(), height: dds.get_height(), extent, format, bytes: dds.data })
}
