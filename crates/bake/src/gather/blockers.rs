//! What blocks the directions of one receiver.

use crate::domain::Domain;
use glam::Vec3;
use raytrace::Hit;

/// Cosine of the angle from the normal within which what lies above a point covers it. Walls beside it reach in there far up alone.
const ABOVE: f32 = std::f32::consts::FRAC_1_SQRT_2;
/// Share of the directions within that angle that a cover blocks. A wall that leans over ground is seen, however near its foot: little more than
/// half of them meet ground as near as that.
const COVERED: f64 = 0.85;

/// The surfaces that block directions.
#[derive(Debug, Default)]
pub(crate) struct Blockers {
    /// Closest-hit rays traced.
    pub(crate) rays: u64,
    /// Share of them that meets the inside of a body.
    pub(crate) inside_share: f32,
    /// Share of them that meets the back of a surface with one side, of a body or not; not told where some surfaces are translucent. Backs of
    /// walls count twice, up to 1: who stands behind one sees its back in half of the view. Those of masked surfaces count once: among leaves
    /// half of what is seen are backs.
    pub(crate) behind_share: f32,
    /// World directions, what they meet, and their weights, which sum to what is not open.
    pub(crate) found: Vec<(Vec3, Hit, f32)>,
    /// Of each: the factor of its light on the way through translucent surfaces, RGB; empty where there are none.
    pub(crate) filters: Vec<Vec3>,
}

impl Blockers {
    /// How high above the point about a normal what covers it lies; infinite where nothing does, for points in space, and where some surfaces are
    /// translucent. The directions are those of the domain.
    pub(crate) fn cover(&self, normal: Vec3, domain: &Domain) -> f32 {
        if !self.filters.is_empty() {
            return f32::INFINITY;
        }
        let share = match domain {
            Domain::Cosine => 1.0 - ABOVE * ABOVE,
            Domain::Hemisphere(_) => 1.0 - ABOVE,
            // A point in space lies on no surface that something could cover.
            Domain::Sphere(_) => return f32::INFINITY,
        };
        let cosine = |(direction, hit, weight): &(Vec3, Hit, f32)| (direction.dot(normal), hit.t, f64::from(*weight));
        let above = self.found.iter().map(cosine).filter(|(cosine, ..)| *cosine > ABOVE);
        let mut heights: Vec<(f32, f64)> = above.map(|(cosine, t, weight)| (t * cosine, weight)).collect();
        heights.sort_by(|a, b| a.0.total_cmp(&b.0));
        let enough = COVERED * f64::from(share);
        let mut sum = 0.0;
        let highest = heights.into_iter().find(|(_, weight)| {
            sum += weight;
            sum >= enough
        });
        highest.map_or(f32::INFINITY, |(height, _)| height)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::domain::Judge;
    use sh_math::Bands;

    /// Blockers under a plate at a height of 2, seen through `count` directions that lie evenly in the domain above the point; of those a share
    /// about the normal meets it.
    fn under_a_plate(share: f32, z: impl Fn(f32) -> f32) -> Blockers {
        let count = 4096;
        let at = |k: u32| {
            let (z, angle) = (z((k as f32 + 0.5) / count as f32), k as f32 * 2.399_963);
            let radius = (1.0 - z * z).sqrt();
            let hit = Hit { triangle: 0, t: 2.0 / z, u: 0.0, v: 0.0, front: true };
            (Vec3::new(radius * libm::cosf(angle), radius * libm::sinf(angle), z), hit, 1.0 / count as f32)
        };
        // Every direction within the angle stands for as many around it.
        let meets = |k: &u32| (*k as f32 * 0.618_034).fract() < share;
        Blockers { found: (0..count).filter(meets).map(at).collect(), ..Blockers::default() }
    }

    fn judge() -> Judge {
        Judge::new(Bands::new(2).expect("few"), Bands::new(4).expect("few"))
    }

    /// A plate covers a point from 85 % of the directions within 45 degrees on, whether these follow the cosine or not.
    #[test]
    fn plates_cover_points_of_surfaces() {
        for (share, height) in [(1.0, 2.0), (0.87, 2.0), (0.83, f32::INFINITY)] {
            let even = under_a_plate(share, |x| x).cover(Vec3::Z, &Domain::Hemisphere(judge()));
            let by_cosine = under_a_plate(share, f32::sqrt).cover(Vec3::Z, &Domain::Cosine);
            assert!([even, by_cosine].iter().all(|found| *found == height || (found - height).abs() < 1e-4), "{share}");
        }
    }

    /// Even directions taken for such as follow the cosine tell nothing; points in space lie on nothing that could be covered.
    #[test]
    fn plates_cover_points_of_surfaces_can_fail() {
        assert_eq!(under_a_plate(1.0, |x| x).cover(Vec3::Z, &Domain::Cosine), f32::INFINITY);
        assert_eq!(under_a_plate(1.0, |x| x).cover(Vec3::Z, &Domain::Sphere(judge())), f32::INFINITY);
    }
}
