//! A packet of rays from one point: what all of them share, and its tests against boxes and triangles.

use crate::block::dot;
use crate::lanes::Lanes;
use crate::ray::{FIRST, Line};
use crate::sight::Plane3;
use crate::tree::{Node, Tree, WIDTH};
use crate::walk::{Apart, LATER, Walker};
use glam::Vec3;

/// Directions with a component below this go alone: its reciprocal is too large, or it counts as zero.
const STEEPEST: f32 = 2.0e-18;

/// Components of a unit direction stay below this; sums of three of them lie between these.
const LARGEST_UNIT: f32 = 1.001;
const SHORTEST: f32 = 0.99;
const LONGEST: f32 = 1.74;

/// Most rays in a packet, at any level.
pub(crate) const WIDEST: usize = 16;

/// One number for each ray of a packet.
pub(crate) type Many = [f32; WIDEST];

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

impl<'a, R: Lanes> Packet<'a, R> {
    /// None where a ray goes along an axis or is no unit direction.
    #[inline(always)]
    pub(crate) fn of(tree: &Tree, origin: Vec3, each: &'a [Many; 3]) -> Option<Packet<'a, R>> {
        let [x, y, z] = each;
        let direction = [R::load(x), R::load(y), R::load(z)];
        let least = Vec3::new(direction[0].lowest(), direction[1].lowest(), direction[2].lowest());
        let most = Vec3::new(direction[0].highest(), direction[1].highest(), direction[2].highest());
        let size = [direction[0].abs(), direction[1].abs(), direction[2].abs()];
        let (steepest, longest) = (size[0].min(size[1]).min(size[2]), size[0].add(size[1]).add(size[2]));
        // All false where a component is not a number, so that the ranges hold.
        let usual =
            steepest.above(R::splat(STEEPEST)) & R::splat(LONGEST).above(longest) & longest.above(R::splat(SHORTEST));
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

    /// Which rays may meet a triangle, and which of those beyond doubt.
    #[inline(always)]
    pub(crate) fn meets(&self, triangle: &Plane3) -> (u32, u32) {
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
        (dot(self.direction, normal), R::splat(triangle.slack[k]))
    }

    /// Which rays meet one box before `far`.
    #[inline(always)]
    pub(crate) fn meets_box(&self, planes: &Planes, slot: usize, mut far: R) -> u32 {
        let mut near = R::splat(0.0);
        for axis in 0..3 {
            let enter = R::splat(planes.enter[axis][slot]).mul(self.inverse[axis]);
            let leave = R::splat(planes.leave[axis][slot]).mul(self.inverse[axis]);
            let mixed = self.mixed >> axis & 1 == 1;
            near = if mixed { enter.min(leave).max(near) } else { enter.max(near) };
            far = if mixed { enter.max(leave).min(far) } else { leave.min(far) };
        }
        !near.above(far.mul(R::splat(LATER)))
    }

    /// One of the rays: a packet's directions are unit and not too steep, so they need no scaling.
    #[inline(always)]
    pub(crate) fn line(&self, ray: usize, origin: Vec3) -> Line {
        let one = |each: &[Many; 3]| Vec3::new(each[0][ray], each[1][ray], each[2][ray]);
        Line {
            origin,
            direction: one(self.each),
            inverse: one(&self.inverse_each),
            scale: 1.0,
            t_min: 0.0,
            t_max: f32::INFINITY,
            after: FIRST,
        }
    }

    /// One of the rays, ready to walk on alone.
    #[inline(always)]
    pub(crate) fn walker(&self, ray: usize, origin: Vec3) -> Walker {
        let line = self.line(ray, origin);
        Walker { line, octant: line.octant(), apart: self.apart, end: f32::INFINITY }
    }
}

/// The planes of eight boxes from the origin, one by one.
#[derive(Default)]
pub(crate) struct Planes {
    enter: [[f32; WIDTH]; 3],
    leave: [[f32; WIDTH]; 3],
}

/// The planes of eight boxes from the origin of a packet, and where its rays pass them at the earliest and the latest.
pub(crate) struct Boxes<E> {
    enter: [E; 3],
    leave: [E; 3],
    near: (E, E),
    far: (E, E),
}

impl<E: Lanes> Boxes<E> {
    /// The boxes of a node; what lies beyond `reach` is of no interest to any ray.
    #[inline(always)]
    pub(crate) fn of<R>(node: &Node, packet: &Packet<'_, R>, reach: f32) -> Boxes<E> {
        let zero = E::splat(0.0);
        let far = (E::splat(f32::INFINITY), E::splat(reach));
        let mut boxes = Boxes { enter: [zero; 3], leave: [zero; 3], near: (zero, zero), far };
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
    pub(crate) fn met(&self) -> (u32, u32) {
        let some = !self.near.0.above(self.far.1.mul(E::splat(LATER))) & ((1 << WIDTH) - 1);
        (some, !self.near.1.above(self.far.0) & some)
    }

    /// Before which parameter no ray enters each box.
    #[inline(always)]
    pub(crate) fn nears(&self) -> [f32; WIDTH] {
        let mut nears = [0.0; WIDTH];
        self.near.0.store(&mut nears);
        nears
    }

    #[inline(always)]
    pub(crate) fn store(&self, planes: &mut Planes) {
        for axis in 0..3 {
            self.enter[axis].store(&mut planes.enter[axis]);
            self.leave[axis].store(&mut planes.leave[axis]);
        }
    }
}
