//! An independent path tracer: the ground truth that baked transfer is judged by.
//!
//! Diffuse, two-sided transport under distant light, by plain paths: next-event estimation towards picture and lamps,
//! combined with cosine-sampled directions. No spherical harmonics, no interpolation between vertices, no code
//! shared with the baker. What it draws is the same: both sides of a surface block and reflect; surfaces that blend
//! or transmit do not stop light; emission is seen by the camera but lights nothing.

mod camera;
mod light;
mod path;
mod receiver;
mod render;
mod world;

pub use light::Light;
pub use receiver::{Estimate, Receiver, radiance_at};
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
