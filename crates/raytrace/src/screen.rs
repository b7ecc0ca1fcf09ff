//! A packet through the tree until each of its rays is blocked; the last few alive go on alone.

use crate::block::candidates_between;
use crate::lanes::{Lanes, Path};
use crate::packet::{Boxes, Packet, Planes};
use crate::scratch::{Scratch, Visit};
use crate::sight::{PER_CELL, Plane3};
use crate::tree::{Child, Node, Tree};
use crate::walk::{PERMUTED, Solid, Walker, blocked, blocked_for_sure};

/// Packets with at most this many rays left are walked ray by ray.
const ALONE: u32 = 3;

/// Everything a packet's walk refers to.
pub(crate) struct Screen<'a, R> {
    pub(crate) tree: &'a Tree,
    pub(crate) packet: Packet<'a, R>,
    pub(crate) solid: Solid<'a>,
    /// Where its occluders are remembered.
    pub(crate) cell: usize,
}

impl<R: Lanes> Screen<'_, R> {
    /// Which of the rays in `alive` are blocked.
    #[inline(always)]
    pub(crate) fn blocked<P: Path<Rays = R>>(&self, alive: u32, scratch: &mut Scratch) -> u32 {
        let mut open = self.try_occluders::<P>(alive, scratch);
        scratch.waiting.clear();
        let mut child = Child::node(0);
        let mut mask = open;
        while open != 0 {
            mask &= open;
            if mask.count_ones() <= ALONE {
                open &= !self.one_by_one::<P>(child, mask, scratch);
            } else if let Some(index) = child.as_block() {
                open &= !self.try_block::<P>(index, mask, scratch);
            } else if !scratch.sights.under.holds(self.tree, child.index()) {
                self.descend::<P>(&self.tree.nodes[child.index()], mask, &mut scratch.waiting);
            }
            let Some(next) = scratch.waiting.pop() else {
                break;
            };
            child = Child::from_bits(next.child);
            mask = next.rays;
        }
        alive & !open
    }

    /// Tries what blocked the last rays that went this way; returns the rays it leaves.
    #[inline(always)]
    fn try_occluders<P: Path<Rays = R>>(&self, alive: u32, scratch: &mut Scratch) -> u32 {
        let Scratch { sights, occluders, .. } = scratch;
        let mut open = alive;
        for index in 0..PER_CELL {
            let Some((block, lane)) = occluders.get(self.cell, index) else {
                continue;
            };
            let seen = sights.view::<P::Four>(self.tree, block);
            let (_, sure) = self.packet.meets(&Plane3::of(seen, lane));
            if sure & open == 0 {
                occluders.forget(self.cell, index);
            }
            open &= !sure;
            if open == 0 {
                break;
            }
        }
        open
    }

    /// Which rays of a mask the triangles of a block stop.
    #[inline(always)]
    fn try_block<P: Path>(&self, index: usize, mask: u32, scratch: &mut Scratch) -> u32 {
        let block = &self.tree.blocks[index];
        let Scratch { sights, occluders, .. } = scratch;
        let origin = sights.origin;
        let seen = sights.view::<P::Four>(self.tree, index);
        let mut stopped = 0;
        let mut lanes = candidates_between::<P::Four>(seen, self.packet.least, self.packet.most);
        while lanes != 0 {
            let lane = lanes.trailing_zeros() as usize;
            lanes &= lanes - 1;
            let (maybe, sure) = self.packet.meets(&Plane3::of(seen, lane));
            let open = maybe & mask & !stopped;
            if open == 0 {
                continue;
            }
            let masked = block.masked >> lane & 1 == 1;
            let mut now = if masked { 0 } else { sure & open };
            let mut doubt = open & !now;
            while doubt != 0 {
                let ray = doubt.trailing_zeros() as usize;
                doubt &= doubt - 1;
                let line = self.packet.line(ray, origin);
                let stop = blocked_for_sure(block, lane, &line, self.solid);
                now |= u32::from(stop) << ray;
            }
            if now != 0 && !masked {
                occluders.keep(self.cell, index, lane);
            }
            stopped |= now;
            if stopped == mask {
                break;
            }
        }
        stopped
    }

    /// Puts the children that any ray of a mask meets on the stack, the farthest first.
    #[inline(always)]
    fn descend<P: Path>(&self, node: &Node, mask: u32, waiting: &mut Vec<Visit>) {
        let boxes = Boxes::<P::Eight>::of(node, &self.packet, f32::INFINITY);
        // Empty boxes pass where an axis tells nothing, and so would all boxes.
        let (some, all) = boxes.met();
        let (some, all) = (some & node.present, if self.packet.mixed == 0 { all } else { 0 });
        let mut planes = Planes::default();
        if some & !all != 0 {
            boxes.store(&mut planes);
        }
        let mut order = PERMUTED[self.packet.octant][some as usize];
        while order != 0 {
            let last = 7 - order.leading_zeros() as usize;
            order &= !(1 << last);
            let slot = last ^ self.packet.octant;
            let rays = if all >> slot & 1 == 1 {
                mask
            } else {
                self.packet.meets_box(&planes, slot, R::splat(f32::INFINITY)) & mask
            };
            if rays != 0 {
                self.tree.fetch::<P>(node.children[slot]);
                waiting.push(Visit { rays, child: node.children[slot].bits(), near: 0.0 });
            }
        }
    }

    /// Walks the rays of a mask one by one from a child on down.
    #[inline(always)]
    fn one_by_one<P: Path>(&self, from: Child, mask: u32, scratch: &mut Scratch) -> u32 {
        let mut stopped = 0;
        let mut rays = mask;
        while rays != 0 {
            let ray = rays.trailing_zeros() as usize;
            rays &= rays - 1;
            let walker = self.packet.walker(ray, scratch.sights.origin);
            stopped |= u32::from(alone::<P>(self.tree, &walker, from, self.solid, self.cell, scratch)) << ray;
        }
        stopped
    }
}

/// Whether one ray of a fan is blocked, from a child on down; remembers by what.
#[inline(always)]
pub(crate) fn alone<P: Path>(
    tree: &Tree,
    walker: &Walker,
    from: Child,
    solid: Solid<'_>,
    cell: usize,
    scratch: &mut Scratch,
) -> bool {
    let Scratch { sights, occluders, stack, .. } = scratch;
    let Some((index, lane)) = blocked::<P>(tree, walker, from, stack, solid, sights) else {
        return false;
    };
    if tree.blocks[index].masked >> lane & 1 == 0 {
        occluders.keep(cell, index, lane);
    }
    true
}
