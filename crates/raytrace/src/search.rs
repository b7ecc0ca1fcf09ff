//! A packet through the tree to the nearest hit of each of its rays; the last few that look on go on alone.

use crate::block::{candidates, candidates_between};
use crate::found::{Found, Place};
use crate::group::Group;
use crate::lanes::{Lanes, Path};
use crate::nearest::{pop, push};
use crate::packet::{Boxes, Packet, Planes};
use crate::ray::{Hit, Line};
use crate::scratch::{Scratch, Visit};
use crate::sight::{PER_CELL, Plane3, Sights};
use crate::tree::{BLOCK, Child, Node, Tree};
use crate::walk::{LATER, PERMUTED, Solid};

/// Packets of which at most this many rays look on are walked ray by ray.
const ALONE: u32 = 2;

/// Everything a packet's search refers to.
pub(crate) struct Search<'a, R> {
    pub(crate) tree: &'a Tree,
    pub(crate) packet: Packet<'a, R>,
    pub(crate) solid: Solid<'a>,
    /// Where its occluders are remembered.
    pub(crate) cell: usize,
}

impl<R: Lanes> Search<'_, R> {
    /// Finds the nearest hits of the rays in `alive` and leaves them in `scratch.found`.
    #[inline(always)]
    pub(crate) fn run<P: Path<Rays = R>>(&self, alive: u32, scratch: &mut Scratch) {
        let Scratch { found, sights, occluders, waiting, stack, .. } = scratch;
        found.start(alive.count_ones() as usize);
        // What blocked rays that went this way is a good first guess: nothing beyond it is visited.
        for index in 0..PER_CELL {
            if let Some((block, lane)) = occluders.get(self.cell, index) {
                self.try_block::<P>(block, 1 << lane, alive, found, sights);
            }
        }
        waiting.clear();
        let mut visit = Visit { rays: alive, child: Child::node(0).bits(), near: 0.0 };
        loop {
            let child = Child::from_bits(visit.child);
            // What nearer hits have overtaken since is passed over.
            let late = R::splat(visit.near).above(found.all_far::<R>().mul(R::splat(LATER)));
            let rays = visit.rays & !late;
            if rays.count_ones() <= ALONE {
                self.one_by_one::<P>(child, rays, found, sights, stack);
            } else if let Some(index) = child.as_block() {
                self.try_block::<P>(index, u32::MAX, rays, found, sights);
            } else if !sights.under.holds(self.tree, child.index()) {
                self.descend::<P>(&self.tree.nodes[child.index()], rays, found, waiting);
            }
            let Some(next) = waiting.pop() else {
                break;
            };
            visit = next;
        }
    }

    /// Writes the hits to where the rays stand in the list, and remembers the triangles.
    #[inline(always)]
    pub(crate) fn hand_over(&self, group: &Group, scratch: &mut Scratch, hits: &mut [Option<Hit>]) {
        let Scratch { found, meetings, sights, occluders, .. } = scratch;
        let n = group.alive.count_ones() as usize;
        let origin = sights.origin;
        found.settle_all(self.tree, origin, &group.directions, n, meetings);
        let mut last = None;
        for ray in 0..n {
            let hit = found.settle(ray, &self.packet.line(ray, origin), self.tree);
            let place = found.place(ray);
            hits[group.members[ray]] = hit;
            let known = hit.is_none() || last == Some(place);
            if !known && self.tree.blocks[place.block as usize].masked >> place.lane & 1 == 0 {
                occluders.keep(self.cell, place.block as usize, place.lane as usize);
                last = Some(place);
            }
        }
    }

    /// Offers the triangles of a block, those of a mask, to the rays of another.
    #[inline(always)]
    fn try_block<P: Path<Rays = R>>(
        &self,
        index: usize,
        lanes: u32,
        rays: u32,
        found: &mut Found,
        sights: &mut Sights,
    ) {
        let block = &self.tree.blocks[index];
        let origin = sights.origin;
        let seen = sights.view::<P::Four>(self.tree, index);
        let between = candidates_between::<P::Four>(seen, self.packet.least, self.packet.most);
        let mut lanes = lanes & between;
        if lanes == 0 {
            return;
        }
        let (seen, depths) = sights.view_in_depth::<P::Four>(self.tree, index);
        while lanes != 0 {
            let lane = lanes.trailing_zeros() as usize;
            lanes &= lanes - 1;
            let (maybe, sure) = self.packet.meets(&Plane3::of(seen, lane));
            if maybe & rays == 0 {
                continue;
            }
            let sure = if block.masked >> lane & 1 == 1 { 0 } else { sure };
            let place = Place::new(self.tree, index, lane);
            let depth = depths.one::<R>(lane);
            let mut doubt = found.offer(place, (maybe & rays, sure), &depth, self.packet.direction);
            while doubt != 0 {
                let ray = doubt.trailing_zeros() as usize;
                doubt &= doubt - 1;
                found.decide(ray, place, &self.packet.line(ray, origin), self.tree, self.solid);
            }
        }
        found.tighten::<R>();
    }

    /// Puts the children that any ray of a mask meets on the stack, the farthest first.
    #[inline(always)]
    fn descend<P: Path>(&self, node: &Node, rays: u32, found: &Found, waiting: &mut Vec<Visit>) {
        let boxes = Boxes::<P::Eight>::of(node, &self.packet, found.reach);
        // Empty boxes pass where an axis tells nothing, and so would all boxes.
        let (some, all) = boxes.met();
        let (some, all) = (some & node.present, if self.packet.mixed == 0 { all } else { 0 });
        let mut planes = Planes::default();
        if some & !all != 0 {
            boxes.store(&mut planes);
        }
        let nears = boxes.nears();
        let far = found.all_far::<R>();
        let mut order = PERMUTED[self.packet.octant][some as usize];
        while order != 0 {
            let last = 7 - order.leading_zeros() as usize;
            order &= !(1 << last);
            let slot = last ^ self.packet.octant;
            let rays = if all >> slot & 1 == 1 { rays } else { self.packet.meets_box(&planes, slot, far) & rays };
            if rays != 0 {
                self.tree.fetch::<P>(node.children[slot]);
                waiting.push(Visit { rays, child: node.children[slot].bits(), near: nears[slot] });
            }
        }
    }

    /// Walks the rays of a mask one by one from a child on down.
    #[inline(always)]
    fn one_by_one<P: Path<Rays = R>>(
        &self,
        from: Child,
        mut rays: u32,
        found: &mut Found,
        sights: &mut Sights,
        stack: &mut Vec<u32>,
    ) {
        if rays == 0 {
            return;
        }
        while rays != 0 {
            let ray = rays.trailing_zeros() as usize;
            rays &= rays - 1;
            self.alone::<P>(ray, from, found, sights, stack);
        }
        found.tighten::<R>();
    }

    /// Walks one ray from a child on down.
    #[inline(always)]
    fn alone<P: Path>(&self, ray: usize, from: Child, found: &mut Found, sights: &mut Sights, stack: &mut Vec<u32>) {
        let walker = self.packet.walker(ray, sights.origin);
        let base = stack.len();
        let mut child = from;
        loop {
            if let Some(index) = child.as_block() {
                self.try_block_alone::<P>(index, ray, &walker.line, found, sights);
            } else if !sights.under.holds(self.tree, child.index()) {
                push::<P>(self.tree, &self.tree.nodes[child.index()], &walker, found.far(ray), stack);
            }
            match pop(stack, base, found.far(ray)) {
                Some(next) => child = next,
                None => return,
            }
        }
    }

    /// Offers the triangles of a block to one ray.
    #[inline(always)]
    fn try_block_alone<P: Path>(&self, index: usize, ray: usize, line: &Line, found: &mut Found, sights: &mut Sights) {
        let (mut open, sure) = candidates::<P::Four>(sights.view::<P::Four>(self.tree, index), line.direction);
        if open == 0 {
            return;
        }
        let sure = sure & !self.tree.blocks[index].masked;
        let (_, depths) = sights.view_in_depth::<P::Four>(self.tree, index);
        let direction = line.direction.to_array().map(P::Four::splat);
        let (near, far) = depths.all::<P::Four>().range(direction);
        let (mut nears, mut fars) = ([0.0; BLOCK], [0.0; BLOCK]);
        near.store(&mut nears);
        far.store(&mut fars);
        while open != 0 {
            let lane = open.trailing_zeros() as usize;
            open &= open - 1;
            if nears[lane] > found.far(ray) {
                continue;
            }
            let place = Place::new(self.tree, index, lane);
            let decided = sure >> lane & 1 == 1 && found.offer_one(ray, place, nears[lane], fars[lane]);
            if !decided {
                found.decide(ray, place, line, self.tree, self.solid);
            }
        }
    }
}
