//! Legendre polynomials and the Gauss rule on their roots.

/// `P_0..P_(count-1)` at `z`, by `l P_l = (2l - 1) z P_(l-1) - (l - 1) P_(l-2)`.
pub(crate) fn polynomials(count: usize, z: f64) -> Vec<f64> {
    let mut values = vec![1.0, z];
    for l in 2..count {
        let degree = l as f64;
        values.push(((2.0 * degree - 1.0) * z * values[l - 1] - (degree - 1.0) * values[l - 2]) / degree);
    }
    values.truncate(count);
    values
}

/// Nodes and weights on [-1, 1], exact for polynomials of degree `2 count - 1`.
pub(crate) fn gauss_rule(count: usize) -> Vec<(f64, f64)> {
    (0..count).map(|i| gauss_node(count, i)).collect()
}

/// The `i`-th root of `P_count` by Newton's method from its asymptotic place, and its weight
/// `2 / ((1 - z^2) P'_count(z)^2)`.
fn gauss_node(count: usize, i: usize) -> (f64, f64) {
    let n = count as f64;
    let mut z = -libm::cos(std::f64::consts::PI * (i as f64 + 0.75) / (n + 0.5));
    let mut slope = 1.0;
    // six digits to start with, twice as many with each step
    for _ in 0..5 {
        let values = polynomials(count + 1, z);
        slope = n * (z * values[count] - values[count - 1]) / (z * z - 1.0);
        z -= values[count] / slope;
    }
    (z, 2.0 / ((1.0 - z * z) * slope * slope))
}
