//! The plane of one triangle: what a sample needs to interpolate in it.

use glam::{DVec2, DVec3};

/// A triangle in projective space, ready to interpolate perspective-correctly.
///
/// The point seen at (x, y) is s·(x, y, 1) with s = det(v0, v1, v2) / (n·(x, y, 1)); the weight of corner i is
/// n_i·(x, y, 1) / n·(x, y, 1) with n_i the cross product of the two other corners and n = n_0 + n_1 + n_2.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Facet {
    normals: [DVec3; 3],
}

impl Facet {
    /// The facet of three corners in projective space.
    pub(crate) fn new([a, b, c]: [DVec3; 3]) -> Self {
        Self { normals: [b.cross(c), c.cross(a), a.cross(b)] }
    }

    /// Weights of the corners at a place on the picture; not negative, with sum 1.
    pub(crate) fn weights(&self, place: DVec2) -> [f32; 3] {
        let d = place.extend(1.0);
        let raw = self.normals.map(|n| n.dot(d));
        // The sign of the sum says on which side the eye is. A sample that snapping moved just outside counts as on the edge.
        let sign = (raw[0] + raw[1] + raw[2]).signum();
        let inside = raw.map(|w| (w * sign).max(0.0));
        let sum = inside[0] + inside[1] + inside[2];
        let scale = 1.0 / sum;
        if scale.is_finite() { inside.map(|w| (w * scale) as f32) } else { [1.0 / 3.0; 3] }
    }

    /// Coefficients (k) of the inverse depth 1/w = k·(x, y, 1), or `None` where the plane passes through the eye.
    pub(crate) fn inverse_depth(&self, corners: [DVec3; 3]) -> Option<DVec3> {
        let plane = (self.normals[0] + self.normals[1] + self.normals[2]) / corners[0].dot(self.normals[0]);
        plane.is_finite().then_some(plane)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn weights_and_depth_follow_the_perspective() {
        let corners = [DVec3::new(-1.0, 0.0, 1.0), DVec3::new(3.0, 0.0, 3.0), DVec3::new(0.0, 2.0, 2.0)];
        let facet = Facet::new(corners);
        // The middle of the first edge is at (1, 0, 2), seen at x = 0.5 and not at the middle of the edge's picture.
        let weights = facet.weights(DVec2::new(0.5, 0.0));
        assert!((weights[0] - 0.5).abs() < 1e-6 && (weights[1] - 0.5).abs() < 1e-6, "{weights:?}");
        let inverse = facet.inverse_depth(corners).expect("not edge-on").dot(DVec3::new(0.5, 0.0, 1.0));
        assert!((inverse - 0.5).abs() < 1e-12, "{inverse}");
    }
}
