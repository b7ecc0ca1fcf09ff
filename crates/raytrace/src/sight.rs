//! What one origin has seen of the triangles: prepared blocks, and the triangles that blocked its last rays.

use crate::block::{Seen, candidates, see};
use crate::depth::Depths;
use crate::lanes::Lanes;
use crate::ray::Line;
use crate::tree::Tree;
use crate::under::Under;
use crate::walk::View;
use glam::Vec3;

/// Blocks remembered at once (48 KiB, and 24 KiB for depths: most of what one receiver's rays touch again and again).
const REMEMBERED: usize = 256;

/// Blocks prepared for the origin of a fan, by the low bits of their number.
#[derive(Debug)]
pub(crate) struct Sights {
    edges: Memory<Seen>,
    depths: Memory<Depths>,
    fan: u64,
    pub(crate) origin: Vec3,
    /// What lies under the fan.
    pub(crate) under: Under,
    /// Blocks that were looked at.
    pub(crate) looks: usize,
}

impl Sights {
    pub(crate) fn new() -> Sights {
        let (edges, depths) = (Memory::new(Seen::NOTHING), Memory::new(Depths::NOTHING));
        Sights { edges, depths, fan: 0, origin: Vec3::ZERO, under: Under::new(), looks: 0 }
    }

    /// Forgets everything: a new origin.
    pub(crate) fn start(&mut self, origin: Vec3) {
        // The count of fans fills 32 bits; keys of the fan 2^32 ago would pass for new ones.
        self.fan += 1;
        if self.fan >> 32 != 0 {
            self.fan = 1;
            self.edges.keys.fill(0);
            self.depths.keys.fill(0);
        }
        self.origin = origin;
    }

    /// A block as the origin sees it.
    #[inline(always)]
    pub(crate) fn view<F: Lanes>(&mut self, tree: &Tree, block: usize) -> &Seen {
        self.looks += 1;
        let (place, known) = self.edges.find(self.fan, block);
        if !known {
            self.edges.values[place] = see::<F>(&tree.blocks[block], self.origin);
        }
        &self.edges.values[place]
    }

    /// A block as the origin sees it, and how far off it is.
    #[inline(always)]
    pub(crate) fn view_in_depth<F: Lanes>(&mut self, tree: &Tree, block: usize) -> (&Seen, &Depths) {
        let (place, known) = self.depths.find(self.fan, block);
        if !known {
            self.depths.values[place] = Depths::of::<F>(&tree.blocks[block], self.origin);
        }
        self.view::<F>(tree, block);
        (&self.edges.values[place], &self.depths.values[place])
    }
}

/// The latest of what was worked out for blocks and the origin of one fan.
#[derive(Debug)]
struct Memory<T> {
    /// Fan and block in each place.
    keys: Vec<u64>,
    values: Vec<T>,
}

impl<T: Copy> Memory<T> {
    fn new(nothing: T) -> Memory<T> {
        Memory { keys: vec![0; REMEMBERED], values: vec![nothing; REMEMBERED] }
    }

    /// The place of a block, and whether it holds what was worked out for it; whoever asks must put it there else.
    #[inline(always)]
    fn find(&mut self, fan: u64, block: usize) -> (usize, bool) {
        let place = block % REMEMBERED;
        let key = fan << 32 | block as u64;
        let known = self.keys[place] == key;
        self.keys[place] = key;
        (place, known)
    }
}

impl View for Sights {
    #[inline(always)]
    fn test<F: Lanes>(&mut self, tree: &Tree, block: usize, line: &Line) -> (u32, u32) {
        candidates::<F>(self.view::<F>(tree, block), line.direction)
    }

    #[inline(always)]
    fn is_under(&mut self, tree: &Tree, node: usize) -> bool {
        self.under.holds(tree, node)
    }
}

/// Cells per axis within an octant, by which occluders are remembered.
const CELLS: usize = 8;

/// Occluders remembered in a cell.
pub(crate) const PER_CELL: usize = 4;

/// Block and lane of a triangle.
type Place = (u32, u32);

/// No triangle.
const NOWHERE: Place = (u32::MAX, 0);

/// One triangle as the origin sees it: normals of its three edge planes and their bounds.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Plane3 {
    pub(crate) normals: [f32; 9],
    pub(crate) slack: [f32; 3],
}

impl Plane3 {
    #[inline(always)]
    pub(crate) fn of(seen: &Seen, lane: usize) -> Plane3 {
        let mut plane = Plane3 { normals: [0.0; 9], slack: [0.0; 3] };
        for (i, row) in seen.normals.iter().enumerate() {
            plane.normals[i] = row[lane];
        }
        for (i, row) in seen.slack.iter().enumerate() {
            plane.slack[i] = row[lane];
        }
        plane
    }
}

/// The triangles that blocked the latest rays by the direction of those rays: a receiver's neighbour mostly sees the
/// same triangle there. They are tried before the tree is walked.
#[derive(Debug)]
pub(crate) struct Occluders {
    cells: Vec<[Place; PER_CELL]>,
}

impl Occluders {
    pub(crate) fn new() -> Occluders {
        Occluders { cells: vec![[NOWHERE; PER_CELL]; 8 * CELLS * CELLS] }
    }

    /// The cell of a unit direction in an octant.
    #[inline(always)]
    pub(crate) fn cell(octant: usize, direction: [f32; 3]) -> usize {
        let [x, y, z] = direction.map(f32::abs);
        let scale = CELLS as f32 / (x + y + z);
        let along = |a: f32| ((a * scale) as usize).min(CELLS - 1);
        (octant * CELLS + along(x)) * CELLS + along(y)
    }

    /// Forgets everything: another tracer.
    pub(crate) fn clear(&mut self) {
        self.cells.fill([NOWHERE; PER_CELL]);
    }

    /// One of the triangles remembered in a cell: its block and lane.
    #[inline(always)]
    pub(crate) fn get(&self, cell: usize, index: usize) -> Option<(usize, usize)> {
        let place = self.cells[cell][index];
        (place != NOWHERE).then_some((place.0 as usize, place.1 as usize))
    }

    /// Forgets a triangle that was tried in vain.
    #[inline(always)]
    pub(crate) fn forget(&mut self, cell: usize, index: usize) {
        self.cells[cell][index] = NOWHERE;
    }

    /// Remembers a triangle that blocked.
    #[inline(always)]
    pub(crate) fn keep(&mut self, cell: usize, block: usize, lane: usize) {
        let place = (block as u32, lane as u32);
        let kept = &mut self.cells[cell];
        if !kept.contains(&place) {
            kept.rotate_right(1);
            kept[0] = place;
        }
    }
}
