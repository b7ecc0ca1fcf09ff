//! Cuts edges that come out from under a surface which lies close over them: a sheet of paper on a table, a lamp a hair below its ceiling.
//!
//! Light changes there within a few gaps' widths of the rim, far less than an edge is long. A vertex just beyond keeps the light under the
//! cover, or the shade at its rim, from being drawn out along the edge.

use crate::Error;
use crate::cuts::Cuts;
use crate::gather::{Gatherer, Worker};
use crate::ledge;
use crate::passes::Monitor;
use crate::quick_look::QuickLook;
use crate::receivers::{FaceSums, Receiver};
use crate::split::{Edge, edges, length, sorted};
use crate::world::World;
use coeff_io::Settings;
use glam::Vec3;
use rayon::prelude::*;
use raytrace::{Hit, Ray};
use scene::{Mesh, Scene};
use std::borrow::Cow;
use std::collections::BTreeMap;

/// Widest gap under a cover, over the edge: below wider ones light changes within lengths that halving reaches.
const WIDEST: f32 = 1.0 / 8.0;
/// Least cosine between the normals of a surface and its cover: walls are none.
const LEVEL: f32 = 0.7;
/// Halvings by which the end of a cover is found.
const STEPS: usize = 10;
/// Error of interpolation of light of the sky from where an edge is cut, against an open receiver's light.
const BEND: f32 = 0.15;
/// Difference of what a cover and the surface beyond it send on, from where an edge is cut.
const SENT: f32 = 0.05;

/// The scene with its edges that are longer than `shortest` cut beside the rims of close covers where that matters; `world` holds the same
/// surfaces.
pub(crate) fn cut_at_contacts<'a>(
    mut scene: Cow<'a, Scene>,
    world: &World<'_>,
    (settings, shortest): (&Settings, f32),
    monitor: &Monitor<'_>,
) -> Result<Cow<'a, Scene>, Error> {
    let look = QuickLook::new();
    let gatherer = look.gatherer(world);
    let bounces = ledge::matters(settings);
    let mut cuts = Cuts::default();
    for mesh in &scene.meshes {
        let two_sided = scene.materials[mesh.material as usize].double_sided;
        let ways = ways(mesh, shortest, two_sided);
        let one = |worker: &mut Worker, (_, ends): &(Edge, [Receiver; 2])| {
            if monitor.is_cancelled() {
                return None;
            }
            Way::new(world, ends)?.cut(&gatherer, bounces, worker)
        };
        let found: Vec<Option<f32>> = ways.par_iter().map_init(Worker::new, one).collect();
        monitor.check()?;
        let found = ways.iter().zip(found).filter_map(|((edge, _), share)| Some((*edge, share?)));
        found.for_each(|(edge, share)| cuts.add(mesh, edge, share));
    }
    if !cuts.is_empty() {
        cuts.apply(scene.to_mut());
    }
    Ok(scene)
}

/// The edges of a mesh that are longer than `shortest`, from either end and on each side that is drawn, with their ends as receivers. These have
/// the normal of the triangles at the edge: that of a vertex in a crease leans over to the other face.
fn ways(mesh: &Mesh, shortest: f32, two_sided: bool) -> Vec<(Edge, [Receiver; 2])> {
    let faces = FaceSums::of(mesh);
    let mut normals: BTreeMap<Edge, Vec3> = BTreeMap::new();
    for triangle in &mesh.triangles {
        let [a, b, c] = triangle.map(|v| mesh.positions[v as usize]);
        for edge in edges(triangle).map(sorted).into_iter().filter(|edge| length(mesh, *edge) > shortest) {
            *normals.entry(edge).or_default() += (b - a).cross(c - a);
        }
    }
    let mut ways = Vec::new();
    for ([a, b], sum) in normals {
        let Some(normal) = sum.try_normalize() else { continue };
        for edge in [[a, b], [b, a]] {
            let front = |v: u32| Receiver { normal, geometric_normal: normal, ..faces.receiver(mesh, v as usize) };
            let front = edge.map(front);
            ways.push((edge, front));
            if two_sided {
                ways.push((edge, front.map(|end| end.back())));
            }
        }
    }
    ways
}

/// The way along an edge from an end under a cover, or within the width of the gap from its rim.
struct Way<'a> {
    world: &'a World<'a>,
    ends: &'a [Receiver; 2],
    /// Metres.
    length: f32,
    /// Where the cover is met from the first end.
    cover: Hit,
}

impl<'a> Way<'a> {
    /// None where the first end has no cover, or the last has one.
    fn new(world: &'a World<'a>, ends: &'a [Receiver; 2]) -> Option<Self> {
        let length = ends[0].position.distance(ends[1].position);
        let is_covered = |share: f32| cover(world, ends, length, share);
        let cover = is_covered(0.0)?;
        is_covered(1.0).is_none().then_some(Self { world, ends, length, cover })
    }

    /// Share of the way at which light is again what it is without the cover, if the edge is worth a cut there.
    fn cut(&self, gatherer: &Gatherer<'_>, bounces: bool, worker: &mut Worker) -> Option<f32> {
        let (mut within, mut beyond, mut gap) = (0.0, 1.0, self.cover.t);
        for _ in 0..STEPS {
            let middle = 0.5 * (within + beyond);
            match cover(self.world, self.ends, self.length, middle) {
                Some(hit) => (within, gap) = (middle, hit.t),
                None => beyond = middle,
            }
        }
        // At three times the gap from the rim 3 % of a sheet's shadow are left; the cover ends once the gap beyond it.
        let share = beyond + 2.0 * gap / self.length;
        let is_far = 2.0 * (share - beyond) < 1.0 - share;
        (is_far && self.is_bent(gatherer, share, bounces, worker)).then_some(share)
    }

    /// Whether light at a share of the way is not what lies between that of its ends; ends inside bodies take theirs from elsewhere.
    fn is_bent(&self, gatherer: &Gatherer<'_>, share: f32, bounces: bool, worker: &mut Worker) -> bool {
        let [a, b] = self.ends;
        if self.world.surrounds(a) || self.world.surrounds(b) {
            return false;
        }
        let mut sky = |one: &Receiver| gatherer.direct(one, 0, worker).0.transfer;
        let looks = [a, b, &a.towards(b, share)].map(&mut sky);
        let between = |k: usize| (1.0 - share) * looks[0][k] + share * looks[1][k];
        let bend: f32 = looks[2].iter().enumerate().map(|(k, at)| (at - between(k)).powi(2)).sum();
        if bend.sqrt() > BEND * gatherer.bank.open_norm as f32 {
            return true;
        }
        let above = |one: &Receiver| self.world.closest(&Ray::new(self.world.start_above(one), one.geometric_normal));
        bounces && ledge::differ(gatherer, [Some(self.cover), above(b)], SENT, worker)
    }
}

/// Where a ray meets the cover of a share of the way between two receivers at this distance: halfway between upwards and back along the way.
fn cover(world: &World<'_>, [from, to]: &[Receiver; 2], length: f32, share: f32) -> Option<Hit> {
    let at = from.towards(to, share);
    let normal = at.geometric_normal;
    let direction = normal - (to.position - from.position) / length;
    let hit = world.closest(&Ray { t_max: WIDEST * length, ..Ray::new(world.start_above(&at), direction) })?;
    let [a, b, c] = world.points(hit.triangle);
    let level = (b - a).cross(c - a).normalize_or_zero().dot(normal).abs();
    (level > LEVEL).then_some(hit)
}
