//! Scenes of the kind and size that transfer textures were measured on ([T], table 1): no known answers, but known numbers of triangles.
//!
//! The models of the paper are not free. Each scene here stands on a ground of very few triangles beside bodies of many, shines with a
//! roughness that varies over the surface, and has two cameras: `main` shows all of it, in `close` every pixel shows a surface.

mod body;
mod dragon;
mod heads;
mod plants;
mod room;
mod shine;
#[cfg(test)]
mod soundness;

use super::patch::scene;
use crate::{Camera, Material, Mesh, Scene, Texture};

/// Name and one-line description of the scenes for measuring. They are large and prove nothing by themselves, so tests that walk
/// [`super::BUILTINS`] do not meet them.
pub const PAPER_SCENES: &[(&str, &str)] = &[
    ("paper-plants", "18 thousand triangles: three plants in glazed pots, glossy"),
    (
        "paper-room",
        "21 thousand triangles: a furnished room, walls of two triangles, a floor with a normal map, glossy",
    ),
    ("paper-heads", "441 thousand triangles: three sculpted heads, one mesh each, glossy"),
    ("paper-dragon", "1.3 million triangles: a knotted serpent with scales, glossy"),
];

/// The scene of that name; `None` if there is none.
pub(super) fn builtin(name: &str) -> Option<Scene> {
    Some(match name {
        "paper-plants" => plants::plants(),
        "paper-room" => room::room(),
        "paper-heads" => heads::heads(),
        "paper-dragon" => dragon::dragon(),
        _ => return None,
    })
}

/// A scene with its pictures and the two views.
fn shown(name: &str, materials: Vec<Material>, meshes: Vec<Mesh>, textures: Vec<Texture>, views: [Camera; 2]) -> Scene {
    let [main, close] = views;
    let mut scene = scene(name, materials, meshes, main);
    scene.cameras.push(Camera { name: "close".into(), ..close });
    scene.textures = textures;
    scene
}
