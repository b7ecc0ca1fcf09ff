//! A few vectors that hold what many long rows have in common: rows are kept as their dot products with them while a bake goes on.

use super::eigen::symmetric;
use crate::dot::dot;
use rayon::prelude::*;

/// Most vectors of a sketch.
const MOST_RANK: usize = 320;

/// Orthonormal vectors.
#[derive(Debug, Clone)]
pub struct Sketch {
    columns: usize,
    /// `[vector][column]`.
    vectors: Vec<f32>,
    /// Relative error of the rows that it was learned from.
    error: f32,
}

impl Sketch {
    /// The fewest vectors that hold sample rows to within a relative error, root mean square; 320 at most.
    ///
    /// The principal components of the rows, not centred, by the eigenvectors of their Gram matrix.
    ///
    /// # Panics
    /// When the rows are not whole.
    #[must_use]
    pub fn learn(rows: &[f32], columns: usize, error: f32) -> Self {
        assert!(columns > 0 && rows.len().is_multiple_of(columns), "whole rows");
        let rows: Vec<&[f32]> = rows.chunks_exact(columns).collect();
        let n = rows.len();
        let gram: Vec<f64> =
            (0..n * n).into_par_iter().map(|k| dot(rows[(k / n).max(k % n)], rows[(k / n).min(k % n)])).collect();
        let (values, vectors) = symmetric(&gram, n);
        let all: f64 = values.iter().map(|v| v.max(0.0)).sum();
        let mut held = Self { columns, vectors: Vec::new(), error: 0.0 };
        let mut left = all;
        let enough = f64::from(error) * f64::from(error) * all;
        for (value, vector) in values.into_iter().zip(vectors).take(MOST_RANK) {
            // Beyond the digits of the rows eigenvectors are noise.
            if left <= enough || value <= 1e-12 * all {
                break;
            }
            left -= value;
            held.add(&rows, &vector);
        }
        if held.vectors.is_empty() {
            // Rows of nothing but zeros.
            held.vectors = std::iter::once(1.0).chain(std::iter::repeat_n(0.0, columns - 1)).collect();
        }
        held.error = if all > 0.0 { (left.max(0.0) / all).sqrt() as f32 } else { 0.0 };
        held
    }

    /// Adds the combination of rows, made orthogonal to the vectors so far, and of length 1.
    fn add(&mut self, rows: &[&[f32]], weights: &[f64]) {
        let mut sum = vec![0.0f64; self.columns];
        for (row, weight) in rows.iter().zip(weights) {
            sum.iter_mut().zip(*row).for_each(|(sum, x)| *sum += weight * f64::from(*x));
        }
        for vector in self.vectors.chunks_exact(self.columns) {
            let along: f64 = sum.iter().zip(vector).map(|(a, b)| a * f64::from(*b)).sum();
            sum.iter_mut().zip(vector).for_each(|(sum, v)| *sum -= along * f64::from(*v));
        }
        let length = sum.iter().map(|x| x * x).sum::<f64>().sqrt();
        if length > 0.0 {
            self.vectors.extend(sum.into_iter().map(|x| (x / length) as f32));
        }
    }

    /// Number of vectors, at least 1.
    #[must_use]
    pub fn rank(&self) -> usize {
        self.vectors.len() / self.columns
    }

    /// `[vector][column]`.
    pub(crate) fn vectors(&self) -> &[f32] {
        &self.vectors
    }

    /// Numbers of a row.
    pub(crate) fn columns(&self) -> usize {
        self.columns
    }

    /// Relative error of the rows that it was learned from.
    #[must_use]
    pub fn error(&self) -> f32 {
        self.error
    }

    /// The dot products of a row with the vectors.
    #[must_use]
    pub fn project(&self, row: &[f32]) -> Vec<f32> {
        self.vectors.chunks_exact(self.columns).map(|vector| dot(vector, row) as f32).collect()
    }

    /// The row that has these dot products.
    #[must_use]
    pub fn expand(&self, products: &[f32]) -> Vec<f32> {
        let mut row = vec![0.0f32; self.columns];
        for (product, vector) in products.iter().zip(self.vectors.chunks_exact(self.columns)) {
            row.iter_mut().zip(vector).for_each(|(sum, v)| *sum += product * v);
        }
        row
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Rows of a plane through the origin of a space of 50 dimensions, and something small beside it.
    fn rows(noise: f32) -> Vec<f32> {
        let row = |r: usize| {
            let (a, b) = ((r % 7) as f32 - 3.0, (r % 5) as f32 - 1.0);
            (0..50).map(move |c| {
                a * ((c * 3) % 11) as f32 + b * ((c * 5) % 13) as f32 + noise * ((r * c * 31 % 97) as f32 - 48.0)
            })
        };
        (0..60).flat_map(row).collect()
    }

    fn error(sketch: &Sketch, rows: &[f32]) -> f32 {
        let (mut off, mut all) = (0.0, 0.0);
        for row in rows.chunks_exact(50) {
            let back = sketch.expand(&sketch.project(row));
            off += row.iter().zip(&back).map(|(a, b)| (a - b).powi(2)).sum::<f32>();
            all += row.iter().map(|x| x * x).sum::<f32>();
        }
        (off / all).sqrt()
    }

    #[test]
    fn a_plane_takes_two_vectors() {
        let sketch = Sketch::learn(&rows(0.0), 50, 1e-4);
        assert_eq!(sketch.rank(), 2);
        assert!(error(&sketch, &rows(0.0)) < 1e-5);
        assert!(error(&sketch, &rows(0.05)) > 1e-3, "what is beside the plane is lost");
    }

    #[test]
    fn the_error_asked_for_is_kept() {
        let rows = rows(0.05);
        for asked in [0.2, 0.05, 0.01] {
            let sketch = Sketch::learn(&rows, 50, asked);
            let reached = error(&sketch, &rows);
            assert!(reached <= asked * 1.01 && (reached - sketch.error()).abs() < 1e-3, "{asked} {reached}");
        }
        assert!(Sketch::learn(&rows, 50, 0.2).rank() < Sketch::learn(&rows, 50, 0.01).rank(), "can fail");
        assert_eq!(Sketch::learn(&[0.0; 100], 50, 0.1).rank(), 1, "zeros");
    }
}
