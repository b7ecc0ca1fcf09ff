//! Cells that are split where surfaces come near, and the probes at their corners.

use super::grid::Grid;
use super::overlap::overlap;
use crate::world::World;
use crate::{Error, SettingField};
use coeff_io::Node;
use glam::{UVec3, Vec3};

/// Share of a cell's edges by which a surface may miss it and still count as near.
const NEAR: f32 = 1.0 / 8.0;
/// Most cells, split ones included.
const MOST_NODES: u64 = 1 << 22;

/// Cells and probes.
#[derive(Debug)]
pub(super) struct Tree {
    /// As [`coeff_io::Volume::nodes`].
    pub(super) nodes: Vec<Node>,
    /// Along x first, then y, then z.
    pub(super) probes: Vec<Corner>,
}

/// A corner of cells.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Corner {
    /// In steps of the finest level.
    pub(super) place: UVec3,
    /// How often the smallest cell was split that it belongs to.
    pub(super) level: u32,
}

/// A cell that is not split.
struct Leaf {
    node: usize,
    low: UVec3,
    level: u32,
}

impl Tree {
    pub(super) fn build(grid: &Grid, world: &World<'_>) -> Result<Self, Error> {
        let cells = UVec3::from_array(grid.cells);
        let count = grid.cells.iter().map(|&n| u64::from(n)).product();
        refuse_more_than(MOST_NODES, count)?;
        let mut builder = Builder {
            grid,
            world,
            nodes: vec![Node::Split(0); count as usize],
            leaves: Vec::with_capacity(count as usize),
        };
        // A grid that is not split needs to know no surface.
        let triangles: Vec<u32> = if grid.levels > 0 { (0..world.corners.len() as u32).collect() } else { Vec::new() };
        builder.block(UVec3::ZERO, cells, &triangles)?;
        Ok(builder.finish())
    }

    /// Bytes that it takes while it is copied into the file's model.
    pub(super) fn bytes(&self) -> u64 {
        (2 * size_of_val(self.nodes.as_slice()) + size_of_val(self.probes.as_slice())) as u64
    }
}

fn refuse_more_than(most: u64, cells: u64) -> Result<(), Error> {
    if cells > most {
        let allowed = "at most 4194304 are possible: use a wider spacing, fewer levels or a smaller box";
        return Err(Error::Setting { setting: SettingField::Volume, value: format!("{cells} cells or more"), allowed });
    }
    Ok(())
}

struct Builder<'a> {
    grid: &'a Grid,
    world: &'a World<'a>,
    nodes: Vec<Node>,
    leaves: Vec<Leaf>,
}

impl Builder<'_> {
    /// Halves a block of cells of the coarsest level until it is one, and hands on the triangles that come near.
    fn block(&mut self, low: UVec3, size: UVec3, triangles: &[u32]) -> Result<(), Error> {
        let scale = 1 << self.grid.levels;
        if size == UVec3::ONE {
            let [columns, rows, _] = self.grid.cells;
            let node = low.x + columns * (low.y + rows * low.z);
            return self.cell(node as usize, low * scale, 0, triangles);
        }
        let longest = (0..3).max_by_key(|&axis| size[axis]).expect("three axes");
        let mut first = size;
        first[longest] /= 2;
        let mut second_low = low;
        second_low[longest] += first[longest];
        let mut second = size;
        second[longest] -= first[longest];
        for (low, size) in [(low, first), (second_low, second)] {
            let near = self.near(low * scale, size * scale, 0, triangles);
            self.block(low, size, &near)?;
        }
        Ok(())
    }

    fn cell(&mut self, node: usize, low: UVec3, level: u32, triangles: &[u32]) -> Result<(), Error> {
        if triangles.is_empty() || level == self.grid.levels {
            self.leaves.push(Leaf { node, low, level });
            return Ok(());
        }
        let first = self.nodes.len();
        refuse_more_than(MOST_NODES, first as u64 + 8)?;
        self.nodes[node] = Node::Split(first as u32);
        self.nodes.extend([Node::Split(0); 8]);
        let edge = 1 << (self.grid.levels - level - 1);
        for part in 0..8 {
            let low = low + edge * eighth(part);
            let near = self.near(low, UVec3::splat(edge), level + 1, triangles);
            self.cell(first + part as usize, low, level + 1, &near)?;
        }
        Ok(())
    }

    /// Those of the triangles that come near a box, which consists of cells of a level.
    fn near(&self, low: UVec3, size: UVec3, level: u32, triangles: &[u32]) -> Vec<u32> {
        let (low, high) = (self.grid.point(low), self.grid.point(low + size));
        let half: Vec3 = 0.5 * (high - low) + NEAR * self.grid.edges(level);
        let centre = 0.5 * (low + high);
        triangles.iter().copied().filter(|&t| overlap(self.world.points(t), centre, half)).collect()
    }

    /// Numbers the corners.
    fn finish(mut self) -> Tree {
        let corner = |leaf: &Leaf, part: u32| leaf.low + (1 << (self.grid.levels - leaf.level)) * eighth(part);
        let of_leaf = |leaf: &Leaf| [0, 1, 2, 3, 4, 5, 6, 7].map(|part| key(corner(leaf, part)));
        let mut keys: Vec<u64> = self.leaves.iter().flat_map(of_leaf).collect();
        keys.sort_unstable();
        keys.dedup();
        let mut probes: Vec<Corner> = keys.iter().map(|&key| Corner { place: place(key), level: 0 }).collect();
        for leaf in &self.leaves {
            let numbers = of_leaf(leaf).map(|key| keys.binary_search(&key).expect("every corner is there") as u32);
            for number in numbers {
                let probe = &mut probes[number as usize];
                probe.level = probe.level.max(leaf.level);
            }
            self.nodes[leaf.node] = Node::Leaf(numbers);
        }
        Tree { nodes: self.nodes, probes }
    }
}

/// The lowest corner of a part of a cell, in edges of the parts.
fn eighth(part: u32) -> UVec3 {
    UVec3::new(part & 1, part >> 1 & 1, part >> 2)
}

/// A number that grows along x first, then y, then z.
fn key(place: UVec3) -> u64 {
    u64::from(place.z) << 42 | u64::from(place.y) << 21 | u64::from(place.x)
}

fn place(key: u64) -> UVec3 {
    let part = |shift: u32| (key >> shift & 0x1f_ffff) as u32;
    UVec3::new(part(0), part(21), part(42))
}
