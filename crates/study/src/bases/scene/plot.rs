//! The comparison as a plot: error as drawn against bytes.

use super::{Comparison, ENCODINGS};
use crate::front::front;
use crate::plot::chart::{Chart, Label, Series, Unit};
use std::ops::Range;

/// The encodings that are shown: all but f32, which takes twice the bytes of f16 for the same error.
const SHOWN: Range<usize> = 1..ENCODINGS.len();

impl Comparison {
    /// Error as drawn against bytes of the light maps, a kind of points for each encoding but f32, with the front and a ring around what is
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
        let pairs: Vec<(usize, usize)> = rows.clone().flat_map(|row| SHOWN.map(move |stored| (row, stored))).collect();
        let points: Vec<[f64; 2]> = pairs.iter().map(|&pair| at(pair)).collect();
        let best: Vec<(usize, usize)> = front(&points).into_iter().map(|index| pairs[index]).collect();
        let chosen = (self.choice.row, self.choice.stored);
        Chart {
            x: ("bytes of the light maps".into(), Unit::Bytes),
            y: ("relative error as drawn, rms".into(), Unit::Share),
            series: SHOWN.map(kind).collect(),
            front: best.iter().map(|&pair| at(pair)).collect(),
            labels: self.labelled(chosen, &best).map(|(pair, text)| Label { at: at(pair), text }).collect(),
            chosen: Some(at(chosen)),
        }
    }

    /// Points with names: what is recommended, the front, then one of each other basis.
    fn labelled(
        &self,
        chosen: (usize, usize),
        best: &[(usize, usize)],
    ) -> impl Iterator<Item = ((usize, usize), String)> {
        let front = best.iter().copied().filter(move |&pair| pair != chosen);
        let mut pairs: Vec<(usize, usize)> = std::iter::once(chosen).chain(front).collect();
        for row in 0..self.rows.len() {
            if pairs.iter().all(|pair| pair.0 != row) {
                pairs.push((row, SHOWN.start));
            }
        }
        pairs.into_iter().map(|pair| (pair, self.rows[pair.0].basis.name().to_owned()))
    }
}
