//! Pearson's chi² test: do counts follow a density?

use crate::quadrature::gauss_legendre;
use crate::special::gamma_q;

/// Bins with fewer expected counts are pooled: below about 5 the chi² distribution no longer holds.
pub const MIN_EXPECTED: f64 = 5.0;

/// What a passed test found.
#[derive(Debug, Clone, Copy)]
pub struct Outcome {
    /// Sum of (observed - expected)² / expected over the pooled bins.
    pub statistic: f64,
    /// Pooled bins minus one.
    pub degrees_of_freedom: usize,
    /// Probability of a statistic at least as large if the density is right.
    pub p_value: f64,
}

/// Significance of one of `n_tests` tests such that all together fail by chance with `alpha` (Šidák).
#[must_use]
pub fn sidak(alpha: f64, n_tests: usize) -> f64 {
    -libm::expm1(libm::log1p(-alpha) / n_tests.max(1) as f64)
}

/// Tests counts against expected counts at significance [`sidak`]`(alpha, n_tests)`.
///
/// # Errors
/// One sentence with the statistic when the counts are too unlikely, or when a count lies where none may.
pub fn test(observed: &[u64], expected: &[f64], alpha: f64, n_tests: usize) -> Result<Outcome, String> {
    if observed.len() != expected.len() {
        return Err(format!("{} observed bins but {} expected ones", observed.len(), expected.len()));
    }
    let (total, total_expected) = (observed.iter().sum::<u64>() as f64, expected.iter().sum::<f64>());
    // Without this a density that does not integrate to one would only spread over all bins.
    if !crate::close(total, total_expected, 0.5, 1e-3) {
        return Err(format!("{total} samples, but the density integrates to {total_expected:.1} of them"));
    }
    if let Some(bin) = (0..observed.len()).find(|&i| expected[i] <= 1e-9 && observed[i] > 0) {
        return Err(format!("{} samples in bin {bin}, where the density is 0", observed[bin]));
    }
    let pooled = pool(observed, expected);
    if pooled.len() < 2 {
        return Err(format!("only {} bin has {MIN_EXPECTED} expected samples; draw more", pooled.len()));
    }
    let statistic = pooled.iter().map(|(o, e)| (o - e) * (o - e) / e).sum::<f64>();
    let degrees_of_freedom = pooled.len() - 1;
    let p_value = gamma_q(degrees_of_freedom as f64 / 2.0, statistic / 2.0);
    let limit = sidak(alpha, n_tests);
    if p_value < limit {
        return Err(format!(
            "chi² {statistic:.1} with {degrees_of_freedom} degrees of freedom: p = {p_value:.2e} < {limit:.2e} ({total} samples)"
        ));
    }
    Ok(Outcome { statistic, degrees_of_freedom, p_value })
}

/// Joins bins, smallest expectation first, until each has [`MIN_EXPECTED`].
fn pool(observed: &[u64], expected: &[f64]) -> Vec<(f64, f64)> {
    let mut order: Vec<usize> = (0..observed.len()).collect();
    order.sort_by(|&a, &b| expected[a].total_cmp(&expected[b]));
    let mut pooled = Vec::new();
    let (mut o, mut e) = (0.0, 0.0);
    for i in order {
        o += observed[i] as f64;
        e += expected[i];
        if e >= MIN_EXPECTED {
            pooled.push((o, e));
            (o, e) = (0.0, 0.0);
        }
    }
    // What is left over is smaller than any bin: it joins the last.
    if let Some(last) = pooled.last_mut() {
        last.0 += o;
        last.1 += e;
    }
    pooled
}

/// Bins over a band of the unit sphere: equal steps in `z` and in longitude around `z`.
#[derive(Debug, Clone)]
pub struct SphereBins {
    /// Lower and upper `z`; a direction outside is an error.
    pub z_range: [f64; 2],
    /// Steps in `z`.
    pub n_z: usize,
    /// Steps in longitude.
    pub n_phi: usize,
}

impl SphereBins {
    /// Tests unit directions against a density per solid angle.
    ///
    /// # Errors
    /// As [`test()`]; also when a direction is not unit or lies outside `z_range`.
    pub fn test(
        &self,
        directions: &[[f64; 3]],
        pdf: impl Fn([f64; 3]) -> f64,
        alpha: f64,
        n_tests: usize,
    ) -> Result<Outcome, String> {
        let mut observed = vec![0_u64; self.n_z * self.n_phi];
        for &direction in directions {
            observed[self.bin(direction)?] += 1;
        }
        let expected: Vec<f64> = self.integrals(pdf).iter().map(|p| p * directions.len() as f64).collect();
        test(&observed, &expected, alpha, n_tests)
    }

    fn bin(&self, [x, y, z]: [f64; 3]) -> Result<usize, String> {
        let [low, high] = self.z_range;
        let length = (x * x + y * y + z * z).sqrt();
        // Directions come rounded to f32.
        if (length - 1.0).abs() > 1e-6 || z < low - 1e-6 || z > high + 1e-6 {
            return Err(format!("direction ({x}, {y}, {z}) is not unit or not in z {low}..{high}"));
        }
        let turn = libm::atan2(y, x) / std::f64::consts::TAU;
        let step = |share: f64, n: usize| ((share * n as f64) as usize).min(n - 1);
        let row = step(((z - low) / (high - low)).max(0.0), self.n_z);
        Ok(row * self.n_phi + step(turn - turn.floor(), self.n_phi))
    }

    /// Probability of each bin, by 8 x 8 Gauss points.
    fn integrals(&self, pdf: impl Fn([f64; 3]) -> f64) -> Vec<f64> {
        let rule = gauss_legendre(8);
        let [low, high] = self.z_range;
        let (dz, dphi) = ((high - low) / self.n_z as f64, std::f64::consts::TAU / self.n_phi as f64);
        let mut integrals = Vec::with_capacity(self.n_z * self.n_phi);
        for bin in 0..self.n_z * self.n_phi {
            let (row, column) = ((bin / self.n_phi) as f64, (bin % self.n_phi) as f64);
            let mut sum = 0.0;
            for &(a, weight_a) in &rule {
                let z = low + dz * (row + 0.5 + 0.5 * a);
                let r = (1.0 - z * z).max(0.0).sqrt();
                for &(b, weight_b) in &rule {
                    let (sin, cos) = libm::sincos(dphi * (column + 0.5 + 0.5 * b));
                    sum += weight_a * weight_b * pdf([r * cos, r * sin, z]);
                }
            }
            integrals.push(sum * dz * dphi / 4.0);
        }
        integrals
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const FAIR: [f64; 6] = [100.0; 6];

    #[test]
    fn fair_die_passes_with_the_known_statistic() {
        let outcome = test(&[90, 110, 95, 105, 100, 100], &FAIR, 0.01, 1).expect("a fair die passes");
        crate::assert_close!(outcome.statistic, 2.5, 1e-12, 0.0);
        // Q(5/2, 5/4) from the closed form erfc(s) + 2 exp(-s²) (s + 2/3 s³) / sqrt(pi), s² = 5/4.
        crate::assert_close!(outcome.p_value, 0.776_495_1, 1e-6, 0.0);
    }

    #[test]
    fn loaded_die_can_fail() {
        assert!(test(&[160, 88, 88, 88, 88, 88], &FAIR, 0.01, 1).is_err(), "p is 1e-7");
        assert!(test(&[100; 6], &[120.0; 6], 0.01, 1).is_err(), "the density is too large by a fifth");
        assert!(test(&[300, 300, 0], &[300.0, 299.0, 0.0], 0.01, 1).is_ok(), "an empty bin is no fault");
        assert!(test(&[300, 299, 1], &[300.0, 300.0, 0.0], 0.01, 1).is_err(), "a sample of density 0");
    }

    #[test]
    fn small_bins_are_pooled() {
        let pooled = pool(&[1, 0, 2, 50, 4], &[1.0, 1.0, 1.0, 48.0, 6.0]);
        assert_eq!(pooled, vec![(7.0, 9.0), (50.0, 48.0)], "three bins of one need the next to reach five");
    }

    #[test]
    fn sidak_of_two_tests() {
        let one = sidak(0.05, 2);
        crate::assert_close!(1.0 - (1.0 - one) * (1.0 - one), 0.05, 1e-14, 0.0);
    }
}
