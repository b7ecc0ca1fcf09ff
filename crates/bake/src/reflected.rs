//! What surfaces send on to one receiver: the sum that a bounce is made of.

use crate::field::{BLOCK, Field};
use crate::receivers::Receivers;
use crate::senders::Sender;
use glam::Vec4;

/// Senders whose rows are read together: few enough for all to stay near the processor, many enough for sums to stay in its registers.
const GROUP: usize = 16;
/// Blocks that are summed together: they fit in registers.
const TOGETHER: usize = 8;

/// Adds what every sender of a receiver sends on: albedo times its transfer, times its share.
pub(crate) fn add_reflected(receivers: &Receivers, id: u32, senders: &[Sender], last: &Field, row: &mut [f32]) {
    let stride = last.row_len() / last.channels;
    let mut rows: [&[f32]; GROUP] = [&[]; GROUP];
    for group in senders.chunks(GROUP) {
        for (from, sender) in rows.iter_mut().zip(group) {
            *from = last.row(sender.resolve(receivers, id));
        }
        for (c, channel) in row.chunks_exact_mut(stride).enumerate() {
            let mut start = c * stride;
            for out in channel.chunks_mut(TOGETHER * BLOCK) {
                let sent = group.iter().map(|sender| sender.weight[c]).zip(rows.iter().copied());
                add(out, start, sent);
                start += out.len();
            }
        }
    }
}

/// Adds the weighted parts of rows from `start` on, in the order of the rows.
fn add<'a>(out: &mut [f32], start: usize, sent: impl Iterator<Item = (f32, &'a [f32])>) {
    match out.len() / BLOCK {
        1 => add_blocks::<1>(out, start, sent),
        2 => add_blocks::<2>(out, start, sent),
        3 => add_blocks::<3>(out, start, sent),
        4 => add_blocks::<4>(out, start, sent),
        5 => add_blocks::<5>(out, start, sent),
        6 => add_blocks::<6>(out, start, sent),
        7 => add_blocks::<7>(out, start, sent),
        _ => add_blocks::<TOGETHER>(out, start, sent),
    }
}

fn add_blocks<'a, const N: usize>(out: &mut [f32], start: usize, sent: impl Iterator<Item = (f32, &'a [f32])>) {
    let mut sums: [Vec4; N] = std::array::from_fn(|k| Vec4::from_slice(&out[k * BLOCK..]));
    for (weight, row) in sent {
        let from = &row[start..start + N * BLOCK];
        for (k, sum) in sums.iter_mut().enumerate() {
            *sum += weight * Vec4::from_slice(&from[k * BLOCK..]);
        }
    }
    for (sum, out) in sums.iter().zip(out.chunks_exact_mut(BLOCK)) {
        sum.write_to_slice(out);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::hit::{PackedHit, Source};
    use crate::senders::fill_row;

    /// Senders `0..count` by way of rows with one corner each.
    fn senders(count: usize) -> Vec<Sender> {
        let scene = scene::Scene::default();
        let world = crate::world::World::new(&scene, &|_| true, &|_| false).expect("an empty world");
        let hit = |k: usize| PackedHit {
            source: Source::Near(k as u32),
            is_back: false,
            barycentrics: [0.0; 2],
            reflected: [0.1 + k as f32 * 0.37 % 0.9, 0.7 - k as f32 * 0.11 % 0.6, 0.3],
        };
        let mut row = Vec::new();
        fill_row(&world, &(0..count).map(hit).collect::<Vec<_>>(), &mut row);
        row
    }

    fn field(count: usize, coefficients: usize, channels: usize) -> Field {
        let mut field = Field::zeros(count, coefficients, channels);
        for receiver in 0..count {
            let value = |k: usize| ((receiver * 131 + k * 37) % 101) as f32 / 50.0 - 0.99;
            field.set(receiver as u32, &(0..coefficients * channels).map(value).collect::<Vec<_>>());
        }
        field
    }

    /// Sender by sender and number by number, in f32: the same bits, for every number of bands and of senders about a group.
    fn one_by_one(senders: &[Sender], last: &Field, row: &mut [f32]) {
        let stride = last.row_len() / last.channels;
        for (number, sender) in senders.iter().enumerate() {
            for (k, out) in row.iter_mut().enumerate() {
                *out += sender.weight[k / stride] * last.row(number as u32)[k];
            }
        }
    }

    #[test]
    fn sums_are_those_taken_one_by_one() {
        for bands in 1..=10usize {
            for (count, channels) in [(0, 1), (1, 3), (15, 3), (16, 1), (17, 3), (50, 3)] {
                let (senders, last) = (senders(count), field(count.max(1), bands * bands, channels));
                let receivers = Receivers { near_of: vec![0], ..Receivers::of(&scene::Scene::default()) };
                let (mut row, mut expected) = (vec![0.25; last.row_len()], vec![0.25; last.row_len()]);
                add_reflected(&receivers, 0, &senders, &last, &mut row);
                one_by_one(&senders, &last, &mut expected);
                let bits = |row: &[f32]| row.iter().map(|x| x.to_bits()).collect::<Vec<_>>();
                assert_eq!(bits(&row), bits(&expected), "{bands} bands, {count} senders");
                // Twin: in the opposite order the sums round otherwise.
                let mut reversed = vec![0.25; last.row_len()];
                for (k, out) in reversed.iter_mut().enumerate() {
                    for (number, sender) in senders.iter().enumerate().rev() {
                        *out += sender.weight[k / (last.row_len() / channels)] * last.row(number as u32)[k];
                    }
                }
                assert!(count < 50 || bands < 3 || bits(&reversed) != bits(&expected), "can fail");
            }
        }
    }
}
