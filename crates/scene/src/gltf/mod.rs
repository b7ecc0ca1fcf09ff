//! Loading glTF 2.0 and its binary form GLB.
//!
//! The crate `gltf` gives the data model and its validation; what that misses is checked here before anything is
//! read: index ranges in attributes, byte ranges of accessors, the node graph.

mod accessor;
mod complete;
mod container;
mod document;
mod draco;
mod extensions;
mod instancing;
mod material;
mod meshopt;
mod morph;
mod node;
mod place;
mod primitive;
mod skin;
mod specular_glossiness;
mod texture;
mod view;

use std::path::Path;

use crate::folder::Folder;
use crate::uri::{Uri, parse};
use crate::{Error, Report, Scene, Warning};

use document::Document;

/// Most vertices or triangles of a scene with all its instances; a guard against files that multiply themselves.
const MAX_ELEMENTS: usize = 1 << 25;

/// Reads a file of either form; `bytes` are its content.
pub(crate) fn load(file: &Path, bytes: &[u8]) -> Result<Scene, Error> {
    let (json, binary) = container::split(file, bytes)?;
    let folder = Folder::of(file);
    let mut report = Report::default();
    let document = Document::parse(file, json, binary, &folder, &mut report)?;
    let (materials, textures) = material::read(&document, &folder, &mut report)?;
    let primitives = primitive::read_all(&document, materials.len() as u32 - 1, &mut report)?;
    let placed = place::place(&document, &primitives, &mut report)?;
    // Those that no material reads belong to the scene too.
    for uri in document.root.images.iter().filter_map(|image| image.uri.as_ref()) {
        if let Ok(Uri::Relative(name)) = parse(uri) {
            folder.mention("", &name);
        }
    }
    Ok(Scene {
        name: file.display().to_string(),
        origin: placed.origin.to_array(),
        meshes: placed.meshes,
        materials,
        textures,
        cameras: placed.cameras,
        lights: placed.lights,
        moving: placed.moving,
        report,
        files: folder.into_files(),
    })
}

/// Notes a defect that does not stop the load.
fn warn(report: &mut Report, object: impl Into<String>, message: impl Into<String>) {
    report.warnings.push(Warning { object: object.into(), message: message.into() });
}
