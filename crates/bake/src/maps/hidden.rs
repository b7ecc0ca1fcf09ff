//! Texels that no view shows: under a shell that is drawn from its other side alone, or in a gap that is lower than a texel is large.
//!
//! They are dark, and filters would draw their darkness out along the rim of the shell or of the gap, by a texel here and by two there. Those
//! beside texels that are seen take the light of these; the others keep their own.

use super::plate::{NONE, Plate};
use crate::arrival::Arrival;
use crate::repair;
use scene::lightmap::Texel;
use std::ops::Range;

/// Texels from one that is seen up to which filters read.
const READ: usize = 2;

/// A texel that no view shows.
pub(crate) struct Hidden {
    /// Its place in the sheet.
    pub(crate) place: usize,
    /// What arrives there.
    pub(crate) row: Vec<f32>,
}

/// Whether what is found at a texel of some extent on its surface tells that no view shows it.
pub(crate) fn is_hidden(arrival: &Arrival, extent: f32) -> bool {
    repair::is_hidden_texel(arrival.openness, arrival.behind_share) || arrival.cover < extent
}

/// Fills texels inside of bodies from their chart, and hidden ones near those that are seen. Returns the hidden ones of charts that have none of
/// these; they stay empty.
pub(crate) fn mend(plate: &mut Plate, hidden: Vec<Hidden>) -> Vec<Hidden> {
    let far: Vec<bool> = hidden.iter().map(|one| !is_read(plate, one.place)).collect();
    let seen = plate.slots() as u32;
    plate.mend();
    plate.unseen.extend(seen..plate.slots() as u32);
    let mut empty = Vec::new();
    for one in hidden.into_iter().zip(far).filter(|(_, far)| *far).map(|(one, _)| one) {
        match plate.slot_of[one.place] {
            NONE => empty.push(one),
            slot => plate.values[slot as usize * plate.row_len..][..plate.row_len].copy_from_slice(&one.row),
        }
    }
    empty
}

/// Gives texels whose chart has nothing to mend them with rows of their own, made from the vertices around them. Returns the slots.
pub(crate) fn fill(plate: &mut Plate, texels: &[Texel], mut row: impl FnMut(&Texel, usize) -> Vec<f32>) -> Range<u32> {
    let first = plate.slots() as u32;
    for texel in texels {
        let place = texel.row as usize * plate.width + texel.column as usize;
        if plate.slot_of[place] == NONE {
            plate.add_slot(place, plate.owner[place]);
            plate.values.extend(row(texel, place));
        }
    }
    let filled = first..plate.slots() as u32;
    plate.unseen.extend(filled.clone());
    filled
}

/// Whether a texel of its chart that is seen lies so near that filters read both.
fn is_read(plate: &Plate, place: usize) -> bool {
    let (column, row) = (place % plate.width, place / plate.width);
    let columns = column.saturating_sub(READ)..(column + READ + 1).min(plate.width);
    let of_chart = |&slot: &u32| slot != NONE && plate.chart_of[slot as usize] == plate.owner[place];
    (row.saturating_sub(READ)..(row + READ + 1).min(plate.height))
        .any(|y| plate.slot_of[y * plate.width..][columns.clone()].iter().any(of_chart))
}
