//! The binary container (glTF 2.0, section 4).

use std::path::Path;

use crate::Error;

const JSON: u32 = 0x4E4F_534A;
const BIN: u32 = 0x004E_4942;

/// The JSON text and, of a GLB file, its binary chunk. Bytes without the magic number are taken as JSON text.
pub(super) fn split<'a>(file: &Path, bytes: &'a [u8]) -> Result<(&'a [u8], Option<&'a [u8]>), Error> {
    let bytes = bytes.strip_prefix(b"\xEF\xBB\xBF").unwrap_or(bytes);
    let is_glb = file.extension().is_some_and(|e| e.eq_ignore_ascii_case("glb"));
    if !bytes.starts_with(b"glTF") {
        if is_glb {
            let what = format!("starts with {:02x?} instead of the magic \"glTF\"", &bytes[..bytes.len().min(4)]);
            return Err(Error::invalid(file, "GLB header", what));
        }
        return Ok((bytes, None));
    }
    let invalid = |object: &str, what: String| Error::invalid(file, object, what);
    let (Some(version), Some(length)) = (word(bytes, 4), word(bytes, 8)) else {
        return Err(invalid("GLB header", format!("{} bytes; a header has 12", bytes.len())));
    };
    if version != 2 {
        return Err(Error::unsupported(file, "GLB header", format!("version {version}"), "save it as glTF 2.0"));
    }
    if length as usize != bytes.len() {
        return Err(invalid("GLB header", format!("length {length}, but the file has {} bytes", bytes.len())));
    }
    let (mut at, mut json, mut binary) = (12, None, None);
    while at < bytes.len() {
        let (Some(size), Some(kind)) = (word(bytes, at), word(bytes, at + 4)) else {
            return Err(invalid("GLB chunk", format!("the header at byte {at} is cut off")));
        };
        let data = bytes[at + 8..].get(..size as usize).ok_or_else(|| {
            let left = bytes.len() - at - 8;
            invalid("GLB chunk", format!("the chunk at byte {at} wants {size} bytes, {left} are left"))
        })?;
        match (kind, json, binary) {
            (JSON, None, _) => json = Some(data),
            (BIN, Some(_), None) => binary = Some(data),
            (JSON, ..) => return Err(invalid("GLB chunk", format!("a second JSON chunk at byte {at}"))),
            (BIN, None, _) => return Err(invalid("GLB chunk", "the first chunk is binary instead of JSON".into())),
            (BIN, ..) => return Err(invalid("GLB chunk", format!("a second binary chunk at byte {at}"))),
            // Unknown chunks are to be ignored (section 4.4.1).
            _ => {}
        }
        at += 8 + size as usize;
    }
    let json = json.ok_or_else(|| invalid("GLB chunk", "there is no JSON chunk".into()))?;
    Ok((json, binary))
}

fn word(bytes: &[u8], at: usize) -> Option<u32> {
    bytes.get(at..)?.first_chunk::<4>().map(|b| u32::from_le_bytes(*b))
}
