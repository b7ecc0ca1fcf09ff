//! Eigenvectors of symmetric matrices, in a fixed order of operations: a file is the same on every machine, which libraries that choose
//! their kernels by the processor do not promise.

/// Most steps of the QL iteration for one eigenvalue.
const STEPS: usize = 64;
/// Turns of two vectors that are kept before they are done.
const TURNS: usize = 1 << 14;
/// Components of all vectors that are turned together: those of a few hundred vectors stay near the processor.
const TOGETHER: usize = 8;

/// Eigenvalues, the largest first, and their unit eigenvectors, `[vector][component]`, of a symmetric matrix of `n` rows.
///
/// Householder's reduction to three diagonals, then QL with implicit shifts (J. H. Wilkinson, C. Reinsch, *Linear Algebra*, 1971).
///
/// # Panics
/// When there are not `n * n` numbers.
pub(crate) fn symmetric(matrix: &[f64], n: usize) -> (Vec<f64>, Vec<Vec<f64>>) {
    assert_eq!(matrix.len(), n * n, "a square matrix");
    if n == 0 {
        return (Vec::new(), Vec::new());
    }
    let mut z: Vec<Vec<f64>> = matrix.chunks_exact(n).map(<[f64]>::to_vec).collect();
    let (mut diagonal, mut beside) = tridiagonal(&mut z);
    let mut vectors: Vec<Vec<f64>> = (0..n).map(|k| z.iter().map(|row| row[k]).collect()).collect();
    iterate(&mut diagonal, &mut beside, &mut vectors);
    let mut order: Vec<usize> = (0..n).collect();
    order.sort_by(|&a, &b| diagonal[b].total_cmp(&diagonal[a]).then(a.cmp(&b)));
    (order.iter().map(|&k| diagonal[k]).collect(), order.iter().map(|&k| std::mem::take(&mut vectors[k])).collect())
}

/// Reduces `z` to three diagonals; `z` becomes the orthogonal transform.
fn tridiagonal(z: &mut [Vec<f64>]) -> (Vec<f64>, Vec<f64>) {
    let n = z.len();
    let (mut diagonal, mut beside) = (vec![0.0; n], vec![0.0; n]);
    for i in (1..n).rev() {
        let scale: f64 = z[i][..i].iter().map(|x| x.abs()).sum();
        if i == 1 || scale == 0.0 {
            beside[i] = z[i][i - 1];
            diagonal[i] = 0.0;
            continue;
        }
        let mut row: Vec<f64> = z[i][..i].iter().map(|x| x / scale).collect();
        let mut h: f64 = row.iter().map(|x| x * x).sum();
        let f = row[i - 1];
        let g = if f >= 0.0 { -h.sqrt() } else { h.sqrt() };
        beside[i] = scale * g;
        h -= f * g;
        row[i - 1] = f - g;
        // Only what is left of the diagonal is kept: each row counts as a column too.
        let mut image = vec![0.0; i];
        for j in 0..i {
            image[j] += dot(&z[j][..=j], &row);
            add(&mut image[..j], row[j], &z[j]);
        }
        image.iter_mut().for_each(|e| *e /= h);
        let half = dot(&image, &row) / (h + h);
        image.iter_mut().zip(&row).for_each(|(e, u)| *e -= half * u);
        for j in 0..i {
            let (u, e) = (row[j], image[j]);
            add(&mut z[j][..=j], -u, &image);
            add(&mut z[j][..=j], -e, &row);
        }
        for (j, u) in row.iter().enumerate() {
            z[j][i] = u / h;
        }
        z[i][..i].copy_from_slice(&row);
        diagonal[i] = h;
    }
    for i in 0..n {
        if diagonal[i] != 0.0 {
            let mut factors = vec![0.0; i];
            for (row, &factor) in z.iter().zip(&z[i][..i]) {
                add(&mut factors, factor, row);
            }
            for row in z.iter_mut().take(i) {
                let u = row[i];
                add(&mut row[..i], -u, &factors);
            }
        }
        diagonal[i] = z[i][i];
        z[i][i] = 1.0;
        z[i][..i].fill(0.0);
        z.iter_mut().take(i).for_each(|row| row[i] = 0.0);
    }
    (diagonal, beside)
}

/// QL with implicit shifts; the columns of the transform become the eigenvectors, one after the other as they lie in memory.
fn iterate(diagonal: &mut [f64], beside: &mut [f64], vectors: &mut [Vec<f64>]) {
    let n = diagonal.len();
    let mut turns = Vec::new();
    beside.rotate_left(1);
    beside[n - 1] = 0.0;
    for l in 0..n {
        for _ in 0..STEPS {
            let end = (l..n - 1)
                .find(|&m| beside[m].abs() <= f64::EPSILON * (diagonal[m].abs() + diagonal[m + 1].abs()))
                .unwrap_or(n - 1);
            if end == l {
                break;
            }
            let mut g = (diagonal[l + 1] - diagonal[l]) / (2.0 * beside[l]);
            let r = (g * g + 1.0).sqrt();
            g = diagonal[end] - diagonal[l] + beside[l] / (g + if g >= 0.0 { r } else { -r });
            let (mut sine, mut cosine, mut p) = (1.0, 1.0, 0.0);
            let mut broke = false;
            for i in (l..end).rev() {
                let (f, b) = (sine * beside[i], cosine * beside[i]);
                let r = (f * f + g * g).sqrt();
                beside[i + 1] = r;
                if r == 0.0 {
                    diagonal[i + 1] -= p;
                    beside[end] = 0.0;
                    broke = true;
                    break;
                }
                (sine, cosine) = (f / r, g / r);
                g = diagonal[i + 1] - p;
                let r = (diagonal[i] - g) * sine + 2.0 * cosine * b;
                p = sine * r;
                diagonal[i + 1] = g + p;
                g = cosine * r - b;
                turns.push(Turn { first: i, sine, cosine });
            }
            if turns.len() >= TURNS {
                turn(vectors, &turns);
                turns.clear();
            }
            if !broke {
                diagonal[l] -= p;
                beside[l] = g;
                beside[end] = 0.0;
            }
        }
    }
    turn(vectors, &turns);
}

/// A turn of a vector and the next within the plane of both.
struct Turn {
    first: usize,
    sine: f64,
    cosine: f64,
}

/// Does turns one after the other, a few components of all vectors at a time.
fn turn(vectors: &mut [Vec<f64>], turns: &[Turn]) {
    let n = vectors.len();
    let mut parts = vec![[0.0; TOGETHER]; n];
    for start in (0..n).step_by(TOGETHER) {
        let count = TOGETHER.min(n - start);
        for (part, vector) in parts.iter_mut().zip(&*vectors) {
            part[..count].copy_from_slice(&vector[start..start + count]);
        }
        for &Turn { first, sine, cosine } in turns {
            let (a, b) = (parts[first], parts[first + 1]);
            for k in 0..TOGETHER {
                parts[first + 1][k] = sine * a[k] + cosine * b[k];
                parts[first][k] = cosine * a[k] - sine * b[k];
            }
        }
        for (part, vector) in parts.iter().zip(&mut *vectors) {
            vector[start..start + count].copy_from_slice(&part[..count]);
        }
    }
}

/// Dot product of the shorter length in four lanes: a fixed order that vectorises.
fn dot(a: &[f64], b: &[f64]) -> f64 {
    let (a, b) = (&a[..a.len().min(b.len())], &b[..a.len().min(b.len())]);
    let (a4, b4) = (a.chunks_exact(4), b.chunks_exact(4));
    let rest: f64 = a4.remainder().iter().zip(b4.remainder()).map(|(x, y)| x * y).sum();
    let mut lanes = [0.0; 4];
    for (x, y) in a4.zip(b4) {
        for k in 0..4 {
            lanes[k] += x[k] * y[k];
        }
    }
    lanes.iter().sum::<f64>() + rest
}

/// Adds a multiple of the first of `values` to all of `sums`.
fn add(sums: &mut [f64], factor: f64, values: &[f64]) {
    sums.iter_mut().zip(values).for_each(|(sum, value)| *sum += factor * value);
}

#[cfg(test)]
mod tests {
    use super::symmetric;

    fn some(n: usize) -> Vec<f64> {
        let mut matrix = vec![0.0; n * n];
        for i in 0..n {
            for j in 0..=i {
                let x = ((i * 7 + j * 13) % 17) as f64 / 4.0 - 2.0;
                (matrix[i * n + j], matrix[j * n + i]) = (x, x);
            }
        }
        matrix
    }

    /// `A v = lambda v`, unit vectors, descending order, and the trace.
    #[test]
    fn vectors_are_only_stretched() {
        for n in [1, 2, 3, 8, 40] {
            let matrix = some(n);
            let (values, vectors) = symmetric(&matrix, n);
            for (value, vector) in values.iter().zip(&vectors) {
                for i in 0..n {
                    let image: f64 = matrix[i * n..(i + 1) * n].iter().zip(vector).map(|(a, v)| a * v).sum();
                    assert!((image - value * vector[i]).abs() < 1e-11 * n as f64, "{n}: {image} {}", value * vector[i]);
                }
                assert!((vector.iter().map(|v| v * v).sum::<f64>() - 1.0).abs() < 1e-12);
            }
            let trace: f64 = (0..n).map(|i| matrix[i * n + i]).sum();
            assert!((values.iter().sum::<f64>() - trace).abs() < 1e-10);
            assert!(values.windows(2).all(|pair| pair[0] >= pair[1]));
        }
        let (values, _) = symmetric(&[2.0, 1.0, 1.0, 2.0], 2);
        assert!((values[0] - 3.0).abs() < 1e-14 && (values[1] - 1.0).abs() < 1e-14);
        let (other, _) = symmetric(&[2.0, 1.5, 1.5, 2.0], 2);
        assert!((other[0] - 3.0).abs() > 0.1, "can fail");
    }

    #[test]
    fn nothing_and_zeros_are_no_trouble() {
        assert!(symmetric(&[], 0).0.is_empty());
        assert_eq!(symmetric(&[0.0; 9], 3).0, [0.0; 3]);
    }
}
