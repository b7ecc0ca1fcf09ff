//! Orthonormal frames around a normal.

use glam::Vec3;

/// A right-handed orthonormal frame; local `z` is the normal.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Frame {
    /// Local x in the world.
    pub tangent: Vec3,
    /// Local y in the world.
    pub bitangent: Vec3,
    /// Local z in the world.
    pub normal: Vec3,
}

impl Frame {
    /// A frame around a unit normal, without a branch or a trigonometric function.
    ///
    /// The sign of `normal.z` picks one of two smooth families, each far from its pole
    /// (Duff et al. 2017, "Building an Orthonormal Basis, Revisited").
    #[inline]
    #[must_use]
    pub fn from_normal(normal: Vec3) -> Self {
        let sign = 1.0_f32.copysign(normal.z);
        let a = -1.0 / (sign + normal.z);
        let b = normal.x * normal.y * a;
        Self {
            tangent: Vec3::new(1.0 + sign * normal.x * normal.x * a, sign * b, -sign * normal.x),
            bitangent: Vec3::new(b, sign + normal.y * normal.y * a, -normal.y),
            normal,
        }
    }

    /// Local coordinates to world coordinates.
    #[inline]
    #[must_use]
    pub fn to_world(&self, local: Vec3) -> Vec3 {
        self.tangent * local.x + self.bitangent * local.y + self.normal * local.z
    }

    /// World coordinates to local coordinates.
    #[inline]
    #[must_use]
    pub fn to_local(&self, world: Vec3) -> Vec3 {
        Vec3::new(self.tangent.dot(world), self.bitangent.dot(world), self.normal.dot(world))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{rng::Rng, warp};

    /// Largest departure from a right-handed orthonormal frame.
    fn defect(frame: &Frame) -> f32 {
        let Frame { tangent: t, bitangent: b, normal: n } = *frame;
        let lengths = [t, b, n].map(|v| (v.length_squared() - 1.0).abs());
        let angles = [t.dot(b), t.dot(n), b.dot(n), (t.cross(b) - n).length()].map(f32::abs);
        lengths.into_iter().chain(angles).fold(0.0, f32::max)
    }

    #[test]
    fn frames_are_orthonormal_everywhere() {
        let mut rng = Rng::new(1, 0);
        let poles = [Vec3::Z, -Vec3::Z, Vec3::X, -Vec3::Y, Vec3::new(1e-20, 0.0, -1.0), Vec3::new(0.0, 1e-5, -1.0)];
        let random = (0..10_000).map(|_| warp::square_to_uniform_sphere(rng.next_square()));
        for normal in poles.into_iter().chain(random) {
            let frame = Frame::from_normal(normal.normalize());
            assert!(defect(&frame) < 1e-6, "{frame:?}");
            let v = Vec3::new(0.3, -0.4, 0.5);
            assert!((frame.to_local(frame.to_world(v)) - v).length() < 1e-6, "{frame:?}");
        }
    }

    #[test]
    fn crooked_frames_can_fail() {
        let frame = Frame::from_normal(Vec3::Y);
        assert!(defect(&Frame { tangent: -frame.tangent, ..frame }) > 1.0, "left-handed");
        assert!(defect(&Frame { tangent: frame.tangent * 1.01, ..frame }) > 1e-2, "not unit");
    }
}
