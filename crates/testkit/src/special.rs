//! Incomplete gamma and beta functions: tails of the chi² and Student distributions.

/// Terms after which a series or fraction is taken as it is; both need about sqrt(a) terms.
const MAX_TERMS: usize = 10_000;
/// Relative size of the last term.
const LAST_TERM: f64 = 1e-15;
/// Stands in for a zero denominator in Lentz's method.
const TINY: f64 = 1e-300;

/// Regularised upper incomplete gamma function Q(a, x), `a > 0`, `x >= 0`.
///
/// Series below `x = a + 1` and a continued fraction above (Abramowitz and Stegun 6.5.29, 6.5.31).
pub(crate) fn gamma_q(a: f64, x: f64) -> f64 {
    if x <= 0.0 {
        return 1.0;
    }
    let front = libm::exp(a * libm::log(x) - x - libm::lgamma(a));
    if x < a + 1.0 {
        let (mut term, mut sum) = (1.0 / a, 1.0 / a);
        for n in 1..MAX_TERMS {
            term *= x / (a + n as f64);
            sum += term;
            if term < sum * LAST_TERM {
                break;
            }
        }
        return 1.0 - front * sum;
    }
    // Q = front / (x+1-a - 1(1-a) / (x+3-a - 2(2-a) / (x+5-a - ...)))
    let fraction = lentz(x + 1.0 - a, |n| {
        let n = n as f64;
        (-n * (n - a), x + 2.0 * n + 1.0 - a)
    });
    front / fraction
}

/// Regularised incomplete beta function I_x(a, b), by its continued fraction (Abramowitz and Stegun 26.5.8).
pub(crate) fn beta_i(a: f64, b: f64, x: f64) -> f64 {
    if x <= 0.0 || x >= 1.0 {
        return x.clamp(0.0, 1.0);
    }
    // The fraction converges fast on this side of the mean only.
    if x > (a + 1.0) / (a + b + 2.0) {
        return 1.0 - beta_i(b, a, 1.0 - x);
    }
    let log_beta = libm::lgamma(a) + libm::lgamma(b) - libm::lgamma(a + b);
    let front = libm::exp(a * libm::log(x) + b * libm::log(1.0 - x) - log_beta) / a;
    let fraction = lentz(1.0, |n| {
        let m = (n / 2) as f64;
        let numerator = if n % 2 == 0 {
            m * (b - m) / ((a + 2.0 * m - 1.0) * (a + 2.0 * m))
        } else {
            -(a + m) * (a + b + m) / ((a + 2.0 * m) * (a + 2.0 * m + 1.0))
        };
        (numerator * x, 1.0)
    });
    front / fraction
}

/// Continued fraction `b0 + a1 / (b1 + a2 / (b2 + ...))` where `term(n) = (a_n, b_n)`, by Lentz's method.
fn lentz(b0: f64, term: impl Fn(usize) -> (f64, f64)) -> f64 {
    let not_zero = |v: f64| if v.abs() < TINY { TINY } else { v };
    let mut value = not_zero(b0);
    let (mut c, mut d) = (value, 0.0);
    for n in 1..MAX_TERMS {
        let (a_n, b_n) = term(n);
        d = 1.0 / not_zero(b_n + a_n * d);
        c = not_zero(b_n + a_n / c);
        value *= c * d;
        if (c * d - 1.0).abs() < LAST_TERM {
            break;
        }
    }
    value
}

#[cfg(test)]
mod tests {
    use super::{beta_i, gamma_q};
    use crate::assert_close;

    #[test]
    fn gamma_q_equals_closed_forms() {
        for x in [0.1, 1.0, 3.0, 20.0] {
            assert_close!(gamma_q(1.0, x), libm::exp(-x), 1e-14, 1e-11);
            assert_close!(gamma_q(0.5, x), libm::erfc(f64::sqrt(x)), 1e-14, 1e-11);
            assert_close!(gamma_q(3.0, x), libm::exp(-x) * (1.0 + x + x * x / 2.0), 1e-14, 1e-11);
        }
    }

    #[test]
    fn beta_i_equals_closed_forms() {
        for x in [0.05, 0.3, 0.5, 0.9] {
            assert_close!(beta_i(1.0, 1.0, x), x, 1e-13, 0.0);
            assert_close!(beta_i(2.0, 3.0, x), x * x * (6.0 - 8.0 * x + 3.0 * x * x), 1e-13, 0.0);
            let arcsine = libm::asin(f64::sqrt(x)) * 2.0 / std::f64::consts::PI;
            assert_close!(beta_i(0.5, 0.5, x), arcsine, 1e-12, 0.0);
        }
    }
}
