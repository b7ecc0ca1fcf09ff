//! Eigenvectors of symmetric matrices, in a fixed order of operations: a file is the same on every machine, which libraries that choose
//! their kernels by the processor do not promise.

/// Most steps of the QL iteration for one eigenvalue.
const STEPS: usize = 64;

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
    iterate(&mut diagonal, &mut beside, &mut z);
    let mut order: Vec<usize> = (0..n).collect();
    order.sort_by(|&a, &b| diagonal[b].total_cmp(&diagonal[a]).then(a.cmp(&b)));
    let vectors = order.iter().map(|&k| z.iter().map(|row| row[k]).collect()).collect();
    (order.iter().map(|&k| diagonal[k]).collect(), vectors)
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
        let mut image = vec![0.0; i];
        for (j, image) in image.iter_mut().enumerate() {
            let below: f64 = (j + 1..i).map(|k| z[k][j] * row[k]).sum();
            *image = (z[j][..=j].iter().zip(&row).map(|(a, b)| a * b).sum::<f64>() + below) / h;
        }
        let half = image.iter().zip(&row).map(|(a, b)| a * b).sum::<f64>() / (h + h);
        image.iter_mut().zip(&row).for_each(|(e, u)| *e -= half * u);
        for j in 0..i {
            let (u, e) = (row[j], image[j]);
            for k in 0..=j {
                z[j][k] -= u * image[k] + e * row[k];
            }
        }
        for (j, u) in row.iter().enumerate() {
            z[j][i] = u / h;
        }
        z[i][..i].copy_from_slice(&row);
        diagonal[i] = h;
    }
    for i in 0..n {
        if diagonal[i] != 0.0 {
            let factors: Vec<f64> = (0..i).map(|j| (0..i).map(|k| z[i][k] * z[k][j]).sum()).collect();
            for row in z.iter_mut().take(i) {
                let u = row[i];
                row[..i].iter_mut().zip(&factors).for_each(|(x, g)| *x -= g * u);
            }
        }
        diagonal[i] = z[i][i];
        z[i][i] = 1.0;
        z[i][..i].fill(0.0);
        z.iter_mut().take(i).for_each(|row| row[i] = 0.0);
    }
    (diagonal, beside)
}

/// QL with implicit shifts; the columns of `z` become the eigenvectors.
fn iterate(diagonal: &mut [f64], beside: &mut [f64], z: &mut [Vec<f64>]) {
    let n = diagonal.len();
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
                for row in z.iter_mut() {
                    let (a, b) = (row[i], row[i + 1]);
                    row[i + 1] = sine * a + cosine * b;
                    row[i] = cosine * a - sine * b;
                }
            }
            if !broke {
                diagonal[l] -= p;
                beside[l] = g;
                beside[end] = 0.0;
            }
        }
    }
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
