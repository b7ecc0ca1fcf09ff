//! The camera and the turned light as the shaders see them (docs/shading.md, Camera and rasterisation).

use crate::{Frame, gpu_data};
use coeff_io::Camera;
use glam::{Mat3, Vec3};

/// The view of a frame; `near` is the view depth of the near plane, `largest` the most that the target can hold.
pub(crate) fn view(frame: &Frame, near: f32, largest: f32) -> gpu_data::View {
    let eye = Vec3::from(frame.camera.eye);
    let (forward, right, up) = axes(&frame.camera);
    let tangent = (0.5 * frame.camera.vertical_fov).tan();
    let aspect = frame.width as f32 / frame.height as f32;
    let light_from_world = Mat3::from_quat(frame.rotation.normalize().inverse());
    gpu_data::View {
        eye: eye.into(),
        near,
        forward: forward.into(),
        largest,
        right: (tangent * aspect * right).into(),
        up: (tangent * up).into(),
        clip_x: (right / (tangent * aspect)).into(),
        clip_y: (up / tangent).into(),
        light_from_world: light_from_world.to_cols_array_2d().map(|[x, y, z]| [x, y, z, 0.0]),
        ..Default::default()
    }
}

/// View depth of the near plane: a share of the diagonal of the box around `positions`.
pub(crate) fn near_plane(positions: &[[f32; 3]]) -> f32 {
    const SHARE: f32 = 1e-4;
    let lowest = positions.iter().fold(Vec3::INFINITY, |low, &p| low.min(p.into()));
    let highest = positions.iter().fold(Vec3::NEG_INFINITY, |high, &p| high.max(p.into()));
    let near = SHARE * (highest - lowest).length();
    if near > 0.0 && near.is_finite() { near } else { SHARE }
}

/// Unit forward, right and up. An `up` along the view is replaced by the axis that the view follows least.
fn axes(camera: &Camera) -> (Vec3, Vec3, Vec3) {
    let forward = (Vec3::from(camera.target) - Vec3::from(camera.eye)).normalize();
    let mut right = forward.cross(Vec3::from(camera.up).normalize_or_zero());
    if right.length() < 1e-6 {
        let least = forward.abs().min_position();
        right = forward.cross(Vec3::AXES[least]);
    }
    let right = right.normalize();
    (forward, right, right.cross(forward))
}
