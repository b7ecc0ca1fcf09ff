//! The nearest hits of many rays from one point: those that are wanted, in full packets.

use crate::fan::FanState;
use crate::group::{Directions, Group};
use crate::lanes::{Path, Portable};
use crate::level::Job;
use crate::nearest::nearest;
use crate::packet::Packet;
use crate::ray::{Hit, Line};
use crate::search::Search;
use crate::sight::Occluders;
use crate::tree::Tree;
use crate::walk::{Solid, Walker};

/// [`crate::Tracer::closest_fan`] at one level.
pub(crate) struct ClosestFan<'a> {
    pub(crate) tree: &'a Tree,
    pub(crate) directions: Directions<'a>,
    pub(crate) wanted: &'a [u64],
    pub(crate) solid: Solid<'a>,
    pub(crate) state: &'a mut FanState,
    pub(crate) hits: &'a mut [Option<Hit>],
}

impl Job for ClosestFan<'_> {
    type Output = ();

    #[inline(always)]
    fn run<P: Path>(self) {
        let ClosestFan { tree, directions, wanted, solid, state, hits } = self;
        let FanState { scratch, group } = state;
        let mut places = (0..hits.len()).filter(|i| wanted[i / 64] >> (i % 64) & 1 == 1);
        loop {
            group.gather::<P::Rays>(&directions, &mut places);
            if group.alive == 0 {
                return;
            }
            let Some(packet) = Packet::<P::Rays>::of(tree, directions.origin, &group.directions) else {
                strangers(tree, &directions, group, solid, &mut scratch.stack, hits);
                continue;
            };
            let cell = Occluders::cell(packet.octant, group.middle::<P::Rays>());
            let search = Search { tree, packet, solid, cell };
            search.run::<P>(group.alive, scratch);
            search.hand_over(group, scratch, hits);
        }
    }
}

/// Rays that no packet takes: one by one.
#[cold]
#[inline(never)]
fn strangers(
    tree: &Tree,
    directions: &Directions<'_>,
    group: &Group,
    solid: Solid<'_>,
    stack: &mut Vec<u32>,
    hits: &mut [Option<Hit>],
) {
    for &place in &group.members[..group.alive.count_ones() as usize] {
        if let Some(line) = Line::new(&directions.ray(place)) {
            hits[place] = nearest::<Portable>(tree, &Walker::new(tree, line), stack, solid);
        }
    }
}
