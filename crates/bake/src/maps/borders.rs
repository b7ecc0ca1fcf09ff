//! Texels at the borders of charts hold what the filter is to read at their points.
//!
//! A texel whose middle lies outside of its chart stands for a point inside. Filters take its numbers for those of its middle, so what falls off
//! towards a border would go on by up to half a texel there, as the steps of the border have it: in scallops. Such texels are solved for, so that
//! filters read at every such point what was found there; nearly always that carries the fall on outwards.

use super::join::bilinear;
use super::plate::Plate;
use super::stitch::{Agreement, Part, settle};
use std::collections::BTreeMap;

/// Weight of staying as it was, against what the filter reads at a point: enough where two points are nearly one.
const STAY: f32 = 0.01;

/// Moves the texels of a plate that stand for points beside their middles; once charts have a ring around them. Its rows have these parts.
pub(crate) fn read_back(plate: &mut Plate, parts: &[Part]) {
    let Plate { row_len, .. } = *plate;
    let wanted: Vec<(u32, Agreement)> = plate.aside.iter().filter_map(|&(slot, at)| own(plate, slot, at)).collect();
    let mut slots: Vec<u32> = wanted.iter().map(|(slot, _)| *slot).collect();
    let free = slots.len();
    let mut place: BTreeMap<u32, u32> = slots.iter().copied().zip(0..).collect();
    let mut agreements: Vec<Agreement> = Vec::with_capacity(free);
    for (_, weights) in &wanted {
        let mut local = |&(slot, weight): &(u32, f32)| {
            let next = slots.len() as u32;
            let index = *place.entry(slot).or_insert(next);
            if index == next {
                slots.push(slot);
            }
            (index, weight)
        };
        agreements.push(weights.iter().map(&mut local).collect());
    }
    // What was found there, which stays.
    for (k, agreement) in agreements.iter_mut().enumerate() {
        agreement.push((slots.len() as u32, -1.0));
        slots.push(slots[k]);
    }
    settle(&agreements, &slots, &vec![STAY; free], (parts, row_len), &mut plate.values);
}

/// What the filter reads at the point that a slot stands for, where all of that is of its chart.
fn own(plate: &Plate, slot: u32, at: glam::Vec2) -> Option<(u32, Agreement)> {
    let read = bilinear(plate, at);
    let chart = plate.chart_of[slot as usize];
    let is_own = read.iter().all(|&(other, _)| plate.chart_of[other as usize] == chart);
    (is_own && read.iter().any(|&(other, _)| other == slot)).then_some((slot, read))
}

#[cfg(test)]
mod tests {
    use super::read_back;
    use crate::maps::plate::{NONE, Plate};
    use crate::maps::stitch::Part;
    use glam::Vec2;

    /// One number a row, of one channel.
    const ONE: [Part; 1] = [Part { numbers: 0..1, means: 1 }];

    /// Light that rises by 1 a texel from the border of a half-plane on, `x cos + y sin = 2.3`, as it is found at the points of texels; also the
    /// slots of texels whose middles lie outside.
    fn slope(turn: f32) -> (Plate, impl Fn(Vec2) -> f32) {
        let towards = Vec2::new(libm::cosf(turn), libm::sinf(turn));
        let height = move |at: Vec2| at.dot(towards) - 2.3;
        let mut plate = Plate::empty([16, 16], 1);
        for texel in 0..256 {
            let low = Vec2::new((texel % 16) as f32, (texel / 16) as f32);
            let parts = (0..400).map(|k| low + (Vec2::new((k % 20) as f32, (k / 20) as f32) + 0.5) / 20.0);
            let held: Vec<Vec2> = parts.filter(|&at| height(at) > 0.0).collect();
            if held.is_empty() {
                continue;
            }
            let is_middle = height(low + 0.5) > 0.0;
            let at = if is_middle { low + 0.5 } else { held.iter().sum::<Vec2>() / held.len() as f32 };
            let slot = plate.add_slot(texel, 0);
            plate.values.push(1.0 + height(at));
            if !is_middle {
                plate.aside.push((slot, at));
            }
        }
        (plate, height)
    }

    /// The largest error of what a filter, written out here, reads near the border.
    fn worst(plate: &Plate, height: &dyn Fn(Vec2) -> f32) -> f32 {
        let texel = |x: usize, y: usize| plate.slot_of[y * 16 + x];
        let mut worst = 0.0f32;
        for k in 0..160 * 160 {
            let at = Vec2::new((k % 160) as f32, (k / 160) as f32) / 10.0;
            let (x, y) = (at.x - 0.5, at.y - 0.5);
            if !(0.0..1.0).contains(&height(at)) || !(1.0..14.0).contains(&x) || !(1.0..14.0).contains(&y) {
                continue;
            }
            let (i, j) = (x as usize, y as usize);
            let slots = [texel(i, j), texel(i + 1, j), texel(i, j + 1), texel(i + 1, j + 1)];
            if slots.contains(&NONE) {
                continue;
            }
            let [a, b, c, d] = slots.map(|slot| plate.values[slot as usize]);
            let (u, v) = (x - i as f32, y - j as f32);
            let read = (1.0 - v) * ((1.0 - u) * a + u * b) + v * ((1.0 - u) * c + u * d);
            worst = worst.max((read - 1.0 - height(at)).abs());
        }
        worst
    }

    /// What is linear is read as it is, up to the border, however this lies among the texels.
    #[test]
    fn a_slope_goes_on_to_the_border() {
        for turn in [0.0, 0.3, 0.61, 0.9, 1.3] {
            let (mut plate, height) = slope(turn);
            let before = worst(&plate, &height);
            read_back(&mut plate, &ONE);
            let after = worst(&plate, &height);
            assert!(after < 0.05, "{turn}: {after}, {before} before");
        }
    }

    /// The same numbers in the middles of their texels are off by up to half a texel.
    #[test]
    fn a_slope_goes_on_to_the_border_can_fail() {
        let (plate, height) = slope(0.61);
        assert!(worst(&plate, &height) > 0.2);
    }

    /// Where one number is everywhere nothing moves, and what falls steeply is never less than nothing.
    #[test]
    fn what_is_even_stays_and_nothing_is_less_than_none() {
        let (mut plate, _) = slope(0.61);
        plate.values.fill(0.5);
        read_back(&mut plate, &ONE);
        assert!(plate.values.iter().all(|value| (value - 0.5).abs() < 1e-6));
        let (mut plate, _) = slope(0.61);
        plate.values.iter_mut().for_each(|value| *value = (*value - 1.0).max(0.0));
        read_back(&mut plate, &ONE);
        assert!(plate.values.iter().all(|value| *value >= 0.0));
    }

    /// Least number of a plate whose red and blue are even and whose green falls to none, where so many channels are held.
    fn least(means: usize) -> f32 {
        let (mut plate, _) = slope(0.61);
        plate.row_len = 3;
        plate.values = plate.values.iter().flat_map(|value| [1.0, (value - 1.0).max(0.0), 1.0]).collect();
        read_back(&mut plate, &[Part { numbers: 0..3, means }]);
        let even = plate.values.iter().enumerate().filter(|(k, _)| k % 3 != 1);
        assert!(even.into_iter().all(|(_, value)| (value - 1.0).abs() < 1e-6));
        plate.values.iter().copied().fold(f32::INFINITY, f32::min)
    }

    #[test]
    fn no_channel_is_less_than_none() {
        assert!(least(3) >= 0.0, "{}", least(3));
    }

    /// Red tells nothing of green.
    #[test]
    fn no_channel_is_less_than_none_can_fail() {
        assert!(least(1) < -0.01, "{}", least(1));
    }
}
