//! Receivers on the ground.

use glam::Vec3;
use reference::Receiver;

/// The ground point (x, 0, z) that faces up.
pub(crate) fn ground(x: f32, z: f32, albedo: f32) -> Receiver {
    let position = Vec3::new(x, 0.0, z);
    Receiver { position, normal: Vec3::Y, geometric_normal: Vec3::Y, albedo: Vec3::splat(albedo) }
}
