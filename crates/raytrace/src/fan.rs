//! Many rays from one point: packets of neighbours in the list.

use crate::closest_fan::ClosestFan;
use crate::group::{Directions, Group};
use crate::lanes::{Lanes, Path, Portable};
use crate::level::{Job, dispatch};
use crate::packet::{Packet, WIDEST};
use crate::ray::{Hit, LARGEST, Line};
use crate::scratch::Scratch;
use crate::screen::{Screen, alone};
use crate::sight::Occluders;
use crate::tracer::Tracer;
use crate::tree::{Child, Tree};
use crate::walk::{Solid, Walker};
use glam::Vec3;

/// What a thread keeps between fans. It changes how fast answers come, never what they are.
#[derive(Debug)]
pub struct FanState {
    pub(crate) scratch: Scratch,
    pub(crate) group: Group,
}

impl FanState {
    /// An empty state.
    pub fn new() -> FanState {
        FanState { scratch: Scratch::new(), group: Group::new() }
    }

    /// Nodes that all fans so far opened, and blocks that they looked at: what their answers cost, without a clock.
    pub fn steps(&self) -> usize {
        self.scratch.sights.looks + self.scratch.sights.under.visits
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
        if !self.sees(origin) {
            return;
        }
        let directions = Directions { origin, each: [xs, ys, zs] };
        state.scratch.start(self, &directions);
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
        if !self.sees(origin) {
            return;
        }
        let directions = Directions { origin, each: [xs, ys, zs] };
        state.scratch.start(self, &directions);
        dispatch(self.level, ClosestFan { tree: &self.tree, directions, wanted, solid, state, hits });
    }

    /// Whether there is anything to hit, and a point to look from.
    fn sees(&self, origin: Vec3) -> bool {
        !self.tree.nodes.is_empty() && origin.is_finite() && origin.abs().max_element() <= 2.0 * LARGEST
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
        for first in (0..directions.len()).step_by(P::Rays::N) {
            group.fill::<P::Rays>(&directions, first);
            let stopped = match Packet::<P::Rays>::of(tree, directions.origin, &group.directions) {
                Some(packet) => {
                    let cell = Occluders::cell(packet.octant, group.middle::<P::Rays>());
                    Screen { tree, packet, solid, cell }.blocked::<P>(group.alive, scratch)
                }
                None => strangers(tree, &directions, group, solid, scratch),
            };
            group.mark(stopped, blocked);
        }
    }
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
