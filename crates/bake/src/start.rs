//! Where rays leave a receiver: above every surface that lies in its plane.
//!
//! Ground that covers a part of a floor lies in the floor's plane up to rounding. Which of them is above the other is then no question of
//! the scene: turned by an odd angle, it changes from point to point, and with it what is seen. So rays start above both.

use crate::world::World;
use glam::Vec3;
use raytrace::{Hit, Ray, offset_origin};
use scene::Mesh;

/// How far rounding may put a surface off its plane, over the sum of its largest coordinates by their part in the normal: four times half a
/// step of each. Its corners are rounded once, points between corners a few times more.
const ROUNDING: f32 = 1.0 / 4_194_304.0;
/// Cosine from where two surfaces that touch count as parallel.
const PARALLEL: f32 = 0.9;
/// Surfaces in one plane that rays start above at most.
const LAYERS: usize = 8;

/// Largest coordinates of a mesh by amount; splitting triangles changes neither them nor the rounding of what they span.
pub(crate) fn extent(mesh: &Mesh) -> Vec3 {
    mesh.positions.iter().filter(|p| p.is_finite()).fold(Vec3::ZERO, |most, p| most.max(p.abs()))
}

/// How far rounding may put a surface with this normal off its plane, metres.
pub(crate) fn rounding(extent: Vec3, normal: Vec3) -> f32 {
    ROUNDING * extent.dot(normal.abs())
}

impl World<'_> {
    /// Where rays leave a point of a surface that may be off its plane by `own` metres. Surfaces that are parallel to it and no farther off than
    /// the rounding of both explains lie below.
    pub(crate) fn start(&self, position: Vec3, normal: Vec3, own: f32) -> Vec3 {
        let start = offset_origin(position, normal);
        let step = (start - position).dot(normal);
        let most = own + rounding(self.extent, normal);
        let (mut lift, mut ray) = (0.0f32, Ray { t_max: most - step, ..Ray::new(start, normal) });
        // Along an axis, steps are larger than the rounding of planes that lie near the origin on it.
        for _ in 0..if most > step { LAYERS } else { 0 } {
            let Some(hit) = self.next(&ray) else { break };
            let [a, b, c] = self.points(hit.triangle);
            let across = (b - a).cross(c - a).normalize_or_zero().dot(normal).abs();
            let other = rounding(self.extents[self.locate(hit.triangle).0], normal);
            if across < PARALLEL || step + hit.t > own + other {
                break;
            }
            // The tracer rounds corners once more, anew for each origin.
            lift = lift.max(hit.t + 0.5 * other.max(step));
            ray.t_min = hit.t.next_up();
        }
        if lift > 0.0 { start + lift * normal } else { start }
    }

    /// The nearest surface along a ray, translucent ones too.
    fn next(&self, ray: &Ray) -> Option<Hit> {
        let veil = self.translucent.as_ref().and_then(|layer| {
            let hit = layer.tracer.closest(ray, &|_, _, _| true)?;
            Some(Hit { triangle: layer.first + hit.triangle, ..hit })
        });
        self.closest(ray).into_iter().chain(veil).min_by(|a, b| a.t.total_cmp(&b.t))
    }
}
