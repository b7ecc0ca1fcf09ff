//! A drawn picture, for calculations and for the display.

use crate::Tonemap;
use crate::tone::{Quantiser, curve};
use rayon::prelude::*;

/// A drawn picture, row by row from the top.
#[derive(Debug, Clone, PartialEq)]
pub struct Image {
    /// Columns.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// Linear Rec. 709, scene-referred: after exposure and bloom, before the tone curve.
    pub linear: Vec<[f32; 3]>,
    /// Tone-mapped and sRGB-encoded RGBA; opaque.
    pub display: Vec<[u8; 4]>,
}

impl Image {
    /// Adds the display form to a linear picture.
    pub(crate) fn new(width: u32, height: u32, linear: Vec<[f32; 3]>, tonemap: Tonemap, quantiser: &Quantiser) -> Self {
        let encode = |pixel: &[f32; 3]| {
            let byte = |x: f32| quantiser.byte(curve(tonemap, x));
            [byte(pixel[0]), byte(pixel[1]), byte(pixel[2]), 255]
        };
        let display = linear.par_iter().map(encode).collect();
        Self { width, height, linear, display }
    }
}
