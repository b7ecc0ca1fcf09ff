//! Who sends light on to each receiver of a chunk: rows of a sparse matrix, kept from the first pass for the bounces.

use crate::gather::Gathered;
use crate::hit::{PackedHit, Source};
use crate::receivers::{NONE, Receivers};
use crate::world::World;

/// One entry of a row: a receiver, and the share of what it sends that arrives, RGB.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Sender {
    /// A receiver, a cell, or a number among the near points of the row's receiver; see the bits.
    key: u32,
    pub(crate) weight: [f32; 3],
}

/// Bit of [`Sender::key`] for the back of a receiver, where it has one.
const BACK: u32 = 1 << 31;
/// Bit of [`Sender::key`] for a near point.
const NEAR: u32 = 1 << 30;
/// Odd factor that spreads keys over a hash table: 2^32 over the golden ratio.
const SPREAD: u32 = 0x9e37_79b1;
/// Bit of [`Sender::key`] for a cell.
const CELL: u32 = 1 << 29;

impl Sender {
    /// The receiver that sends to `receiver`; known once the backs and near points are.
    pub(crate) fn resolve(&self, receivers: &Receivers, receiver: u32) -> u32 {
        let number = self.key & !(BACK | NEAR | CELL);
        if self.key & NEAR != 0 {
            return receivers.near_of[receiver as usize] + number;
        }
        if self.key & CELL != 0 {
            return receivers.cell_of[2 * number as usize + usize::from(self.key & BACK != 0)];
        }
        resolve(number, self.key & BACK != 0, receivers)
    }
}

/// The receiver on a side of a vertex: the front where the back has none.
pub(crate) fn resolve(vertex: u32, is_back: bool, receivers: &Receivers) -> u32 {
    let back = if is_back { receivers.back_of[vertex as usize] } else { NONE };
    if back == NONE { vertex } else { back }
}

/// The receivers that tell what a point of a traced triangle sends, with their shares: its corners, or its cell.
pub(crate) fn shares(
    world: &World<'_>,
    receivers: &Receivers,
    triangle: u32,
    is_back: bool,
    [u, v]: [f32; 2],
) -> impl Iterator<Item = (u32, f32)> {
    let corners = || world.corners[triangle as usize].map(|corner| resolve(corner, is_back, receivers));
    let (of, count) = match world.cells.at(triangle, [u, v]) {
        Some(cell) => ([receivers.cell_of[2 * cell as usize + usize::from(is_back)]; 3], 1),
        None => (corners(), 3),
    };
    let shares = if count == 1 { [1.0, 0.0, 0.0] } else { [1.0 - u - v, u, v] };
    of.into_iter().zip(shares).take(count)
}

/// The rows of the receivers of a chunk.
#[derive(Debug, Default)]
pub(crate) struct Senders {
    ends: Vec<u32>,
    entries: Vec<Sender>,
}

impl Senders {
    /// Rows of what receivers were found to see, of the hits that are picked.
    pub(crate) fn of(world: &World<'_>, results: &[Gathered], hits: fn(&Gathered) -> &[PackedHit]) -> Self {
        let mut senders = Self { ends: Vec::with_capacity(results.len()), entries: Vec::new() };
        let mut row = Vec::new();
        for result in results {
            fill_row(world, hits(result), &mut row);
            senders.entries.extend_from_slice(&row);
            senders.ends.push(senders.entries.len() as u32);
        }
        senders.entries.shrink_to_fit();
        senders
    }

    /// The row of the k-th receiver.
    pub(crate) fn row(&self, k: usize) -> &[Sender] {
        let start = if k == 0 { 0 } else { self.ends[k - 1] as usize };
        &self.entries[start..self.ends[k] as usize]
    }

    /// Memory that the rows take.
    pub(crate) fn bytes(&self) -> u64 {
        (self.entries.len() * size_of::<Sender>() + self.ends.len() * size_of::<u32>()) as u64
    }
}

/// Replaces `row` by the senders of a receiver, each once: what is hit between vertices comes from the corners of the triangle, or from its cell.
pub(crate) fn fill_row(world: &World<'_>, hits: &[PackedHit], row: &mut Vec<Sender>) {
    row.clear();
    for hit in hits {
        match hit.source {
            Source::Near(index) => row.push(Sender { key: index | NEAR, weight: hit.reflected }),
            Source::Triangle(triangle) => {
                let side = if hit.is_back { BACK } else { 0 };
                if let Some(cell) = world.cells.at(triangle, hit.barycentrics) {
                    row.push(Sender { key: cell | CELL | side, weight: hit.reflected });
                    continue;
                }
                let [u, v] = hit.barycentrics;
                for (corner, share) in world.corners[triangle as usize].into_iter().zip([1.0 - u - v, u, v]) {
                    row.push(Sender { key: corner | side, weight: hit.reflected.map(|x| x * share) });
                }
            }
        }
    }
    merge(row);
}

/// Sums the weights of entries of one key, in the order of the rays; keys rise.
fn merge(row: &mut Vec<Sender>) {
    // A hash table of the places of keys in the row, at most half full: far fewer keys are left to sort than there are entries.
    let bits = (2 * row.len()).next_power_of_two().ilog2().max(1);
    let mut places = vec![u32::MAX; 1 << bits];
    let mut kept = 0;
    for k in 0..row.len() {
        let next = row[k];
        let mut at = (next.key.wrapping_mul(SPREAD) >> (u32::BITS - bits)) as usize;
        while places[at] != u32::MAX && row[places[at] as usize].key != next.key {
            at = (at + 1) & (places.len() - 1);
        }
        if places[at] == u32::MAX {
            places[at] = kept as u32;
            row[kept] = next;
            kept += 1;
        } else {
            let sum = &mut row[places[at] as usize].weight;
            sum.iter_mut().zip(next.weight).for_each(|(sum, more)| *sum += more);
        }
    }
    row.truncate(kept);
    row.sort_unstable_by_key(|sender| sender.key);
}

#[cfg(test)]
mod tests {
    use super::{BACK, Sender, merge};

    #[test]
    fn merging_keeps_the_sum_of_each_sender() {
        let entry = |key, x: f32| Sender { key, weight: [x, 2.0 * x, 0.0] };
        let mut row = vec![entry(7, 0.25), entry(3, 0.5), entry(7 | BACK, 1.0), entry(7, 0.125), entry(3, 0.5)];
        merge(&mut row);
        assert_eq!(row, [entry(3, 1.0), entry(7, 0.375), entry(7 | BACK, 1.0)]);
    }
}
