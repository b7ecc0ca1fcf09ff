//! Choice among many by weight: lists and pictures.

/// A list of weights prepared for sampling.
#[derive(Debug, Clone, PartialEq)]
pub struct Table1d {
    /// `cumulative[i]` is the sum of the weights before `i`; one longer than the list.
    cumulative: Vec<f64>,
    /// The entry at each share `k / n` of the total, k = 0..=n: the search starts between two of them, so it takes the
    /// same few steps for any n (Chen and Asau 1974).
    guide: Vec<u32>,
}

/// One entry of a [`Table1d`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Choice {
    /// Which entry.
    pub index: usize,
    /// What is left of the random number, again uniform in `[0, 1)`.
    pub remapped: f64,
    /// With which probability the entry is chosen; never 0.
    pub probability: f64,
}

impl Table1d {
    /// Prepares non-negative weights; none where a weight is negative or not finite, or all are 0.
    #[must_use]
    pub fn new(weights: &[f32]) -> Option<Self> {
        let valid = weights.iter().all(|w| w.is_finite() && *w >= 0.0);
        valid.then(|| Self::from_sums(weights.iter().map(|&w| f64::from(w))))?
    }

    fn from_sums(weights: impl Iterator<Item = f64>) -> Option<Self> {
        let mut sum = 0.0;
        let mut cumulative = vec![sum];
        cumulative.extend(weights.map(|weight| {
            sum += weight;
            sum
        }));
        (sum > 0.0).then(|| {
            let guide = guide(&cumulative, sum);
            Self { cumulative, guide }
        })
    }

    /// Sum of the weights.
    #[must_use]
    pub fn total(&self) -> f64 {
        *self.cumulative.last().expect("a table holds at least the zero it starts with")
    }

    /// The entry at the share `u` in `[0, 1)` of the total; an entry of weight 0 is never chosen.
    #[must_use]
    pub fn sample(&self, u: f64) -> Choice {
        let total = self.total();
        // Rounding may lift u * total to the total itself, where a weight of 0 could lie.
        let target = (u * total).min(total.next_down()).max(0.0);
        let index = self.find(u, target);
        let weight = self.weight(index);
        let remapped = ((target - self.cumulative[index]) / weight).clamp(0.0, 1.0_f64.next_down());
        Choice { index, remapped, probability: weight / total }
    }

    /// The entry with `cumulative[i] <= target < cumulative[i + 1]`.
    fn find(&self, u: f64, target: f64) -> usize {
        let n = self.guide.len() - 1;
        let k = ((u * n as f64) as usize).min(n - 1);
        let (first, last) = (self.guide[k] as usize, self.guide[k + 1] as usize);
        // Rounding of u * n can put a target just outside its pair of guides.
        if self.cumulative[first] <= target && target < self.cumulative[last + 1] {
            return first + self.cumulative[first + 1..=last].partition_point(|&c| c <= target);
        }
        self.cumulative.partition_point(|&c| c <= target) - 1
    }

    /// Probability of an entry.
    #[must_use]
    pub fn probability(&self, index: usize) -> f64 {
        self.weight(index) / self.total()
    }

    #[inline]
    fn weight(&self, index: usize) -> f64 {
        self.cumulative[index + 1] - self.cumulative[index]
    }
}

/// Entries at equal steps of the total, in one pass.
fn guide(cumulative: &[f64], total: f64) -> Vec<u32> {
    let n = cumulative.len() - 1;
    let mut index = 0;
    let step = |k: usize| {
        let target = k as f64 / n as f64 * total;
        // The last target is the total itself: stay on the last entry.
        while index + 1 < n && cumulative[index + 1] <= target {
            index += 1;
        }
        index as u32
    };
    (0..=n).map(step).collect()
}

/// A picture of weights prepared for sampling: a row first, then a column in it.
#[derive(Debug, Clone, PartialEq)]
pub struct Table2d {
    rows: Table1d,
    /// One table per row; none for a row of zeros.
    columns: Vec<Option<Table1d>>,
}

/// One cell of a [`Table2d`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Cell {
    /// Column and row.
    pub position: [usize; 2],
    /// What is left of the random numbers: a uniform position within the cell, along column and row.
    pub remapped: [f64; 2],
    /// With which probability the cell is chosen; never 0.
    pub probability: f64,
}

impl Table2d {
    /// Prepares `weights`, row by row of `width`; none where [`Table1d::new`] gives none or the rows are not full.
    #[must_use]
    pub fn new(width: usize, weights: &[f32]) -> Option<Self> {
        if width == 0 || !weights.len().is_multiple_of(width) {
            return None;
        }
        if !weights.iter().all(|w| w.is_finite() && *w >= 0.0) {
            return None;
        }
        let columns: Vec<_> = weights.chunks_exact(width).map(Table1d::new).collect();
        let totals = columns.iter().map(|row| row.as_ref().map_or(0.0, Table1d::total));
        Some(Self { rows: Table1d::from_sums(totals)?, columns })
    }

    /// Sum of the weights.
    #[must_use]
    pub fn total(&self) -> f64 {
        self.rows.total()
    }

    /// The cell at the shares `u` (along the columns, along the rows) in `[0, 1)²`.
    #[must_use]
    pub fn sample(&self, u: [f64; 2]) -> Cell {
        let row = self.rows.sample(u[1]);
        let columns = self.columns[row.index].as_ref().expect("a row that can be chosen has a weight");
        let column = columns.sample(u[0]);
        Cell {
            position: [column.index, row.index],
            remapped: [column.remapped, row.remapped],
            probability: row.probability * column.probability,
        }
    }

    /// Probability of a cell by column and row.
    #[must_use]
    pub fn probability(&self, [column, row]: [usize; 2]) -> f64 {
        self.columns[row].as_ref().map_or(0.0, |columns| self.rows.probability(row) * columns.probability(column))
    }
}
