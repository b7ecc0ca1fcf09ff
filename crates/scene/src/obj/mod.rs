//! Loading OBJ and MTL.
//!
//! Both have many dialects: what cannot be misunderstood is read, what has a meaning but is not supported is told,
//! and only what leaves no shape is refused, with its line. Lengths are taken as they are, as metres.

mod ears;
mod library;
mod map;
mod mtl;
mod parse;
mod polygon;
mod solid;
mod text;

use std::collections::HashMap;
use std::path::Path;

use glam::{Vec2, Vec3};

use crate::folder::Folder;
use crate::repair::SMOOTH_CREASE;
use crate::{Error, Mesh, Report, Scene, Warning, normals};
use parse::{Content, Corner, Group, NONE};

/// Reads an OBJ file; `bytes` are its content.
pub(crate) fn load(file: &Path, bytes: &[u8]) -> Result<Scene, Error> {
    let mut report = Report::default();
    let mut content = parse::parse(file, &text::decode(bytes), &mut report)?;
    let origin = content.take_origin(&mut report);
    let folder = Folder::of(file);
    let library = library::read(&folder, file, &content.libraries, &mut report);
    let (materials, textures) = mtl::convert(&library.materials, &folder, &mut report);
    let default_material = materials.len() as u32 - 1;
    let mut unknown = Vec::new();
    let mut lacking = Lacking::default();
    let mut meshes = Vec::with_capacity(content.groups.len());
    for group in &content.groups {
        let used = group.material.as_deref();
        let material = used.and_then(|name| library.find(name));
        if let (Some(name), None) = (used, material)
            && !unknown.contains(&name)
        {
            unknown.push(name);
        }
        let mut mesh = mesh(&content, group, &mut lacking);
        mesh.material = material.map_or(default_material, |i| i as u32);
        meshes.push(mesh);
    }
    lacking.tell(&mut report);
    parse::warn_of_unknown(&unknown, &mut report);
    let name = file.display().to_string();
    let mut scene =
        Scene { name, origin, meshes, materials, textures, report, files: folder.into_files(), ..Scene::default() };
    solid::mark_double_sided(&mut scene);
    Ok(scene)
}

/// Vertices that lack coordinates or normals which others of their mesh have.
#[derive(Debug, Default)]
struct Lacking {
    coordinates: usize,
    normals: usize,
}

impl Lacking {
    fn tell(&self, report: &mut Report) {
        let mut warn = |count: usize, message: String| {
            if count > 0 {
                report.warnings.push(Warning { object: "faces".into(), message });
            }
        };
        let (coordinates, normals) = (self.coordinates, self.normals);
        let lack = "corners have none while others of their mesh do";
        warn(coordinates, format!("texture coordinates: {coordinates} {lack}; (0, 0) is used"));
        warn(normals, format!("normals: {normals} {lack}; theirs were made from the faces"));
    }
}

/// One group as a mesh of triangles; vertices in the order in which faces name them.
fn mesh(content: &Content, group: &Group, lacking: &mut Lacking) -> Mesh {
    let mut number: HashMap<Corner, u32> = HashMap::new();
    let mut vertices: Vec<Corner> = Vec::new();
    let indices: Vec<u32> = group
        .corners
        .iter()
        .map(|corner| {
            *number.entry(*corner).or_insert_with(|| {
                vertices.push(*corner);
                vertices.len() as u32 - 1
            })
        })
        .collect();
    let positions: Vec<Vec3> = vertices.iter().map(|v| content.positions[v[0] as usize].as_vec3()).collect();
    let without = |kind: usize| vertices.iter().filter(|v| v[kind] == NONE).count();
    let coordinates = attribute(&vertices, 1, |i| content.coordinates[i], Vec2::ZERO);
    let normals = attribute(&vertices, 2, |i| content.normals[i], Vec3::ZERO);
    let colors = |v: &Corner| content.colors.get(v[0] as usize).map(|c| c.extend(1.0));
    let triangles_only = group.arities.iter().all(|arity| *arity == 3);
    let arities: &[u32] = if triangles_only { &[] } else { &group.arities };
    let mut mesh = Mesh {
        name: group.name.clone(),
        triangles: polygon::triangulate(&positions, &indices, arities),
        // The rows of a picture run downwards here and upwards in OBJ.
        uv0: coordinates.into_iter().map(|uv| Vec2::new(uv.x, 1.0 - uv.y)).collect(),
        normals,
        colors: vertices.iter().filter_map(colors).collect(),
        positions,
        ..Mesh::default()
    };
    if !mesh.uv0.is_empty() {
        lacking.coordinates += without(1);
    }
    if !mesh.normals.is_empty() && without(2) > 0 {
        lacking.normals += without(2);
        let missing: Vec<bool> = vertices.iter().map(|v| v[2] == NONE).collect();
        normals::complete(&mut mesh, &missing, SMOOTH_CREASE);
    }
    mesh
}

/// The values of one attribute, `unsaid` where a vertex has none; empty where no vertex has one.
fn attribute<T: Copy>(vertices: &[Corner], kind: usize, value: impl Fn(usize) -> T, unsaid: T) -> Vec<T> {
    if vertices.iter().all(|v| v[kind] == NONE) {
        return Vec::new();
    }
    vertices.iter().map(|v| if v[kind] == NONE { unsaid } else { value(v[kind] as usize) }).collect()
}
