//! Surfaces that stop a part of the light, as rays cross them: what blends or transmits.

use crate::world::World;
use glam::Vec3;
use raytrace::{Hit, Ray, Tracer};
use std::cell::RefCell;

/// The translucent triangles of a scene, in a tree of their own: the tree of what is opaque asks no ray for more.
pub(crate) struct Translucent {
    pub(crate) tracer: Tracer,
    /// Number of the first of them among the traced triangles.
    pub(crate) first: u32,
    /// Whether some of them tint the light that they pass.
    pub(crate) tints: bool,
}

/// Where a ray crosses a translucent surface.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Crossing {
    pub(crate) hit: Hit,
    /// Share of the light from behind that the surface hides.
    pub(crate) opacity: f32,
    /// Share of the light from behind that it passes, RGB; the rest is absorbed.
    pub(crate) transmittance: Vec3,
}

/// A crossing as the tree finds it: triangle, barycentrics, opacity and transmittance.
type Met = (u32, [f32; 2], f32, Vec3);

/// Buffers of a thread. Contents never change results.
#[derive(Default)]
pub(crate) struct Crossings {
    met: Vec<Met>,
    /// Those of the last ray, the nearest first.
    pub(crate) list: Vec<Crossing>,
}

impl Translucent {
    /// Share of the light from infinity that reaches a point along a direction, RGB: the product over all surfaces on the way.
    pub(crate) fn transmittance(&self, world: &World<'_>, ray: &Ray, buffers: &mut Crossings) -> Vec3 {
        let is_closed = self.walk(world, ray, buffers, |transmittance| transmittance == Vec3::ZERO);
        if is_closed {
            return Vec3::ZERO;
        }
        // In the order of the triangles, which that of the tree does not change.
        buffers.met.iter().map(|met| met.3).product()
    }

    /// Lists what a ray crosses, up to its end, into `buffers`.
    pub(crate) fn cross(&self, world: &World<'_>, ray: &Ray, buffers: &mut Crossings) {
        self.walk(world, ray, buffers, |_| false);
        let Crossings { met, list } = buffers;
        list.clear();
        list.extend(met.iter().map(|&(triangle, [u, v], opacity, transmittance)| {
            let [a, b, c] = world.points(triangle).map(|corner| corner.as_dvec3());
            let (ab, ac) = (b - a, c - a);
            let direction = ray.direction.as_dvec3();
            let way = a + f64::from(u) * ab + f64::from(v) * ac - ray.origin.as_dvec3();
            let t = way.dot(direction) / direction.length_squared();
            let front = ab.cross(ac).dot(direction) < 0.0;
            Crossing { hit: Hit { triangle, t: t as f32, u, v, front }, opacity, transmittance }
        }));
        list.sort_by(|a, b| a.hit.t.total_cmp(&b.hit.t).then(a.hit.triangle.cmp(&b.hit.triangle)));
    }

    /// Collects what a ray meets, each triangle once; ends with `true` where `stops` says so of what a surface passes.
    fn walk(&self, world: &World<'_>, ray: &Ray, buffers: &mut Crossings, stops: impl Fn(Vec3) -> bool) -> bool {
        let mut all = std::mem::take(&mut buffers.met);
        all.clear();
        let all = RefCell::new(all);
        let stopped = self.tracer.occluded(ray, &|triangle, u, v| {
            let triangle = self.first + triangle;
            let (opacity, transmittance) = world.translucency(triangle, u, v);
            if transmittance != Vec3::ONE {
                all.borrow_mut().push((triangle, [u, v], opacity, transmittance));
            }
            stops(transmittance)
        });
        buffers.met = all.into_inner();
        // A triangle may stand in several leaves of the tree.
        buffers.met.sort_unstable_by_key(|met| met.0);
        buffers.met.dedup_by_key(|met| met.0);
        stopped
    }
}
