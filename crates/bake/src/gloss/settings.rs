//! What is wanted of transfer textures and compression.

use crate::maps::SheetSettings;

/// Transfer in textures.
#[derive(Debug, Clone, PartialEq)]
pub struct TextureSettings {
    /// The sheets; a mesh lies in one at most, by its second texture coordinates. `directional` is of no account.
    pub sheets: Vec<SheetSettings>,
    /// Rings of texels that are filled around each chart, for filters.
    pub dilation: u32,
    /// Whether levels of detail are made, as far as charts keep apart in them.
    pub levels: bool,
    /// Whether diffuse transfer is about the normals of normal maps, \[T\] section 6.2.
    pub bent: bool,
    /// Whether the two sides of seams are made to agree.
    pub stitch: bool,
}

/// How far rows are put into clusters (`coeff_io::Form::Clustered`).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Compression {
    /// Relative error allowed to diffuse transfer and visibility; none keeps them as they are.
    pub rows: Option<f32>,
    /// Error allowed to bounces that can be relit, whose rows are long, relative to all that arrives at surfaces that shine; 0 keeps them whole, in
    /// halves. It is a wish: no more than 320 vectors are common to all, and the noise of the rays counts as well.
    pub bounces: f32,
}

impl Default for Compression {
    fn default() -> Self {
        Self { rows: None, bounces: 0.02 }
    }
}
