//! Sources that are built into the program: `builtin:NAME`.

use crate::Error;
use scene::Scene;
use std::path::Path;

/// The name behind `builtin:`, where a source has that form.
pub(crate) fn builtin_name(source: &Path) -> Option<&str> {
    source.to_str()?.strip_prefix("builtin:")
}

/// Loads a scene: a `.gltf`, `.glb` or `.obj` file, or `builtin:NAME` of [`scene::BUILTINS`].
///
/// [`Scene::report`] says what was repaired.
///
/// # Errors
/// [`Error::Scene`] or [`Error::UnknownBuiltin`].
pub fn load_scene(source: impl AsRef<Path>) -> Result<Scene, Error> {
    let path = source.as_ref();
    match builtin_name(path) {
        Some(name) => {
            scene::builtin(name).ok_or_else(|| Error::UnknownBuiltin { kind: "scene", name: name.to_owned() })
        }
        None => Ok(scene::load(path)?),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sources_are_builtins_or_files() {
        assert_eq!(load_scene("builtin:plane").expect("a builtin").meshes.len(), 1);
        assert!(matches!(load_scene("builtin:nothing"), Err(Error::UnknownBuiltin { kind: "scene", .. })));
        assert!(matches!(load_scene("nothing.glb"), Err(Error::Scene(_))));
    }
}
