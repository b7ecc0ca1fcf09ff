//! The camera and the turned light as the shaders see them (docs/shading.md, Camera and rasterisation).

use crate::{Frame, gpu_data};
use coeff_io::Prt;
use glam::{DMat3, DQuat};

/// Ratio of the near distance to the diagonal of the scene.
const NEAR_SHARE: f32 = 1e-4;

/// The view of a frame; `near` is the view depth of the near plane, `largest` the most that the target can hold.
pub(crate) fn view(frame: &Frame, near: f32, largest: f32) -> gpu_data::View {
    let [right, up, back] = frame.camera.axes().map(|axis| axis.as_dvec3());
    let tangent = (0.5 * f64::from(frame.camera.vertical_fov)).tan();
    let aspect = f64::from(frame.width) / f64::from(frame.height);
    let light_from_world = DMat3::from_quat(light_from_world(frame));
    gpu_data::View {
        eye: frame.camera.eye,
        near,
        forward: (-back).as_vec3().into(),
        largest,
        right: (tangent * aspect * right).as_vec3().into(),
        white: f32::from(u8::from(!frame.albedo)),
        up: (tangent * up).as_vec3().into(),
        clip_x: (right / (tangent * aspect)).as_vec3().into(),
        clip_y: (up / tangent).as_vec3().into(),
        light_from_world: light_from_world.to_cols_array_2d().map(|[x, y, z]| [x as f32, y as f32, z as f32, 0.0]),
        ..Default::default()
    }
}

/// View depth of the near plane: a share of the diagonal of the box around all positions.
pub(crate) fn near_plane(prt: &Prt) -> f32 {
    let (least, greatest) = prt.bounds();
    let near = NEAR_SHARE * (greatest - least).length();
    if near > 0.0 && near.is_finite() { near } else { NEAR_SHARE }
}

fn light_from_world(frame: &Frame) -> DQuat {
    frame.rotation.as_dquat().normalize().inverse()
}
