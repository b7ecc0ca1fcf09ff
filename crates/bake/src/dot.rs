//! The dot product.

/// Dot product in eight lanes and blocks of 512: a fixed order that vectorises, with f64 between blocks.
pub(crate) fn dot(a: &[f32], b: &[f32]) -> f64 {
    let mut total = 0.0f64;
    for (a, b) in a.chunks(512).zip(b.chunks(512)) {
        let mut lanes = [0.0f32; 8];
        let (a8, b8) = (a.chunks_exact(8), b.chunks_exact(8));
        let rest: f32 = a8.remainder().iter().zip(b8.remainder()).map(|(x, y)| x * y).sum();
        for (x, y) in a8.zip(b8) {
            for k in 0..8 {
                lanes[k] += x[k] * y[k];
            }
        }
        total += lanes.iter().map(|&x| f64::from(x)).sum::<f64>() + f64::from(rest);
    }
    total
}

#[cfg(test)]
mod tests {
    use super::dot;

    /// Against the sum in f64, at lengths around the lanes and blocks.
    #[test]
    fn lanes_and_blocks_add_up() {
        for n in [0, 1, 7, 8, 9, 511, 512, 513, 1875] {
            let a: Vec<f32> = (0..n).map(|k| ((k * 37 % 101) as f32 - 50.0) / 50.0).collect();
            let b: Vec<f32> = (0..n).map(|k| ((k * 53 % 97) as f32 - 48.0) / 48.0).collect();
            let exact: f64 = a.iter().zip(&b).map(|(a, b)| f64::from(*a) * f64::from(*b)).sum();
            assert!((dot(&a, &b) - exact).abs() < 1e-4, "{n}");
            assert!(n < 9 || (dot(&a[1..], &b[..n - 1]) - exact).abs() > 1e-4, "can fail");
        }
    }
}
