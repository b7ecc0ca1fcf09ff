//! Many rays from one point.

use crate::ray::{Hit, Ray};
use crate::tracer::Tracer;
use glam::Vec3;

/// What a thread keeps between fans. It changes how fast answers come, never what they are.
#[derive(Debug, Default)]
pub struct FanState {}

impl FanState {
    /// An empty state.
    pub fn new() -> FanState {
        FanState::default()
    }
}

impl Tracer {
    /// Whether anything lies on each of many endless rays from one point: bit `i % 64` of `blocked[i / 64]` for the
    /// unit direction (xs, ys, zs)[i]; further bits are cleared. `solid` as for [`Tracer::closest`].
    ///
    /// Fast where neighbours in the list point in similar directions.
    ///
    /// # Panics
    /// If the slices differ in length or `blocked` is too short.
    #[expect(
        clippy::too_many_arguments,
        reason = "a structure of arrays has its arrays as arguments"
    )]
    pub fn occluded_fan(
        &self,
        origin: Vec3,
        xs: &[f32],
        ys: &[f32],
        zs: &[f32],
        solid: &dyn Fn(u32, f32, f32) -> bool,
        _state: &mut FanState,
        blocked: &mut [u64],
    ) {
        blocked.fill(0);
        for i in 0..xs.len() {
            let ray = Ray::new(origin, Vec3::new(xs[i], ys[i], zs[i]));
            blocked[i / 64] |= u64::from(self.occluded(&ray, solid)) << (i % 64);
        }
    }

    /// The nearest hits of the endless rays from one point whose bit in `wanted` is set: `hits[i]` for direction `i`,
    /// None where it is not wanted or meets nothing. `solid` as for [`Tracer::closest`].
    ///
    /// # Panics
    /// If the slices differ in length or `wanted` is too short.
    #[expect(
        clippy::too_many_arguments,
        reason = "a structure of arrays has its arrays as arguments"
    )]
    pub fn closest_fan(
        &self,
        origin: Vec3,
        xs: &[f32],
        ys: &[f32],
        zs: &[f32],
        wanted: &[u64],
        solid: &dyn Fn(u32, f32, f32) -> bool,
        _state: &mut FanState,
        hits: &mut [Option<Hit>],
    ) {
        for (i, hit) in hits.iter_mut().enumerate() {
            let ray = Ray::new(origin, Vec3::new(xs[i], ys[i], zs[i]));
            let asked = wanted[i / 64] >> (i % 64) & 1 == 1;
            *hit = if asked {
                self.closest(&ray, solid)
            } else {
                None
            };
        }
    }
}
