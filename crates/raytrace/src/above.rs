//! Whether a receiver sees anything at all on its side of its tangent plane.

use crate::flat::Flats;
use crate::tracer::Tracer;
use crate::tree::{Child, Tree};
use glam::{DVec3, Vec3};
use std::sync::atomic::Ordering;

/// A corner counts as above the plane from this part of the largest coordinate in play: half of the step by which
/// rays leave a surface, so that whatever lies lower is below where the rays start.
const TOLERANCE: f64 = 1.0 / 4_194_304.0;

/// Nodes and blocks between two looks at whether it would have been worth knowing how flat the parts of the tree are.
const STRETCH: usize = 32;

/// Steps per block of the tree that are spent in questions of more than a stretch before [`Flats`] are made: about what they cost.
/// Scenes in which no plane runs along much of the scene never need them.
const WORTH: usize = 16;

impl Tracer {
    /// Whether any triangle has a corner above the plane through `origin` with unit `normal`, by more than 2^-22 of
    /// the largest coordinate of the two; where none has, no ray from a point stepped off that plane is blocked.
    pub fn anything_above(&self, origin: Vec3, normal: Vec3) -> bool {
        self.find(&Half::above(origin, normal)).0
    }

    /// The same for triangles whose front faces against `normal`, which count from `slack` metres below the plane on and where
    /// they touch it: ground that a body rests on, as a point just above the foot of that body sees it.
    pub fn anything_faced(&self, origin: Vec3, normal: Vec3, slack: f32) -> bool {
        self.find(&Half::faced(origin, normal, slack)).0
    }

    /// Nodes and blocks that [`Tracer::anything_above`] looks at: what its answer costs, without a clock.
    pub fn steps_above(&self, origin: Vec3, normal: Vec3) -> usize {
        self.find(&Half::above(origin, normal)).1
    }

    /// The same for [`Tracer::anything_faced`].
    pub fn steps_faced(&self, origin: Vec3, normal: Vec3, slack: f32) -> usize {
        self.find(&Half::faced(origin, normal, slack)).1
    }

    /// Whether some triangle counts, and how many nodes and blocks were looked at. Of the children of a node those that reach
    /// highest come first: a box touches what is in it, so the way up mostly leads to an answer.
    fn find(&self, half: &Half) -> (bool, usize) {
        let tree = &self.tree;
        let mut open = if tree.nodes.is_empty() { vec![] } else { vec![Child::node(0)] };
        let mut flats = self.tree.flats.get();
        let mut steps = 0;
        while let Some(child) = open.pop() {
            steps += 1;
            if let Some(index) = child.as_block() {
                if half.counts_in_block(tree, index) {
                    return (true, steps);
                }
                continue;
            }
            if flats.is_none() && steps.is_multiple_of(STRETCH) {
                flats = self.flats_if_worth();
            }
            if flats.is_some_and(|flats| steps > STRETCH && !flats.may_reach(child.index(), half)) {
                continue;
            }
            half.push_reaching(tree, child.index(), &mut open);
        }
        (false, steps)
    }

    /// Notes that some steps gave no answer; how flat the tree is, once that is worth knowing. Answers do not depend on it.
    fn flats_if_worth(&self) -> Option<&Flats> {
        let spent = self.spent.fetch_add(STRETCH, Ordering::Relaxed) + STRETCH;
        (spent > WORTH * self.tree.blocks.len()).then(|| self.tree.flats())
    }
}

/// What is asked for: corners above a plane, or a little below it on triangles that face it.
#[derive(Debug)]
pub(crate) struct Half {
    pub(crate) from: DVec3,
    pub(crate) normal: DVec3,
    /// Metres below the plane from where triangles count that face it; where none is given all count, above the plane.
    slack: Option<f64>,
    /// Largest coordinate of the point, by amount.
    size: f64,
}

impl Half {
    fn above(origin: Vec3, normal: Vec3) -> Half {
        let size = f64::from(origin.abs().max_element());
        Half { from: origin.as_dvec3(), normal: normal.as_dvec3(), slack: None, size }
    }

    fn faced(origin: Vec3, normal: Vec3, slack: f32) -> Half {
        Half { slack: Some(f64::from(slack)), ..Half::above(origin, normal) }
    }

    /// Whether only triangles count that face the plane.
    pub(crate) fn is_faced(&self) -> bool {
        self.slack.is_some()
    }

    fn height(&self, point: Vec3) -> f64 {
        (point.as_dvec3() - self.from).dot(self.normal)
    }

    /// Height that a corner of largest coordinate `size` must exceed.
    fn least(&self, size: f64) -> f64 {
        let tolerance = TOLERANCE * size.max(self.size);
        self.slack.map_or(tolerance, |slack| -(slack + tolerance))
    }

    /// Height that every corner in a box must exceed at least.
    pub(crate) fn least_in(&self, (lower, upper): (Vec3, Vec3)) -> f64 {
        // Above the plane the demand grows with the coordinates of a corner, below it shrinks.
        let size = if self.is_faced() {
            lower.abs().max(upper.abs()).max_element()
        } else {
            lower.max(-upper).max(Vec3::ZERO).max_element()
        };
        self.least(f64::from(size))
    }

    fn counts_in_block(&self, tree: &Tree, index: usize) -> bool {
        let block = &tree.blocks[index];
        let lanes = (0..4).filter(|lane| block.valid >> lane & 1 == 1);
        lanes.map(|lane| block.corners(lane)).any(|corners| self.counts(corners))
    }

    fn counts(&self, corners: [Vec3; 3]) -> bool {
        let high = |p: &Vec3| self.height(*p) > self.least(f64::from(p.abs().max_element()));
        corners.iter().any(high) && (!self.is_faced() || facing(corners).dot(self.normal) < 0.0)
    }

    /// Adds the children of a node in whose boxes a corner may count, the highest last.
    fn push_reaching(&self, tree: &Tree, index: usize, open: &mut Vec<Child>) {
        let node = &tree.nodes[index];
        let mut found = [(0.0, Child::NONE); 8];
        let mut count = 0;
        for slot in (0..8).filter(|&slot| node.children[slot] != Child::NONE) {
            let (lower, upper) = node.child_bounds(slot);
            // Rounding is monotonous: no corner in the box is reckoned higher than the corner of the box.
            let far = Vec3::select(self.normal.as_vec3().cmpgt(Vec3::ZERO), upper, lower);
            let excess = self.height(far) - self.least_in((lower, upper));
            if excess > 0.0 {
                found[count] = (excess, node.children[slot]);
                count += 1;
            }
        }
        let found = &mut found[..count];
        found.sort_by(|a, b| a.0.total_cmp(&b.0));
        open.extend(found.iter().map(|(_, child)| child));
    }
}

/// A normal of a triangle on its front, of any length.
pub(crate) fn facing([a, b, c]: [Vec3; 3]) -> DVec3 {
    (b - a).as_dvec3().cross((c - a).as_dvec3())
}
