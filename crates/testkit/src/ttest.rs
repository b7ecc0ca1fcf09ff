//! Tests of a mean against a known value: Student's t from samples, z from a mean with its standard error.

use crate::chi2::sidak;
use crate::special::beta_i;

/// Two-sided probability that a standard normal value lies at least `|z|` from 0.
#[must_use]
pub fn normal_p_value(z: f64) -> f64 {
    libm::erfc(z.abs() / std::f64::consts::SQRT_2)
}

/// Two-sided probability that Student's t with `degrees_of_freedom` lies at least `|t|` from 0.
#[must_use]
pub fn student_p_value(t: f64, degrees_of_freedom: f64) -> f64 {
    beta_i(degrees_of_freedom / 2.0, 0.5, degrees_of_freedom / (degrees_of_freedom + t * t))
}

/// Tests independent samples against their expected mean at significance [`sidak`]`(alpha, n_tests)`.
///
/// # Errors
/// One sentence with mean, spread and p when the mean is too unlikely.
pub fn test(samples: &[f64], expected: f64, alpha: f64, n_tests: usize) -> Result<f64, String> {
    let n = samples.len() as f64;
    if samples.len() < 2 {
        return Err("a t-test needs at least two samples".to_owned());
    }
    let mean = samples.iter().sum::<f64>() / n;
    let variance = samples.iter().map(|s| (s - mean) * (s - mean)).sum::<f64>() / (n - 1.0);
    let std_error = (variance / n).sqrt();
    if std_error == 0.0 {
        return exact(mean, expected);
    }
    judge(student_p_value((mean - expected) / std_error, n - 1.0), [mean, std_error, expected], alpha, n_tests)
}

/// Tests a mean of many samples and its standard error against the expected value.
///
/// # Errors
/// As [`test()`]; a standard error of 0 allows only rounding.
pub fn z_test(mean: f64, std_error: f64, expected: f64, alpha: f64, n_tests: usize) -> Result<f64, String> {
    if std_error == 0.0 {
        return exact(mean, expected);
    }
    judge(normal_p_value((mean - expected) / std_error), [mean, std_error, expected], alpha, n_tests)
}

/// Without spread the value must be right but for the rounding of f32.
fn exact(mean: f64, expected: f64) -> Result<f64, String> {
    if crate::close(mean, expected, 1e-12, 1e-5) {
        return Ok(1.0);
    }
    Err(format!("{mean} without any spread, expected {expected}"))
}

fn judge(p: f64, [mean, std_error, expected]: [f64; 3], alpha: f64, n_tests: usize) -> Result<f64, String> {
    let limit = sidak(alpha, n_tests);
    // Written so that a NaN fails too.
    if p >= limit {
        return Ok(p);
    }
    Err(format!("{mean} ± {std_error} is not {expected}: p = {p:.2e} < {limit:.2e}"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tails_equal_known_quantiles() {
        crate::assert_close!(normal_p_value(1.959_963_985), 0.05, 1e-9, 0.0);
        // t with 1 degree of freedom is Cauchy; with 2, P = 1 - t / sqrt(2 + t²).
        crate::assert_close!(student_p_value(1.0, 1.0), 0.5, 1e-12, 0.0);
        crate::assert_close!(student_p_value(3.0, 2.0), 1.0 - 3.0 / 11.0_f64.sqrt(), 1e-12, 0.0);
    }

    #[test]
    fn right_mean_passes() {
        test(&[0.9, 1.1, 1.0, 1.05, 0.95], 1.0, 0.01, 1).expect("the mean is 1");
        z_test(1.02, 0.01, 1.0, 0.01, 1).expect("two standard errors are common");
    }

    #[test]
    fn wrong_mean_can_fail() {
        assert!(test(&[0.9, 1.1, 1.0, 1.05, 0.95], 2.0, 0.01, 1).is_err(), "far off");
        assert!(z_test(1.05, 0.01, 1.0, 0.01, 1).is_err(), "five standard errors");
        assert!(z_test(1.05, 0.0, 1.0, 0.01, 1).is_err(), "no spread, wrong value");
        assert!(z_test(f64::NAN, 0.1, 1.0, 0.01, 1).is_err(), "NaN");
    }
}
