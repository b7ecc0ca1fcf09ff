//! A packet of rays from one point through the tree; the last few alive go on alone.

use crate::block::{candidates_between, dot};
use crate::lanes::{Lanes, Path};
use crate::ray::Line;
use crate::sight::{Occluders, PER_CELL, Plane3, Sights};
use crate::tree::{Child, Node, Tree, WIDTH};
use crate::walk::{Apart, LATER, PERMUTED, Solid, Walker, blocked, blocked_for_sure};
use glam::Vec3;

/// Packets with at most this many rays left are walked ray by ray.
const ALONE: u32 = 3;

/// Most rays in a packet, at any level.
pub(crate) const WIDEST: usize = 16;

/// One number for each ray of a packet.
pub(crate) type Many = [f32; WIDEST];

/// The working memory of a fan.
#[derive(Debug)]
pub(crate) struct Scratch {
    pub(crate) sights: Sights,
    pub(crate) occluders: Occluders,
    /// Rays (high half) and child (low half) still to visit.
    waiting: Vec<u64>,
    pub(crate) stack: Vec<u32>,
    /// The tree of the last fan.
    serial: u64,
}

impl Scratch {
    pub(crate) fn new() -> Scratch {
        Scratch {
            sights: Sights::new(),
            occluders: Occluders::new(),
            waiting: Vec::new(),
            stack: Vec::new(),
            serial: 0,
        }
    }

    /// Makes ready for a fan.
    pub(crate) fn start(&mut self, tree: &Tree, origin: Vec3) {
        self.sights.start(origin);
        if self.serial != tree.serial {
            self.serial = tree.serial;
            self.occluders.clear();
        }
    }
}

/// Rays side by side, all from one origin, with finite reciprocals.
pub(crate) struct Packet<'a, R> {
    pub(crate) direction: [R; 3],
    pub(crate) inverse: [R; 3],
    /// The same directions and reciprocals, one by one.
    pub(crate) each: &'a [Many; 3],
    pub(crate) inverse_each: [Many; 3],
    /// One bit per axis: set where all directions are negative.
    pub(crate) octant: usize,
    /// One bit per axis: set where directions of both signs meet.
    pub(crate) mixed: usize,
    pub(crate) apart: Apart,
    /// Corners of the box around the directions.
    pub(crate) least: Vec3,
    pub(crate) most: Vec3,
    /// Least and greatest reciprocal of each axis that is not mixed.
    pub(crate) range: [(f32, f32); 3],
}

/// Everything a packet's walk refers to.
pub(crate) struct Walk<'a, R> {
    pub(crate) tree: &'a Tree,
    pub(crate) packet: Packet<'a, R>,
    pub(crate) solid: Solid<'a>,
    /// Where its occluders are remembered.
    pub(crate) cell: usize,
}

impl<R: Lanes> Walk<'_, R> {
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
            } else {
                self.descend::<P>(&self.tree.nodes[child.index()], mask, &mut scratch.waiting);
            }
            let Some(next) = scratch.waiting.pop() else {
                break;
            };
            child = Child::from_bits(next as u32);
            mask = (next >> 32) as u32;
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
            let (_, sure) = self.meets(&Plane3::of(seen, lane));
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

    /// Which rays may meet a triangle, and which of those beyond doubt.
    #[inline(always)]
    fn meets(&self, triangle: &Plane3) -> (u32, u32) {
        let zero = R::splat(0.0);
        let (a, a_slack) = self.edge(triangle, 0);
        let (b, b_slack) = self.edge(triangle, 1);
        let (c, c_slack) = self.edge(triangle, 2);
        let most = a.add(a_slack).min(b.add(b_slack)).min(c.add(c_slack));
        let out = zero.above(most);
        let least = a.sub(a_slack).min(b.sub(b_slack)).min(c.sub(c_slack));
        let all = (1u32 << R::N) - 1;
        (!out & all, least.above(zero) & !out)
    }

    /// Products of the rays with the plane of one edge, and their bound.
    #[inline(always)]
    fn edge(&self, triangle: &Plane3, k: usize) -> (R, R) {
        let normal = [
            R::splat(triangle.normals[3 * k]),
            R::splat(triangle.normals[3 * k + 1]),
            R::splat(triangle.normals[3 * k + 2]),
        ];
        (dot(self.packet.direction, normal), R::splat(triangle.slack[k]))
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
            let (maybe, sure) = self.meets(&Plane3::of(seen, lane));
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
                let line = self.line(ray, origin);
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
    fn descend<P: Path>(&self, node: &Node, mask: u32, waiting: &mut Vec<u64>) {
        let boxes = Boxes::<P::Eight>::of(node, &self.packet);
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
            let rays = if all >> slot & 1 == 1 { mask } else { self.meets_box(&planes, slot) & mask };
            if rays != 0 {
                self.tree.fetch::<P>(node.children[slot]);
                waiting.push(u64::from(rays) << 32 | u64::from(node.children[slot].bits()));
            }
        }
    }

    /// Which rays meet one box.
    #[inline(always)]
    fn meets_box(&self, planes: &Planes, slot: usize) -> u32 {
        let mut near = R::splat(0.0);
        let mut far = R::splat(f32::INFINITY);
        for axis in 0..3 {
            let enter = R::splat(planes.enter[axis][slot]).mul(self.packet.inverse[axis]);
            let leave = R::splat(planes.leave[axis][slot]).mul(self.packet.inverse[axis]);
            let mixed = self.packet.mixed >> axis & 1 == 1;
            near = if mixed { enter.min(leave).max(near) } else { enter.max(near) };
            far = if mixed { enter.max(leave).min(far) } else { leave.min(far) };
        }
        !near.above(far.mul(R::splat(LATER)))
    }

    /// Walks the rays of a mask one by one from a child on down.
    #[inline(always)]
    fn one_by_one<P: Path>(&self, from: Child, mask: u32, scratch: &mut Scratch) -> u32 {
        let mut stopped = 0;
        let mut rays = mask;
        while rays != 0 {
            let ray = rays.trailing_zeros() as usize;
            rays &= rays - 1;
            let line = self.line(ray, scratch.sights.origin);
            let walker = Walker { line, octant: line.octant(), apart: self.packet.apart, end: f32::INFINITY };
            stopped |= u32::from(alone::<P>(self.tree, &walker, from, self.solid, self.cell, scratch)) << ray;
        }
        stopped
    }

    /// One of the rays: a packet's directions are unit and not too steep, so they need no scaling.
    #[inline(always)]
    fn line(&self, ray: usize, origin: Vec3) -> Line {
        let one = |each: &[Many; 3]| Vec3::new(each[0][ray], each[1][ray], each[2][ray]);
        Line {
            origin,
            direction: one(self.packet.each),
            inverse: one(&self.packet.inverse_each),
            scale: 1.0,
            t_min: 0.0,
            t_max: f32::INFINITY,
        }
    }
}

/// The planes of eight boxes from the origin, one by one.
#[derive(Default)]
struct Planes {
    enter: [[f32; WIDTH]; 3],
    leave: [[f32; WIDTH]; 3],
}

/// The planes of eight boxes from the origin of a packet, and where its rays pass them at the earliest and the latest.
struct Boxes<E> {
    enter: [E; 3],
    leave: [E; 3],
    near: (E, E),
    far: (E, E),
}

impl<E: Lanes> Boxes<E> {
    #[inline(always)]
    fn of<R>(node: &Node, packet: &Packet<'_, R>) -> Boxes<E> {
        let (zero, endless) = (E::splat(0.0), E::splat(f32::INFINITY));
        let mut boxes = Boxes { enter: [zero; 3], leave: [zero; 3], near: (zero, zero), far: (endless, endless) };
        for axis in 0..3 {
            let (enter, leave) = packet.apart.planes::<E>(node, packet.octant, axis);
            boxes.enter[axis] = enter;
            boxes.leave[axis] = leave;
            if packet.mixed >> axis & 1 == 1 {
                // Reciprocals of both signs have no bounds: this axis tells nothing.
                continue;
            }
            let (least, most) = (E::splat(packet.range[axis].0), E::splat(packet.range[axis].1));
            let (a, b) = (enter.mul(least), enter.mul(most));
            let (c, d) = (leave.mul(least), leave.mul(most));
            boxes.near = (a.min(b).max(boxes.near.0), a.max(b).max(boxes.near.1));
            boxes.far = (c.min(d).min(boxes.far.0), c.max(d).min(boxes.far.1));
        }
        boxes
    }

    /// Which boxes some ray may meet, and which of those every ray does.
    #[inline(always)]
    fn met(&self) -> (u32, u32) {
        let some = !self.near.0.above(self.far.1.mul(E::splat(LATER))) & ((1 << WIDTH) - 1);
        (some, !self.near.1.above(self.far.0) & some)
    }

    #[inline(always)]
    fn store(&self, planes: &mut Planes) {
        for axis in 0..3 {
            self.enter[axis].store(&mut planes.enter[axis]);
            self.leave[axis].store(&mut planes.leave[axis]);
        }
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
