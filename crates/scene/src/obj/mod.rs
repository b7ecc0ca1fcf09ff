//! Loading OBJ and MTL.
//!
//! The crate `tobj` parses; before it sees a byte, [`check`] and [`mtl`] refuse with a line number, or mend with a
//! warning, what it would misread or panic on. Lengths are taken as they are, as metres.

mod check;
mod mtl;
mod polygon;
mod solid;

use std::cell::RefCell;
use std::path::Path;

use glam::{Vec2, Vec3, Vec4};

use crate::folder::Folder;
use crate::{Error, Mesh, Report, Scene, Warning};

/// Reads an OBJ file; `bytes` are its content.
pub(crate) fn load(file: &Path, bytes: &[u8]) -> Result<Scene, Error> {
    let mut report = Report::default();
    let text = check::clean(file, &String::from_utf8_lossy(bytes), &mut report)?;
    let folder = Folder::of(file);
    let libraries = RefCell::new(Vec::new());
    let options = tobj::LoadOptions { single_index: true, ..tobj::LoadOptions::default() };
    let (models, materials) = tobj::load_obj_buf(&mut text.as_bytes(), &options, |name| {
        mtl::library(&folder, &name.to_string_lossy(), &mut libraries.borrow_mut())
    })
    .map_err(|error| Error::invalid(file, "OBJ statements", error.to_string()))?;
    report.warnings.extend(libraries.into_inner());
    let materials = materials.unwrap_or_default();
    check::warn_of_unknown_materials(&text, &materials, &mut report);
    let (materials, textures) = mtl::convert(&materials, &folder, &mut report);
    let default_material = materials.len() as u32 - 1;
    let faced = models.iter().filter(|model| !model.mesh.indices.is_empty());
    let meshes = faced.map(|model| mesh(model, default_material, &mut report)).collect();
    let mut scene = Scene { name: file.display().to_string(), meshes, materials, textures, report, ..Scene::default() };
    solid::mark_double_sided(&mut scene);
    Ok(scene)
}

/// One model (an object or group with one material) as a mesh of triangles.
fn mesh(model: &tobj::Model, default_material: u32, report: &mut Report) -> Mesh {
    let source = &model.mesh;
    let (triples, _) = source.positions.as_chunks::<3>();
    let positions: Vec<Vec3> = triples.iter().map(|p| Vec3::from(*p)).collect();
    let count = positions.len();
    // Corners of one model may lack coordinates or normals that others have; then the parser's lists are short and
    // nobody knows whose they are.
    let mut whole = |values: usize, what: &str| {
        if values != 0 && values != count {
            let message = format!("only some corners have {what}; all were dropped");
            report.warnings.push(Warning { object: model.name.clone(), message });
        }
        values == count
    };
    let (normals, _) = source.normals.as_chunks::<3>();
    let (coordinates, _) = source.texcoords.as_chunks::<2>();
    let (colors, _) = source.vertex_color.as_chunks::<3>();
    let has_normals = whole(normals.len(), "normals");
    let has_coordinates = whole(coordinates.len(), "texture coordinates");
    let has_colors = whole(colors.len(), "colours");
    Mesh {
        name: model.name.clone(),
        material: source.material_id.map_or(default_material, |i| i as u32),
        normals: if has_normals { normals.iter().map(|n| Vec3::from(*n)).collect() } else { Vec::new() },
        // The rows of a picture run downwards here and upwards in OBJ.
        uv0: if has_coordinates {
            coordinates.iter().map(|[u, v]| Vec2::new(*u, 1.0 - v)).collect()
        } else {
            Vec::new()
        },
        colors: if has_colors {
            colors.iter().map(|c| Vec3::from(*c).extend(1.0)).collect()
        } else {
            Vec::<Vec4>::new()
        },
        triangles: polygon::triangulate(&positions, &source.indices, &source.face_arities),
        positions,
        ..Mesh::default()
    }
}
