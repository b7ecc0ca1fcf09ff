//! What a receiver sees through surfaces that stop a part of the light.

use super::{Blockers, Gatherer, Worker, add_open};
use crate::directions::DirectionSet;
use crate::dot::dot;
use crate::found::mean;
use crate::transmittance::{Crossings, Translucent};
use glam::Vec3;
use raytrace::{Hit, Ray};
use sh_math::rotate::Rotation;

impl Gatherer<'_> {
    /// Writes what translucent surfaces pass of each ray; nothing of those that are blocked.
    pub(super) fn pass(
        &self,
        layer: &Translucent,
        (origin, [xs, ys, zs]): (Vec3, [&[f32]; 3]),
        met: &[u64],
        crossings: &mut Crossings,
        passed: &mut Vec<Vec3>,
    ) {
        passed.clear();
        passed.extend((0..xs.len()).map(|k| {
            if met[k / 64] >> (k % 64) & 1 == 1 {
                return Vec3::ZERO;
            }
            layer.transmittance(self.world, &Ray::new(origin, Vec3::new(xs[k], ys[k], zs[k])), crossings)
        }));
    }

    /// Direct transfer per channel, `[channel of 3][coefficient]` in world axes, of the directions up to a step.
    pub(super) fn tinted(&self, set: &DirectionSet, step: usize, rotation: &Rotation, worker: &Worker) -> Vec<f32> {
        let channels = worker.tints.iter().flat_map(|open| {
            let (_, local) = self.channel(set, step, open);
            let mut world: Vec<f32> = local.into_iter().map(|x| x as f32).collect();
            rotation.apply(&mut world);
            world
        });
        channels.collect()
    }

    /// Direct transfer in the local frame of the channel of which least arrives, whose error is the largest; none where nothing is tinted.
    pub(super) fn darkest(&self, set: &DirectionSet, step: usize, worker: &Worker) -> Option<Vec<f64>> {
        if !self.world.tints() {
            return None;
        }
        let channels = worker.tints.iter().map(|open| self.channel(set, step, open));
        channels.min_by(|a, b| a.0.total_cmp(&b.0)).map(|(_, local)| local)
    }

    /// Open share, and direct transfer in the local frame, of one channel.
    fn channel(&self, set: &DirectionSet, step: usize, open: &[f32]) -> (f64, Vec<f64>) {
        let mut sums = vec![0.0f64; self.bands.coefficients()];
        (0..=step).for_each(|number| add_open(set, number, &open[set.range(number)], &mut sums));
        let step = &set.steps[step];
        let openness = dot(&set.weights[..step.end], open) / step.weight;
        (openness, self.corrected(&sums, openness, step))
    }

    /// The surfaces along the directions that were found blocked, wholly or in part: of each direction all that the ray crosses up to what
    /// stops it, by what the surfaces before let through. The weights sum to what is not open; what is absorbed is in the filters.
    pub(super) fn blockers_through(
        &self,
        layer: &Translucent,
        origin: Vec3,
        weights: &[f32],
        openness: f32,
        worker: &mut Worker,
    ) -> Blockers {
        let mut all = Blockers::default();
        let (mut total, mut inside) = (0.0f64, 0.0f64);
        let Worker { directions: [xs, ys, zs], wanted, nearest, open, crossings, .. } = worker;
        for (j, opaque) in nearest.iter().enumerate() {
            if wanted[j / 64] >> (j % 64) & 1 == 0 {
                continue;
            }
            let direction = Vec3::new(xs[j], ys[j], zs[j]);
            let t_max = opaque.map_or(f32::INFINITY, |hit| hit.t);
            layer.cross(self.world, &Ray { t_max, ..Ray::new(origin, direction) }, crossings);
            let seen = Along::new(crossings, opaque.as_ref());
            // A direction that was foreseen otherwise stands for its like that were not tried.
            let weight = f64::from(weights[j]) * f64::from(1.0 - open[j].min(seen.passed));
            if weight <= 0.0 || seen.hits.is_empty() {
                continue;
            }
            total += weight;
            for (hit, share, filter) in seen.hits {
                let weight = weight * f64::from(share);
                let is_inside = self.world.bodies.is_inside(&hit);
                inside += if is_inside { weight } else { 0.0 };
                all.found.push((direction, hit, weight as f32));
                all.filters.push(filter);
            }
        }
        if total > 0.0 {
            let scale = ((1.0 - f64::from(openness)) / total) as f32;
            all.found.iter_mut().for_each(|(_, _, weight)| *weight *= scale);
            all.inside_share = (inside / total) as f32;
        }
        all
    }
}

/// The surfaces along one ray.
struct Along {
    /// Each with its share of what is not open, and the factor of its light; the shares sum to 1.
    hits: Vec<(Hit, f32, Vec3)>,
    /// Share of the light from infinity that passes all of them, mean of the channels.
    passed: f32,
}

impl Along {
    fn new(crossings: &Crossings, opaque: Option<&Hit>) -> Self {
        let mut through = Vec3::ONE;
        let mut seen: Vec<(Hit, Vec3)> = Vec::with_capacity(crossings.list.len() + 1);
        for crossing in &crossings.list {
            if crossing.opacity > 0.0 {
                seen.push((crossing.hit, through * crossing.opacity));
            }
            through *= crossing.transmittance;
        }
        if let Some(hit) = opaque {
            seen.push((*hit, through));
            through = Vec3::ZERO;
        }
        let passed = mean(through);
        let total: f32 = seen.iter().map(|(_, share)| mean(*share)).sum();
        if total <= 0.0 {
            // All that is stopped is absorbed: a surface that sends nothing stands for it.
            let first = crossings.list.first().map(|crossing| crossing.hit).or(opaque.copied());
            return Self { hits: first.map(|hit| (hit, 1.0, Vec3::ZERO)).into_iter().collect(), passed };
        }
        let shown = total / (1.0 - passed);
        let parts = seen.into_iter().filter(|(_, share)| mean(*share) > 0.0).map(|(hit, share)| {
            let own = mean(share);
            (hit, own / total, share / own * shown)
        });
        Self { hits: parts.collect(), passed }
    }
}
