//! Geometry, materials and cameras in world space; glTF and OBJ loading; scenes with known answers.
//!
//! The world is right-handed, in metres, y up (the axes of glTF); colours are linear Rec. 709.
//! A [`Scene`] is flat: each mesh is one primitive of one instance, already in world space.

mod model;

pub use model::{
    AlphaMode, Camera, LightKind, Material, Mesh, PunctualLight, Report, Scene, Texture, TextureSlot, Warning, Wrap,
};
