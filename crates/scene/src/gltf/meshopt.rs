//! Buffer views compressed by meshoptimizer: EXT_meshopt_compression and KHR_meshopt_compression.

use std::collections::HashMap;

use ::gltf::json::{Root, Value, buffer};
use meshoptimizer_rs::codec;
use meshoptimizer_rs::{Error as Fault, Workspace};

use super::document::Document;
use super::warn;
use crate::{Error, Report};

/// The extension under its two names.
const NAMES: [&str; 2] = ["KHR_meshopt_compression", "EXT_meshopt_compression"];
/// Decoded bytes that all views of a file may take together (2 GiB).
const MAX_BYTES: u64 = 2 << 30;

/// A decompressed view.
#[derive(Debug)]
pub(super) struct View {
    pub(super) bytes: Vec<u8>,
    /// Bytes of one element.
    pub(super) stride: usize,
}

/// Whether a buffer only stands in for loaders that cannot decompress: it may have no data.
pub(super) fn is_fallback(root: &Root, buffer: usize) -> bool {
    let views = || root.buffer_views.iter().filter(|view| view.buffer.value() == buffer);
    let compressed_data = root.buffer_views.iter().filter_map(compression).any(|c| c["buffer"] == buffer as u64);
    views().next().is_some() && views().all(|view| compression(view).is_some()) && !compressed_data
}

fn compression(view: &buffer::View) -> Option<&Value> {
    let extensions = view.extensions.as_ref()?;
    NAMES.iter().find_map(|name| extensions.others.get(*name))
}

/// Decompresses all views that are compressed.
pub(super) fn decode_all(document: &Document<'_>, report: &mut Report) -> Result<HashMap<usize, View>, Error> {
    let mut decoded = HashMap::new();
    let (mut workspace, mut total) = (Workspace::default(), 0u64);
    for (index, view) in document.root.buffer_views.iter().enumerate() {
        let Some(json) = compression(view) else { continue };
        let object = format!("bufferViews[{index}].{}", NAMES[1]);
        let stream = Stream::read(json).ok_or_else(|| document.invalid(&object, "lacks a member or has an odd one"))?;
        total = total.saturating_add(stream.count.saturating_mul(stream.stride));
        if total > MAX_BYTES {
            return Err(document.invalid(object, format!("more than {MAX_BYTES} bytes after decompression")));
        }
        let bytes = document.bytes(&object, stream.buffer, stream.offset, stream.length)?;
        match stream.decode(bytes, &mut workspace) {
            Ok(bytes) => drop(decoded.insert(index, View { bytes, stride: stream.stride as usize })),
            Err(fault) if is_fallback(&document.root, view.buffer.value()) => {
                return Err(document.invalid(object, format!("the data cannot be decompressed ({fault})")));
            }
            // The view of the other buffer holds the same data.
            Err(fault) => warn(report, object, format!("cannot be decompressed ({fault}); the plain data is used")),
        }
    }
    Ok(decoded)
}

/// What the extension says of one view.
struct Stream {
    buffer: usize,
    offset: u64,
    length: u64,
    stride: u64,
    count: u64,
    mode: Mode,
    filter: Option<Filter>,
}

enum Mode {
    Attributes,
    Triangles,
    Indices,
}

enum Filter {
    Octahedral,
    Quaternion,
    Exponential,
    Color,
}

impl Stream {
    fn read(json: &Value) -> Option<Self> {
        let number = |key: &str| json[key].as_u64();
        let mode = match json["mode"].as_str()? {
            "ATTRIBUTES" => Mode::Attributes,
            "TRIANGLES" => Mode::Triangles,
            "INDICES" => Mode::Indices,
            _ => return None,
        };
        let filter = match json.get("filter").map(Value::as_str) {
            None | Some(Some("NONE")) => None,
            Some(Some("OCTAHEDRAL")) => Some(Filter::Octahedral),
            Some(Some("QUATERNION")) => Some(Filter::Quaternion),
            Some(Some("EXPONENTIAL")) => Some(Filter::Exponential),
            Some(Some("COLOR")) => Some(Filter::Color),
            _ => return None,
        };
        Some(Self {
            buffer: usize::try_from(number("buffer")?).ok()?,
            offset: number("byteOffset").unwrap_or(0),
            length: number("byteLength")?,
            stride: number("byteStride")?,
            count: number("count")?,
            mode,
            filter,
        })
    }

    fn decode(&self, source: &[u8], workspace: &mut Workspace) -> Result<Vec<u8>, Fault> {
        let (count, stride) = (self.count as usize, self.stride as usize);
        let mut bytes = match self.mode {
            Mode::Attributes => codec::decode_vertex_buffer(count, stride, source, workspace),
            Mode::Triangles => codec::decode_index_buffer(count, stride, source, workspace),
            Mode::Indices => codec::decode_index_sequence(count, stride, source, workspace),
        }?;
        match self.filter {
            None => Ok(()),
            Some(Filter::Octahedral) => codec::decode_filter_oct(&mut bytes, count, stride, workspace),
            Some(Filter::Quaternion) => codec::decode_filter_quat(&mut bytes, count, stride, workspace),
            Some(Filter::Exponential) => codec::decode_filter_exp(&mut bytes, count, stride, workspace),
            Some(Filter::Color) => codec::decode_filter_color(&mut bytes, count, stride, workspace),
        }?;
        Ok(bytes)
    }
}
