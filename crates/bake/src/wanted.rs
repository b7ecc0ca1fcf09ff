//! Receivers that others want beside those of the file.

use crate::gather::Gathered;
use crate::hit::{NearPoint, PackedHit, Source};
use crate::receivers::{NONE, Receivers};
use crate::world::World;
use std::collections::{BTreeMap, BTreeSet};

/// Receivers that others want beside those of the file, for the time of the bake.
#[derive(Default)]
pub(crate) struct Wanted {
    /// Share of a receiver's light from where the backs that it sees are worth receivers of their own.
    pub(crate) worth: f32,
    /// Triangles whose backs are wanted.
    pub(crate) backs: BTreeSet<u32>,
    /// Receivers and their near points.
    pub(crate) near: Vec<(u32, Vec<NearPoint>)>,
    /// Cells that rays met, twice their number and one more for the back, each with the point nearest to its middle.
    pub(crate) cells: BTreeMap<u32, NearPoint>,
}

impl Wanted {
    /// Takes note of what a receiver sees.
    pub(crate) fn note(&mut self, id: u32, seen: &Gathered, world: &World<'_>) {
        if !seen.near.is_empty() {
            self.near.push((id, seen.near.clone()));
        }
        let backs_count = back_share(&seen.hits) > self.worth;
        for hit in seen.hits.iter().filter(|hit| backs_count || !hit.is_back) {
            self.note_cell(hit, world);
        }
        if !backs_count {
            return;
        }
        for source in seen.hits.iter().filter(|hit| hit.is_back).map(|hit| hit.source) {
            if let Source::Triangle(triangle) = source {
                self.backs.insert(triangle);
            }
        }
    }

    fn note_cell(&mut self, hit: &PackedHit, world: &World<'_>) {
        let Source::Triangle(triangle) = hit.source else { return };
        let Some(cell) = world.cells.at(triangle, hit.barycentrics) else { return };
        let point = NearPoint { triangle, front: !hit.is_back, barycentrics: hit.barycentrics };
        let best = self.cells.entry(2 * cell + u32::from(hit.is_back)).or_insert(point);
        if world.cells.off_middle(&point) < world.cells.off_middle(best) {
            *best = point;
        }
    }

    /// Makes receivers of all that is wanted.
    pub(crate) fn add_to(self, receivers: &mut Receivers, world: &World<'_>) {
        for (slot, point) in self.cells {
            let slot = slot as usize;
            receivers.cell_of.resize(receivers.cell_of.len().max(slot + 1), NONE);
            if receivers.cell_of[slot] == NONE {
                receivers.cell_of[slot] = receivers.list.len() as u32;
                receivers.list.push(world.receiver_at(&point));
            }
        }
        let vertices: BTreeSet<u32> = self.backs.iter().flat_map(|&t| world.corners[t as usize]).collect();
        for vertex in vertices {
            receivers.add_back(vertex);
        }
        for (id, points) in self.near {
            receivers.add_near(id, points.iter().map(|point| world.receiver_at(point)));
        }
    }
}

/// Whether what a receiver sees can want a receiver of its own: the back of a surface, or a cell.
pub(crate) fn is_wanted(world: &World<'_>, hit: &PackedHit) -> bool {
    let on_cell = |triangle| world.cells.at(triangle, hit.barycentrics).is_some();
    hit.is_back || matches!(hit.source, Source::Triangle(triangle) if on_cell(triangle))
}

/// Share of a receiver's light that the backs it sees send on at most.
fn back_share(hits: &[PackedHit]) -> f32 {
    let backs = hits.iter().filter(|hit| hit.is_back);
    backs.map(|hit| hit.reflected.into_iter().fold(0.0, f32::max)).sum()
}
