//! Windows whose kernel is nowhere negative.

use crate::Bands;

/// Factors with a non-negative kernel.
#[must_use]
pub fn non_negative(bands: Bands) -> Vec<f64> {
    let table: &[f64] = match bands.count() {
        3 => &[1.0, 0.571_290_87, 0.228_899_99],
        4 => &[1.0, 0.685_485_50, 0.365_937_12, 0.110_461_30],
        5 => &[1.0, 0.769_739_14, 0.506_065_31, 0.241_679_23, 0.081_334_57],
        _ => &[1.0],
    };
    table.to_vec()
}
