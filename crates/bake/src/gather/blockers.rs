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
    /// How high above the point about a normal what covers it lies; infinite where nothing does, or some surfaces are translucent. The
    /// directions are those of the domain.
    pub(crate) fn cover(&self, normal: Vec3, domain: &Domain) -> f32 {
        if !self.filters.is_empty() {
            return f32::INFINITY;
        }
        let share = match domain {
            Domain::Cosine => 1.0 - ABOVE * ABOVE,
            Domain::Hemisphere(_) | Domain::Sphere(_) => 1.0 - ABOVE,
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
