//! Statistics, image distances, quadrature and data discovery: a dev-dependency of every crate's tests.

pub mod chi2;
mod data;
pub mod gltf;
pub mod image;
pub mod quadrature;
mod special;
pub mod ttest;

pub use data::{data_dir, say_skipped, skip};

/// Whether `a` and `b` differ by at most `abs + rel * max(|a|, |b|)`; false for NaN.
#[must_use]
pub fn close(a: f64, b: f64, abs: f64, rel: f64) -> bool {
    (a - b).abs() <= abs + rel * a.abs().max(b.abs())
}

/// Asserts [`close`]; takes any number type that converts to f64 with `as`, and an optional message.
#[macro_export]
macro_rules! assert_close {
    ($a:expr, $b:expr, $abs:expr, $rel:expr $(,)?) => {
        $crate::assert_close!($a, $b, $abs, $rel, "{} against {}", stringify!($a), stringify!($b))
    };
    ($a:expr, $b:expr, $abs:expr, $rel:expr, $($message:tt)+) => {{
        let (a, b) = ($a as f64, $b as f64);
        assert!(
            $crate::close(a, b, $abs as f64, $rel as f64),
            "{a:e} is not close to {b:e} (difference {:e}, allowed {:e} + {:e} relative): {}",
            (a - b).abs(), $abs as f64, $rel as f64, format_args!($($message)+)
        );
    }};
}

#[cfg(test)]
mod tests {
    #[test]
    fn close_counts_both_tolerances() {
        assert!(super::close(1.0, 1.1, 0.1, 0.01), "within the sum of both");
        assert!(super::close(100.0, 101.0, 0.0, 0.01), "within the relative part");
    }

    #[test]
    #[should_panic(expected = "is not close to")]
    fn assert_close_can_fail() {
        assert_close!(1.0_f32, 1.1_f32, 0.01, 0.01);
    }

    #[test]
    fn close_to_nan_can_fail() {
        assert!(!super::close(f64::NAN, f64::NAN, 1.0, 1.0), "NaN is close to nothing");
    }
}
