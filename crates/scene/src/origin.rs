//! Scenes far from the origin of their coordinates: the offset that is taken off before positions are rounded.

use glam::DVec3;

/// Distance over size of a scene beyond which f32 positions lose what matters: steps above 1e-5 of the size.
const FAR: f64 = 64.0;
/// The same where the steps are above 4 mm in metres: large sites hold small things.
const FAR_IN_METRES: f64 = 4.0;
/// Coordinates from which on neighbouring f32 numbers are that far apart.
const COARSE: f64 = 65_536.0;

/// A box around points in f64.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Extent {
    min: DVec3,
    max: DVec3,
}

impl Extent {
    /// The box of no points.
    pub(crate) fn new() -> Self {
        Self { min: DVec3::INFINITY, max: DVec3::NEG_INFINITY }
    }

    /// Grows to hold a point; points that are not finite are left out.
    pub(crate) fn add(&mut self, point: DVec3) {
        if point.is_finite() {
            *self = Self { min: self.min.min(point), max: self.max.max(point) };
        }
    }

    /// The point whose coordinates are taken off all others: zero where the scene lies near its origin.
    ///
    /// Its coordinates are multiples of a power of two of about the size of the scene, so they take nothing off the
    /// digits of what lies there, and an axis along which the scene is near keeps its numbers.
    pub(crate) fn common_origin(&self) -> DVec3 {
        let size = (self.max - self.min).length();
        let reach = self.min.abs().max(self.max.abs()).max_element();
        let far = reach > FAR * size || reach > COARSE && reach > FAR_IN_METRES * size;
        if !(size > 0.0 && size.is_finite() && far) {
            return DVec3::ZERO;
        }
        let grid = libm::exp2(libm::floor(libm::log2(size)));
        let middle = 0.5 * (self.min + self.max);
        // An axis along which the scene is near zero stays as it is; adding zero makes -0 zero.
        let moved = DVec3::select(middle.abs().cmpgt(DVec3::splat(size)), middle, DVec3::ZERO);
        (moved / grid).round() * grid + 0.0
    }
}

/// Distance between neighbouring f32 numbers of a size.
pub(crate) fn step(size: f64) -> f64 {
    let size = size as f32;
    f64::from(size.next_up()) - f64::from(size)
}

/// What is said of an origin that was taken off.
pub(crate) fn message(origin: DVec3) -> String {
    let [x, y, z] = origin.to_array();
    format!(
        "lies {:.0} m from the origin of its coordinates; ({x}, {y}, {z}) was taken off all positions, so that none \
         is rounded, and is kept as their origin",
        origin.length()
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    fn extent(min: [f64; 3], max: [f64; 3]) -> Extent {
        let mut extent = Extent::new();
        extent.add(DVec3::from(min));
        extent.add(DVec3::from(max));
        extent
    }

    #[test]
    fn only_far_scenes_are_moved() {
        let near = [
            extent([-12.0, 0.0, -12.0], [12.0, 6.0, 12.0]),
            extent([1000.0, 0.0, 0.0], [1024.0, 6.0, 24.0]),
            extent([-2e5, 0.0, 0.0], [2e5, 10.0, 1e5]),
            extent([7.0, 7.0, 7.0], [7.0, 7.0, 7.0]),
            Extent::new(),
        ];
        for extent in near {
            assert_eq!(extent.common_origin(), DVec3::ZERO, "{extent:?}");
        }
    }

    #[test]
    fn the_origin_leaves_small_numbers_and_near_axes_alone() {
        let tower = extent([499_988.0, 0.0, -5_300_012.0], [500_012.0, 6.0, -5_299_988.0]);
        assert_eq!(tower.common_origin(), DVec3::new(500_000.0, 0.0, -5_300_000.0));
        let (millimetres, kilometres) = (1e-3, 1e3);
        for unit in [millimetres, kilometres] {
            let [min, max] = [[499.0, 0.0, 0.0], [500.0, 1.0, 1.0]].map(|p| p.map(|x| x * unit));
            let origin = extent(min, max).common_origin();
            assert!((origin.x / unit - 499.5).abs() < 2.0 && origin.y == 0.0, "{origin} in units of {unit}");
        }
        let site = extent([4e5, 0.0, -5.4e6], [6e5, 1e3, -5.2e6]);
        assert!(site.common_origin().z < -5e6, "a wide site with steps of half a metre");
    }

    #[test]
    fn steps_are_those_of_f32() {
        assert_eq!([1.0, 5.3e6].map(step), [f64::from(f32::EPSILON), 0.5]);
    }
}
