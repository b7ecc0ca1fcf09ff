//! From a path to a finished scene.

use std::path::Path;

use crate::folder::read_file;
use crate::{Error, Scene, Warning, backdrop, gltf, obj, repair};

/// Loads a `.gltf`, `.glb` or `.obj` file with everything that it refers to in its folder.
///
/// The scene comes back in world space with unit normals, tangents where a normal map wants them, and without
/// degenerate triangles or unused vertices; [`Scene::report`] says what was mended.
///
/// # Errors
/// [`Error::Io`] where a file cannot be read, [`Error::Unsupported`] where it requires what this program cannot do,
/// [`Error::Invalid`] where it breaks its format. Missing materials and textures are warnings, not errors.
pub fn load(path: &Path) -> Result<Scene, Error> {
    let mut scene = read(path).map_err(Error::printable)?;
    scene.report.join_alike();
    Ok(scene)
}

/// The finished scene with its warnings one by one.
fn read(path: &Path) -> Result<Scene, Error> {
    let extension = path.extension().and_then(|e| e.to_str()).unwrap_or_default().to_ascii_lowercase();
    let read = || read_file(path).map_err(|error| Error::io(path, "scene", error));
    let mut scene = match extension.as_str() {
        "gltf" | "glb" => gltf::load(path, &read()?)?,
        "obj" => obj::load(path, &read()?)?,
        _ => {
            let hint = "convert the scene to .gltf, .glb or .obj";
            let what = if extension.is_empty() {
                "a name without an ending".into()
            } else {
                format!("the file type {extension:?}")
            };
            return Err(Error::unsupported(path, "scene", what, hint));
        }
    };
    scene.name = path.display().to_string();
    scene.files.insert(0, path.to_owned());
    repair::finish(&mut scene);
    backdrop::drop_domes(&mut scene);
    if scene.meshes.is_empty() {
        return Err(Error::invalid(path, "scene", nothing_left(&scene)));
    }
    Ok(scene)
}

/// Why there is nothing to light, with the warnings that explain it.
fn nothing_left(scene: &Scene) -> String {
    let mut what = String::from("holds no triangle, so there is nothing to light");
    for Warning { object, message } in scene.report.warnings.iter().take(3) {
        what.push_str(&format!("; {object}: {message}"));
    }
    what
}
