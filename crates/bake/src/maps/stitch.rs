//! Makes the light of the two sides of a seam agree as the filter reads it.
//!
//! The numbers `x` of the texels along seams are those with the least `sum over points of (left(x) - right(x))^2 + mu |x - before|^2`,
//! where left and right are the bilinear look-ups at one point of a seam, and mu is far less for texels that no view shows: they yield to those
//! that are seen. Each number of a row is solved for by itself, by conjugate
//! gradients.

use rayon::prelude::*;
use std::collections::BTreeSet;
use std::ops::Range;

/// Weight of staying as it was, against one look-up at a seam. There are about two look-ups to a texel.
const STAY: f32 = 0.02;
/// The same for texels that no view shows: next to nothing of their dark reaches the other side.
const YIELD: f32 = 0.001;
/// Numbers of a row that are solved for side by side.
const LANES: usize = 16;
/// Most steps of the solver.
const STEPS: usize = 100;
/// Part of the first residual at which a solution is good.
const ENOUGH: f64 = 1e-4;

/// Two look-ups that should agree: slots with weights, those of the second side negative.
pub(crate) type Agreement = Vec<(u32, f32)>;

/// Numbers of a row that belong together. The first of them, as many as there are channels, are means of light over all directions.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Part {
    pub(crate) numbers: Range<usize>,
    pub(crate) means: usize,
}

/// Moves the rows (`row_len` numbers each) of all slots, each of which some agreement names; those that no view shows more readily.
pub(crate) fn stitch(
    agreements: &[Agreement],
    unseen: &BTreeSet<u32>,
    (parts, row_len): (&[Part], usize),
    values: &mut [f32],
) {
    let slots: Vec<u32> = (0..(values.len() / row_len.max(1)) as u32).collect();
    let stay: Vec<f32> = slots.iter().map(|slot| if unseen.contains(slot) { YIELD } else { STAY }).collect();
    settle(agreements, &slots, &stay, (parts, row_len), values);
}

/// Moves the rows of the first of some slots, as many as `stay` has weights of staying as they were. The agreements name slots by their places in
/// `slots`; the others keep what they hold, and one slot may be there twice: once as it was.
pub(super) fn settle(
    rows: &[Agreement],
    slots: &[u32],
    stay: &[f32],
    (parts, row_len): (&[Part], usize),
    values: &mut [f32],
) {
    if rows.is_empty() {
        return;
    }
    let rows = Matrix::of(rows);
    let row = |slot: u32| slot as usize * row_len..(slot as usize + 1) * row_len;
    let moved = &slots[..stay.len()];
    let before: Vec<f32> = moved.iter().flat_map(|&slot| &values[row(slot)]).copied().collect();
    let solved: Vec<Vec<[f32; LANES]>> = (0..row_len.div_ceil(LANES))
        .into_par_iter()
        .map(|batch| {
            let number = |slot: u32, lane: usize| {
                let n = batch * LANES + lane;
                if n < row_len { values[slot as usize * row_len + n] } else { 0.0 }
            };
            let before = slots.iter().map(|&slot| std::array::from_fn(|lane| number(slot, lane))).collect();
            solve(&rows, before, stay)
        })
        .collect();
    for (batch, solved) in solved.into_iter().enumerate() {
        for (&slot, lanes) in moved.iter().zip(solved) {
            let own = &mut values[row(slot)];
            own[batch * LANES..].iter_mut().zip(lanes).for_each(|(value, lane)| *value = lane);
        }
    }
    for (&slot, before) in moved.iter().zip(before.chunks_exact(row_len.max(1))) {
        for part in parts {
            let own = part.numbers.clone();
            hold_back(&mut values[row(slot)][own.clone()], &before[own], part.means);
        }
    }
}

/// Keeps the means of a part from falling below nothing: no light is less. All of it goes as far as the first of them that gets there.
fn hold_back(part: &mut [f32], before: &[f32], means: usize) {
    let falls = |now: f32, was: f32| now < 0.0 && was >= 0.0;
    let pairs = part.iter().zip(before).take(means).filter(|(now, was)| falls(**now, **was));
    let Some(share) = pairs.map(|(now, was)| was / (was - now)).reduce(f32::min) else { return };
    for (index, (now, was)) in part.iter_mut().zip(before).enumerate() {
        let held = was + share * (*now - was);
        // Rounding may leave the least bit less than nothing.
        *now = if index < means && falls(held, *was) { 0.0 } else { held };
    }
}

/// Agreements one after the other, with where each ends.
struct Matrix {
    entries: Vec<(u32, f32)>,
    ends: Vec<usize>,
}

impl Matrix {
    fn of(rows: &[Agreement]) -> Self {
        let mut all = Self { entries: Vec::with_capacity(rows.iter().map(Vec::len).sum()), ends: Vec::new() };
        for row in rows {
            all.entries.extend_from_slice(row);
            all.ends.push(all.entries.len());
        }
        all
    }

    fn rows(&self) -> impl Iterator<Item = &[(u32, f32)]> {
        let mut start = 0;
        self.ends.iter().map(move |&end| &self.entries[std::mem::replace(&mut start, end)..end])
    }
}

/// Conjugate gradients for the change `d` of the first, with the weights mu in `stay`: `(A^T A + mu) d = -A^T A before`.
fn solve(rows: &Matrix, before: Vec<[f32; LANES]>, stay: &[f32]) -> Vec<[f32; LANES]> {
    let mut residual = vec![[0.0f32; LANES]; before.len()];
    squared(rows, &before, &mut residual);
    residual[stay.len()..].fill([0.0; LANES]);
    residual.iter_mut().flatten().for_each(|value| *value = -*value);
    let mut change = vec![[0.0f32; LANES]; before.len()];
    let mut direction = residual.clone();
    let mut norm = dot(&residual, &residual);
    let first = norm;
    let mut image = residual.clone();
    for _ in 0..STEPS {
        squared(rows, &direction, &mut image);
        image[stay.len()..].fill([0.0; LANES]);
        for ((out, along), stay) in image.iter_mut().zip(&direction).zip(stay) {
            out.iter_mut().zip(along).for_each(|(out, along)| *out += stay * along);
        }
        let slope = dot(&direction, &image);
        let step: [f32; LANES] = std::array::from_fn(|k| ratio(norm[k], slope[k]));
        for ((d, r), (p, q)) in change.iter_mut().zip(&mut residual).zip(direction.iter().zip(&image)) {
            for k in 0..LANES {
                d[k] += step[k] * p[k];
                r[k] -= step[k] * q[k];
            }
        }
        let next = dot(&residual, &residual);
        if next.iter().zip(first).all(|(&now, first)| now <= ENOUGH * ENOUGH * first) {
            break;
        }
        let again: [f32; LANES] = std::array::from_fn(|k| ratio(next[k], norm[k]));
        for (p, r) in direction.iter_mut().zip(&residual) {
            for k in 0..LANES {
                p[k] = r[k] + again[k] * p[k];
            }
        }
        norm = next;
    }
    change.iter().zip(before).map(|(d, b)| std::array::from_fn(|k| b[k] + d[k])).collect()
}

fn ratio(a: f64, b: f64) -> f32 {
    if b > 0.0 { (a / b) as f32 } else { 0.0 }
}

/// `A^T A x`.
fn squared(rows: &Matrix, x: &[[f32; LANES]], out: &mut [[f32; LANES]]) {
    out.fill([0.0; LANES]);
    for row in rows.rows() {
        let mut sum = [0.0; LANES];
        for &(slot, weight) in row {
            let x = &x[slot as usize];
            (0..LANES).for_each(|k| sum[k] += weight * x[k]);
        }
        for &(slot, weight) in row {
            let out = &mut out[slot as usize];
            (0..LANES).for_each(|k| out[k] += weight * sum[k]);
        }
    }
}

fn dot(a: &[[f32; LANES]], b: &[[f32; LANES]]) -> [f64; LANES] {
    let mut sum = [0.0; LANES];
    for (a, b) in a.iter().zip(b) {
        for k in 0..LANES {
            sum[k] += f64::from(a[k]) * f64::from(b[k]);
        }
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::{Agreement, Part, STAY, YIELD, stitch};
    use std::collections::BTreeSet;

    /// One agreement of two texels: the least of `(a - b)^2 + mu ((a - a0)^2 + (b - b0)^2)` has `a - b = (a0 - b0) mu / (2 + mu)`, and
    /// the sum stays.
    #[test]
    fn two_texels_meet_in_the_middle() {
        let mut values = vec![3.0, 10.0, 1.0, -2.0];
        stitch(&[vec![(0, 1.0), (1, -1.0)]], &BTreeSet::new(), (&[], 2), &mut values);
        for k in 0..2 {
            let (before, after) = ([3.0, 10.0][k] - [1.0, -2.0][k], values[k] - values[2 + k]);
            assert!((after - before * STAY / (2.0 + STAY)).abs() < 1e-4, "{after}");
            assert!((values[k] + values[2 + k] - [4.0, 8.0][k]).abs() < 1e-4);
        }
    }

    /// The least of `(a - b)^2 + mu (a - a0)^2 + nu (b - b0)^2` moves a by `(b0 - a0) nu / (mu + nu + mu nu)`: of two that disagree the one that no
    /// view shows gives way. Where both are seen they meet.
    #[test]
    fn what_no_view_shows_gives_way() {
        let moved = |unseen: &[u32]| {
            let mut values = vec![3.0, 1.0];
            stitch(&[vec![(0, 1.0), (1, -1.0)]], &unseen.iter().copied().collect(), (&[], 1), &mut values);
            values[0] - 3.0
        };
        let exact = -2.0 * YIELD / (STAY + YIELD + STAY * YIELD);
        assert!((moved(&[1]) - exact).abs() < 1e-3, "{} instead of {exact}", moved(&[1]));
        assert!(moved(&[]) < -0.9, "can fail");
    }

    /// Against a dense solution by elimination, on a chain of look-ups with odd weights.
    #[test]
    fn a_chain_is_solved() {
        const N: usize = 9;
        let rows: Vec<Agreement> =
            (0..N - 1).map(|k| vec![(k as u32, 0.75), ((k + 1) as u32, 0.25), (((k + 4) % N) as u32, -1.0)]).collect();
        let before: Vec<f32> = (0..N).map(|k| ((k * k * 7) % 11) as f32).collect();
        let mut values = before.clone();
        stitch(&rows, &BTreeSet::new(), (&[], 1), &mut values);
        let exact = dense(&rows, &before);
        let worst = |a: &[f32]| a.iter().zip(&exact).map(|(x, e)| (f64::from(*x) - e).abs()).fold(0.0, f64::max);
        assert!(worst(&values) < 2e-3, "{}", worst(&values));
        assert!(worst(&before) > 1.0, "the start must be seen to be wrong");
    }

    /// Two look-ups that are to agree with the dark, of a row of RGB: a texel of one of them without green, which would fall below nothing with what
    /// the other takes off.
    fn beside_the_dark(means: usize) -> Vec<f32> {
        let mut values = vec![1.0, 0.0, 1.0, 1.0, 0.5, 1.0, 1.0, 0.0, 1.0];
        let parts = [Part { numbers: 0..3, means }];
        stitch(&[vec![(0, 0.5), (1, 0.5), (2, -1.0)]], &BTreeSet::new(), (&parts, 3), &mut values);
        values
    }

    #[test]
    fn no_channel_falls_below_nothing() {
        let values = beside_the_dark(3);
        assert!(values.iter().all(|value| *value >= 0.0), "{values:?}");
        assert!(values[4] < 0.45, "what has light still gives way: {values:?}");
    }

    /// By red alone.
    #[test]
    fn no_channel_falls_below_nothing_can_fail() {
        assert!(beside_the_dark(1)[1] < -0.05, "{:?}", beside_the_dark(1));
    }

    fn dense(rows: &[Agreement], before: &[f32]) -> Vec<f64> {
        let n = before.len();
        let mut m = vec![vec![0.0f64; n + 1]; n];
        for (i, row) in m.iter_mut().enumerate() {
            row[i] = f64::from(STAY);
            row[n] = f64::from(STAY) * f64::from(before[i]);
        }
        for row in rows {
            for &(i, a) in row {
                for &(j, b) in row {
                    m[i as usize][j as usize] += f64::from(a) * f64::from(b);
                }
            }
        }
        for i in 0..n {
            for j in 0..n {
                if j != i {
                    let factor = m[j][i] / m[i][i];
                    (0..=n).for_each(|k| m[j][k] -= factor * m[i][k]);
                }
            }
        }
        (0..n).map(|i| m[i][n] / m[i][i]).collect()
    }
}
