//! One ray through the tree to its nearest hit.

use crate::block::glance;
use crate::lanes::{Lanes, Path};
use crate::ray::{Hit, Line, meet};
use crate::tree::{Block, Child, Node, Tree, WIDTH};
use crate::walk::{LATER, PERMUTED, Solid, Walker};

/// The hit of one triangle if it beats the best so far.
#[inline(never)]
pub(crate) fn nearer(block: &Block, lane: usize, line: &Line, best: Option<&Hit>, solid: Solid<'_>) -> Option<Hit> {
    let mut hit = meet(line, block.corners(lane))?;
    hit.triangle = block.triangles[lane];
    let place = (hit.t, hit.triangle);
    let beats = place > line.after && best.is_none_or(|best| place < (best.t, best.triangle));
    let counts = beats && (block.masked >> lane & 1 == 0 || solid(hit.triangle, hit.u, hit.v));
    counts.then_some(hit)
}

/// The nearest hit of a ray that shares its origin with no other; of equally near ones that of the smallest
/// triangle number.
#[inline(always)]
pub(crate) fn nearest<P: Path>(tree: &Tree, walker: &Walker, stack: &mut Vec<u32>, solid: Solid<'_>) -> Option<Hit> {
    let base = stack.len();
    let mut child = Child::node(0);
    let mut best: Option<Hit> = None;
    let mut end = walker.end;
    loop {
        if let Some(index) = child.as_block() {
            let block = &tree.blocks[index];
            let (mut open, _) = glance::<P::Four>(block, walker.line.origin, walker.line.direction);
            while open != 0 {
                let lane = open.trailing_zeros() as usize;
                open &= open - 1;
                if let Some(hit) = nearer(block, lane, &walker.line, best.as_ref(), solid) {
                    best = Some(hit);
                    end = hit.t / walker.line.scale;
                }
            }
        } else {
            push::<P>(tree, &tree.nodes[child.index()], walker, end, stack);
        }
        match pop(stack, base, end) {
            Some(next) => child = next,
            None => return best,
        }
    }
}

/// The next child to visit: what a nearer hit has overtaken since is passed over.
#[inline(always)]
pub(crate) fn pop(stack: &mut Vec<u32>, base: usize, end: f32) -> Option<Child> {
    while stack.len() > base {
        let (bits, near) = (stack.pop()?, stack.pop()?);
        if f32::from_bits(near) <= end * LATER {
            return Some(Child::from_bits(bits));
        }
    }
    None
}

/// Puts the children that a ray meets before `end` on the stack with where it enters them, the farthest first.
#[inline(always)]
pub(crate) fn push<P: Path>(tree: &Tree, node: &Node, walker: &Walker, end: f32, stack: &mut Vec<u32>) {
    let (mask, near) = walker.boxes::<P::Eight>(node, end);
    let mut nears = [0.0; WIDTH];
    near.store(&mut nears);
    let mut order = PERMUTED[walker.octant][mask as usize];
    while order != 0 {
        let last = 7 - order.leading_zeros() as usize;
        order &= !(1 << last);
        let slot = last ^ walker.octant;
        tree.fetch::<P>(node.children[slot]);
        stack.extend([nears[slot].to_bits(), node.children[slot].bits()]);
    }
}
