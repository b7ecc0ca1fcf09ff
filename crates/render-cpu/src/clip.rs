//! Cutting triangles where they come too near or lie too far aside.

use glam::DVec3;

/// Triangles are cut where |x| or |y| exceeds this many half pictures, so that fixed-point coordinates cannot overflow.
pub(crate) const GUARD: f64 = 8.0;
/// A triangle cut by five planes has at most eight corners.
pub(crate) const MAX_CORNERS: usize = 8;

/// A convex polygon in projective space.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Polygon {
    corners: [DVec3; MAX_CORNERS],
    count: usize,
}

impl Polygon {
    /// The part of a triangle with w >= near that lies within the guard band; `None` where nothing of it can be on the picture.
    pub(crate) fn clipped(triangle: [DVec3; 3], near: f64) -> Option<Self> {
        let outside = |f: &dyn Fn(DVec3) -> bool| triangle.iter().all(|&v| f(v));
        if outside(&|v| v.z < near) || !triangle.iter().all(|v| v.is_finite()) {
            return None;
        }
        if outside(&|v| v.x > v.z) || outside(&|v| -v.x > v.z) || outside(&|v| v.y > v.z) || outside(&|v| -v.y > v.z) {
            return None;
        }
        let mut polygon = Self { corners: [DVec3::ZERO; MAX_CORNERS], count: 3 };
        polygon.corners[..3].copy_from_slice(&triangle);
        polygon.cut(|v| v.z - near);
        polygon.cut(|v| GUARD * v.z - v.x);
        polygon.cut(|v| GUARD * v.z + v.x);
        polygon.cut(|v| GUARD * v.z - v.y);
        polygon.cut(|v| GUARD * v.z + v.y);
        (polygon.count >= 3).then_some(polygon)
    }

    /// The corners in the order of the triangle.
    pub(crate) fn corners(&self) -> &[DVec3] {
        &self.corners[..self.count]
    }

    /// Keeps the part where `distance`, a linear function, is not negative.
    fn cut(&mut self, distance: impl Fn(DVec3) -> f64) {
        let old = *self;
        let signed = old.corners.map(&distance);
        if signed[..old.count].iter().all(|&s| s >= 0.0) {
            return;
        }
        self.count = 0;
        for i in 0..old.count {
            let j = (i + 1) % old.count;
            let (a, b) = (signed[i], signed[j]);
            if a >= 0.0 {
                self.push(old.corners[i]);
            }
            // Always from the kept to the cut corner, so that two triangles with a common edge cut it at the same point.
            if a >= 0.0 && b < 0.0 {
                self.push(old.corners[i] + (old.corners[j] - old.corners[i]) * (a / (a - b)));
            } else if a < 0.0 && b >= 0.0 {
                self.push(old.corners[j] + (old.corners[i] - old.corners[j]) * (b / (b - a)));
            }
        }
    }

    fn push(&mut self, corner: DVec3) {
        // Rounding may make a polygon not quite convex; a corner too many is then no loss.
        if self.count < MAX_CORNERS {
            self.corners[self.count] = corner;
            self.count += 1;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_triangle_through_the_eye_plane_keeps_its_front_part() {
        let triangle = [DVec3::new(0.0, 0.0, 2.0), DVec3::new(1.0, 0.0, -2.0), DVec3::new(0.0, 1.0, -2.0)];
        let polygon = Polygon::clipped(triangle, 1.0).expect("a part lies before the near plane");
        let on_plane = polygon.corners().iter().filter(|v| (v.z - 1.0).abs() < 1e-12).count();
        assert_eq!((polygon.corners().len(), on_plane), (3, 2));
    }

    #[test]
    fn a_triangle_behind_the_eye_is_dropped() {
        assert!(Polygon::clipped([DVec3::new(0.0, 0.0, -1.0), DVec3::NEG_Z, DVec3::NEG_Z], 0.1).is_none());
    }
}
