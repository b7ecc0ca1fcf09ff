//! Numbers of twice the digits, for tables that are built once.
//!
//! A value is the unevaluated sum of two f64, the second at most half an ulp of the first. Only the four operations and
//! square roots are used, so results are the same on every machine.

use std::ops::{Add, Div, Mul, Sub};

/// `high + low`, about 32 digits.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct DoubleDouble {
    high: f64,
    low: f64,
}

impl DoubleDouble {
    pub(crate) const ZERO: Self = Self::new(0.0);

    pub(crate) const fn new(value: f64) -> Self {
        Self { high: value, low: 0.0 }
    }

    /// The nearest f64.
    pub(crate) fn round(self) -> f64 {
        self.high
    }

    /// Square root of a positive number: the f64 root and one Newton step.
    pub(crate) fn sqrt(self) -> Self {
        let root = self.high.sqrt();
        let rest = self - product(root, root);
        quick_sum(root, rest.high / (2.0 * root))
    }
}

impl Add for DoubleDouble {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        let highs = sum(self.high, other.high);
        let lows = sum(self.low, other.low);
        let first = quick_sum(highs.high, highs.low + lows.high);
        quick_sum(first.high, first.low + lows.low)
    }
}

impl Sub for DoubleDouble {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        self + Self { high: -other.high, low: -other.low }
    }
}

impl Mul for DoubleDouble {
    type Output = Self;
    fn mul(self, other: Self) -> Self {
        let exact = product(self.high, other.high);
        let cross = self.high * other.low + self.low * other.high;
        quick_sum(exact.high, exact.low + cross)
    }
}

impl Div for DoubleDouble {
    type Output = Self;
    fn div(self, other: Self) -> Self {
        let first = self.high / other.high;
        let rest = self - other * Self::new(first);
        let second = rest.high / other.high;
        let rest = rest - other * Self::new(second);
        quick_sum(first, second) + Self::new(rest.high / other.high)
    }
}

/// The exact sum of two numbers.
fn sum(a: f64, b: f64) -> DoubleDouble {
    let high = a + b;
    let part = high - a;
    DoubleDouble { high, low: (a - (high - part)) + (b - part) }
}

/// The exact sum of two numbers, the first the larger.
fn quick_sum(a: f64, b: f64) -> DoubleDouble {
    let high = a + b;
    DoubleDouble { high, low: b - (high - a) }
}

/// The exact product of two numbers below 2^996, from halves of 26 bits.
fn product(a: f64, b: f64) -> DoubleDouble {
    let high = a * b;
    let ([a1, a2], [b1, b2]) = (halves(a), halves(b));
    DoubleDouble { high, low: ((a1 * b1 - high) + a1 * b2 + a2 * b1) + a2 * b2 }
}

/// A number as the sum of two with at most 26 bits each.
fn halves(value: f64) -> [f64; 2] {
    /// `2^27 + 1`.
    const SPLIT: f64 = 134_217_729.0;
    let scaled = SPLIT * value;
    let high = scaled - (scaled - value);
    [high, value - high]
}

#[cfg(test)]
mod tests {
    use super::DoubleDouble;

    #[test]
    fn root_of_two_squared_is_two_to_32_digits() {
        let root = DoubleDouble::new(2.0).sqrt();
        let rest = root * root - DoubleDouble::new(2.0);
        assert!(rest.round().abs() < 1e-30, "sqrt(2)^2 - 2 = {:e}", rest.round());
    }

    #[test]
    fn third_times_three_is_one_to_32_digits() {
        let third = DoubleDouble::new(1.0) / DoubleDouble::new(3.0);
        let rest = third * DoubleDouble::new(3.0) - DoubleDouble::new(1.0);
        assert!(rest.round().abs() < 1e-31, "1/3 * 3 - 1 = {:e}", rest.round());
    }
}
