//! Geometry, materials and cameras in world space; glTF and OBJ loading; scenes with known answers.
//!
//! The world is right-handed, in metres, y up (the axes of glTF); colours are linear Rec. 709.
//! A [`Scene`] is flat: each mesh is one primitive of one instance, already in world space.

mod backdrop;
mod bounds;
mod error;
mod folder;
mod gltf;
pub mod known;
pub mod lightmap;
mod load;
mod model;
mod normals;
mod obj;
mod origin;
mod picture;
mod repair;
mod surface;
mod tangents;
mod texture;
mod uri;
mod vertices;
mod warnings;
mod weld;

pub use backdrop::share_of_sphere;
pub use bounds::{Bounds, default_camera};
pub use error::Error;
pub use known::{BUILTINS, PAPER_SCENES, builtin};
pub use load::load;
pub use model::{
    AlphaMode, Camera, LightKind, Material, Mesh, PunctualLight, Report, Scene, Texture, TextureSlot, Warning, Wrap,
};
pub use texture::linear_from_srgb;
pub use warnings::printable;
