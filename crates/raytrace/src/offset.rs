//! Where a ray that leaves a surface starts: just off it, by a distance that scales with the coordinates.

use glam::Vec3;

/// The distance over the largest coordinate: 2^-21, four to eight units in the last place of that coordinate.
///
/// A point computed on a triangle in single precision is off its plane by up to two such units, and the tracer
/// rounds corners once more when it translates them; a larger step would pass through thin walls.
const STEP: f32 = 1.0 / 2_097_152.0;

/// A point moved off the surface it lies on along a unit normal, far enough that a ray from it does not meet that
/// surface again and near enough that it passes through no other.
///
/// The step scales with the largest coordinate of the position, so it holds at any scale and far from the origin.
/// For points inside a triangle much larger than its distance from the world's origin use [`offset_origin_on`].
pub fn offset_origin(position: Vec3, geometric_normal: Vec3) -> Vec3 {
    step_off(position, geometric_normal, position.abs().max_element())
}

/// [`offset_origin`] for a point computed from the corners of a triangle, whose coordinates set its rounding.
pub fn offset_origin_on(corners: [Vec3; 3], position: Vec3, geometric_normal: Vec3) -> Vec3 {
    let [a, b, c] = corners.map(|corner| corner.abs().max_element());
    step_off(position, geometric_normal, a.max(b).max(c))
}

fn step_off(position: Vec3, normal: Vec3, size: f32) -> Vec3 {
    position + normal * (size * STEP)
}
