//! The comparison as a plot: error as drawn against bytes.

use super::{Comparison, ENCODINGS};
use crate::front::front;
use crate::plot::chart::{Chart, Label, Series, Unit};

impl Comparison {
    /// Error as drawn against bytes of the light maps, a kind of points for each encoding, with the front and a ring around what is
    /// recommended.
    #[must_use]
    pub fn chart(&self) -> Chart {
        let at = |(row, stored): (usize, usize)| {
            let stored = &self.rows[row].stored[stored];
            [stored.bytes as f64, stored.drawn.rms]
        };
        let rows = 0..self.rows.len();
        let kind = |index: usize| Series {
            name: ENCODINGS[index].id().to_owned(),
            points: rows.clone().map(|row| at((row, index))).collect(),
        };
        let pairs: Vec<(usize, usize)> =
            rows.clone().flat_map(|row| (0..ENCODINGS.len()).map(move |stored| (row, stored))).collect();
        let points: Vec<[f64; 2]> = pairs.iter().map(|&pair| at(pair)).collect();
        let best: Vec<(usize, usize)> = front(&points).into_iter().map(|index| pairs[index]).collect();
        let chosen = (self.choice.row, self.choice.stored);
        let word = |pair: (usize, usize)| Label { at: at(pair), text: self.rows[pair.0].basis.name().to_owned() };
        // Then one point of each basis, in the first of the small encodings.
        let others = rows.clone().map(|row| (row, 1));
        Chart {
            x: ("bytes of the light maps".into(), Unit::Bytes),
            y: ("relative error as drawn, rms".into(), Unit::Share),
            series: (0..ENCODINGS.len()).map(kind).collect(),
            front: best.iter().map(|&pair| at(pair)).collect(),
            labels: std::iter::once(chosen).chain(best.iter().copied()).chain(others).map(word).collect(),
            chosen: Some(at(chosen)),
        }
    }
}
