//! Receivers that others want beside those of the file.

use crate::gather::Gathered;
use crate::hit::{NearPoint, PackedHit, Source};
use crate::receivers::Receivers;
use crate::world::World;
use std::collections::BTreeSet;

/// Receivers that others want beside those of the file, for the time of the bake.
#[derive(Default)]
pub(crate) struct Wanted {
    /// Share of a receiver's light from where the backs that it sees are worth receivers of their own.
    pub(crate) worth: f32,
    /// Triangles whose backs are wanted.
    pub(crate) backs: BTreeSet<u32>,
    /// Receivers and their near points.
    pub(crate) near: Vec<(u32, Vec<NearPoint>)>,
}

impl Wanted {
    /// Takes note of what a receiver sees.
    pub(crate) fn note(&mut self, id: u32, seen: &Gathered) {
        if !seen.near.is_empty() {
            self.near.push((id, seen.near.clone()));
        }
        if back_share(&seen.hits) <= self.worth {
            return;
        }
        for source in seen.hits.iter().filter(|hit| hit.is_back).map(|hit| hit.source) {
            if let Source::Triangle(triangle) = source {
                self.backs.insert(triangle);
            }
        }
    }

    /// Makes receivers of all that is wanted.
    pub(crate) fn add_to(self, receivers: &mut Receivers, world: &World<'_>) {
        let vertices: BTreeSet<u32> = self.backs.iter().flat_map(|&t| world.corners[t as usize]).collect();
        for vertex in vertices {
            receivers.add_back(vertex);
        }
        for (id, points) in self.near {
            receivers.add_near(id, points.iter().map(|point| world.receiver_at(point)));
        }
    }
}

/// Share of a receiver's light that the backs it sees send on at most.
fn back_share(hits: &[PackedHit]) -> f32 {
    let backs = hits.iter().filter(|hit| hit.is_back);
    backs.map(|hit| hit.reflected.into_iter().fold(0.0, f32::max)).sum()
}
