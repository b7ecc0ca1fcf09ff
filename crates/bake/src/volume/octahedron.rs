//! The octahedral map: the sphere on a square, of which every texel is about as large.

use coeff_io::octahedral;
use glam::{Vec2, Vec3};

/// The unit direction of a point of the square [-1, 1]^2: +z in the middle, -z at the corners, +x to the right (columns), +y along the
/// rows.
pub(super) fn direction(x: f32, y: f32) -> Vec3 {
    octahedral::of_square(Vec2::new(x, y))
}

/// Solid angle of a small part of the square, over its area: `1 / |p|^3` on the octahedron `|x| + |y| + |z| = 1`.
pub(super) fn density(x: f32, y: f32) -> f32 {
    let square = octahedral::on_octahedron(Vec2::new(x, y)).length_squared();
    1.0 / (square * square.sqrt())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn axes_are_where_they_are_said_to_be() {
        let expected = [
            (0.0, 0.0, Vec3::Z),
            (1.0, 0.0, Vec3::X),
            (-1.0, 0.0, Vec3::NEG_X),
            (0.0, 1.0, Vec3::Y),
            (0.0, -1.0, Vec3::NEG_Y),
            (1.0, 1.0, Vec3::NEG_Z),
            (-1.0, 1.0, Vec3::NEG_Z),
        ];
        for (x, y, axis) in expected {
            assert!(direction(x, y).abs_diff_eq(axis, 1e-6), "({x}, {y}): {}", direction(x, y));
        }
        // In the quarter of +x and +y below the horizon.
        let low = direction(0.9, 0.6);
        assert!(low.x > 0.0 && low.y > 0.0 && low.z < 0.0 && low.x > low.y, "{low}");
    }

    /// The integral over the square is the whole sphere; without the density it is not.
    #[test]
    fn solid_angles_sum_to_the_sphere() {
        let n = 200;
        let at = |i: i32| (2.0 * i as f32 + 1.0) / n as f32 - 1.0;
        let area = 4.0 / f64::from(n * n);
        let sum = |density: fn(f32, f32) -> f32| -> f64 {
            (0..n * n).map(|k| area * f64::from(density(at(k % n), at(k / n)))).sum()
        };
        let sphere = 4.0 * std::f64::consts::PI;
        assert!((sum(density) / sphere - 1.0).abs() < 1e-3, "{}", sum(density));
        assert!((sum(|_, _| 1.0) / sphere - 1.0).abs() > 0.1, "can fail");
    }
}
