//! An independent path tracer: the ground truth that baked transfer is judged by.
//!
//! Two-sided transport under distant light, by plain paths: next-event estimation towards picture and lamps, combined with directions
//! that are drawn by the surface. Diffuse, unless a world is given a [`Gloss`]. No spherical harmonics, no interpolation between vertices, no code
//! shared with the baker. What it draws is the same: both sides of a surface block and reflect; surfaces that blend
//! or transmit stop the share of light that they cover, and tint what passes through them; emission is seen by the camera but lights nothing.

mod camera;
mod gloss;
mod light;
mod lobe;
mod microfacet;
mod mirror;
mod path;
mod receiver;
mod render;
mod shiny;
mod world;

pub use gloss::{Gloss, Lobe, Mirroring};
pub use light::Light;
pub use microfacet::directional_albedo;
pub use receiver::{Estimate, Gaze, Receiver, radiance_at, radiance_seen};
pub use render::{Picture, render};
pub use world::World;

/// How many paths, from which seed, how long.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Settings {
    /// Paths per receiver or pixel; at least 2 for a standard error.
    pub samples: u32,
    /// Everything random follows from it and from the index of the receiver or pixel.
    pub seed: u64,
    /// Reflections between surfaces before the light reaches the receiver's own: `Some(0)` is direct light only, as
    /// in a bake of that many bounces; `None` follows paths until they end by themselves.
    pub max_bounces: Option<u32>,
}
