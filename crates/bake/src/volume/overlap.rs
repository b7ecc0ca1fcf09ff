//! Whether a triangle comes into a box.

use glam::Vec3;

/// Whether a triangle and the box of a centre and half edges have a point in common: no axis parts them, of the three of the box, the
/// normal of the triangle and the nine products of their edges.
pub(super) fn overlap(corners: [Vec3; 3], centre: Vec3, half: Vec3) -> bool {
    let [a, b, c] = corners.map(|corner| corner - centre);
    if a.min(b).min(c).cmpgt(half).any() || a.max(b).max(c).cmplt(-half).any() {
        return false;
    }
    let edges = [b - a, c - b, a - c];
    if parts(edges[0].cross(edges[1]), [a, b, c], half) {
        return false;
    }
    let products = edges.iter().flat_map(|edge| Vec3::AXES.map(|axis| axis.cross(*edge)));
    products.into_iter().all(|axis| !parts(axis, [a, b, c], half))
}

/// Whether an axis parts the triangle from the box about the origin.
fn parts(axis: Vec3, corners: [Vec3; 3], half: Vec3) -> bool {
    let radius = axis.abs().dot(half);
    let along = corners.map(|corner| corner.dot(axis));
    let low = along[0].min(along[1]).min(along[2]);
    let high = along[0].max(along[1]).max(along[2]);
    low > radius || high < -radius
}

#[cfg(test)]
mod tests {
    use super::*;
    use sampling::rng::Rng;

    /// A triangle cut down to the box by its six planes, one after the other: what is left over, or nothing.
    fn clipped(corners: [Vec3; 3], half: Vec3) -> bool {
        let mut polygon = corners.to_vec();
        for axis in 0..3 {
            for sign in [1.0, -1.0] {
                let inside = |p: Vec3| half[axis] - sign * p[axis];
                let mut rest = Vec::new();
                for (i, &p) in polygon.iter().enumerate() {
                    let q = polygon[(i + 1) % polygon.len()];
                    let (s, t) = (inside(p), inside(q));
                    if s >= 0.0 {
                        rest.push(p);
                    }
                    if (s > 0.0) != (t > 0.0) && s != t {
                        rest.push(p + (q - p) * (s / (s - t)));
                    }
                }
                polygon = rest;
            }
        }
        !polygon.is_empty()
    }

    #[test]
    fn agrees_with_cutting() {
        let half = Vec3::new(0.5, 0.3, 0.8);
        let mut counts = [0, 0, 0];
        let mut random = Rng::new(7, 0);
        for _ in 0..20_000 {
            let corners = [(); 3].map(|()| Vec3::from_array([(); 3].map(|()| 3.0 * random.next_f32() - 1.5)));
            let (found, expected) = (overlap(corners, Vec3::ZERO, half), clipped(corners, half));
            assert_eq!(found, expected, "{corners:?}");
            counts[usize::from(found)] += 1;
            let [a, b, c] = corners;
            let boxed = a.min(b).min(c).cmple(half).all() && a.max(b).max(c).cmpge(-half).all();
            counts[2] += usize::from(boxed && !found);
        }
        assert!(counts.iter().all(|&n| n > 500), "all cases come up, and boxes alone would be wrong: {counts:?}");
    }
}
