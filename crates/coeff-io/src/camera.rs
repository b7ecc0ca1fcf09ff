//! Where a camera looks: its matrix and the box that a scene fills.

use crate::{Camera, Prt};
use glam::{Mat4, Vec3, Vec4};

impl Camera {
    /// Matrix from world space to clip space: x right, y up, depth 0 at `near` and 1 at `far` after the division.
    ///
    /// `aspect` is width over height; distances are in metres along the view.
    #[must_use]
    pub fn clip_from_world(&self, aspect: f32, near: f32, far: f32) -> Mat4 {
        let [right, up, back] = self.axes();
        let eye = Vec3::from(self.eye);
        let view_from_world = Mat4::from_cols(
            Vec4::new(right.x, up.x, back.x, 0.0),
            Vec4::new(right.y, up.y, back.y, 0.0),
            Vec4::new(right.z, up.z, back.z, 0.0),
            Vec4::new(-right.dot(eye), -up.dot(eye), -back.dot(eye), 1.0),
        );
        let focal = 1.0 / (0.5 * self.vertical_fov).tan();
        let depth = far / (near - far);
        let clip_from_view = Mat4::from_cols(
            Vec4::new(focal / aspect, 0.0, 0.0, 0.0),
            Vec4::new(0.0, focal, 0.0, 0.0),
            Vec4::new(0.0, 0.0, depth, -1.0),
            Vec4::new(0.0, 0.0, depth * near, 0.0),
        );
        clip_from_view * view_from_world
    }

    /// Unit axes of the view in world space: right, up, and back (against the view).
    #[must_use]
    pub fn axes(&self) -> [Vec3; 3] {
        let back = (Vec3::from(self.eye) - Vec3::from(self.target)).normalize_or(Vec3::Z);
        let up = Vec3::from(self.up).normalize_or(Vec3::Y);
        // A camera that looks along its own up direction still needs a right: any horizontal one will do.
        let other = if back.x.abs() < 0.9 { Vec3::X } else { Vec3::Z };
        let right = up.cross(back);
        let right = if right.length_squared() > 1e-10 { right } else { other.cross(back) };
        let right = right.normalize();
        [right, back.cross(right), back]
    }
}

impl Prt {
    /// Least and greatest corner of the box around all vertices, metres.
    #[must_use]
    pub fn bounds(&self) -> (Vec3, Vec3) {
        let empty = (Vec3::INFINITY, Vec3::NEG_INFINITY);
        let positions = self.geometry.positions.iter().map(|p| Vec3::from(*p));
        positions.fold(empty, |(least, greatest), p| (least.min(p), greatest.max(p)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn camera() -> Camera {
        let (eye, target, up) = ([1.0, 2.0, 8.0], [1.0, 2.0, 0.0], [0.0, 1.0, 0.0]);
        Camera { name: String::new(), eye, target, up, vertical_fov: std::f32::consts::FRAC_PI_2 }
    }

    /// Looking along -z with a quarter turn of view, the edge of the picture lies at 45 degrees.
    #[test]
    fn points_land_where_the_lens_says() {
        let clip_from_world = camera().clip_from_world(2.0, 1.0, 100.0);
        let project = |x, y, z| clip_from_world.project_point3(Vec3::new(x, y, z));
        assert!(project(1.0, 2.0, 7.0).distance(Vec3::ZERO) < 1e-6, "the axis at the near plane");
        assert!(project(1.0, 2.0, -92.0).distance(Vec3::Z) < 1e-5, "the axis at the far plane");
        let corner = project(1.0 + 2.0 * 4.0, 2.0 + 4.0, 4.0);
        assert!(corner.truncate().distance(glam::Vec2::ONE) < 1e-6, "the upper right corner: {corner}");
    }

    #[test]
    fn a_camera_that_looks_along_its_up_direction_has_axes() {
        for direction in [Vec3::Y, Vec3::NEG_Y, Vec3::X] {
            let target = (Vec3::from(camera().eye) + direction).to_array();
            let [right, up, back] = Camera { target, up: direction.to_array(), ..camera() }.axes();
            assert!(right.cross(up).distance(back) < 1e-6 && back.distance(-direction) < 1e-6);
        }
    }
}
