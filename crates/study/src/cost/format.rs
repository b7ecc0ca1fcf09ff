//! Coefficients in fewer bits: what a smaller number format would cost in accuracy.
//!
//! The file keeps 32-bit floats today; this reckons what others would do to the same coefficients.

use coeff_io::Transfer;
use half::f16;

/// How a coefficient is stored.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Format {
    /// 16-bit floats.
    F16,
    /// 8 bits over the range that each coefficient and channel has in the data.
    U8,
}

/// Steps of 8 bits.
const STEPS: f32 = 255.0;

impl Format {
    /// The name in tables.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::F16 => "16-bit floats",
            Self::U8 => "8 bits, a range per coefficient",
        }
    }

    /// The transfer after it was stored and read back.
    #[must_use]
    pub fn round_trip(self, transfer: &Transfer) -> Transfer {
        let values = match self {
            Self::F16 => transfer.values.iter().map(|&v| f16::from_f32(v).to_f32()).collect(),
            Self::U8 => in_steps(&transfer.values, row_len(transfer)),
        };
        Transfer { values, ..transfer.clone() }
    }

    /// Bytes of the coefficients, with the ranges where there are any.
    #[must_use]
    pub fn bytes(self, transfer: &Transfer) -> u64 {
        let count = transfer.values.len() as u64;
        match self {
            Self::F16 => 2 * count,
            Self::U8 => count + 8 * row_len(transfer) as u64,
        }
    }
}

fn row_len(transfer: &Transfer) -> usize {
    (transfer.bands * transfer.bands * transfer.channels) as usize
}

/// Smallest and largest value of each column of rows of `len` values.
fn ranges(values: &[f32], len: usize) -> Vec<[f32; 2]> {
    let mut ranges = vec![[f32::INFINITY, f32::NEG_INFINITY]; len];
    for row in values.chunks_exact(len.max(1)) {
        for ([low, high], &v) in ranges.iter_mut().zip(row) {
            *low = low.min(v);
            *high = high.max(v);
        }
    }
    ranges
}

fn in_steps(values: &[f32], len: usize) -> Vec<f32> {
    let ranges = ranges(values, len);
    let stored = |v: f32, [low, high]: [f32; 2]| {
        let size = high - low;
        // A coefficient that is the same everywhere needs no bits.
        if size > 0.0 { low + ((v - low) / size * STEPS).round() / STEPS * size } else { low }
    };
    values.iter().enumerate().map(|(i, &v)| stored(v, ranges[i % len])).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use sampling::rng;

    /// Two bands, one channel; column i has values of the size 4^-i.
    fn transfer() -> Transfer {
        let value = |i: u64| {
            let unit = rng::hash(7, 0, i) as f64 / u64::MAX as f64;
            ((unit - 0.4) * 0.25f64.powi((i % 4) as i32)) as f32
        };
        Transfer { bands: 2, channels: 1, values: (0..4000).map(value).collect(), ..Transfer::default() }
    }

    /// Largest error of a column, and the largest that rounding to the nearest step may make: half a step of the
    /// range, and what 32-bit floats lose beside it.
    fn error_and_bound(stored: &Transfer, column: usize) -> [f32; 2] {
        let (given, stored) = (transfer().values, &stored.values);
        let of = |values: &[f32]| -> Vec<f32> { values.iter().copied().skip(column).step_by(4).collect() };
        let (given, stored) = (of(&given), of(stored));
        let low = given.iter().copied().fold(f32::MAX, f32::min);
        let high = given.iter().copied().fold(f32::MIN, f32::max);
        let error = given.iter().zip(&stored).map(|(a, b)| (a - b).abs()).fold(0.0, f32::max);
        [error, (high - low) / 510.0 + 4.0 * f32::EPSILON * high.abs().max(low.abs())]
    }

    #[test]
    fn eight_bits_err_by_half_a_step_of_each_range() {
        let stored = Format::U8.round_trip(&transfer());
        for column in 0..4 {
            let [error, bound] = error_and_bound(&stored, column);
            assert!(error <= bound && error > 0.5 * bound, "column {column}: {error} of {bound}");
        }
        assert_eq!(Format::U8.bytes(&transfer()), 4000 + 4 * 8);
    }

    /// One range for all coefficients, as the papers have it, is seen to be too coarse for the small ones.
    #[test]
    fn eight_bits_err_by_half_a_step_of_each_range_can_fail() {
        let given = transfer();
        let stored = Transfer { values: in_steps(&given.values, 1), ..given };
        let [error, bound] = error_and_bound(&stored, 3);
        assert!(error > 5.0 * bound, "{error} of {bound}");
    }

    /// A 16-bit float keeps 11 significant bits, so it errs by 2^-11 of the value at most; below 2^-14 by half of its smallest
    /// step, 2^-25.
    #[test]
    fn sixteen_bits_keep_eleven() {
        let given = transfer();
        let stored = Format::F16.round_trip(&given);
        let bound = |a: f32| f32::max(a.abs() / 2048.0, 2.0f32.powi(-25));
        let shares = given.values.iter().zip(&stored.values).map(|(&a, &b)| (a - b).abs() / bound(a));
        let worst = shares.fold(0.0, f32::max);
        assert!(worst <= 1.0 && worst > 0.5, "{worst} of the bound");
        assert_eq!(Format::F16.bytes(&given), 8000);
    }

    #[test]
    fn a_constant_coefficient_is_kept() {
        assert_eq!(in_steps(&[0.3, 0.3, 0.3], 1), [0.3, 0.3, 0.3]);
        assert!(in_steps(&[], 4).is_empty());
    }
}
