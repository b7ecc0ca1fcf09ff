//! Checks that a tree is sound: every triangle is where rays look for it.

use crate::tracer::Tracer;
use crate::tree::{BLOCK, Child};
use glam::Vec3;

impl Tracer {
    /// Checks the structure: every node and block has one parent, boxes lie within their parents', each
    /// corner of a triangle lies in a box above one of its blocks, and a walk's stack is as deep as announced.
    ///
    /// # Errors
    /// One sentence that names the first fault found.
    pub fn validate(&self) -> Result<(), String> {
        let tree = &self.tree;
        let mut parents = (vec![0u32; tree.nodes.len()], vec![0u32; tree.blocks.len()]);
        let mut covered = std::collections::BTreeMap::<u32, u8>::new();
        let everything = (Vec3::NEG_INFINITY, Vec3::INFINITY);
        let mut open = if tree.nodes.is_empty() { vec![] } else { vec![(0usize, everything, 1usize)] };
        while let Some((index, outer, depth)) = open.pop() {
            parents.0[index] += 1;
            if depth * crate::tree::WIDTH > tree.stack_need {
                return Err(format!("node {index} lies deeper than the stack of {}", tree.stack_need));
            }
            let node = &tree.nodes[index];
            let there = |slot: &usize| node.children[*slot] != Child::NONE;
            if (0..crate::tree::WIDTH).filter(there).fold(0, |mask, slot| mask | 1 << slot) != node.present {
                return Err(format!("node {index} miscounts its children"));
            }
            for slot in (0..crate::tree::WIDTH).filter(|&slot| node.children[slot] != Child::NONE) {
                let bounds = node.child_bounds(slot);
                if !within(bounds, outer) {
                    return Err(format!("child {slot} of node {index} sticks out of its parent's box"));
                }
                match node.children[slot].as_block() {
                    Some(block) => {
                        let count = parents.1.get_mut(block).ok_or(format!("block {block} does not exist"))?;
                        *count += 1;
                        self.cover(block, bounds, &mut covered);
                    }
                    None if node.children[slot].index() < tree.nodes.len() => {
                        open.push((node.children[slot].index(), bounds, depth + 1));
                    }
                    None => return Err(format!("child {slot} of node {index} does not exist")),
                }
            }
        }
        if parents.0.iter().chain(&parents.1).any(|&n| n != 1) {
            return Err("a node or a block has no parent or several".into());
        }
        match covered.iter().find(|&(_, &corners)| corners != 7) {
            Some((triangle, _)) => Err(format!("triangle {triangle} has a corner outside of its boxes")),
            None => Ok(()),
        }
    }

    /// Notes which corners of a block's triangles lie in the block's box, widened for the rounding of split boxes.
    fn cover(&self, block: usize, (lower, upper): (Vec3, Vec3), covered: &mut std::collections::BTreeMap<u32, u8>) {
        let margin = Vec3::splat(self.tree.reach * 1.0e-6);
        let block = &self.tree.blocks[block];
        for lane in (0..BLOCK).filter(|lane| block.valid >> lane & 1 == 1) {
            let corners = covered.entry(block.triangles[lane]).or_default();
            for (k, corner) in block.corners(lane).into_iter().enumerate() {
                let inside = corner.cmpge(lower - margin).all() && corner.cmple(upper + margin).all();
                *corners |= u8::from(inside) << k;
            }
        }
    }
}

fn within(inner: (Vec3, Vec3), outer: (Vec3, Vec3)) -> bool {
    inner.0.cmpge(outer.0).all() && inner.1.cmple(outer.1).all()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn grid() -> Tracer {
        let positions: Vec<Vec3> =
            (0..400).map(|i| Vec3::new((i % 20) as f32, (i / 20) as f32, (i % 7) as f32)).collect();
        let triangles: Vec<[u32; 3]> = (0..370).map(|i| [i, i + 1, i + 21]).collect();
        Tracer::build(&positions, &triangles, &[])
    }

    #[test]
    fn built_trees_are_sound() {
        assert_eq!(grid().validate(), Ok(()));
        assert_eq!(Tracer::build(&[], &[], &[]).validate(), Ok(()));
    }

    #[test]
    fn soundness_can_fail() {
        let mut tracer = grid();
        let slot =
            (0..8).find(|&slot| tracer.tree.nodes[0].children[slot].as_block().is_none()).expect("an inner child");
        tracer.tree.nodes[0].bounds[0][slot] += 0.5;
        assert!(tracer.validate().is_err(), "a box that shrank");
        let mut tracer = grid();
        tracer.tree.nodes[0].children[0] = tracer.tree.nodes[0].children[1];
        assert!(tracer.validate().is_err(), "a child that is there twice");
    }
}
