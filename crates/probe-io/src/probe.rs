//! Pixels with a layout: radiance by direction.

use crate::Layout;

/// A picture of the radiance that arrives from every direction.
#[derive(Debug, Clone)]
pub struct Probe {
    /// How the pixels lie on the sphere.
    pub layout: Layout,
    /// Columns.
    pub width: usize,
    /// Rows.
    pub height: usize,
    /// Linear RGB radiance, row by row from the top; finite and not negative.
    pub pixels: Vec<[f32; 3]>,
}
