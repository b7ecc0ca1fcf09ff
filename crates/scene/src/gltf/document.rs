//! The checked JSON document and its buffers.

use std::borrow::Cow;
use std::collections::HashMap;
use std::path::{Path, PathBuf};

use ::gltf::json::validation::{Error as Fault, USize64, Validate};
use ::gltf::json::{Index, Path as JsonPath, Root, Value};

use super::complete::{Aside, complete};
use super::extensions;
use super::meshopt::{self, View};
use crate::folder::{Folder, Missing};
use crate::uri::{Uri, parse};
use crate::{Error, Report};

/// A document that passed validation, with the bytes of its buffers.
pub(super) struct Document<'a> {
    pub(super) file: PathBuf,
    pub(super) root: Root,
    /// What the crate does not read.
    pub(super) aside: Aside,
    /// Empty where nothing but compressed views refers to a buffer.
    buffers: Vec<Cow<'a, [u8]>>,
    /// Views that were compressed, by index.
    decoded: HashMap<usize, View>,
}

impl<'a> Document<'a> {
    /// Parses and validates the JSON text and fetches the buffers.
    pub(super) fn parse(
        file: &Path,
        json: &[u8],
        binary: Option<&'a [u8]>,
        folder: &Folder,
        report: &mut Report,
    ) -> Result<Self, Error> {
        let (root, aside) = parse_root(json).map_err(|error| not_json(file, json, &error))?;
        check_version(file, &root.asset.version)?;
        extensions::check(file, &root, report)?;
        check_attributes(file, &root)?;
        validate(file, &root)?;
        let buffers = fetch_buffers(file, &root, binary, folder)?;
        let mut document = Self { file: file.to_owned(), root, aside, buffers, decoded: HashMap::new() };
        document.decoded = meshopt::decode_all(&document, report)?;
        Ok(document)
    }

    /// An error about an object of this file.
    pub(super) fn invalid(&self, object: impl Into<String>, what: impl Into<String>) -> Error {
        Error::invalid(&self.file, object, what)
    }

    /// The bytes of a buffer view, checked against its buffer and decompressed.
    pub(super) fn view(&self, index: Index<::gltf::json::buffer::View>) -> Result<&[u8], Error> {
        if let Some(view) = self.decoded.get(&index.value()) {
            return Ok(&view.bytes);
        }
        let view = &self.root.buffer_views[index.value()];
        let (offset, length) = (view.byte_offset.unwrap_or_default().0, view.byte_length.0);
        self.bytes(&format!("bufferViews[{}]", index.value()), view.buffer.value(), offset, length)
    }

    /// Bytes from one element of a buffer view to the next; `size` where they follow each other.
    pub(super) fn stride(&self, index: Index<::gltf::json::buffer::View>, size: usize) -> usize {
        let stated = self.root.buffer_views[index.value()].byte_stride.map(|stride| stride.0);
        stated.or_else(|| self.decoded.get(&index.value()).map(|view| view.stride)).unwrap_or(size)
    }

    /// A range of a buffer that `object` refers to.
    pub(super) fn bytes(&self, object: &str, buffer: usize, offset: u64, length: u64) -> Result<&[u8], Error> {
        let bytes = self
            .buffers
            .get(buffer)
            .ok_or_else(|| self.invalid(object, format!("buffer {buffer} of {}", self.buffers.len())))?;
        match offset.checked_add(length).filter(|end| *end <= bytes.len() as u64) {
            Some(end) => Ok(&bytes[offset as usize..end as usize]),
            None => {
                let what = format!("bytes {offset} + {length} lie outside buffer {buffer} of {}", bytes.len());
                Err(self.invalid(object, what))
            }
        }
    }
}

/// The crate's reading of a document that was completed first.
fn parse_root(json: &[u8]) -> Result<(Root, Aside), ::gltf::json::Error> {
    let mut value: Value = ::gltf::json::deserialize::from_slice(json)?;
    let aside = complete(&mut value);
    let root = ::gltf::json::deserialize::from_value(value).map_err(|error| {
        // The text gives the line and column that the value no longer has.
        let in_text = ::gltf::json::deserialize::from_slice::<Root>(json).err();
        in_text.filter(|other| other.to_string().starts_with(&error.to_string())).unwrap_or(error)
    })?;
    Ok((root, aside))
}

/// A file that is not glTF 2.0 JSON; glTF 1.0 is told apart, for its arrays are objects.
fn not_json(file: &Path, json: &[u8], error: &::gltf::json::Error) -> Error {
    let version = ::gltf::json::deserialize::from_slice::<Value>(json).ok();
    let version = version.as_ref().and_then(|v| v.get("asset")?.get("version")?.as_str());
    if let Some(version) = version
        && !version.starts_with("2.")
    {
        return old_version(file, version);
    }
    Error::invalid(file, "JSON", error.to_string())
}

fn old_version(file: &Path, version: &str) -> Error {
    Error::unsupported(file, "asset.version", format!("glTF {version:?}"), "save the scene as glTF 2.0")
}

fn check_version(file: &Path, version: &str) -> Result<(), Error> {
    if version.starts_with("2.") { Ok(()) } else { Err(old_version(file, version)) }
}

/// Attribute indices in range; the crate's own validation would panic on them.
fn check_attributes(file: &Path, root: &Root) -> Result<(), Error> {
    for (m, mesh) in root.meshes.iter().enumerate() {
        for (p, primitive) in mesh.primitives.iter().enumerate() {
            if let Some(index) = primitive.attributes.values().find(|i| i.value() >= root.accessors.len()) {
                let what = format!("accessor {} of {} accessors", index.value(), root.accessors.len());
                return Err(Error::invalid(file, format!("meshes[{m}].primitives[{p}].attributes"), what));
            }
        }
    }
    Ok(())
}

/// The crate's validation, less what this loader can do without: accessors without data are zeros (glTF 2.0,
/// 3.6.2.3), bounds of positions are not used, textures without a source become white, and required extensions are
/// checked above against a list that is true.
fn validate(file: &Path, root: &Root) -> Result<(), Error> {
    let mut complaints = Vec::new();
    root.validate(root, JsonPath::new, &mut |path, fault| complaints.push((path().to_string(), fault)));
    complaints.retain(|(path, fault)| match fault {
        Fault::Missing => !is_dispensable(path),
        // Attributes that the crate does not know, such as an application's own, are not read.
        Fault::Invalid => !path.ends_with("[\"<invalid semantic name>\"]"),
        Fault::Unsupported => !path.starts_with("extensionsRequired"),
        _ => true,
    });
    let Some((path, first)) = complaints.first() else { return Ok(()) };
    let more = match complaints.len() - 1 {
        0 => String::new(),
        n => format!(" (and {n} more errors)"),
    };
    Err(Error::invalid(file, path.as_str(), format!("{first}{more}").to_lowercase()))
}

fn is_dispensable(path: &str) -> bool {
    let ends = |start: &str, end: &str| path.starts_with(start) && path.ends_with(end);
    ends("accessors[", "].bufferView")
        || ends("textures[", "].source")
        || ends("meshes[", "[\"POSITION\"].min")
        || ends("meshes[", "[\"POSITION\"].max")
}

fn fetch_buffers<'a>(
    file: &Path,
    root: &Root,
    binary: Option<&'a [u8]>,
    folder: &Folder,
) -> Result<Vec<Cow<'a, [u8]>>, Error> {
    let fetch = |(b, buffer): (usize, &::gltf::json::Buffer)| {
        let object = format!("buffers[{b}]");
        if meshopt::is_fallback(root, b) {
            return Ok(Cow::Borrowed([].as_slice()));
        }
        let bytes = match (&buffer.uri, binary) {
            (Some(uri), _) => Cow::Owned(fetch_buffer(file, &object, uri, folder)?),
            (None, Some(binary)) if b == 0 => Cow::Borrowed(binary),
            (None, _) => return Err(Error::invalid(file, object, "has no uri, and the file no binary chunk for it")),
        };
        let USize64(wanted) = buffer.byte_length;
        if (bytes.len() as u64) < wanted {
            return Err(Error::invalid(
                file,
                object,
                format!("byteLength is {wanted}, but there are {} bytes", bytes.len()),
            ));
        }
        Ok(bytes)
    };
    root.buffers.iter().enumerate().map(fetch).collect()
}

fn fetch_buffer(file: &Path, object: &str, uri: &str, folder: &Folder) -> Result<Vec<u8>, Error> {
    match parse(uri).map_err(|why| Error::invalid(file, object, why))? {
        Uri::Data(bytes) => Ok(bytes),
        Uri::Relative(name) => folder.read(&name).map_err(|missing| match missing {
            Missing::Refused(why) => Error::unsupported(file, object, why, "place the data beside the scene"),
            Missing::Io(path, error) => Error::io(&path, format!("{object} of {}", file.display()), error),
        }),
    }
}
