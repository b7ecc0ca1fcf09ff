//! Many rays from one point: packets of neighbours in the list.

use crate::group::{Directions, Group};
use crate::lanes::{Lanes, Path, Portable};
use crate::level::{Job, dispatch};
use crate::nearest::{Best, nearest};
use crate::packet::{Many, Packet, Scratch, WIDEST, Walk, alone};
use crate::ray::{Hit, LARGEST, Line};
use crate::sight::{Occluders, PER_CELL};
use crate::tracer::Tracer;
use crate::tree::{Child, Tree};
use crate::walk::{Apart, Solid, Walker};
use glam::Vec3;

/// Directions with a component below this go alone: its reciprocal is too large.
const STEEPEST: f32 = 1.0e-18;

/// Components of a unit direction, and sums of three of them, stay below these.
const LARGEST_UNIT: f32 = 1.001;
const LONGEST: f32 = 1.74;

/// What a thread keeps between fans. It changes how fast answers come, never what they are.
#[derive(Debug)]
pub struct FanState {
    scratch: Scratch,
    group: Group,
}

impl FanState {
    /// An empty state.
    pub fn new() -> FanState {
        FanState { scratch: Scratch::new(), group: Group::new() }
    }
}

impl Default for FanState {
    fn default() -> FanState {
        FanState::new()
    }
}

impl Tracer {
    /// Whether anything lies on each of many endless rays from one point: bit `i % 64` of `blocked[i / 64]` for the
    /// unit direction `(xs[i], ys[i], zs[i])`; further bits are cleared. `solid` as for [`Tracer::closest`].
    ///
    /// Fast where neighbours in the list point in similar directions.
    ///
    /// # Panics
    /// If the slices differ in length or `blocked` is too short.
    #[expect(clippy::too_many_arguments, reason = "a structure of arrays has its arrays as arguments")]
    pub fn occluded_fan(
        &self,
        origin: Vec3,
        xs: &[f32],
        ys: &[f32],
        zs: &[f32],
        solid: &dyn Fn(u32, f32, f32) -> bool,
        state: &mut FanState,
        blocked: &mut [u64],
    ) {
        assert!(xs.len() == ys.len() && xs.len() == zs.len(), "one x, y and z for each direction");
        assert!(blocked.len() * 64 >= xs.len(), "one bit for each direction");
        blocked.fill(0);
        let sane = origin.is_finite() && origin.abs().max_element() <= 2.0 * LARGEST;
        if self.tree.nodes.is_empty() || !sane {
            return;
        }
        let directions = Directions { origin, each: [xs, ys, zs] };
        dispatch(self.level, OccludedFan { tree: &self.tree, directions, solid, state, blocked });
    }

    /// The nearest hits of the endless rays from one point whose bit in `wanted` is set: `hits[i]` for direction `i`,
    /// None where it is not wanted or meets nothing. `solid` as for [`Tracer::closest`].
    ///
    /// # Panics
    /// If the slices differ in length or `wanted` is too short.
    #[expect(clippy::too_many_arguments, reason = "a structure of arrays has its arrays as arguments")]
    pub fn closest_fan(
        &self,
        origin: Vec3,
        xs: &[f32],
        ys: &[f32],
        zs: &[f32],
        wanted: &[u64],
        solid: &dyn Fn(u32, f32, f32) -> bool,
        state: &mut FanState,
        hits: &mut [Option<Hit>],
    ) {
        assert!(xs.len() == ys.len() && xs.len() == zs.len(), "one x, y and z for each direction");
        assert!(hits.len() == xs.len(), "one hit for each direction");
        assert!(wanted.len() * 64 >= xs.len(), "one bit for each direction");
        hits.fill(None);
        if self.tree.nodes.is_empty() {
            return;
        }
        let directions = Directions { origin, each: [xs, ys, zs] };
        let scratch = &mut state.scratch;
        dispatch(self.level, ClosestFan { tree: &self.tree, directions, wanted, solid, scratch, hits });
    }
}

/// [`Tracer::closest_fan`] at one level.
struct ClosestFan<'a> {
    tree: &'a Tree,
    directions: Directions<'a>,
    wanted: &'a [u64],
    solid: Solid<'a>,
    scratch: &'a mut Scratch,
    hits: &'a mut [Option<Hit>],
}

impl Job for ClosestFan<'_> {
    type Output = ();

    #[inline(always)]
    fn run<P: Path>(self) {
        let ClosestFan { tree, directions, wanted, solid, scratch, hits } = self;
        scratch.start(tree, directions.origin);
        let Scratch { sights, occluders, stack, .. } = scratch;
        let asked = (0..hits.len()).filter(|i| wanted[i / 64] >> (i % 64) & 1 == 1);
        for i in asked {
            let Some(line) = Line::new(&directions.ray(i)) else {
                continue;
            };
            let walker = Walker::new(tree, line);
            // What blocked rays that went this way is a good first guess: nothing beyond it is visited.
            let cell = Occluders::cell(walker.octant, line.direction.to_array());
            let mut guess = Best::default();
            for index in 0..PER_CELL {
                if let Some((block, lane)) = occluders.get(cell, index) {
                    guess.improve::<P>(tree, block, 1 << lane, &line, solid, sights);
                }
            }
            let best = nearest::<P>(tree, &walker, guess, stack, solid, sights);
            hits[i] = best.hit;
            let (block, lane) = best.place;
            if best.hit.is_some() && tree.blocks[block].masked >> lane & 1 == 0 {
                occluders.keep(cell, block, lane);
            }
        }
    }
}

/// [`Tracer::occluded_fan`] at one level.
struct OccludedFan<'a> {
    tree: &'a Tree,
    directions: Directions<'a>,
    solid: Solid<'a>,
    state: &'a mut FanState,
    blocked: &'a mut [u64],
}

impl Job for OccludedFan<'_> {
    type Output = ();

    #[inline(always)]
    fn run<P: Path>(self) {
        let OccludedFan { tree, directions, solid, state, blocked } = self;
        let FanState { scratch, group } = state;
        scratch.start(tree, directions.origin);
        for first in (0..directions.len()).step_by(P::Rays::N) {
            group.fill::<P::Rays>(&directions, first);
            let stopped = match packet::<P::Rays>(tree, directions.origin, &group.directions) {
                Some(packet) => {
                    let cell = Occluders::cell(packet.octant, group.middle::<P::Rays>());
                    Walk { tree, packet, solid, cell }.blocked::<P>(group.alive, scratch)
                }
                None => strangers(tree, &directions, group, solid, scratch),
            };
            group.mark(stopped, blocked);
        }
    }
}

/// A packet of a group; None where a ray goes along an axis or is no unit direction.
#[inline(always)]
fn packet<'a, R: Lanes>(tree: &Tree, origin: Vec3, each: &'a [Many; 3]) -> Option<Packet<'a, R>> {
    let [x, y, z] = each;
    let direction = [R::load(x), R::load(y), R::load(z)];
    let least = Vec3::new(direction[0].lowest(), direction[1].lowest(), direction[2].lowest());
    let most = Vec3::new(direction[0].highest(), direction[1].highest(), direction[2].highest());
    let size = [direction[0].abs(), direction[1].abs(), direction[2].abs()];
    let (steepest, longest) = (size[0].min(size[1]).min(size[2]), size[0].add(size[1]).add(size[2]));
    // Both false where a component is not a number, so that the ranges hold.
    let usual = steepest.above(R::splat(STEEPEST)) & R::splat(LONGEST).above(longest);
    if usual != (1u32 << R::N) - 1 || least.abs().max(most.abs()).max_element() > LARGEST_UNIT {
        return None;
    }
    let one = R::splat(1.0);
    let inverse = [one.div(direction[0]), one.div(direction[1]), one.div(direction[2])];
    let mut inverse_each = [[0.0; WIDEST]; 3];
    for axis in 0..3 {
        inverse[axis].store(&mut inverse_each[axis]);
    }
    let (negative, positive) = (least.cmplt(Vec3::ZERO).bitmask(), most.cmpgt(Vec3::ZERO).bitmask());
    let mixed = (negative & positive) as usize;
    // Where all are of one sign the reciprocals of the bounds bound the reciprocals, rounding included.
    let (low, high) = (most.recip(), least.recip());
    Some(Packet {
        direction,
        inverse,
        each,
        inverse_each,
        octant: negative as usize & !mixed,
        mixed,
        apart: Apart::new(tree, origin),
        least,
        most,
        range: [(low.x, high.x), (low.y, high.y), (low.z, high.z)],
    })
}

/// Rays that no packet takes: one by one.
#[cold]
#[inline(never)]
fn strangers(tree: &Tree, directions: &Directions<'_>, group: &Group, solid: Solid<'_>, scratch: &mut Scratch) -> u32 {
    let mut stopped = 0;
    for i in (0..WIDEST).filter(|i| group.alive >> i & 1 == 1) {
        if let Some(line) = Line::new(&directions.ray(group.first + i)) {
            let walker = Walker::new(tree, line);
            stopped |= u32::from(alone::<Portable>(tree, &walker, Child::node(0), solid, 0, scratch)) << i;
        }
    }
    stopped
}
