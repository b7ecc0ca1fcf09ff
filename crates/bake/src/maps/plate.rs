//! The texels of one sheet while they are worked on.

use glam::Vec2;

/// No slot, no chart.
pub(crate) const NONE: u32 = u32::MAX;

/// Texels that hold something have a slot, with a row of numbers; row 0 of the sheet is at v = 0.
#[derive(Debug, Clone)]
pub(crate) struct Plate {
    pub(crate) width: usize,
    pub(crate) height: usize,
    /// Numbers in a row.
    pub(crate) row_len: usize,
    /// Of each texel its slot, or [`NONE`].
    pub(crate) slot_of: Vec<u32>,
    /// Of each texel the chart that touches it, or [`NONE`].
    pub(crate) owner: Vec<u32>,
    /// Of each slot its texel.
    pub(crate) texel_of: Vec<u32>,
    /// Of each slot its chart.
    pub(crate) chart_of: Vec<u32>,
    /// Of each slot the slot that it took its frame from: itself where a surface is.
    pub(crate) model_of: Vec<u32>,
    /// `[slot][number]`.
    pub(crate) values: Vec<f32>,
    /// Slots of texels that no view shows.
    pub(crate) unseen: Vec<u32>,
    /// Slots whose numbers are those of a point beside the middle of their texel, with that point in texels.
    pub(crate) aside: Vec<(u32, Vec2)>,
}

impl Plate {
    pub(crate) fn empty([width, height]: [usize; 2], row_len: usize) -> Self {
        Self {
            width,
            height,
            row_len,
            slot_of: vec![NONE; width * height],
            owner: vec![NONE; width * height],
            texel_of: Vec::new(),
            chart_of: Vec::new(),
            model_of: Vec::new(),
            values: Vec::new(),
            unseen: Vec::new(),
            aside: Vec::new(),
        }
    }

    pub(crate) fn slots(&self) -> usize {
        self.texel_of.len()
    }

    /// Gives a texel a slot; its row is to be appended to the values.
    pub(crate) fn add_slot(&mut self, texel: usize, chart: u32) -> u32 {
        let slot = self.texel_of.len() as u32;
        self.slot_of[texel] = slot;
        self.owner[texel] = chart;
        self.texel_of.push(texel as u32);
        self.chart_of.push(chart);
        self.model_of.push(slot);
        slot
    }

    /// Fills texels that a chart touches but that have no slot, from their own chart: those that could not see. Returns how many stay empty.
    pub(crate) fn mend(&mut self) -> usize {
        let all = 0..self.slot_of.len();
        let mut missing: Vec<usize> = all.filter(|&t| self.owner[t] != NONE && self.slot_of[t] == NONE).collect();
        while !missing.is_empty() && self.grow(missing.iter().copied()) {
            missing.retain(|&t| self.slot_of[t] == NONE);
        }
        missing.len()
    }

    /// Fills one more ring of empty texels around every chart, each from one chart alone.
    pub(crate) fn dilate(&mut self) {
        let empty: Vec<usize> = (0..self.slot_of.len()).filter(|&t| self.owner[t] == NONE).collect();
        self.grow(empty.into_iter());
    }

    /// Gives each of the texels that has neighbours with slots the mean of those of one chart; whether any had.
    fn grow(&mut self, texels: impl Iterator<Item = usize>) -> bool {
        let before = self.slots();
        let found: Vec<(usize, u32, Vec<u32>)> = texels
            .filter_map(|texel| {
                let around = self.around(texel);
                let chart = match self.owner[texel] {
                    NONE => most(around.iter().map(|&slot| self.chart_of[slot as usize]))?,
                    own => own,
                };
                let own: Vec<u32> = around.into_iter().filter(|&slot| self.chart_of[slot as usize] == chart).collect();
                (!own.is_empty()).then_some((texel, chart, own))
            })
            .collect();
        for (texel, chart, own) in found {
            let slot = self.add_slot(texel, chart);
            self.model_of[slot as usize] = self.model_of[own[0] as usize];
            let share = 1.0 / own.len() as f32;
            let start = self.values.len();
            self.values.resize(start + self.row_len, 0.0);
            for source in own {
                let (filled, row) = self.values.split_at_mut(start);
                let source = &filled[source as usize * self.row_len..][..self.row_len];
                row.iter_mut().zip(source).for_each(|(sum, value)| *sum += share * value);
            }
        }
        self.slots() > before
    }

    /// Slots of the eight texels around one.
    fn around(&self, texel: usize) -> Vec<u32> {
        let (column, row) = (texel % self.width, texel / self.width);
        let mut out = Vec::new();
        for y in row.saturating_sub(1)..(row + 2).min(self.height) {
            for x in column.saturating_sub(1)..(column + 2).min(self.width) {
                let slot = self.slot_of[y * self.width + x];
                if slot != NONE && (x, y) != (column, row) {
                    out.push(slot);
                }
            }
        }
        out
    }
}

/// The most frequent number, of several the smallest.
fn most(numbers: impl Iterator<Item = u32>) -> Option<u32> {
    let mut sorted: Vec<u32> = numbers.collect();
    sorted.sort_unstable();
    let groups = sorted.chunk_by(|a, b| a == b);
    groups.max_by_key(|group| (group.len(), std::cmp::Reverse(group[0]))).map(|group| group[0])
}

#[cfg(test)]
mod tests {
    use super::{NONE, Plate};

    /// Two charts of one column each, with `gap` empty columns between them.
    fn two(gap: usize) -> Plate {
        let mut plate = Plate::empty([gap + 4, 4], 1);
        for row in 0..4 {
            for (column, chart) in [(1, 0), (gap + 2, 1)] {
                plate.add_slot(row * (gap + 4) + column, chart);
                plate.values.push(chart as f32);
            }
        }
        plate
    }

    /// No texel holds a mixture, however the rings meet.
    #[test]
    fn charts_do_not_mix() {
        for gap in 1..5 {
            let mut plate = two(gap);
            (0..4).for_each(|_| plate.dilate());
            assert_eq!(plate.slots(), 4 * (gap + 4), "all texels are filled");
            for slot in 0..plate.slots() {
                assert_eq!(plate.values[slot], plate.chart_of[slot] as f32, "gap {gap}");
            }
        }
    }

    /// A texel that could not see is mended from its own chart, though another is as near.
    #[test]
    fn the_blind_are_mended_from_their_own_chart() {
        let mut plate = two(1);
        plate.owner[7] = 1;
        assert_eq!(plate.mend(), 0);
        let slot = plate.slot_of[7];
        assert_eq!(plate.values[slot as usize], 1.0);
        let mut alone = Plate::empty([3, 3], 1);
        alone.owner[4] = 7;
        assert_eq!((alone.mend(), alone.slot_of[4]), (1, NONE), "nothing to mend it from");
    }
}
