//! What blocks the directions of one receiver.

use glam::Vec3;
use raytrace::Hit;

/// Cosine of the angle from the normal within which what lies above a point covers it. Walls beside it reach in there far up alone.
const ABOVE: f32 = std::f32::consts::FRAC_1_SQRT_2;
/// Share of the directions within that angle that a cover blocks.
const COVERED: f64 = 0.5;

/// How high above a point about a normal what covers it lies; infinite where nothing does. Directions are those of a hemisphere, and weigh
/// the same; the given weights sum to `all` where each of them is blocked.
pub(super) fn cover(found: impl Iterator<Item = (Vec3, f32, f64)>, normal: Vec3, all: f64) -> f32 {
    let cosine = |(direction, t, weight): (Vec3, f32, f64)| (direction.dot(normal), t, weight);
    let above = found.map(cosine).filter(|(cosine, ..)| *cosine > ABOVE);
    let mut heights: Vec<(f32, f64)> = above.map(|(cosine, t, weight)| (t * cosine, weight)).collect();
    heights.sort_by(|a, b| a.0.total_cmp(&b.0));
    let enough = COVERED * f64::from(1.0 - ABOVE) * all;
    let mut sum = 0.0;
    let highest = heights.into_iter().find(|(_, weight)| {
        sum += weight;
        sum >= enough
    });
    highest.map_or(f32::INFINITY, |(height, _)| height)
}

/// The surfaces that block directions.
#[derive(Debug)]
pub(crate) struct Blockers {
    /// Closest-hit rays traced.
    pub(crate) rays: u64,
    /// Share of them that meets the inside of a body.
    pub(crate) inside_share: f32,
    /// Share of them that meets the back of a surface with one side, of a body or not; not told where some surfaces are translucent.
    pub(crate) behind_share: f32,
    /// Height of what covers the point, as [`cover`] tells it of a hemisphere; infinite where nothing does, or some surfaces are translucent.
    pub(crate) cover: f32,
    /// World directions, what they meet, and their weights, which sum to what is not open.
    pub(crate) found: Vec<(Vec3, Hit, f32)>,
    /// Of each: the factor of its light on the way through translucent surfaces, RGB; empty where there are none.
    pub(crate) filters: Vec<Vec3>,
}

impl Default for Blockers {
    fn default() -> Self {
        let none = (Vec::new(), Vec::new());
        Self { rays: 0, inside_share: 0.0, behind_share: 0.0, cover: f32::INFINITY, found: none.0, filters: none.1 }
    }
}
