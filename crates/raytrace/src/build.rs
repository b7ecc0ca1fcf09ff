//! Builds the tree: obvhs makes a binary one, which is folded into nodes of eight and blocks of four.

use crate::binary::binary_tree;
use crate::tree::{BLOCK, Block, Child, Node, Tree, WIDTH, traceable};
use glam::{Vec3, Vec3A};
use obvhs::bvh2::Bvh2;
use obvhs::triangle::Triangle;
use std::sync::atomic::{AtomicU64, Ordering};

/// Trees built so far, by which a fan's state knows its tree again.
static TREES: AtomicU64 = AtomicU64::new(0);

/// What testing a block costs against a step through a binary node: at once, and per triangle.
const BLOCK_COST: f32 = 0.9;
const TRIANGLE_COST: f32 = 0.2;
const NODE_COST: f32 = 0.6;

/// The triangles that can be hit, with their numbers in the input.
struct Soup {
    triangles: Vec<Triangle>,
    numbers: Vec<u32>,
}

impl Soup {
    fn gather(positions: &[Vec3], indices: &[[u32; 3]], masked: &[bool]) -> Soup {
        let hidden = repeats(positions, indices, masked);
        let mut soup =
            Soup { triangles: Vec::with_capacity(indices.len()), numbers: Vec::with_capacity(indices.len()) };
        for (number, corners) in indices.iter().enumerate() {
            let corner = |k: usize| positions.get(corners[k] as usize).copied().unwrap_or(Vec3::NAN);
            let corners = [corner(0), corner(1), corner(2)];
            if traceable(corners) && !hidden[number] {
                let [v0, v1, v2] = corners.map(Vec3A::from);
                soup.triangles.push(Triangle { v0, v1, v2 });
                soup.numbers.push(number as u32);
            }
        }
        soup
    }
}

/// Of each triangle: whether one of a smaller number is the same, corner by corner, and asks no filter. All rays meet that one, and
/// thousands in one place, as doubled geometry has them, would make a tree as deep as they are many.
fn repeats(positions: &[Vec3], indices: &[[u32; 3]], masked: &[bool]) -> Vec<bool> {
    let corner = |i: u32| positions.get(i as usize).map_or([u32::MAX; 3], |p| p.to_array().map(f32::to_bits));
    let key = |number: u32| indices[number as usize].map(corner);
    let is_masked = |number: u32| masked.get(number as usize) == Some(&true);
    let hash = |number: u32| {
        let mix = |hash: u64, &bits: &u32| (hash ^ u64::from(bits)).wrapping_mul(0x9e37_79b9_7f4a_7c15).rotate_left(23);
        (key(number).as_flattened().iter().fold(0, mix), number)
    };
    let mut order: Vec<(u64, u32)> = (0..indices.len() as u32).map(hash).collect();
    order.sort_unstable();
    let mut hidden = vec![false; indices.len()];
    for alike in order.chunk_by_mut(|a, b| a.0 == b.0).filter(|alike| alike.len() > 1) {
        // The first asks no filter if any does not; what comes after it in number cannot be met before it.
        alike.sort_unstable_by_key(|&(_, number)| (key(number), is_masked(number), number));
        for same in alike.chunk_by(|a, b| key(a.1) == key(b.1)) {
            let first = same[0].1;
            for &(_, number) in &same[1..] {
                hidden[number as usize] = !is_masked(first) && number > first;
            }
        }
    }
    hidden
}

/// Builds the tree over the triangles that can be hit; `masked` is empty or says which of them ask the filter.
pub(crate) fn build(positions: &[Vec3], indices: &[[u32; 3]], masked: &[bool]) -> Tree {
    let soup = Soup::gather(positions, indices, masked);
    if soup.triangles.is_empty() {
        return Tree::default();
    }
    // One triangle per leaf: which triangles share a block is decided here, by what a block costs.
    let binary = binary_tree(&soup.triangles);
    let costs = Costs::of(&binary);
    let mut fold = Fold { binary: &binary, costs, soup: &soup, masked, tree: Tree::default() };
    fold.run();
    let mut tree = fold.tree;
    tree.serial = 1 + TREES.fetch_add(1, Ordering::Relaxed);
    tree.stack_need = stack_need(&tree.nodes);
    let size = |t: &Triangle| t.v0.abs().max(t.v1.abs()).max(t.v2.abs()).max_element();
    tree.reach = soup.triangles.iter().map(size).fold(0.0, f32::max);
    tree
}

/// Expected cost of each binary subtree and how many references it holds.
struct Costs {
    cost: Vec<f32>,
    count: Vec<u32>,
}

impl Costs {
    fn of(binary: &Bvh2) -> Costs {
        let n = binary.nodes.len();
        let mut costs = Costs { cost: vec![0.0; n], count: vec![0; n] };
        for index in children_first(binary) {
            let node = &binary.nodes[index];
            let area = node.aabb().half_area();
            let leaf = |count: u32| area * (BLOCK_COST + TRIANGLE_COST * count as f32);
            if node.is_leaf() {
                costs.count[index] = node.prim_count;
                costs.cost[index] = leaf(node.prim_count);
                continue;
            }
            let (left, right) = (node.first_index as usize, node.first_index as usize + 1);
            let count = costs.count[left] + costs.count[right];
            let inner = area * NODE_COST + costs.cost[left] + costs.cost[right];
            let one_block = count as usize <= BLOCK && leaf(count) <= inner;
            costs.count[index] = count;
            costs.cost[index] = if one_block { leaf(count) } else { inner };
        }
        costs
    }

    /// Whether a subtree is cheapest as one block.
    fn is_block(&self, binary: &Bvh2, index: usize) -> bool {
        let node = &binary.nodes[index];
        let area = node.aabb().half_area();
        let count = self.count[index];
        let leaf = area * (BLOCK_COST + TRIANGLE_COST * count as f32);
        node.is_leaf() || (count as usize <= BLOCK && leaf <= self.cost[index])
    }
}

/// Node indices so that children come before their parents.
fn children_first(binary: &Bvh2) -> Vec<usize> {
    let mut found = Vec::with_capacity(binary.nodes.len());
    let mut open = vec![0usize];
    while let Some(index) = open.pop() {
        found.push(index);
        let node = &binary.nodes[index];
        if !node.is_leaf() {
            open.push(node.first_index as usize);
            open.push(node.first_index as usize + 1);
        }
    }
    found.reverse();
    found
}

/// The folding of a binary tree into the wide one.
struct Fold<'a> {
    binary: &'a Bvh2,
    costs: Costs,
    soup: &'a Soup,
    masked: &'a [bool],
    tree: Tree,
}

impl Fold<'_> {
    fn run(&mut self) {
        self.tree.nodes.push(Node::EMPTY);
        let mut open = vec![(0usize, 0usize)];
        while let Some((wide, binary)) = open.pop() {
            let members = self.members(binary);
            for (slot, member) in self.slots(binary, &members) {
                let child = if self.costs.is_block(self.binary, member) {
                    self.add_block(member)
                } else {
                    self.tree.nodes.push(Node::EMPTY);
                    let index = self.tree.nodes.len() - 1;
                    open.push((index, member));
                    Child::node(index)
                };
                let aabb = *self.binary.nodes[member].aabb();
                let node = &mut self.tree.nodes[wide];
                node.children[slot] = child;
                node.present |= 1 << slot;
                for axis in 0..3 {
                    node.bounds[axis][slot] = aabb.min[axis];
                    node.bounds[axis + 3][slot] = aabb.max[axis];
                }
            }
        }
    }

    /// The up to eight subtrees that become a node's children: the largest is opened until there are eight.
    fn members(&self, binary: usize) -> Vec<usize> {
        let mut members = vec![binary];
        while members.len() < WIDTH {
            let open = members.iter().enumerate().filter(|&(_, &m)| !self.costs.is_block(self.binary, m));
            let area = |m: usize| self.binary.nodes[m].aabb().half_area();
            let Some((place, &member)) = open.max_by(|a, b| area(*a.1).total_cmp(&area(*b.1))) else {
                break;
            };
            let first = self.binary.nodes[member].first_index as usize;
            members[place] = first;
            members.push(first + 1);
        }
        members
    }

    /// Puts each member in the slot whose corner of the box it is nearest, best fits first: then slot XOR octant of
    /// a ray rises roughly from near to far.
    fn slots(&self, binary: usize, members: &[usize]) -> Vec<(usize, usize)> {
        let centre = self.binary.nodes[binary].aabb().center();
        let mut fits = Vec::with_capacity(WIDTH * members.len());
        for &member in members {
            let offset = self.binary.nodes[member].aabb().center() - centre;
            for slot in 0..WIDTH {
                let side = |axis: usize| {
                    if slot >> axis & 1 == 1 { offset[axis] } else { -offset[axis] }
                };
                fits.push((side(0) + side(1) + side(2), slot, member));
            }
        }
        fits.sort_by(|a, b| b.0.total_cmp(&a.0).then(a.1.cmp(&b.1)).then(a.2.cmp(&b.2)));
        let mut placed: Vec<(usize, usize)> = Vec::with_capacity(members.len());
        for (_, slot, member) in fits {
            if placed.iter().all(|&(s, m)| s != slot && m != member) {
                placed.push((slot, member));
            }
        }
        placed
    }

    /// Collects a subtree of at most four references into a block.
    fn add_block(&mut self, binary: usize) -> Child {
        let mut members = Vec::with_capacity(BLOCK);
        let mut open = vec![binary];
        while let Some(index) = open.pop() {
            let node = &self.binary.nodes[index];
            if node.is_leaf() {
                let first = node.first_index as usize;
                members.extend_from_slice(&self.binary.primitive_indices[first..first + node.prim_count as usize]);
            } else {
                open.extend([node.first_index as usize, node.first_index as usize + 1]);
            }
        }
        // Two parts of a split triangle in one block are one triangle.
        members.sort_unstable();
        members.dedup();
        self.tree.blocks.push(self.block(&members));
        Child::block(self.tree.blocks.len() - 1)
    }

    fn block(&self, members: &[u32]) -> Block {
        let mut block = Block { corners: [[0.0; BLOCK]; 9], triangles: [u32::MAX; BLOCK], valid: 0, masked: 0 };
        for lane in 0..BLOCK {
            // Lanes left over repeat the first triangle, so that their arithmetic takes no special path.
            let member = *members.get(lane).unwrap_or(&members[0]) as usize;
            let triangle = &self.soup.triangles[member];
            for (k, corner) in [triangle.v0, triangle.v1, triangle.v2].into_iter().enumerate() {
                for axis in 0..3 {
                    block.corners[3 * k + axis][lane] = corner[axis];
                }
            }
            if lane < members.len() {
                let number = self.soup.numbers[member];
                block.triangles[lane] = number;
                block.valid |= 1 << lane;
                block.masked |= u32::from(self.masked.get(number as usize) == Some(&true)) << lane;
            }
        }
        block
    }
}

/// Entries that a walk can have waiting at once; children stand after their parents.
fn stack_need(nodes: &[Node]) -> usize {
    let mut need = vec![0usize; nodes.len()];
    for (index, node) in nodes.iter().enumerate().rev() {
        let inner = node.children.iter().filter(|c| c.as_block().is_none());
        let deepest = inner.map(|c| need[c.index()]).max().unwrap_or(0);
        need[index] = WIDTH + deepest;
    }
    need.first().copied().unwrap_or(0) + 1
}
