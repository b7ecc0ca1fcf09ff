//! Edges that begin beside a narrow lit surface, whose bounced light fades faster than they are long.
//!
//! The foot of a wall on a capital takes half of what the lid before it sends on, and a lid's width higher hardly any. Between vertices that are
//! farther apart the light of the foot is spread over the wall. What is seen of the sky, by which bends are found, tells nothing of that.

use crate::gather::{Gatherer, Worker};
use crate::hit::NearPoint;
use crate::plan::allowed;
use crate::receivers::Receiver;
use coeff_io::{Bounces, Effect, Settings};
use glam::Vec3;
use raytrace::{Hit, Ray};

/// Where rays towards the surface at the foot of an edge start, and how far before the foot they aim, in lengths of the edge. The first looks
/// at what lies there, the second at what lies where that must still be, lest its light bends by more than a tenth of itself in the middle.
const LOOKS: [[f32; 2]; 2] = [[1.0 / 16.0, 1.0 / 16.0], [0.5, 0.75]];
/// How far beyond the aim of the first look a surface still is at the foot, in the way to the aim.
const REACH: f32 = 2.0;
/// Difference of what the two surfaces send on, against an open receiver's light, from where the edge is halved.
const DIFFERENT: f32 = 0.15;

/// Whether light bounces under these settings, so that edges are looked at.
pub(crate) fn matters(settings: &Settings) -> bool {
    settings.bounces != Bounces::Fixed(0) && allowed(settings, Effect::Interreflection)
}

/// Whether bounced light bends along an edge, on the side of the surface that the normal points to, which may be off its plane by `rounding` metres;
/// `gatherer` takes a quick look at direct light.
pub(crate) fn fades(gatherer: &Gatherer<'_>, [a, b]: [Vec3; 2], side: (Vec3, f32), worker: &mut Worker) -> bool {
    fades_from(gatherer, [a, b], side, worker) || fades_from(gatherer, [b, a], side, worker)
}

fn fades_from(
    gatherer: &Gatherer<'_>,
    [foot, end]: [Vec3; 2],
    (normal, rounding): (Vec3, f32),
    worker: &mut Worker,
) -> bool {
    let (world, way) = (gatherer.world, end - foot);
    let look = |[along, before]: [f32; 2], t_max: f32| {
        let start = world.start(foot + along * way, normal, rounding);
        let direction = foot + before * way.length() * normal - start;
        world.closest(&Ray { t_max, ..Ray::new(start, direction) })
    };
    let Some(near) = look(LOOKS[0], REACH) else { return false };
    let far = look(LOOKS[1], f32::INFINITY);
    if far.is_some_and(|far| far.triangle == near.triangle) {
        return false;
    }
    differ(gatherer, [Some(near), far], DIFFERENT, worker)
}

/// Whether what two surfaces send on of light of the sky, where rays met them, differs by more than `least` of an open receiver's light.
pub(crate) fn differ(gatherer: &Gatherer<'_>, hits: [Option<Hit>; 2], least: f32, worker: &mut Worker) -> bool {
    let [a, b] = hits.map(|hit| hit.map(|hit| Sent::by(gatherer, &hit, worker)).unwrap_or_default());
    a.distance(&b) > least * gatherer.bank.open_norm as f32
}

/// What surfaces send to a receiver of the light that falls on them straight, `[channel of 3][coefficient]`.
pub(crate) fn sent_to(gatherer: &Gatherer<'_>, at: &Receiver, worker: &mut Worker) -> Vec<f32> {
    let (seen, step) = gatherer.direct(at, 0, worker);
    let mut all = vec![0.0; 3 * seen.transfer.len()];
    if seen.openness >= 1.0 {
        return all;
    }
    for (_, hit, weight) in gatherer.blockers(0, step, seen.openness, worker).found {
        let sent = Sent::by(gatherer, &hit, worker);
        for (channel, sum) in all.chunks_mut(seen.transfer.len()).enumerate() {
            sum.iter_mut().zip(&sent.transfer).for_each(|(sum, x)| *sum += weight * sent.share[channel] * x);
        }
    }
    all
}

/// What a surface sends on of the light that falls on it straight, from the side where a ray met it.
#[derive(Default)]
struct Sent {
    share: Vec3,
    transfer: Vec<f32>,
}

impl Sent {
    fn by(gatherer: &Gatherer<'_>, hit: &Hit, worker: &mut Worker) -> Self {
        if gatherer.world.bodies.is_inside(hit) {
            return Self::default();
        }
        let point = NearPoint { triangle: hit.triangle, front: hit.front, barycentrics: [hit.u, hit.v] };
        // The same directions everywhere, as for bends.
        let (seen, _) = gatherer.direct(&gatherer.world.receiver_at(&point), 0, worker);
        Self { share: gatherer.world.sent(hit), transfer: seen.transfer }
    }

    /// Norm of the difference, in the channel where it is largest.
    fn distance(&self, other: &Self) -> f32 {
        let square = |channel: usize| {
            let scaled = |sent: &Self, k: usize| sent.transfer.get(k).map_or(0.0, |x| sent.share[channel] * x);
            let count = self.transfer.len().max(other.transfer.len());
            (0..count).map(|k| (scaled(self, k) - scaled(other, k)).powi(2)).sum::<f32>()
        };
        [0, 1, 2].map(square).into_iter().fold(0.0, f32::max).sqrt()
    }
}
