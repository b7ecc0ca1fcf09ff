//! Rows of transfer in clusters: the error is asked for, clusters and vectors follow (clustered principal components, P.-P. Sloan, J. Hall,
//! J. Hart, J. Snyder, *Clustered Principal Components for Precomputed Radiance Transfer*, SIGGRAPH 2003).
//!
//! Everything runs in a fixed order of operations, whatever the number of threads.

mod clusters;
pub(crate) mod eigen;
mod sketch;

use clusters::Clusters;
use coeff_io::{Codebook, Table};
pub use sketch::Sketch;

/// Rows that clusters are learned from.
const SAMPLE: usize = 8192;

/// What is asked for.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Aim {
    /// Relative error: the root mean square of what is lost over that of the rows.
    pub error: f32,
    /// Most clusters.
    pub most_clusters: u32,
    /// Most vectors of a cluster.
    pub most_rank: u32,
}

/// Rows in clusters.
#[derive(Debug, Clone)]
pub struct Compressed {
    /// Means and vectors.
    pub book: Codebook,
    /// Of each row.
    pub clusters: Vec<u16>,
    /// `[row][vector]`.
    pub weights: Vec<f32>,
    /// The error reached; of rows of a sketch without the rounding of the file, which is a twentieth of a per cent.
    pub error: f32,
}

/// Puts rows of `columns` numbers, all finite, into clusters with the fewest bytes that keep the error; none where halves would take no
/// more, or the aim cannot be kept.
///
/// # Panics
/// When the rows are not whole.
#[must_use]
pub fn compress(rows: &[f32], columns: usize, aim: &Aim) -> Option<Compressed> {
    assert!(columns > 0 && rows.len().is_multiple_of(columns), "whole rows");
    let plain = 2 * rows.len();
    // Rows outside of the sample may be farther off than those in it: then a finer choice is looked for.
    for part in [1.0, 0.85, 0.7] {
        let found = search(rows, columns, &Aim { error: part * aim.error, ..*aim })?;
        if found.bytes >= plain {
            return None;
        }
        let all = found.encode(rows, None);
        let table = Table::clustered(&all.book, &all.clusters, &all.weights);
        let error = distance(rows, &table.decode(Some(&all.book)));
        if error <= 1.05 * aim.error {
            return Some(Compressed { error, ..all });
        }
    }
    None
}

/// Puts rows that are kept by the vectors of a sketch into clusters, whose means and vectors are combinations of the sketch's. The error reached
/// is that of the clusters alone. Where the aim cannot be
/// kept, as near as clusters come.
///
/// # Panics
/// When the rows are not whole.
#[must_use]
pub fn compress_sketched(rows: &[f32], sketch: &Sketch, aim: &Aim) -> Compressed {
    let rank = sketch.rank();
    assert!(rows.len().is_multiple_of(rank), "whole rows");
    // What the sketch leaves out is a part of the error.
    let left = (aim.error * aim.error - sketch.error() * sketch.error()).max(0.25 * aim.error * aim.error).sqrt();
    let own = Aim { error: left, ..*aim };
    let one = || {
        let clusters = Clusters::one(&sample(rows, rank), rank);
        let most = rank.min(aim.most_rank as usize);
        Choice { clusters, rank: most, bytes: 0 }
    };
    let found = search(rows, rank, &own).unwrap_or_else(one);
    let all = found.encode(rows, Some(sketch));
    let small = found.decode(rows, &all);
    Compressed { error: distance(rows, &small), ..all }
}

/// Clusters with how many of their vectors are kept.
struct Choice {
    clusters: Clusters,
    rank: usize,
    /// Of codebook and tables.
    bytes: usize,
}

/// The smallest choice that keeps the aim.
fn search(rows: &[f32], columns: usize, aim: &Aim) -> Option<Choice> {
    let count = rows.len() / columns;
    if count == 0 {
        return None;
    }
    let sample = sample(rows, columns);
    let all: f64 = sample.iter().map(|x| f64::from(*x) * f64::from(*x)).sum();
    // Halves round, and rows outside of the sample are a little farther off.
    let enough = f64::from(0.95 * aim.error).powi(2) * all;
    let mut clusters = Clusters::one(&sample, columns);
    let mut best: Option<Choice> = None;
    let mut worse = 0;
    loop {
        let most = columns.min(aim.most_rank as usize);
        let rank = (0..=most).find(|&rank| clusters.left_out(rank) <= enough);
        if let Some(rank) = rank {
            let book = clusters.each.len() * (1 + rank) * columns * 2;
            let bytes = book + count * (2 + 2 * rank);
            match &best {
                Some(best) if best.bytes <= bytes => worse += 1,
                _ => {
                    worse = 0;
                    best = Some(Choice { clusters: clusters.clone(), rank, bytes });
                }
            }
        }
        let number = clusters.each.len();
        let enough_rows = 4 * number <= sample.len() / columns;
        if worse >= 2 || 2 * number > aim.most_clusters as usize || !enough_rows {
            return best;
        }
        // Judged by the vectors that twice as many clusters will about need.
        let next = clusters.split(&sample, rank.unwrap_or(most) / 2);
        if next.each.len() <= number {
            return best;
        }
        clusters = next;
    }
}

/// Evenly chosen rows, all where they are few.
fn sample(rows: &[f32], columns: usize) -> Vec<f32> {
    let count = rows.len() / columns;
    let kept = count.min(SAMPLE);
    let pick = |k: usize| (2 * k + 1) * count / (2 * kept);
    (0..kept).flat_map(|k| &rows[pick(k) * columns..][..columns]).copied().collect()
}

impl Choice {
    /// All rows by the clusters; of those of a sketch its vectors are shared.
    fn encode(&self, rows: &[f32], sketch: Option<&Sketch>) -> Compressed {
        use rayon::prelude::*;
        let columns = self.clusters.columns;
        let of = self.clusters.assign(rows, self.rank);
        let weights: Vec<f32> = rows
            .par_chunks(columns)
            .zip(&of)
            .flat_map_iter(|(row, &c)| {
                let mut weights = self.clusters.each[c as usize].weights(row, self.rank);
                weights.resize(self.rank, 0.0);
                weights
            })
            .collect();
        let mut values = Vec::new();
        for cluster in &self.clusters.each {
            values.extend_from_slice(&cluster.mean);
            let end = values.len() + self.rank * columns;
            cluster.vectors.iter().take(self.rank).for_each(|vector| values.extend_from_slice(vector));
            values.resize(end, 0.0);
        }
        let (clusters, rank) = (self.clusters.each.len() as u32, self.rank as u32);
        let book = match sketch {
            None => Codebook::new([columns as u32, clusters, rank], &values),
            Some(sketch) => Codebook::factored([sketch.columns() as u32, clusters, rank], &values, sketch.vectors()),
        };
        Compressed { book, clusters: of.into_iter().map(|c| c as u16).collect(), weights, error: 0.0 }
    }

    /// The rows that weights in halves say, by the clusters as they are.
    fn decode(&self, rows: &[f32], all: &Compressed) -> Vec<f32> {
        let columns = self.clusters.columns;
        let mut out = Vec::with_capacity(rows.len());
        for (row, &c) in all.clusters.iter().enumerate() {
            let cluster = &self.clusters.each[c as usize];
            let start = out.len();
            out.extend_from_slice(&cluster.mean);
            for (weight, vector) in all.weights[row * self.rank..].iter().zip(cluster.vectors.iter().take(self.rank)) {
                out[start..start + columns].iter_mut().zip(vector).for_each(|(x, v)| *x += weight * v);
            }
        }
        out
    }
}

/// Root mean square of the difference over that of the first.
fn distance(a: &[f32], b: &[f32]) -> f32 {
    let square = |x: f32| f64::from(x) * f64::from(x);
    let off: f64 = a.iter().zip(b).map(|(a, b)| square(a - b)).sum();
    let all: f64 = a.iter().map(|x| square(*x)).sum();
    if all > 0.0 { (off / all).sqrt() as f32 } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::*;
    use sampling::rng::Rng;

    const AIM: Aim = Aim { error: 0.01, most_clusters: 256, most_rank: 64 };

    /// Rows of some flat pieces, each with a place and `rank` directions of its own, in 25 dimensions.
    fn pieces(count: usize, rank: usize, rows: usize) -> Vec<f32> {
        let mut rng = Rng::new(7, 1);
        let mut random = |n: usize| (0..n).map(|_| 2.0 * rng.next_f32() - 1.0).collect::<Vec<f32>>();
        let flats: Vec<Vec<Vec<f32>>> = (0..count).map(|_| (0..=rank).map(|_| random(25)).collect()).collect();
        let mut out = Vec::new();
        for row in 0..rows {
            let flat = &flats[row % count];
            let weights = random(rank);
            for c in 0..25 {
                let along: f32 = weights.iter().zip(&flat[1..]).map(|(w, v)| 0.5 * w * v[c]).sum();
                out.push(3.0 * flat[0][c] + along);
            }
        }
        out
    }

    fn decoded(all: &Compressed) -> Vec<f32> {
        Table::clustered(&all.book, &all.clusters, &all.weights).decode(Some(&all.book))
    }

    /// Eight flat pieces of two dimensions take eight clusters of two vectors.
    #[test]
    fn flat_pieces_are_found() {
        let rows = pieces(8, 2, 4000);
        let all = compress(&rows, 25, &AIM).unwrap();
        let error = distance(&rows, &decoded(&all));
        assert!(error <= AIM.error && (error - all.error).abs() < 1e-5, "{error}");
        assert!(all.book.rank <= 4 && all.book.clusters >= 4, "{} of {}", all.book.clusters, all.book.rank);
        let one = compress(&rows, 25, &Aim { most_clusters: 1, ..AIM });
        let larger = one.is_none_or(|one| one.book.rank > all.book.rank);
        assert!(larger, "a single cluster needs more vectors");
    }

    /// With one cluster the error is the rest of the eigenvalues: against a power iteration that takes them off one by one.
    #[test]
    fn one_cluster_leaves_the_smaller_eigenvalues() {
        let rows = pieces(3, 3, 300);
        let clusters = Clusters::one(&rows, 25);
        let mut away: Vec<Vec<f64>> =
            rows.chunks_exact(25).map(|r| r.iter().map(|x| f64::from(*x)).collect()).collect();
        for c in 0..25 {
            let mean = away.iter().map(|r| r[c]).sum::<f64>() / away.len() as f64;
            away.iter_mut().for_each(|r| r[c] -= mean);
        }
        for rank in 0..4 {
            let left: f64 = away.iter().flatten().map(|x| x * x).sum();
            assert!((clusters.left_out(rank) / left - 1.0).abs() < 1e-3, "{rank}: {} {left}", clusters.left_out(rank));
            assert!((clusters.left_out(rank + 1) / left - 1.0).abs() > 1e-2, "can fail");
            let mut vector = vec![1.0; 25];
            for _ in 0..2000 {
                let mut next = vec![0.0; 25];
                for row in &away {
                    let along: f64 = row.iter().zip(&vector).map(|(a, b)| a * b).sum();
                    next.iter_mut().zip(row).for_each(|(n, x)| *n += along * x);
                }
                let length = next.iter().map(|x| x * x).sum::<f64>().sqrt();
                vector = next.into_iter().map(|x| x / length).collect();
            }
            for row in &mut away {
                let along: f64 = row.iter().zip(&vector).map(|(a, b)| a * b).sum();
                row.iter_mut().zip(&vector).for_each(|(x, v)| *x -= along * v);
            }
        }
    }

    #[test]
    fn odd_rows_are_no_trouble() {
        assert!(compress(&[], 25, &AIM).is_none());
        assert!(compress(&pieces(1, 1, 1), 25, &AIM).is_none(), "one row takes no less");
        let same = [1.5f32; 25].repeat(400);
        let all = compress(&same, 25, &AIM).unwrap();
        assert_eq!((all.book.clusters, all.book.rank), (1, 0));
        assert!(compress(&vec![0.0; 2500], 25, &AIM).is_some_and(|all| all.error == 0.0));
        // Noise in every direction gains nothing.
        assert!(compress(&pieces(1, 25, 200), 25, &Aim { error: 1e-4, ..AIM }).is_none(), "can fail");
    }

    #[test]
    fn long_rows_go_through_a_sketch() {
        let rows = pieces(8, 2, 2000);
        let sketch = Sketch::learn(&rows[..25 * 500], 25, 0.005);
        let short: Vec<f32> = rows.chunks_exact(25).flat_map(|row| sketch.project(row)).collect();
        let all = compress_sketched(&short, &sketch, &AIM);
        let error = distance(&rows, &decoded(&all));
        assert!(error < 1.2 * AIM.error, "{error}");
        let both = (all.error * all.error + sketch.error() * sketch.error()).sqrt();
        assert!((error - both).abs() < 0.2 * AIM.error, "{error} {both}");
        let rough = compress_sketched(&short, &sketch, &Aim { error: 0.2, ..AIM });
        assert!(rough.book.bytes.len() + 2 * rough.weights.len() < all.book.bytes.len() + 2 * all.weights.len());
    }

    #[test]
    fn threads_change_nothing() {
        let rows = pieces(6, 3, 3000);
        let on = |threads: usize| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            let all = pool.install(|| compress(&rows, 25, &AIM)).unwrap();
            (all.book.bytes, all.clusters, all.weights)
        };
        assert!(on(1) == on(2) && on(2) == on(3));
    }
}
