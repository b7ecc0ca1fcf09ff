//! The tree that rays walk: eight-wide nodes with boxes by structure of arrays, triangles in blocks of four.

use crate::flat::Flats;
use crate::lanes::Path;
use crate::ray::LARGEST;
use glam::Vec3;
use std::sync::OnceLock;

/// Width of a node.
pub(crate) const WIDTH: usize = 8;

/// Width of a triangle block.
pub(crate) const BLOCK: usize = 4;

/// Reference to a child: an inner node, a block of triangles or nothing.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Child(u32);

impl Child {
    const LEAF: u32 = 1 << 31;
    /// Where a node has fewer than eight children; its box is empty, so that no ray arrives.
    pub(crate) const NONE: Child = Child(u32::MAX);

    pub(crate) fn node(index: usize) -> Child {
        Child(index as u32)
    }

    pub(crate) fn block(index: usize) -> Child {
        Child(index as u32 | Self::LEAF)
    }

    #[inline(always)]
    pub(crate) fn as_block(self) -> Option<usize> {
        (self.0 & Self::LEAF != 0).then_some((self.0 & !Self::LEAF) as usize)
    }

    /// The index of an inner node.
    #[inline(always)]
    pub(crate) fn index(self) -> usize {
        self.0 as usize
    }

    #[inline(always)]
    pub(crate) fn bits(self) -> u32 {
        self.0
    }

    #[inline(always)]
    pub(crate) fn from_bits(bits: u32) -> Child {
        Child(bits)
    }
}

/// Eight children and their boxes: lower x, y, z, then upper x, y, z.
#[repr(C, align(64))]
#[derive(Clone, Debug)]
pub(crate) struct Node {
    pub(crate) bounds: [[f32; WIDTH]; 6],
    pub(crate) children: [Child; WIDTH],
    /// One bit per child that there is.
    pub(crate) present: u32,
}

impl Node {
    pub(crate) const EMPTY: Node = Node {
        bounds: [
            [f32::INFINITY; WIDTH],
            [f32::INFINITY; WIDTH],
            [f32::INFINITY; WIDTH],
            [f32::NEG_INFINITY; WIDTH],
            [f32::NEG_INFINITY; WIDTH],
            [f32::NEG_INFINITY; WIDTH],
        ],
        children: [Child::NONE; WIDTH],
        present: 0,
    };

    /// Lower and upper corner of a child's box.
    pub(crate) fn child_bounds(&self, slot: usize) -> (Vec3, Vec3) {
        let at = |axis: usize| self.bounds[axis][slot];
        (Vec3::new(at(0), at(1), at(2)), Vec3::new(at(3), at(4), at(5)))
    }
}

/// Four triangles: the coordinates a.x a.y a.z b.x ... c.z, four by four.
#[repr(C, align(16))]
#[derive(Clone, Debug)]
pub(crate) struct Block {
    pub(crate) corners: [[f32; BLOCK]; 9],
    pub(crate) triangles: [u32; BLOCK],
    /// One bit per lane that holds a triangle.
    pub(crate) valid: u32,
    /// One bit per lane whose hits go through the filter.
    pub(crate) masked: u32,
}

impl Block {
    /// The three corners of one triangle.
    #[inline]
    pub(crate) fn corners(&self, lane: usize) -> [Vec3; 3] {
        let corner = |k: usize| {
            Vec3::new(self.corners[3 * k][lane], self.corners[3 * k + 1][lane], self.corners[3 * k + 2][lane])
        };
        [corner(0), corner(1), corner(2)]
    }
}

/// Nodes and blocks; the root is node 0 where there is any.
#[derive(Debug, Default)]
pub(crate) struct Tree {
    pub(crate) nodes: Vec<Node>,
    pub(crate) blocks: Vec<Block>,
    /// Entries that a walk can have waiting at once.
    pub(crate) stack_need: usize,
    /// A number that no other tree of this process has; 0 where there is none.
    pub(crate) serial: u64,
    /// Largest coordinate of any corner, by amount.
    pub(crate) reach: f32,
    /// How flat its parts are: made when a question first needs it.
    pub(crate) flats: OnceLock<Flats>,
}

impl Tree {
    /// How flat the parts of the tree are.
    pub(crate) fn flats(&self) -> &Flats {
        self.flats.get_or_init(|| Flats::of(self))
    }

    /// Brings a child near that will be visited soon.
    #[inline(always)]
    pub(crate) fn fetch<P: Path>(&self, child: Child) {
        let (place, size) = match child.as_block() {
            Some(index) => (self.blocks.as_ptr().wrapping_add(index).cast::<u8>(), size_of::<Block>()),
            None => (self.nodes.as_ptr().wrapping_add(child.index()).cast::<u8>(), size_of::<Node>()),
        };
        let mut at = 0;
        while at < size {
            P::fetch(place.wrapping_add(at));
            at += 64;
        }
    }
}

/// Whether a triangle can be traced at all: finite, within reach, and not two corners in one place.
pub(crate) fn traceable(corners: [Vec3; 3]) -> bool {
    let [a, b, c] = corners;
    let within = |p: Vec3| p.is_finite() && p.abs().max_element() <= LARGEST;
    within(a) && within(b) && within(c) && a != b && b != c && c != a
}
