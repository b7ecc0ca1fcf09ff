//! All the light that falls on a scene from far away.

use crate::Probe;
use glam::Vec3;

/// Distant light: a picture of the smooth part and a list of lamps that are too small for pixels.
#[derive(Debug, Clone)]
pub struct Environment {
    /// What the user called it: a path or `builtin:NAME`.
    pub name: String,
    /// The part that pixels can hold.
    pub image: Probe,
    /// Discs and points of light added to the picture.
    pub lamps: Vec<Lamp>,
}

/// A uniform disc of light in the sky, or a point where `half_angle` is 0.
#[derive(Debug, Clone, Copy)]
pub struct Lamp {
    /// From the scene to the lamp, unit.
    pub direction: Vec3,
    /// Angular radius, radians; 0 for a directional light.
    pub half_angle: f32,
    /// Irradiance on a surface that faces the lamp, RGB.
    pub irradiance: [f32; 3],
}
