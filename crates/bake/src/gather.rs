//! What one receiver sees: its direct transfer, and the surfaces that block its view.

mod blockers;
mod translucent;
mod worker;

pub(crate) use blockers::Blockers;
pub(crate) use worker::Worker;

use crate::directions::{DirectionBank, DirectionSet, Step};
use crate::domain::Domain;
use crate::dot::dot;
use crate::found::mean;
use crate::hit::{NearPoint, PackedHit, near_points, packed};
use crate::mirror::Mirrors;
use crate::receivers::Receiver;
use crate::repair::Finding;
use crate::world::World;
use coeff_io::Quality;
use glam::{Mat3, Vec3};
use raytrace::Hit;
use sampling::estimate::{Doubling, Verdict};
use sampling::frame::Frame;
use sh_math::{Bands, rotate::Rotation};

/// All that the gathering of any receiver needs.
pub(crate) struct Gatherer<'a> {
    pub(crate) world: &'a World<'a>,
    pub(crate) bank: &'a DirectionBank,
    pub(crate) bands: Bands,
    pub(crate) quality: Quality,
    /// Whether rays decide what is seen.
    pub(crate) visibility: bool,
    /// Whether the blocking surfaces are wanted for bounces.
    pub(crate) hits: bool,
    /// Receivers below this id go into the file: they get receivers at what they see very near, and the whole quality.
    pub(crate) permanent: u32,
    /// Share of a receiver's light from where a near surface is worth a receiver of its own.
    pub(crate) worth: f32,
    /// Surfaces that shine, where what they mirror counts.
    pub(crate) mirrors: Option<&'a Mirrors>,
}

/// What a receiver sees.
#[derive(Debug, Default)]
pub(crate) struct Gathered {
    /// Direct transfer in world axes.
    pub(crate) transfer: Vec<f32>,
    /// The same per channel, `[channel of 3][coefficient]`, where translucent surfaces tint what they pass; else empty.
    pub(crate) tinted: Vec<f32>,
    /// Cosine-weighted share of the hemisphere that is open.
    pub(crate) openness: f32,
    /// Estimated error of `transfer` against the norm of an open receiver.
    pub(crate) error: f32,
    /// Any-hit rays traced.
    pub(crate) visibility_rays: u64,
    /// Closest-hit rays traced.
    pub(crate) bounce_rays: u64,
    /// Share of the blocked directions that meet the inside of a body.
    pub(crate) inside_share: f32,
    /// Share of the blocked directions that meet the back of a surface with one side; see [`Blockers`].
    pub(crate) behind_share: f32,
    /// Blocking surfaces; their weights sum to `1 - openness`.
    pub(crate) hits: Vec<PackedHit>,
    /// Points of surfaces so near that their vertices cannot speak for them; some hits refer to these.
    pub(crate) near: Vec<NearPoint>,
    /// What surfaces that shine send of light that falls on them straight, `[channel of 3][coefficient]`; empty where there are none.
    pub(crate) glint: Vec<f32>,
    /// The same surfaces, with the share that they send on of light from other surfaces.
    pub(crate) late: Vec<PackedHit>,
}

impl<'a> Gatherer<'a> {
    /// For a look at what receivers see of the sky: no blockers are wanted, and none goes into the file.
    pub(crate) fn of_direct_light(
        world: &'a World<'a>,
        bank: &'a DirectionBank,
        bands: Bands,
        quality: Quality,
    ) -> Self {
        Self { world, bank, bands, quality, visibility: true, hits: false, permanent: 0, worth: 0.0, mirrors: None }
    }
}

impl Gathered {
    /// What this tells of where the receiver stands.
    pub(crate) fn finding(&self) -> Finding {
        let &Self { openness, inside_share, behind_share, .. } = self;
        Finding { openness, inside_share, behind_share }
    }
}

impl Gatherer<'_> {
    /// Gathers for one receiver: a pure function of the scene, the settings and the receiver's index.
    pub(crate) fn gather(&self, receiver: &Receiver, index: u32, worker: &mut Worker) -> Gathered {
        let (mut out, step) = self.direct(receiver, index, worker);
        if out.openness < 1.0 {
            let blockers = self.blockers(index, step, out.openness, worker);
            self.pack(blockers, index, &mut out);
        }
        out
    }

    /// Direct transfer alone, and the step of the direction set that it took; what blocks is not looked up.
    pub(crate) fn direct(&self, receiver: &Receiver, index: u32, worker: &mut Worker) -> (Gathered, usize) {
        // A point in space has no tangent plane that could spare it the rays.
        let in_space = matches!(self.bank.domain, Domain::Sphere(_));
        if !(self.visibility && (in_space || self.world.can_shadow(receiver))) {
            return (self.unshadowed(receiver), 0);
        }
        let origin = self.world.start_above(receiver);
        let (set, turn) = self.bank.pick(index);
        let world_from_local = turned_frame(receiver.normal, turn);
        let seen = self.trace_visibility(origin, set, &world_from_local, index, worker);
        let mut out = Gathered {
            transfer: seen.local.iter().map(|&x| x as f32).collect(),
            openness: seen.openness as f32,
            error: seen.error as f32,
            visibility_rays: seen.rays,
            ..Gathered::default()
        };
        let rotation = Rotation::from_matrix(self.bands, world_from_local.as_dmat3());
        rotation.apply(&mut out.transfer);
        if self.world.tints() {
            out.tinted = self.tinted(set, seen.step, &rotation, worker);
        }
        (out, seen.step)
    }

    /// Receivers whose results may wait together to be handed on: they take about 256 MiB at most.
    pub(crate) fn receivers_per_block(&self) -> usize {
        let hits = match self.quality {
            _ if !self.hits => 0,
            Quality::Rays(n) => n as usize,
            Quality::Error(_) => MAX_BLOCKERS,
        };
        let hits = if self.world.translucent.is_some() { hits * CROSSED } else { hits };
        let bytes = hits * size_of::<PackedHit>() + self.bands.coefficients() * size_of::<f32>() + 256;
        ((256 << 20) / bytes).max(1)
    }

    /// Closed form, for diffuse receivers \[G\] eq. (22): nothing can stand in the way.
    fn unshadowed(&self, receiver: &Receiver) -> Gathered {
        Gathered {
            transfer: self.bank.domain.open_about(self.bands, receiver.normal),
            openness: 1.0,
            ..Gathered::default()
        }
    }

    /// Doubles the rays until the estimate meets the error asked for, or the set is spent.
    fn trace_visibility(
        &self,
        origin: Vec3,
        set: &DirectionSet,
        frame: &Mat3,
        index: u32,
        worker: &mut Worker,
    ) -> Seen {
        let rule = self.rule(index, set);
        worker.origin = origin;
        worker.directions.iter_mut().for_each(Vec::clear);
        worker.blocked.clear();
        worker.open.clear();
        worker.tints.iter_mut().for_each(Vec::clear);
        let mut progress = rule.start();
        let mut sums = vec![0.0f64; self.bands.coefficients()];
        let (mut open_weight, mut start) = (0.0, 0);
        let mut seen = Seen { local: Vec::new(), openness: 1.0, error: 0.0, step: 0, rays: 0 };
        for (number, step) in set.steps.iter().enumerate() {
            rotate_directions(set, frame, step.end, &mut worker.directions);
            let turn = self.bank.part(index, number);
            worker.choice.choose(&set.surroundings, start..step.end, turn, &mut worker.blocked);
            seen.rays += self.trace_step(origin, start..step.end, worker);
            let open = &worker.open[start..];
            add_open(set, number, open, &mut sums);
            open_weight += dot(&set.weights[start..step.end], open);
            start = step.end;
            seen.step = number;
            seen.openness = open_weight / step.weight;
            seen.local = self.corrected(&sums, seen.openness, step);
            let darkest = self.darkest(set, number, worker);
            let judged = self.bank.domain.judged(darkest.as_ref().unwrap_or(&seen.local));
            match rule.look(&mut progress, step.end as u32, &judged) {
                Verdict::Continue { .. } => {}
                // Too few rays to tell so small an error, whatever they met.
                Verdict::Reached { .. }
                    if self.resolution(seen.rays) > rule.tolerance && start < rule.last as usize => {}
                Verdict::Reached { error } | Verdict::Exhausted { error } => {
                    seen.error = if error.is_finite() {
                        error.max(self.resolution(seen.rays)) / self.bank.open_norm
                    } else {
                        0.0
                    };
                    break;
                }
            }
        }
        seen
    }

    /// The stopping rule in the unit of the coefficients. What only lends light to others, through many rays each, may err
    /// by twice as much.
    fn rule(&self, index: u32, set: &DirectionSet) -> Doubling {
        let slack = if index < self.permanent { 1.0 } else { 2.0 };
        let tolerance = match self.quality {
            Quality::Error(asked) => slack * f64::from(asked) * self.bank.open_norm,
            Quality::Rays(_) => 0.0,
        };
        let last = set.steps.last().map_or(0, |step| step.end as u32);
        Doubling { first: 0, last, tolerance, confirmation: 2.0, memory: REMEMBERED }
    }

    /// Half of what a single ray would change if all counted the same: no estimate is below it, since where all rays of two looks
    /// met the same the change is zero, however many more it would take to find the gap.
    fn resolution(&self, rays: u64) -> f64 {
        0.5 * self.bank.domain.norm_of_direction(self.bands) / rays as f64
    }

    /// Adds to the sum over open directions what the sequence misses of the exact cosine lobe, in proportion to
    /// the share that is open: exact where nothing is blocked, and the constant term is exactly the open share.
    fn corrected(&self, sums: &[f64], openness: f64, step: &Step) -> Vec<f64> {
        let terms = sums.iter().zip(&step.full).zip(&self.bank.open);
        terms.map(|((sum, full), open)| sum / step.samples + openness * (open - full / step.samples)).collect()
    }

    /// Traces the rays chosen of the step of directions `range`; returns their number.
    fn trace_step(&self, origin: Vec3, range: std::ops::Range<usize>, worker: &mut Worker) -> u64 {
        let Worker { fan, directions, traced, met, choice, blocked, open, passed, tints, crossings, .. } = worker;
        let rays = choice.traced.len();
        met.clear();
        met.resize(rays.div_ceil(64), 0);
        let [xs, ys, zs] = if rays == range.len() {
            directions.each_ref().map(|axis| &axis[range.clone()])
        } else {
            for (out, all) in traced.iter_mut().zip(directions) {
                out.clear();
                out.extend(choice.traced.iter().map(|&j| all[j as usize]));
            }
            traced.each_ref().map(|axis| &axis[..])
        };
        let solid = |triangle, u, v| self.world.solid(triangle, u, v);
        self.world.tracer.occluded_fan(origin, xs, ys, zs, &solid, fan, met);
        let mut means = Vec::new();
        if let Some(layer) = &self.world.translucent {
            self.pass(layer, (origin, [xs, ys, zs]), met, crossings, passed);
            means.extend(passed.iter().map(|&share| if layer.tints { mean(share) } else { share.x }));
            for (c, open) in tints.iter_mut().enumerate().filter(|_| layer.tints) {
                choice.settle_channel(range.start, met, |k| passed[k][c], blocked, open);
            }
        }
        choice.settle(range.start, met, &means, blocked, open);
        rays as u64
    }

    /// Finds the nearest surface along blocked ones of the first `end` directions: \[G\] eq. (11) gathers over these only. Returns
    /// the number of rays.
    fn trace_blockers(&self, origin: Vec3, end: usize, index: u32, worker: &mut Worker) -> u64 {
        let rays = self.choose(end, index, worker);
        worker.nearest.clear();
        worker.nearest.resize(end, None);
        let [xs, ys, zs] = &worker.directions;
        let solid = |triangle, u, v| self.world.solid(triangle, u, v);
        let tracer = &self.world.tracer;
        tracer.closest_fan(origin, xs, ys, zs, &worker.wanted, &solid, &mut worker.fan, &mut worker.nearest);
        rays
    }

    /// Picks the blocked directions whose blockers are looked up: all of them, or an even part where there are very many or only
    /// a probe is wanted. Returns their number.
    fn choose(&self, end: usize, index: u32, worker: &mut Worker) -> u64 {
        let wanted = match self.quality {
            _ if !self.hits => PROBES,
            Quality::Rays(_) => end,
            Quality::Error(_) if index < self.permanent => MAX_BLOCKERS,
            Quality::Error(_) => HELPER_BLOCKERS,
        };
        let blocked = worker.blocked.iter().filter(|&&state| state != 0).count();
        worker.wanted.clear();
        worker.wanted.resize(end.div_ceil(64), 0);
        let chosen = blocked.min(wanted);
        let all_blocked = (0..end).filter(|&j| worker.blocked[j] != 0);
        for (before, j) in all_blocked.enumerate() {
            // The k-th of the chosen is the first that reaches k / chosen of all blocked.
            if (before + 1) * chosen / blocked > before * chosen / blocked {
                worker.wanted[j / 64] |= 1 << (j % 64);
            }
        }
        chosen as u64
    }

    /// What blocks the directions that were found blocked up to a step of the set, after [`Gatherer::direct`] of the same receiver.
    pub(crate) fn blockers(&self, index: u32, step: usize, openness: f32, worker: &mut Worker) -> Blockers {
        let origin = worker.origin;
        let (set, _) = self.bank.pick(index);
        let rays = self.trace_blockers(origin, set.steps[step].end, index, worker);
        if let Some(layer) = &self.world.translucent {
            let blockers = self.blockers_through(layer, origin, &set.weights, openness, worker);
            return Blockers { rays, ..blockers };
        }
        let hits = || worker.nearest.iter().enumerate().filter_map(|(j, hit)| hit.as_ref().map(|hit| (j, hit)));
        // A direction that was foreseen to be open and is not stands for its like that were not tried.
        let weight = |j: usize| f64::from(set.weights[j]) * f64::from(1.0 - worker.open[j]);
        let (mut total, mut inside, mut backs, mut whole_backs) = (0.0, 0.0, 0.0, 0.0);
        for (j, hit) in hits() {
            let weight = weight(j);
            total += weight;
            if hit.front {
                continue;
            }
            inside += if self.world.bodies.is_inside(hit) { weight } else { 0.0 };
            if !self.world.is_two_sided(hit.triangle) {
                backs += weight;
                whole_backs += if self.world.has_holes(hit.triangle) { 0.0 } else { weight };
            }
        }
        if total <= 0.0 {
            return Blockers { rays, ..Blockers::default() };
        }
        let scale = (1.0 - f64::from(openness)) / total;
        let [xs, ys, zs] = &worker.directions;
        let direction = |j: usize| Vec3::new(xs[j], ys[j], zs[j]);
        let mut found = Vec::with_capacity(rays as usize);
        found.extend(hits().map(|(j, hit)| (direction(j), *hit, (weight(j) * scale) as f32)));
        let shares = [inside, f64::min(backs + whole_backs, total)];
        let [inside_share, behind_share] = shares.map(|sum| (sum / total) as f32);
        Blockers { rays, inside_share, behind_share, found, filters: Vec::new() }
    }

    fn pack(&self, blockers: Blockers, index: u32, out: &mut Gathered) {
        out.bounce_rays = blockers.rays;
        (out.inside_share, out.behind_share) = (blockers.inside_share, blockers.behind_share);
        if !self.hits || blockers.found.is_empty() {
            return;
        }
        let found = blockers.found;
        let mut weighed: Vec<(Hit, Vec3)> =
            found.iter().map(|(_, hit, weight)| (*hit, self.world.sent(hit) * *weight)).collect();
        weighed.iter_mut().zip(&blockers.filters).for_each(|((_, reflected), filter)| *reflected *= *filter);
        if index < self.permanent && !out.finding().is_covered() {
            out.near = near_points(self.world, &weighed, self.worth);
        }
        out.hits.extend(weighed.iter().map(|(hit, reflected)| packed(self.world, hit, *reflected, &out.near)));
        if let Some(mirrors) = self.mirrors {
            mirrors.add_mirrored(self.world, (&found, &blockers.filters), out);
        }
    }
}

/// Blockers looked up only to tell whether a receiver is inside a body.
const PROBES: usize = 32;
/// Most blockers looked up for bounces.
const MAX_BLOCKERS: usize = 1024;
/// The same for receivers that only lend light to others: many together make up what one of those sees.
const HELPER_BLOCKERS: usize = 256;

/// Translucent surfaces that a ray is taken to cross where memory is set aside.
const CROSSED: usize = 8;

/// Changes of the estimate that count for its error. More would lean on how errors fell when the directions were few.
const REMEMBERED: usize = 4;

/// What the any-hit rays found, in the local frame.
struct Seen {
    local: Vec<f64>,
    openness: f64,
    error: f64,
    step: usize,
    rays: u64,
}

/// Columns: tangent, bitangent, normal; turned about the normal.
fn turned_frame(normal: Vec3, [cos, sin]: [f32; 2]) -> Mat3 {
    let frame = Frame::from_normal(normal);
    let (x, y) = (frame.to_world(Vec3::X), frame.to_world(Vec3::Y));
    Mat3::from_cols(cos * x + sin * y, cos * y - sin * x, normal)
}

/// Appends world directions up to `end` to those that are there.
fn rotate_directions(set: &DirectionSet, frame: &Mat3, end: usize, world: &mut [Vec<f32>; 3]) {
    for (axis, out) in world.iter_mut().enumerate() {
        let start = out.len();
        let (a, b, c) = (frame.x_axis[axis], frame.y_axis[axis], frame.z_axis[axis]);
        let local = set.xs[start..end].iter().zip(&set.ys[start..end]).zip(&set.zs[start..end]);
        out.extend(local.map(|((x, y), z)| a * x + b * y + c * z));
    }
}

/// Adds the basis of the open directions of a step to the sums.
fn add_open(set: &DirectionSet, step: usize, open: &[f32], sums: &mut [f64]) {
    for (sum, basis) in sums.iter_mut().zip(set.basis(step)) {
        *sum += dot(basis, open);
    }
}
