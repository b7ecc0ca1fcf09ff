//! Texels that no view shows: under a shell that is drawn from its other side alone.
//!
//! They are dark, and filters would draw their darkness out along the rim of the shell. Those beside texels that are seen take the light of
//! these; the others keep their own.

use super::Gathered;
use crate::arrival::{Arrival, Shape};
use scene::lightmap::Texel;

/// Open share below which a texel may be hidden.
const OPEN: f32 = 0.02;
/// More than this share of what it sees being the backs of surfaces with one side means that it is.
const BEHIND: f32 = 0.5;
/// Texels from one that is seen up to which filters read.
const READ: usize = 2;

/// A texel that no view shows.
pub(super) struct Hidden {
    pub(super) texel: Texel,
    /// Its place in the sheet.
    pub(super) place: usize,
    /// What arrives there.
    pub(super) row: Vec<f32>,
}

/// Whether what is found at a texel tells that no view shows it.
pub(super) fn is_hidden(arrival: &Arrival) -> bool {
    arrival.openness < OPEN && arrival.behind_share > BEHIND
}

impl Gathered {
    /// Fills texels inside of bodies from their chart, and hidden ones near those that are seen.
    pub(super) fn mend(&mut self, shape: Shape) {
        let far: Vec<bool> = self.hidden.iter().map(|one| !self.is_read(one)).collect();
        self.plate.mend();
        let hidden = std::mem::take(&mut self.hidden);
        for one in hidden.into_iter().zip(far).filter(|(_, far)| *far).map(|(one, _)| one) {
            let slot = self.plate.slot_of[one.place];
            if slot == super::plate::NONE {
                self.inside.push(one.texel);
            } else {
                self.plate.values[slot as usize * shape.len()..][..shape.len()].copy_from_slice(&one.row);
            }
        }
    }

    /// Whether a texel of its chart that is seen lies so near that filters read both.
    fn is_read(&self, one: &Hidden) -> bool {
        let plate = &self.plate;
        let (column, row) = (one.place % plate.width, one.place / plate.width);
        let columns = column.saturating_sub(READ)..(column + READ + 1).min(plate.width);
        (row.saturating_sub(READ)..(row + READ + 1).min(plate.height)).any(|y| {
            let line = &plate.slot_of[y * plate.width..][columns.clone()];
            let of_chart =
                |&slot: &u32| slot != super::plate::NONE && plate.chart_of[slot as usize] == plate.owner[one.place];
            line.iter().any(of_chart)
        })
    }
}
