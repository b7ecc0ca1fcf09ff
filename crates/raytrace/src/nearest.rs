//! One ray through the tree to its nearest hit.

use crate::lanes::{Lanes, Path};
use crate::ray::{Hit, Line, meet};
use crate::tree::{Block, Child, Node, Tree, WIDTH};
use crate::walk::{LATER, PERMUTED, Solid, View, Walker};

/// The best hit so far and where it was found.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Best {
    pub(crate) hit: Option<Hit>,
    /// Block and lane.
    pub(crate) place: (usize, usize),
}

impl Best {
    /// Takes the hits of a block's triangles that are nearer, or as near and of a smaller number.
    #[inline(always)]
    pub(crate) fn improve<P: Path>(
        &mut self,
        tree: &Tree,
        index: usize,
        lanes: u32,
        line: &Line,
        solid: Solid<'_>,
        view: &mut impl View,
    ) {
        let (open, _) = view.test::<P::Four>(tree, index, line);
        let mut open = open & lanes;
        while open != 0 {
            let lane = open.trailing_zeros() as usize;
            open &= open - 1;
            if let Some(hit) = nearer(&tree.blocks[index], lane, line, self.hit.as_ref(), solid) {
                *self = Best { hit: Some(hit), place: (index, lane) };
            }
        }
    }

    /// Last parameter of interest along the scaled direction.
    #[inline(always)]
    fn end(&self, walker: &Walker) -> f32 {
        self.hit.map_or(walker.end, |hit| hit.t / walker.line.scale)
    }
}

/// The hit of one triangle if it beats the best so far.
#[inline(never)]
fn nearer(block: &Block, lane: usize, line: &Line, best: Option<&Hit>, solid: Solid<'_>) -> Option<Hit> {
    let mut hit = meet(line, block.corners(lane))?;
    hit.triangle = block.triangles[lane];
    let beats = best.is_none_or(|best| (hit.t, hit.triangle) < (best.t, best.triangle));
    let counts = beats && (block.masked >> lane & 1 == 0 || solid(hit.triangle, hit.u, hit.v));
    counts.then_some(hit)
}

/// The nearest hit of a ray, of equally near ones that of the smallest triangle number; `best` may hold a first one.
#[inline(always)]
pub(crate) fn nearest<P: Path>(
    tree: &Tree,
    walker: &Walker,
    mut best: Best,
    stack: &mut Vec<u32>,
    solid: Solid<'_>,
    view: &mut impl View,
) -> Best {
    let base = stack.len();
    let mut child = Child::node(0);
    let mut end = best.end(walker);
    loop {
        if let Some(index) = child.as_block() {
            best.improve::<P>(tree, index, u32::MAX, &walker.line, solid, view);
            end = best.end(walker);
        } else {
            push::<P>(tree, &tree.nodes[child.index()], walker, end, stack);
        }
        loop {
            if stack.len() == base {
                return best;
            }
            let (Some(bits), Some(near)) = (stack.pop(), stack.pop()) else {
                return best;
            };
            // What a nearer hit has overtaken since is passed over.
            if f32::from_bits(near) <= end * LATER {
                child = Child::from_bits(bits);
                break;
            }
        }
    }
}

/// Puts the children that a ray meets before `end` on the stack with where it enters them, the farthest first.
#[inline(always)]
fn push<P: Path>(tree: &Tree, node: &Node, walker: &Walker, end: f32, stack: &mut Vec<u32>) {
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
