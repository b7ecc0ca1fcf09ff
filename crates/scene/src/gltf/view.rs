//! Cameras and lights of nodes.

use ::gltf::json::camera::Camera as JsonCamera;
use ::gltf::json::extensions::scene::khr_lights_punctual::{Light, Type};
use ::gltf::json::validation::Checked;
use glam::{DMat4, DVec3, Vec3};

use crate::{Camera, LightKind, PunctualLight};

/// A perspective camera, relative to an origin; it looks along its node's -z.
pub(super) fn camera(camera: &JsonCamera, name: &str, world_from_node: DMat4, origin: DVec3) -> Option<Camera> {
    let perspective = camera.perspective.as_ref()?;
    let sound = perspective.yfov > 0.0 && perspective.yfov < std::f32::consts::PI;
    let eye = world_from_node.w_axis.truncate() - origin;
    let forward = (-world_from_node.z_axis.truncate()).try_normalize()?;
    let up = world_from_node.y_axis.truncate().try_normalize()?;
    sound.then(|| Camera {
        name: camera.name.clone().unwrap_or_else(|| name.into()),
        eye: eye.as_vec3(),
        target: (eye + forward).as_vec3(),
        up: up.as_vec3(),
        vertical_fov: perspective.yfov,
    })
}

/// A punctual light, relative to an origin; it shines along its node's -z.
pub(super) fn lamp(light: &Light, name: &str, world_from_node: DMat4, origin: DVec3) -> Option<PunctualLight> {
    let kind = match (&light.type_, &light.spot) {
        (Checked::Valid(Type::Directional), _) => LightKind::Directional,
        (Checked::Valid(Type::Point), _) => LightKind::Point,
        (Checked::Valid(Type::Spot), Some(spot)) => {
            LightKind::Spot { inner: spot.inner_cone_angle, outer: spot.outer_cone_angle }
        }
        _ => return None,
    };
    Some(PunctualLight {
        name: light.name.clone().unwrap_or_else(|| name.into()),
        kind,
        position: (world_from_node.w_axis.truncate() - origin).as_vec3(),
        direction: (-world_from_node.z_axis.truncate()).try_normalize()?.as_vec3(),
        intensity: Vec3::from(light.color) * light.intensity,
    })
}
