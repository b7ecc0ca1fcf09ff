//! The checked JSON document and its buffers.

use std::borrow::Cow;
use std::path::{Path, PathBuf};

use ::gltf::json::validation::{Error as Fault, USize64, Validate};
use ::gltf::json::{Index, Path as JsonPath, Root, Value};

use super::warn;
use crate::folder::{Folder, Missing};
use crate::uri::{Uri, parse};
use crate::{Error, Report};

/// Extensions that a file may require: what they ask for is done.
const SUPPORTED: &[&str] = &[
    "KHR_lights_punctual",
    "KHR_materials_emissive_strength",
    "KHR_materials_ior",
    "KHR_materials_specular",
    "KHR_materials_transmission",
    "KHR_materials_unlit",
    "KHR_materials_variants",
    "KHR_materials_volume",
    "KHR_mesh_quantization",
    "KHR_texture_transform",
];
/// What to do about extensions that cannot be decoded here.
const HINTS: &[(&str, &str)] = &[
    ("KHR_draco_mesh_compression", "save the scene without Draco compression"),
    ("EXT_meshopt_compression", "save the scene without meshopt compression"),
    ("KHR_texture_basisu", "save the textures as PNG or JPEG"),
    ("EXT_texture_webp", "save the textures as PNG or JPEG"),
];

/// A document that passed validation, with the bytes of its buffers.
pub(super) struct Document<'a> {
    pub(super) file: PathBuf,
    pub(super) root: Root,
    pub(super) buffers: Vec<Cow<'a, [u8]>>,
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
        let root: Root = ::gltf::json::deserialize::from_slice(json).map_err(|error| not_json(file, json, &error))?;
        check_version(file, &root.asset.version)?;
        check_extensions(file, &root, report)?;
        check_attributes(file, &root)?;
        validate(file, &root)?;
        let buffers = fetch_buffers(file, &root, binary, folder)?;
        Ok(Self { file: file.to_owned(), root, buffers })
    }

    /// An error about an object of this file.
    pub(super) fn invalid(&self, object: impl Into<String>, what: impl Into<String>) -> Error {
        Error::invalid(&self.file, object, what)
    }

    /// The bytes of a buffer view, checked against its buffer.
    pub(super) fn view(&self, index: Index<::gltf::json::buffer::View>) -> Result<&[u8], Error> {
        let view = &self.root.buffer_views[index.value()];
        let object = || format!("bufferViews[{}]", index.value());
        let buffer = &self.buffers[view.buffer.value()];
        let (offset, length) = (view.byte_offset.unwrap_or_default().0, view.byte_length.0);
        let end = offset.checked_add(length).filter(|end| *end <= buffer.len() as u64);
        let end = end.ok_or_else(|| {
            let what =
                format!("bytes {offset} + {length} lie outside buffer {} of {}", view.buffer.value(), buffer.len());
            self.invalid(object(), what)
        })?;
        Ok(&buffer[offset as usize..end as usize])
    }
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

/// Refuses what is required and not done here, by name; warns of what is only used.
fn check_extensions(file: &Path, root: &Root, report: &mut Report) -> Result<(), Error> {
    let known = |name: &str| SUPPORTED.contains(&name);
    if let Some(name) = root.extensions_required.iter().find(|name| !known(name)) {
        let hint = HINTS.iter().find(|(n, _)| n == name).map_or("save the scene without it", |(_, hint)| hint);
        return Err(Error::unsupported(file, "extensionsRequired", name.clone(), hint));
    }
    for name in root.extensions_used.iter().filter(|name| !known(name)) {
        warn(report, "extensionsUsed", format!("{name} is not supported and was ignored"));
    }
    Ok(())
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
