//! Clustered principal components: each row is the mean of its cluster and a combination of the cluster's own vectors.

use super::eigen::symmetric;
use crate::dot::dot;
use rayon::prelude::*;

/// Turns of assigning rows and finding means and vectors anew.
const TURNS: usize = 4;
/// Means near to a row whose clusters are tried.
const TRIED: usize = 8;
/// Clusters whose distances are summed side by side.
const SIDE_BY_SIDE: usize = 8;

/// Means and principal vectors of clusters, in full.
#[derive(Debug, Clone)]
pub(crate) struct Clusters {
    pub(crate) columns: usize,
    pub(crate) each: Vec<Cluster>,
}

#[derive(Debug, Clone)]
pub(crate) struct Cluster {
    pub(crate) mean: Vec<f32>,
    /// The largest variance first, orthonormal; fewer than columns where rows are few.
    pub(crate) vectors: Vec<Vec<f32>>,
    /// Sum over its rows of the squares along each vector, and of those along all that are not kept.
    variances: Vec<f64>,
}

impl Clusters {
    /// All rows in one cluster with all its vectors.
    pub(crate) fn one(rows: &[f32], columns: usize) -> Self {
        let all: Vec<u32> = (0..(rows.len() / columns) as u32).collect();
        Self { columns, each: vec![Cluster::of(rows, columns, &all)] }
    }

    /// Twice as many: each is cut at its mean across its longest axis; then rows and clusters settle, judged with `rank` vectors.
    pub(crate) fn split(&self, rows: &[f32], rank: usize) -> Self {
        let half = |row: &[f32], c: u32| {
            let cluster = &self.each[c as usize];
            let along: f32 = cluster.weights(row, 1).first().copied().unwrap_or(0.0);
            2 * c + u32::from(along > 0.0)
        };
        let of = self.assign(rows, rank);
        let of: Vec<u32> = rows.chunks_exact(self.columns).zip(of).map(|(row, c)| half(row, c)).collect();
        let mut next = self.of_members(rows, &of, 2 * self.each.len());
        for _ in 0..TURNS {
            let of = next.assign(rows, rank);
            next = next.of_members(rows, &of, next.each.len());
        }
        next
    }

    /// Clusters of rows by their numbers; those of none are dropped.
    fn of_members(&self, rows: &[f32], of: &[u32], count: usize) -> Self {
        let mut members = vec![Vec::new(); count];
        (0..).zip(of).for_each(|(row, &c)| members[c as usize].push(row));
        members.retain(|members: &Vec<u32>| !members.is_empty());
        let each = members.par_iter().map(|members| Cluster::of(rows, self.columns, members)).collect();
        Self { columns: self.columns, each }
    }

    /// Of each row the cluster whose mean and first `rank` vectors come nearest.
    pub(crate) fn assign(&self, rows: &[f32], rank: usize) -> Vec<u32> {
        let means = Means::of(self);
        rows.par_chunks(self.columns).map(|row| self.nearest(row, rank, &means)).collect()
    }

    fn nearest(&self, row: &[f32], rank: usize, means: &Means) -> u32 {
        let mut near = means.distances(row);
        if near.len() > TRIED {
            near.select_nth_unstable_by(TRIED, |a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
            near.truncate(TRIED);
        }
        let left = |&(square, c): &(f32, u32)| {
            let weights = self.each[c as usize].weights(row, rank);
            (square - weights.iter().map(|w| w * w).sum::<f32>(), c)
        };
        near.iter().map(left).min_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1))).map_or(0, |(_, c)| c)
    }

    /// The sum of squares that is left out with so many vectors of each.
    pub(crate) fn left_out(&self, rank: usize) -> f64 {
        self.each.iter().map(|cluster| cluster.variances.iter().skip(rank).sum::<f64>()).sum()
    }
}

/// The means of clusters, so many side by side: `[group][column][cluster]`, the last group padded by its last mean.
struct Means {
    columns: usize,
    values: Vec<[f32; SIDE_BY_SIDE]>,
    count: usize,
}

impl Means {
    fn of(clusters: &Clusters) -> Self {
        let groups = clusters.each.chunks(SIDE_BY_SIDE);
        let column = |group: &[Cluster], i: usize| std::array::from_fn(|k| group[k.min(group.len() - 1)].mean[i]);
        let values = groups.flat_map(|group| (0..clusters.columns).map(move |i| column(group, i))).collect();
        Self { columns: clusters.columns, values, count: clusters.each.len() }
    }

    /// Squared distances of a row from all means, each summed in the order of the columns, with their numbers.
    fn distances(&self, row: &[f32]) -> Vec<(f32, u32)> {
        let mut found = Vec::with_capacity(self.count.next_multiple_of(SIDE_BY_SIDE));
        for (group, first) in self.values.chunks_exact(self.columns).zip((0..).step_by(SIDE_BY_SIDE)) {
            let mut sums = [0.0f32; SIDE_BY_SIDE];
            for (x, means) in row.iter().zip(group) {
                for (sum, mean) in sums.iter_mut().zip(means) {
                    *sum += (x - mean) * (x - mean);
                }
            }
            found.extend(sums.into_iter().zip(first..));
        }
        found.truncate(self.count);
        found
    }
}

impl Cluster {
    /// Mean and vectors of some of the rows.
    fn of(rows: &[f32], columns: usize, members: &[u32]) -> Self {
        let row = |&r: &u32| &rows[r as usize * columns..][..columns];
        let share = 1.0 / members.len() as f64;
        let mut mean = vec![0.0f64; columns];
        members.iter().map(row).for_each(|row| mean.iter_mut().zip(row).for_each(|(m, x)| *m += f64::from(*x)));
        mean.iter_mut().for_each(|m| *m *= share);
        let away: Vec<Vec<f32>> = members
            .iter()
            .map(row)
            .map(|row| row.iter().zip(&mean).map(|(x, m)| (f64::from(*x) - m) as f32).collect())
            .collect();
        let (values, vectors) = if away.len() < columns { of_few(&away) } else { of_many(&away, columns) };
        let short = |vector: Vec<f64>| vector.into_iter().map(|x| x as f32).collect();
        Self {
            mean: mean.into_iter().map(|m| m as f32).collect(),
            vectors: vectors.into_iter().map(short).collect(),
            variances: values.into_iter().map(|v| v.max(0.0)).collect(),
        }
    }

    /// How far a row lies along each of the first vectors.
    pub(crate) fn weights(&self, row: &[f32], rank: usize) -> Vec<f32> {
        let away: Vec<f32> = row.iter().zip(&self.mean).map(|(x, m)| x - m).collect();
        self.vectors.iter().take(rank).map(|vector| dot(&away, vector) as f32).collect()
    }
}

/// Principal vectors from the covariance.
fn of_many(away: &[Vec<f32>], columns: usize) -> (Vec<f64>, Vec<Vec<f64>>) {
    let mut covariance = vec![0.0f64; columns * columns];
    for row in away {
        for (i, a) in row.iter().enumerate() {
            let line = &mut covariance[i * columns..i * columns + i + 1];
            line.iter_mut().zip(row).for_each(|(sum, b)| *sum += f64::from(*a) * f64::from(*b));
        }
    }
    for i in 0..columns {
        for j in 0..i {
            covariance[j * columns + i] = covariance[i * columns + j];
        }
    }
    symmetric(&covariance, columns)
}

/// The same where rows are fewer than numbers, from the dot products of the rows.
fn of_few(away: &[Vec<f32>]) -> (Vec<f64>, Vec<Vec<f64>>) {
    let n = away.len();
    let gram: Vec<f64> = (0..n * n).map(|k| dot(&away[(k / n).max(k % n)], &away[(k / n).min(k % n)])).collect();
    let (mut values, combinations) = symmetric(&gram, n);
    // Beyond the digits of the rows directions are noise.
    let sound = values.iter().take_while(|value| **value > 1e-10 * values[0]).count();
    values.truncate(sound);
    let vector = |(value, weights): (&f64, Vec<f64>)| {
        let mut sum = vec![0.0f64; away[0].len()];
        for (row, weight) in away.iter().zip(weights) {
            sum.iter_mut().zip(row).for_each(|(sum, x)| *sum += weight * f64::from(*x));
        }
        sum.iter_mut().for_each(|x| *x /= value.sqrt());
        sum
    };
    let vectors = values.iter().zip(combinations).map(vector).collect();
    (values, vectors)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The same bits as one mean after the other, for numbers of clusters about a group; the last number is not that of a padded one.
    #[test]
    fn distances_are_those_taken_one_by_one() {
        let columns = 13;
        let value = |k: usize| ((k * 37 + 11) % 101) as f32 / 50.0 - 0.99;
        let row: Vec<f32> = (0..columns).map(|i| value(i * i)).collect();
        for count in [1, 7, 8, 9, 16, 19] {
            let mean = |c: usize| (0..columns).map(|i| value(c * columns + i)).collect();
            let cluster = |c| Cluster { mean: mean(c), vectors: Vec::new(), variances: Vec::new() };
            let clusters = Clusters { columns, each: (0..count).map(cluster).collect() };
            let found = Means::of(&clusters).distances(&row);
            let one_by_one = |cluster: &Cluster| {
                let mut sum = 0.0f32;
                row.iter().zip(&cluster.mean).for_each(|(x, m)| sum += (x - m) * (x - m));
                sum.to_bits()
            };
            let expected: Vec<(u32, u32)> = clusters.each.iter().map(one_by_one).zip(0..).collect();
            let bits = |found: &[(f32, u32)]| found.iter().map(|(d, c)| (d.to_bits(), *c)).collect::<Vec<_>>();
            assert_eq!(bits(&found), expected, "{count} clusters");
            // Twin: another row is as far from none of them.
            let other = Means::of(&clusters).distances(&row.iter().map(|x| x + 0.5).collect::<Vec<_>>());
            assert!(bits(&other).iter().zip(&expected).all(|(a, b)| a != b), "can fail");
        }
    }
}
