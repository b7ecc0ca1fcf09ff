//! What blocks a receiver's view, as the bounces take it.

use crate::world::World;
use glam::Vec3;
use raytrace::Hit;

/// A point of a surface that a receiver sees from nearer than the vertices of that surface are apart.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct NearPoint {
    /// Traced triangle.
    pub(crate) triangle: u32,
    /// Side that is seen.
    pub(crate) front: bool,
    /// Barycentrics of the second and third corner.
    pub(crate) barycentrics: [f32; 2],
}

/// A point that a receiver sees, with its share of the receiver's cosine-weighted hemisphere.
#[derive(Debug, Clone, Copy)]
pub(crate) struct PackedHit {
    /// What sends the light on.
    pub(crate) source: Source,
    /// Whether the back of a surface was hit for which no near point stands.
    pub(crate) is_back: bool,
    /// Barycentrics of the second and third corner.
    pub(crate) barycentrics: [f32; 2],
    /// Weight times albedo, RGB.
    pub(crate) reflected: [f32; 3],
}

/// What sends light on to a receiver.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Source {
    /// A traced triangle: interpolated from its vertices.
    Triangle(u32),
    /// A near point of the receiver.
    Near(u32),
}

/// A hit that refers to the near point on its side of its triangle, or of its cell, where there is one.
pub(crate) fn packed(world: &World<'_>, hit: &Hit, reflected: Vec3, near: &[NearPoint]) -> PackedHit {
    let cell = |point: &NearPoint| world.cells.at(point.triangle, point.barycentrics);
    let key = (hit.triangle, hit.front, world.cells.at(hit.triangle, [hit.u, hit.v]));
    let found = near.binary_search_by_key(&key, |point| (point.triangle, point.front, cell(point)));
    PackedHit {
        source: found.map_or(Source::Triangle(hit.triangle), |index| Source::Near(index as u32)),
        is_back: found.is_err() && !hit.front,
        barycentrics: [hit.u, hit.v],
        reflected: reflected.to_array(),
    }
}

/// The middles of what a receiver sees of each triangle, or cell of one, that is nearer than it is large, where that sends on more than
/// `worth` of the light, by triangle and side.
///
/// A surface that close lies in the shade of whatever the receiver stands on; its vertices, farther off, do not.
pub(crate) fn near_points(world: &World<'_>, hits: &[(Hit, Vec3)], worth: f32) -> Vec<NearPoint> {
    let extent = |triangle| world.extent(triangle) / world.cells.sides(triangle) as f32;
    // Most are farther than any triangle is large: no need to look theirs up.
    let is_near = |hit: &Hit| hit.t < world.longest && hit.t < extent(hit.triangle);
    let mut near: Vec<&(Hit, Vec3)> = hits.iter().filter(|(hit, _)| is_near(hit)).collect();
    let key = |hit: &Hit| (hit.triangle, hit.front, world.cells.at(hit.triangle, [hit.u, hit.v]));
    near.sort_by_key(|(hit, _)| key(hit));
    let groups = near.chunk_by(|(a, _), (b, _)| key(a) == key(b));
    let middle = |group: &[&(Hit, Vec3)]| {
        let share: f32 = group.iter().map(|(_, reflected)| reflected.max_element()).sum();
        let mean = |of: fn(&Hit) -> f32| {
            group.iter().map(|(hit, reflected)| of(hit) * reflected.max_element()).sum::<f32>() / share
        };
        let (u, v) = (mean(|hit| hit.u), mean(|hit| hit.v));
        let away = |hit: &Hit| (hit.u - u).powi(2) + (hit.v - v).powi(2);
        // A point that was hit: the mean itself may lie inside a body that pierces the triangle.
        let (hit, _) = group.iter().min_by(|(a, _), (b, _)| away(a).total_cmp(&away(b)))?;
        let barycentrics = [hit.u, hit.v];
        (share > worth).then_some(NearPoint { triangle: hit.triangle, front: hit.front, barycentrics })
    };
    groups.filter_map(middle).collect()
}
