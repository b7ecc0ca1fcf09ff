//! Distances between linear RGB pictures.

/// Root of the mean squared difference over pixels and channels.
///
/// # Panics
/// When the pictures differ in length or are empty, as all functions of this module do.
#[must_use]
pub fn rmse(image: &[[f32; 3]], reference: &[[f32; 3]]) -> f64 {
    let (sum, n) = fold(image, reference, |sum, a, b| sum + (a - b) * (a - b));
    (sum / n).sqrt()
}

/// [`rmse`] divided by the root mean square of the reference.
#[must_use]
pub fn relative_rmse(image: &[[f32; 3]], reference: &[[f32; 3]]) -> f64 {
    let (power, n) = fold(image, reference, |sum, _, b| sum + b * b);
    rmse(image, reference) / (power / n).sqrt()
}

/// Sum of absolute differences divided by the sum of the reference's absolute values.
#[must_use]
pub fn mean_relative(image: &[[f32; 3]], reference: &[[f32; 3]]) -> f64 {
    let (difference, _) = fold(image, reference, |sum, a, b| sum + (a - b).abs());
    let (size, _) = fold(image, reference, |sum, _, b| sum + b.abs());
    difference / size
}

/// Largest absolute difference of a channel; NaN if either picture holds one.
#[must_use]
pub fn max_difference(image: &[[f32; 3]], reference: &[[f32; 3]]) -> f64 {
    // f64::max would drop a NaN.
    fold(image, reference, |worst, a, b| if (a - b).abs() <= worst { worst } else { (a - b).abs() + worst * 0.0 }).0
}

fn fold(image: &[[f32; 3]], reference: &[[f32; 3]], step: impl Fn(f64, f64, f64) -> f64) -> (f64, f64) {
    assert_eq!(image.len(), reference.len(), "pictures of different size");
    assert!(!image.is_empty(), "pictures without pixels");
    let pairs = image.as_flattened().iter().zip(reference.as_flattened());
    (pairs.fold(0.0, |sum, (&a, &b)| step(sum, f64::from(a), f64::from(b))), (3 * image.len()) as f64)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::assert_close;

    const GREY: [[f32; 3]; 2] = [[0.5; 3], [1.0; 3]];
    const OFF: [[f32; 3]; 2] = [[0.5; 3], [1.0, 1.0, 1.75]];

    #[test]
    fn distances_of_one_wrong_channel() {
        assert_close!(rmse(&OFF, &GREY), (0.5625_f64 / 6.0).sqrt(), 1e-7, 0.0);
        assert_close!(relative_rmse(&OFF, &GREY), (0.5625_f64 / 3.75).sqrt(), 1e-7, 0.0);
        assert_close!(mean_relative(&OFF, &GREY), 0.75 / 4.5, 1e-7, 0.0);
        assert_close!(max_difference(&OFF, &GREY), 0.75, 0.0, 0.0);
    }

    #[test]
    fn nan_pixels_can_fail() {
        for picture in [[[f32::NAN, 0.0, 0.0], [1.0; 3]], [[1.0; 3], [0.0, f32::NAN, 0.0]]] {
            assert!(max_difference(&picture, &GREY).is_nan(), "a NaN must not vanish");
            assert!(rmse(&picture, &GREY).is_nan(), "a NaN must not vanish");
        }
    }

    #[test]
    #[should_panic(expected = "different size")]
    fn different_sizes_can_fail() {
        let _ = rmse(&GREY, &GREY[..1]);
    }
}
