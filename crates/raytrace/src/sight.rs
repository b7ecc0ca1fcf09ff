//! What one origin has seen of the triangles: prepared blocks, and the triangles that blocked its last rays.

use crate::block::{Seen, see};
use crate::lanes::Lanes;
use crate::tree::Tree;
use crate::walk::View;
use glam::Vec3;

/// Blocks remembered at once (48 KiB: most of what one receiver's rays touch again and again).
const REMEMBERED: usize = 256;

/// Blocks prepared for the origin of a fan, by the low bits of their number.
#[derive(Debug)]
pub(crate) struct Sights {
    /// Fan and block in each place.
    keys: Vec<u64>,
    seen: Vec<Seen>,
    fan: u64,
    pub(crate) origin: Vec3,
}

impl Sights {
    pub(crate) fn new() -> Sights {
        Sights { keys: vec![0; REMEMBERED], seen: vec![Seen::NOTHING; REMEMBERED], fan: 0, origin: Vec3::ZERO }
    }

    /// Forgets everything: a new origin.
    pub(crate) fn start(&mut self, origin: Vec3) {
        // The count of fans fills 32 bits; keys of the fan 2^32 ago would pass for new ones.
        self.fan += 1;
        if self.fan >> 32 != 0 {
            self.fan = 1;
            self.keys.fill(0);
        }
        self.origin = origin;
    }
}

impl View for Sights {
    /// A block as the origin sees it.
    #[inline(always)]
    fn view<F: Lanes>(&mut self, tree: &Tree, block: usize) -> &Seen {
        let place = block % REMEMBERED;
        let key = self.fan << 32 | block as u64;
        if self.keys[place] != key {
            self.keys[place] = key;
            self.seen[place] = see::<F>(&tree.blocks[block], self.origin);
        }
        &self.seen[place]
    }
}

/// Most triangles kept as recent occluders.
pub(crate) const KEPT: usize = 8;

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

/// The triangles that blocked the latest rays, the latest first: they are tried before the tree is walked.
#[derive(Debug, Default)]
pub(crate) struct Occluders {
    /// Block and lane.
    places: Vec<(u32, u32)>,
    planes: Vec<Plane3>,
}

impl Occluders {
    /// Looks at the triangles kept from the last fan from a new origin.
    #[inline(always)]
    pub(crate) fn start<F: Lanes>(&mut self, tree: &Tree, sights: &mut Sights) {
        // The state may come from another tracer.
        let known = |&(block, lane): &(u32, u32)| {
            let block = tree.blocks.get(block as usize);
            block.is_some_and(|block| (block.valid & !block.masked) >> lane & 1 == 1)
        };
        self.places.retain(known);
        self.planes.clear();
        for &(block, lane) in &self.places {
            let seen = sights.view::<F>(tree, block as usize);
            self.planes.push(Plane3::of(seen, lane as usize));
        }
    }

    #[inline(always)]
    pub(crate) fn planes(&self) -> &[Plane3] {
        &self.planes
    }

    /// A kept triangle has blocked again.
    #[inline(always)]
    pub(crate) fn promote(&mut self, index: usize) {
        if index > 0 {
            self.places[..=index].rotate_right(1);
            self.planes[..=index].rotate_right(1);
        }
    }

    /// Keeps a triangle that blocked.
    #[inline(always)]
    pub(crate) fn keep(&mut self, block: usize, lane: usize, seen: &Seen) {
        let place = (block as u32, lane as u32);
        if self.places.first() == Some(&place) {
            return;
        }
        if self.places.len() == KEPT {
            self.places.pop();
            self.planes.pop();
        }
        self.places.insert(0, place);
        self.planes.insert(0, Plane3::of(seen, lane));
    }
}
