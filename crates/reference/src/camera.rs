//! Rays of a perspective view.

use glam::Vec3;
use scene::Camera;

/// A camera prepared for one size of picture.
#[derive(Debug, Clone, Copy)]
pub(crate) struct View {
    pub(crate) eye: Vec3,
    forward: Vec3,
    /// From the centre of the picture at distance 1 to its right and upper edge.
    right: Vec3,
    up: Vec3,
    size: [f32; 2],
}

impl View {
    pub(crate) fn new(camera: &Camera, width: u32, height: u32) -> Self {
        let forward = (camera.target - camera.eye).normalize_or(Vec3::NEG_Z);
        // A camera that looks along its own up direction still needs some right.
        let right = forward.cross(camera.up).try_normalize().unwrap_or_else(|| forward.any_orthonormal_vector());
        let tangent = libm::tanf(0.5 * camera.vertical_fov);
        Self {
            eye: camera.eye,
            forward,
            right: right * (tangent * width as f32 / height as f32),
            up: right.cross(forward) * tangent,
            size: [width as f32, height as f32],
        }
    }

    /// Unit direction through a position in the picture, pixels from the upper left corner.
    pub(crate) fn direction(&self, [x, y]: [f32; 2]) -> Vec3 {
        let (a, b) = (2.0 * x / self.size[0] - 1.0, 1.0 - 2.0 * y / self.size[1]);
        (self.forward + self.right * a + self.up * b).normalize()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const CAMERA: Camera = Camera {
        name: String::new(),
        eye: Vec3::new(0.0, 0.0, 5.0),
        target: Vec3::ZERO,
        up: Vec3::Y,
        vertical_fov: std::f32::consts::FRAC_PI_2,
    };

    #[test]
    fn centre_looks_at_the_target_and_x_goes_right() {
        let view = View::new(&CAMERA, 200, 100);
        assert!((view.direction([100.0, 50.0]) + Vec3::Z).length() < 1e-6, "the centre");
        let corner = view.direction([200.0, 0.0]);
        assert!((corner - Vec3::new(2.0, 1.0, -1.0).normalize()).length() < 1e-6, "upper right: {corner}");
    }
}
