//! Rotation matrices by recursion in the degree, an oracle to degree 20 (it loses ten times more every ten degrees beyond).
//!
//! J. Ivanic, K. Ruedenberg, J. Phys. Chem. 100 (1996) 6342 with the additions of 102 (1998) 9099, and with
//! `sqrt(1 + d)` in V for m < 0, where the paper and its additions have `sqrt(1 - d)`.

use glam::DMat3;

/// `[row][column]` of one degree, orders `-l..=l`.
type Matrix = Vec<Vec<f64>>;

/// Which text of the recursion is followed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Text {
    /// With `sqrt(1 + d)`.
    Corrected,
    /// With `sqrt(1 - d)`.
    Printed,
}

/// Row-major matrices of the degrees `0..n_bands`.
pub(crate) fn matrices(n_bands: usize, rotation: DMat3, text: Text) -> Vec<Vec<f64>> {
    // the band of degree 1 holds (y, z, x)
    let axes = [1, 2, 0];
    let first: Matrix =
        axes.iter().map(|&row| axes.iter().map(|&column| rotation.col(column)[row]).collect()).collect();
    let mut all = vec![vec![vec![1.0]], first.clone()];
    for l in 2..n_bands {
        let next = degree(l as i32, &first, &all[l - 1], text);
        all.push(next);
    }
    all.truncate(n_bands);
    all.into_iter().map(|matrix| matrix.concat()).collect()
}

/// The matrix of degree `l` from those of degree 1 and `l - 1`.
fn degree(l: i32, first: &Matrix, last: &Matrix, text: Text) -> Matrix {
    (-l..=l).map(|m| (-l..=l).map(|n| entry(l, m, n, (first, last), text)).collect()).collect()
}

fn entry(l: i32, m: i32, n: i32, (first, last): (&Matrix, &Matrix), text: Text) -> f64 {
    let p = |i: i32, a: i32, b: i32| product(l, i, a, b, first, last);
    let zero = f64::from(u8::from(m == 0));
    let below = if n.abs() < l { (l + n) * (l - n) } else { 2 * l * (2 * l - 1) };
    let root = |numerator: i32| (f64::from(numerator) / f64::from(below)).sqrt();
    let size = m.abs();
    let mut sum = 0.0;
    if size < l {
        sum += root((l + m) * (l - m)) * p(0, m, n);
    }
    let v = 0.5 * (1.0 + zero).sqrt() * root((l + size - 1) * (l + size)) * (1.0 - 2.0 * zero);
    sum += v * v_term(m, n, text, p);
    if size > 0 && size < l - 1 {
        let w = -0.5 * root((l - size - 1) * (l - size));
        let term = if m > 0 { p(1, m + 1, n) + p(-1, -m - 1, n) } else { p(1, m - 1, n) - p(-1, -m + 1, n) };
        sum += w * term;
    }
    sum
}

/// V of the paper.
fn v_term(m: i32, n: i32, text: Text, p: impl Fn(i32, i32, i32) -> f64) -> f64 {
    match m {
        0 => p(1, 1, n) + p(-1, -1, n),
        1 => p(1, 0, n) * 2.0_f64.sqrt(),
        2.. => p(1, m - 1, n) - p(-1, -m + 1, n),
        -1 if text == Text::Printed => 0.0,
        -1 => p(-1, 0, n) * 2.0_f64.sqrt(),
        _ => p(1, m + 1, n) + p(-1, -m - 1, n),
    }
}

/// P of the paper: `i` is an order of degree 1, `a` one of degree `l - 1`.
fn product(l: i32, i: i32, a: i32, b: i32, first: &Matrix, last: &Matrix) -> f64 {
    let r = |j: i32| first[(i + 1) as usize][(j + 1) as usize];
    let e = |b: i32| last[(a + l - 1) as usize][(b + l - 1) as usize];
    if b == l {
        r(1) * e(l - 1) - r(-1) * e(1 - l)
    } else if b == -l {
        r(1) * e(1 - l) + r(-1) * e(l - 1)
    } else {
        r(0) * e(b)
    }
}
