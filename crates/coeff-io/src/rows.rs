//! Rows of numbers, one per receiver, exact or as a short combination of shared vectors.

use crate::layers::f32_at;
use half::f16;
use serde::{Deserialize, Serialize};

/// A table of numbers: one row per receiver.
#[derive(Debug, Clone, PartialEq)]
pub struct Table {
    /// Number of receivers, at least 1.
    pub rows: u32,
    /// Numbers per receiver.
    pub columns: u32,
    /// How the numbers are held.
    pub form: Form,
    /// `[row][column]` little-endian, or for [`Form::Clustered`] `[row]` u16 clusters and `[row][vector]` f16 weights.
    pub bytes: Vec<u8>,
}

/// How a table holds its numbers.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Form {
    /// Little-endian f32.
    F32,
    /// Little-endian IEEE 754 half.
    F16,
    /// By the means and vectors of a [`Codebook`]: `row = mean[cluster] + sum_i weight_i vector[cluster][i]`, clustered principal
    /// components (P.-P. Sloan et al., "Clustered Principal Components for Precomputed Radiance Transfer", 2003).
    Clustered,
}

/// Means and vectors that many rows share.
#[derive(Debug, Clone, PartialEq)]
pub struct Codebook {
    /// Numbers per vector.
    pub columns: u32,
    /// Number of clusters, 1 to 65,536.
    pub clusters: u32,
    /// Vectors of each cluster beside its mean; may be 0.
    pub rank: u32,
    /// Vectors that all clusters share, of which their means and vectors are combinations; 0 where these stand in full.
    pub shared: u32,
    /// `[cluster][mean, then vectors][column]` f16; with shared vectors `[cluster][mean, then vectors][shared]`, then `[shared][column]`.
    pub bytes: Vec<u8>,
}

impl Codebook {
    /// From `[cluster][mean, then vectors][column]`.
    ///
    /// # Panics
    /// When there are not `clusters * (1 + rank) * columns` values.
    #[must_use]
    pub fn new([columns, clusters, rank]: [u32; 3], values: &[f32]) -> Self {
        let expected = columns as usize * clusters as usize * (1 + rank as usize);
        assert_eq!(values.len(), expected, "a mean and vectors per cluster");
        Self { columns, clusters, rank, shared: 0, bytes: halves(values) }
    }

    /// From means and vectors as combinations, `[cluster][mean, then vectors][shared]`, of shared vectors, `[shared][column]`.
    ///
    /// # Panics
    /// When there are not as many values.
    #[must_use]
    pub fn factored([columns, clusters, rank]: [u32; 3], combinations: &[f32], vectors: &[f32]) -> Self {
        let shared = vectors.len() / columns as usize;
        let expected = shared * clusters as usize * (1 + rank as usize);
        assert!(shared > 0 && vectors.len() == shared * columns as usize, "whole vectors");
        assert_eq!(combinations.len(), expected, "a mean and vectors per cluster");
        let mut bytes = halves(combinations);
        bytes.extend(halves(vectors));
        Self { columns, clusters, rank, shared: shared as u32, bytes }
    }

    /// Numbers of a mean or vector as it stands.
    fn width(&self) -> usize {
        if self.shared > 0 { self.shared as usize } else { self.columns as usize }
    }

    /// Means and vectors as they stand, `[cluster][mean, then vectors][column or shared]`.
    #[must_use]
    pub fn own(&self) -> Vec<f32> {
        let count = self.clusters as usize * (1 + self.rank as usize) * self.width();
        self.bytes[..2 * count].chunks_exact(2).map(half).collect()
    }

    /// The shared vectors, `[shared][column]`; empty where there are none.
    #[must_use]
    pub fn shared_vectors(&self) -> Vec<f32> {
        let count = self.clusters as usize * (1 + self.rank as usize) * self.width();
        if self.shared > 0 { self.bytes[2 * count..].chunks_exact(2).map(half).collect() } else { Vec::new() }
    }

    /// The mean (0) or a vector (from 1 on) of a cluster.
    ///
    /// # Panics
    /// When there is no such vector.
    #[must_use]
    pub fn vector(&self, cluster: u32, number: u32) -> Vec<f32> {
        assert!(cluster < self.clusters && number <= self.rank, "vector {number} of cluster {cluster}");
        let width = self.width();
        let start = (cluster as usize * (1 + self.rank as usize) + number as usize) * width;
        let own: Vec<f32> = self.bytes[2 * start..2 * (start + width)].chunks_exact(2).map(half).collect();
        if self.shared > 0 { self.expanded(&own, &self.shared_vectors()) } else { own }
    }

    /// All means and vectors in full, `[cluster][mean, then vectors][column]`.
    #[must_use]
    pub fn values(&self) -> Vec<f32> {
        let own = self.own();
        if self.shared == 0 {
            return own;
        }
        let vectors = self.shared_vectors();
        own.chunks_exact(self.width()).flat_map(|own| self.expanded(own, &vectors)).collect()
    }

    /// Writes a mean and weighted vectors of a cluster; `shared` are the shared vectors.
    fn combine(&self, cluster: u32, weights: impl Iterator<Item = f32>, shared: &[f32], out: &mut [f32]) {
        let width = self.width();
        let first = cluster as usize * (1 + self.rank as usize);
        let mut own = vec![0.0f32; width];
        for (number, weight) in (first..).zip(std::iter::once(1.0).chain(weights)) {
            let vector = self.bytes[2 * number * width..2 * (number + 1) * width].chunks_exact(2).map(half);
            own.iter_mut().zip(vector).for_each(|(x, v)| *x += weight * v);
        }
        let full = if self.shared > 0 { self.expanded(&own, shared) } else { own };
        out.copy_from_slice(&full);
    }

    fn expanded(&self, own: &[f32], vectors: &[f32]) -> Vec<f32> {
        let mut out = vec![0.0f32; self.columns as usize];
        for (factor, vector) in own.iter().zip(vectors.chunks_exact(self.columns as usize)) {
            out.iter_mut().zip(vector).for_each(|(x, v)| *x += factor * v);
        }
        out
    }

    /// What is wrong, in half a sentence; none where all is sound.
    pub(crate) fn fault(&self) -> Option<String> {
        let product = |sizes: [usize; 3]| sizes.into_iter().try_fold(2_usize, |product, n| product.checked_mul(n));
        let own = product([self.width(), self.clusters as usize, (self.rank as usize).saturating_add(1)]);
        let shared = product([self.shared as usize, self.columns as usize, 1]);
        let bytes = own.zip(shared).and_then(|(own, shared)| own.checked_add(shared));
        if self.columns == 0 || !(1..=1 << 16).contains(&self.clusters) || bytes != Some(self.bytes.len()) {
            return Some(format!(
                "{} bytes are not {} clusters of a mean and {} vectors of {} numbers",
                self.bytes.len(),
                self.clusters,
                self.rank,
                self.columns
            ));
        }
        infinite(&self.bytes, 2)
    }
}

impl Table {
    /// Exact numbers, `[row][column]`.
    ///
    /// # Panics
    /// When the values fill no whole number of rows.
    #[must_use]
    pub fn exact(columns: u32, values: &[f32]) -> Self {
        let bytes = values.iter().flat_map(|value| value.to_le_bytes()).collect();
        Self { rows: rows_of(values.len(), columns), columns, form: Form::F32, bytes }
    }

    /// The same in half precision; numbers beyond its range are brought to its border.
    ///
    /// # Panics
    /// When the values fill no whole number of rows.
    #[must_use]
    pub fn half(columns: u32, values: &[f32]) -> Self {
        Self { rows: rows_of(values.len(), columns), columns, form: Form::F16, bytes: halves(values) }
    }

    /// Rows as combinations of the vectors of a codebook: `weights` are `[row][vector]`.
    ///
    /// # Panics
    /// When there are not `rank` weights per row.
    #[must_use]
    pub fn clustered(book: &Codebook, clusters: &[u16], weights: &[f32]) -> Self {
        assert_eq!(weights.len(), clusters.len() * book.rank as usize, "a weight per row and vector");
        let mut bytes: Vec<u8> = clusters.iter().flat_map(|c| c.to_le_bytes()).collect();
        bytes.extend(halves(weights));
        Self { rows: clusters.len() as u32, columns: book.columns, form: Form::Clustered, bytes }
    }

    /// Cluster of a row of a clustered table.
    #[must_use]
    pub fn cluster(&self, row: u32) -> u16 {
        let at = 2 * row as usize;
        u16::from_le_bytes([self.bytes[at], self.bytes[at + 1]])
    }

    /// Weights of a row of a clustered table of so many vectors.
    pub fn weights(&self, rank: u32, row: u32) -> impl Iterator<Item = f32> + '_ {
        let start = 2 * (self.rows as usize + row as usize * rank as usize);
        self.bytes[start..start + 2 * rank as usize].chunks_exact(2).map(half)
    }

    /// Writes the numbers of a row; `book` is that of the table where it is clustered.
    ///
    /// # Panics
    /// When the row does not exist, `out` is not `columns` long, or a clustered table comes without its book.
    pub fn read(&self, book: Option<&Codebook>, row: u32, out: &mut [f32]) {
        let columns = self.columns as usize;
        assert_eq!(out.len(), columns, "one number per column");
        let start = row as usize * columns;
        match self.form {
            Form::F32 => out.iter_mut().enumerate().for_each(|(i, x)| *x = f32_at(&self.bytes, 4 * (start + i))),
            Form::F16 => {
                let row = self.bytes[2 * start..2 * (start + columns)].chunks_exact(2);
                out.iter_mut().zip(row).for_each(|(x, b)| *x = half(b));
            }
            Form::Clustered => {
                let book = book.expect("a clustered table has a book");
                let cluster = u32::from(self.cluster(row));
                book.combine(cluster, self.weights(book.rank, row), &book.shared_vectors(), out);
            }
        }
    }

    /// All numbers, `[row][column]`.
    ///
    /// # Panics
    /// As [`Table::read`].
    #[must_use]
    pub fn decode(&self, book: Option<&Codebook>) -> Vec<f32> {
        let mut values = vec![0.0; self.rows as usize * self.columns as usize];
        if let (Form::Clustered, Some(book)) = (self.form, book) {
            let shared = book.shared_vectors();
            for (row, out) in (0..).zip(values.chunks_exact_mut(self.columns.max(1) as usize)) {
                book.combine(u32::from(self.cluster(row)), self.weights(book.rank, row), &shared, out);
            }
            return values;
        }
        for (row, out) in (0..).zip(values.chunks_exact_mut(self.columns.max(1) as usize)) {
            self.read(book, row, out);
        }
        values
    }

    /// The first byte that is wrong and what is; none where all is sound.
    pub(crate) fn fault(&self, book: Option<&Codebook>) -> Option<(usize, String)> {
        let (rows, columns) = (self.rows as usize, self.columns as usize);
        let expected = match (self.form, book) {
            (Form::F32, _) => rows.checked_mul(columns).and_then(|n| n.checked_mul(4)),
            (Form::F16, _) => rows.checked_mul(columns).and_then(|n| n.checked_mul(2)),
            (Form::Clustered, Some(book)) if book.columns == self.columns => {
                rows.checked_mul(1 + book.rank as usize).and_then(|n| n.checked_mul(2))
            }
            (Form::Clustered, _) => return Some((0, "there is no codebook for its columns".into())),
        };
        if rows == 0 || columns == 0 || expected != Some(self.bytes.len()) {
            let (bytes, form) = (self.bytes.len(), self.form);
            return Some((0, format!("{bytes} bytes are not {rows} rows of {columns} numbers in {form:?}")));
        }
        match self.form {
            Form::F32 => infinite(&self.bytes, 4).map(|what| (0, what)),
            Form::F16 => infinite(&self.bytes, 2).map(|what| (0, what)),
            Form::Clustered => {
                let clusters = book.map_or(0, |book| book.clusters);
                match (0..self.rows).find(|&row| u32::from(self.cluster(row)) >= clusters) {
                    Some(row) => {
                        Some((2 * row as usize, format!("row {row} is of a cluster that its book does not have")))
                    }
                    None => infinite(&self.bytes[2 * rows..], 2).map(|what| (2 * rows, what)),
                }
            }
        }
    }
}

fn rows_of(values: usize, columns: u32) -> u32 {
    assert!(columns > 0 && values.is_multiple_of(columns as usize), "whole rows of {columns} numbers");
    (values / columns as usize) as u32
}

fn half(bytes: &[u8]) -> f32 {
    f16::from_le_bytes([bytes[0], bytes[1]]).to_f32()
}

/// Little-endian halves, cut at the border of their range.
fn halves(values: &[f32]) -> Vec<u8> {
    let border = f16::MAX.to_f32();
    values.iter().flat_map(|value| f16::from_f32(value.clamp(-border, border)).to_le_bytes()).collect()
}

/// The first number of so many bytes that is not finite.
fn infinite(bytes: &[u8], size: usize) -> Option<String> {
    let finite = |b: &[u8]| if size == 2 { half(b).is_finite() } else { f32_at(b, 0).is_finite() };
    bytes.chunks_exact(size).position(|b| !finite(b)).map(|place| format!("number {place} is not finite"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_clustered_row_is_mean_and_vectors() {
        let book = Codebook::new([2, 2, 1], &[1.0, 2.0, 0.5, -0.5, -1.0, 0.0, 0.0, 4.0]);
        let table = Table::clustered(&book, &[1, 0, 1], &[0.25, 2.0, 0.0]);
        assert_eq!(table.fault(Some(&book)), None);
        assert_eq!(table.decode(Some(&book)), [-1.0, 1.0, 2.0, 1.0, -1.0, 0.0]);
        let wrong = Table::clustered(&book, &[2, 0, 1], &[0.0; 3]);
        assert!(wrong.fault(Some(&book)).is_some() && table.fault(None).is_some());
    }

    /// Shared vectors stand for vectors in full.
    #[test]
    fn factored_books_say_the_same() {
        let shared = [1.0, 0.0, 2.0, 0.0, 1.0, -1.0];
        let combinations = [1.0, 0.5, 0.0, 2.0, -1.0, 1.0, 0.5, 0.25];
        let factored = Codebook::factored([3, 2, 1], &combinations, &shared);
        let full = Codebook::new([3, 2, 1], &factored.values());
        assert_eq!(factored.vector(0, 0), [1.0, 0.5, 1.5]);
        let tables = [&factored, &full].map(|book| Table::clustered(book, &[1, 0], &[0.5, -1.0]).decode(Some(book)));
        assert_eq!(tables[0], tables[1]);
        assert!(factored.fault().is_none() && Codebook { shared: 1, ..factored.clone() }.fault().is_some());
        assert_ne!(factored.values(), Codebook { shared: 0, columns: 2, ..factored }.own(), "can fail");
    }

    #[test]
    fn exact_and_half_rows_are_read_back() {
        let values = [0.5, -1.25, 3.0, 1e-3, 7.0, 1e9];
        assert_eq!(Table::exact(3, &values).decode(None), values);
        let half = Table::half(2, &values).decode(None);
        assert_eq!(half[..3], values[..3]);
        assert!((half[3] - 1e-3).abs() < 1e-6 && half[5] == 65504.0);
    }
}
