//! Geometry, materials and cameras in world space; glTF and OBJ loading; scenes with known answers.
//!
//! The world is right-handed, in metres, y up (the axes of glTF); colours are linear Rec. 709.
//! A [`Scene`] is flat: each mesh is one primitive of one instance, already in world space.

mod bounds;
mod error;
pub mod known;
mod model;
mod surface;
mod texture;
mod vertices;

pub use bounds::{Bounds, default_camera};
pub use error::Error;
pub use known::{BUILTINS, builtin};
pub use model::{
    AlphaMode, Camera, LightKind, Material, Mesh, PunctualLight, Report, Scene, Texture, TextureSlot, Warning, Wrap,
};
pub use texture::linear_from_srgb;
