//! The constant matrices of the quarter turn about x, one per degree.

use crate::double_double::DoubleDouble;
use std::sync::OnceLock;

/// Rows of the coefficient matrix of `Rx(90 degrees)` in one band, zeros left out: `l^2 + l + 1` entries stay.
#[derive(Debug)]
pub(crate) struct QuarterTurn {
    /// Row `r` has the entries `starts[r]..starts[r + 1]`.
    starts: Vec<u32>,
    columns: Vec<u16>,
    values: Vec<f64>,
}

impl QuarterTurn {
    /// The matrix of degree `l < Bands::MAX`, built at its first use.
    pub(crate) fn of_degree(l: usize) -> &'static Self {
        static TURNS: [OnceLock<QuarterTurn>; crate::Bands::MAX as usize] =
            [const { OnceLock::new() }; crate::Bands::MAX as usize];
        TURNS[l].get_or_init(|| Self::build(l))
    }

    /// `to = X from`.
    pub(crate) fn turn(&self, from: &[f64], to: &mut [f64]) {
        for (row, target) in to.iter_mut().enumerate() {
            let range = self.starts[row] as usize..self.starts[row + 1] as usize;
            let entries = self.columns[range.clone()].iter().zip(&self.values[range]);
            *target = entries.fold(0.0, |sum, (&column, value)| sum + value * from[usize::from(column)]);
        }
    }

    /// `to = X^T from`, the turn back.
    pub(crate) fn turn_back(&self, from: &[f64], to: &mut [f64]) {
        to.fill(0.0);
        for (row, source) in from.iter().enumerate() {
            let range = self.starts[row] as usize..self.starts[row + 1] as usize;
            for (&column, value) in self.columns[range.clone()].iter().zip(&self.values[range]) {
                to[usize::from(column)] += value * source;
            }
        }
    }

    /// Rows from the Wigner matrix `d(90 degrees)`: `Rx(90) = Rz(-90) Ry(90) Rz(90)`.
    fn build(l: usize) -> Self {
        let wigner = wigner_quarter(l);
        let (mut starts, mut columns, mut values) = (vec![0], Vec::new(), Vec::new());
        let orders = || -(l as i32)..=l as i32;
        for row in orders() {
            for column in orders() {
                let value = entry(l, &wigner, row, column);
                if value != 0.0 {
                    columns.push((column + l as i32) as u16);
                    values.push(value);
                }
            }
            starts.push(values.len() as u32);
        }
        Self { starts, columns, values }
    }
}

/// Entry of the quarter turn about x, from `wigner[m][k] = d_km(90 degrees)`.
///
/// The quarter turn about y in real functions does not mix cosines with sines; between orders `k, m > 0` it is
/// `(-1)^(k+m) d_km (1 + s)` for cosines and `(-1)^(k+m) d_km (1 - s)` for sines, `s = (-1)^(l+k+m)`. The quarter turns
/// about z before and after only swap cosine and sine of an order, with signs.
fn entry(l: usize, wigner: &[Vec<f64>], row: i32, column: i32) -> f64 {
    let (k, m) = (row.unsigned_abs() as usize, column.unsigned_abs() as usize);
    let mirrored = (l + k + m).is_multiple_of(2);
    let sign = if (k + m).is_multiple_of(2) { 1.0 } else { -1.0 };
    let scale = match (k > 0, m > 0) {
        (true, true) => 2.0,
        (false, false) => 1.0,
        _ => std::f64::consts::SQRT_2,
    };
    let magnitude = sign * scale * wigner[m][k];
    let (row_cosine, row_sine) = quarter_multiple(k);
    let (column_cosine, column_sine) = quarter_multiple(m);
    // cosines meet cosines where the parity is even, sines meet sines where it is odd
    let (left, right) = if mirrored {
        (if row < 0 { -row_sine } else { row_cosine }, if column < 0 { -column_sine } else { column_cosine })
    } else {
        (if row < 0 { row_cosine } else { row_sine }, if column < 0 { column_cosine } else { column_sine })
    };
    left * magnitude * right
}

/// Cosine and sine of `m` quarter turns, exactly.
fn quarter_multiple(m: usize) -> (f64, f64) {
    [(1.0, 0.0), (0.0, 1.0), (-1.0, 0.0), (0.0, -1.0)][m % 4]
}

/// `wigner[m][k] = d_km(90 degrees)` of degree `l` for `0 <= k, m <= l`, correctly rounded.
///
/// Column m is the eigenvector of J_x with eigenvalue m, so its entries obey
/// `sqrt((l-k)(l+k+1)) v_(k+1) + sqrt((l+k)(l-k+1)) v_(k-1) = 2 m v_k`. Run from `k = l` downwards the wanted solution is
/// the growing one, then it oscillates: it is stable, and no band needs the one before it. In f64 the matrix would still
/// be 14 eps from orthogonal at degree 128; twice the digits bring that to the rounding of its entries.
fn wigner_quarter(l: usize) -> Vec<Vec<f64>> {
    let couplings: Vec<DoubleDouble> =
        (0..=l).map(|k| DoubleDouble::new(((l + k) * (l + 1 - k)) as f64).sqrt()).collect();
    (0..=l).map(|m| wigner_column(l, m, &couplings)).collect()
}

/// Column `m`; `couplings[k] = sqrt((l+k)(l-k+1))`.
fn wigner_column(l: usize, m: usize, couplings: &[DoubleDouble]) -> Vec<f64> {
    let eigenvalue = DoubleDouble::new(2.0 * m as f64);
    let mut column = vec![DoubleDouble::ZERO; l + 1];
    // d_lm has the sign (-1)^(l-m); its size follows from the length of the column
    column[l] = DoubleDouble::new(if (l - m).is_multiple_of(2) { 1.0 } else { -1.0 });
    for k in (1..=l).rev() {
        let above = if k < l { couplings[k + 1] * column[k + 1] } else { DoubleDouble::ZERO };
        column[k - 1] = (eigenvalue * column[k] - above) / couplings[k];
    }
    // |d_(-k)m| = |d_km|: every row but the middle one counts twice
    let half = column[1..].iter().fold(DoubleDouble::ZERO, |sum, &value| sum + value * value);
    let length = (column[0] * column[0] + half + half).sqrt();
    column.into_iter().map(|value| (value / length).round()).collect()
}
