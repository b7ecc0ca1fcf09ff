//! One ray through the tree, until anything blocks it.

use crate::block::glance;
use crate::lanes::{Lanes, Path};
use crate::ray::{Line, meet};
use crate::tree::{Block, Child, Node, Tree, WIDTH};
use glam::Vec3;

/// Whether a masked triangle is solid at a point (triangle, u, v).
pub(crate) type Solid<'a> = &'a dyn Fn(u32, f32, f32) -> bool;

/// A ray leaves a box at most this much later than single precision says: four roundings, doubled.
pub(crate) const LATER: f32 = 1.0 + 8.0 * f32::EPSILON;

/// Boxes are widened by this part of the largest coordinate in play. It covers the rounding of corners translated to
/// the origin (2^-24 of their distance) and of the boxes of split triangles (a few units of 2^-24).
const WIDEN: f32 = 16.0 / 16_777_216.0;

/// `PERMUTED[octant][mask]` has bit `i ^ octant` for each bit `i` of the mask.
pub(crate) static PERMUTED: [[u8; 256]; 8] = permuted();

const fn permuted() -> [[u8; 256]; 8] {
    let mut table = [[0u8; 256]; 8];
    let mut octant = 0;
    while octant < 8 {
        let mut mask = 0;
        while mask < 256 {
            let mut bit = 0;
            while bit < 8 {
                if mask >> bit & 1 == 1 {
                    table[octant][mask] |= 1 << (bit ^ octant);
                }
                bit += 1;
            }
            mask += 1;
        }
        octant += 1;
    }
    table
}

/// The origin moved up for lower and down for upper planes, so that every box counts as a little wider.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Apart {
    /// For lower planes, then for upper ones.
    from: [Vec3; 2],
}

impl Apart {
    #[inline(always)]
    pub(crate) fn new(tree: &Tree, origin: Vec3) -> Apart {
        let widen = widening(tree, origin);
        Apart { from: [origin + widen, origin - widen] }
    }

    /// The planes by which rays of an octant enter and leave the boxes of a node along an axis, from the origin.
    #[inline(always)]
    pub(crate) fn planes<E: Lanes>(&self, node: &Node, octant: usize, axis: usize) -> (E, E) {
        let (entry, exit) = (octant >> axis & 1, 1 - (octant >> axis & 1));
        let plane = |side: usize| E::load(&node.bounds[axis + 3 * side]).sub(E::splat(self.from[side][axis]));
        (plane(entry), plane(exit))
    }
}

/// How much wider boxes count, seen from an origin.
#[inline(always)]
pub(crate) fn widening(tree: &Tree, origin: Vec3) -> f32 {
    WIDEN * (tree.reach + origin.abs().max_element())
}

/// One ray with what its box tests need.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Walker {
    pub(crate) line: Line,
    pub(crate) octant: usize,
    pub(crate) apart: Apart,
    /// Last parameter of interest along the scaled direction.
    pub(crate) end: f32,
}

impl Walker {
    #[inline(always)]
    pub(crate) fn new(tree: &Tree, line: Line) -> Walker {
        let octant = line.octant();
        let apart = Apart::new(tree, line.origin);
        // Dividing by a power of two is exact; boxes start at zero, the exact test minds t_min.
        Walker { line, octant, apart, end: line.t_max / line.scale }
    }

    /// Which children's boxes the ray meets before `end`, and where it enters them.
    #[inline(always)]
    pub(crate) fn boxes<E: Lanes>(&self, node: &Node, end: f32) -> (u32, E) {
        let mut near = E::splat(0.0);
        let mut far = E::splat(end);
        for axis in 0..3 {
            let inverse = E::splat(self.line.inverse[axis]);
            let (enter, leave) = self.apart.planes::<E>(node, self.octant, axis);
            // Not-a-number (a plane through the origin, a direction within it) leaves the range as it is.
            near = enter.mul(inverse).max(near);
            far = leave.mul(inverse).min(far);
        }
        (!near.above(far.mul(E::splat(LATER))) & ((1 << WIDTH) - 1), near)
    }
}

/// How a walk tests blocks: with what was prepared for the origin, or anew.
pub(crate) trait View {
    /// Which triangles a line may meet, and which of those beyond doubt.
    fn test<F: Lanes>(&mut self, tree: &Tree, block: usize, line: &Line) -> (u32, u32);

    /// Whether nothing below a node is met, as is known of the origin.
    #[inline(always)]
    fn is_under(&mut self, _tree: &Tree, _node: usize) -> bool {
        false
    }
}

/// Tests each block anew: for a ray that shares its origin with no other.
pub(crate) struct Fresh;

impl View for Fresh {
    #[inline(always)]
    fn test<F: Lanes>(&mut self, tree: &Tree, block: usize, line: &Line) -> (u32, u32) {
        glance::<F>(&tree.blocks[block], line.origin, line.direction)
    }
}

/// Whether anything blocks a ray, from a child of the tree on down.
#[inline(always)]
pub(crate) fn blocked<P: Path>(
    tree: &Tree,
    walker: &Walker,
    from: Child,
    stack: &mut Vec<u32>,
    solid: Solid<'_>,
    view: &mut impl View,
) -> Option<(usize, usize)> {
    let base = stack.len();
    let mut child = from;
    loop {
        if let Some(index) = child.as_block() {
            let tested = view.test::<P::Four>(tree, index, &walker.line);
            let found = blocked_by(&tree.blocks[index], tested, &walker.line, solid);
            if let Some(lane) = found {
                stack.truncate(base);
                return Some((index, lane));
            }
        } else if !view.is_under(tree, child.index()) {
            let node = &tree.nodes[child.index()];
            let (mask, _) = walker.boxes::<P::Eight>(node, walker.end);
            push::<P>(tree, stack, node, mask, walker.octant);
        }
        if stack.len() == base {
            return None;
        }
        child = Child::from_bits(stack.pop()?);
    }
}

/// Puts the children of a mask on the stack, the farthest first.
#[inline(always)]
fn push<P: Path>(tree: &Tree, stack: &mut Vec<u32>, node: &Node, mask: u32, octant: usize) {
    let mut order = PERMUTED[octant][mask as usize];
    while order != 0 {
        let last = 7 - order.leading_zeros() as usize;
        order &= !(1 << last);
        let child = node.children[last ^ octant];
        tree.fetch::<P>(child);
        stack.push(child.bits());
    }
}

/// The lane of a triangle of a block that blocks a ray.
#[inline(always)]
fn blocked_by(block: &Block, (mut open, sure): (u32, u32), line: &Line, solid: Solid<'_>) -> Option<usize> {
    let sure = if line.endless() { sure & !block.masked } else { 0 };
    if sure != 0 {
        return Some(sure.trailing_zeros() as usize);
    }
    while open != 0 {
        let lane = open.trailing_zeros() as usize;
        open &= open - 1;
        if blocked_for_sure(block, lane, line, solid) {
            return Some(lane);
        }
    }
    None
}

/// The exact answer for one triangle.
#[cold]
#[inline(never)]
pub(crate) fn blocked_for_sure(block: &Block, lane: usize, line: &Line, solid: Solid<'_>) -> bool {
    let Some(hit) = meet(line, block.corners(lane)) else {
        return false;
    };
    block.masked >> lane & 1 == 0 || solid(block.triangles[lane], hit.u, hit.v)
}
