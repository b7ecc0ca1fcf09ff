//! Directional light maps: the light that arrives at the texels of a sheet, as a function of the normal that a normal map asks for.

use crate::Layers;
use serde::{Deserialize, Serialize};
use sh_math::hemisphere::Basis;

/// Sheets of coefficients, and which meshes they lie upon (by their second texture coordinates).
///
/// The coefficients of a texel are those of irradiance / pi (the radiance of a white surface) over the unit normals of the
/// tangent frame there: x along the tangent of the vertices, y along `handedness * normal x tangent`, z along the shading normal. So a
/// normal of a normal map is used as it stands; where a material has none it is (0, 0, 1). \[N\] section 2.2.2.
#[derive(Debug, Clone, PartialEq)]
pub struct Maps {
    /// The functions that the coefficients belong to.
    pub basis: Basis,
    /// Whether light is in them, or how they answer to it.
    pub light: MapLight,
    /// Referred to by [`Maps::sheet_of_mesh`].
    pub sheets: Vec<Sheet>,
    /// Of each mesh of the file its sheet; none where the transfer of the vertices is drawn, as on the backs of surfaces.
    pub sheet_of_mesh: Vec<Option<u32>>,
}

/// What the coefficients of maps and volumes hold.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum MapLight {
    /// Light of one probe, as it lay: RGB per function.
    Fixed {
        /// The probe as the user named it.
        probe: String,
        /// Bands of the light.
        bands: u32,
    },
    /// Transfer: per function `bands * bands` numbers whose dot product with the coefficients of a light is the fixed coefficient.
    Relightable {
        /// Bands of the light.
        bands: u32,
    },
}

impl MapLight {
    /// Numbers per function and channel.
    #[must_use]
    pub fn depth(&self) -> usize {
        match self {
            Self::Fixed { .. } => 1,
            Self::Relightable { bands } => (bands * bands) as usize,
        }
    }
}

/// The coefficients of one sheet. Layer `function * depth + i` is coefficient `i` of the light in a function ([`MapLight::depth`]); texel
/// row 0 is at v = 0.
///
/// A sheet holds all functions of the basis, the first few where the basis can be cut there, or, where no normal map is, one in any basis: that of
/// an ordinary light map ([`Basis::ModifiedH1`]).
#[derive(Debug, Clone, PartialEq)]
pub struct Sheet {
    /// The layers.
    pub layers: Layers,
}

/// The coefficients of a sheet under a light: RGB.
#[derive(Debug, Clone, PartialEq)]
pub struct Lit {
    /// Texels along u.
    pub width: u32,
    /// Texels along v.
    pub height: u32,
    /// The functions of the texels: `[function][row][column]`.
    pub functions: Vec<Vec<[f32; 3]>>,
}

impl Sheet {
    /// The coefficients, of the functions that the sheet holds, under a light of `depth` or more coefficients in world axes (unused where the
    /// light is fixed).
    ///
    /// # Panics
    /// When the light has fewer coefficients.
    #[must_use]
    pub fn lit(&self, maps: &Maps, light: &[[f32; 3]]) -> Lit {
        let (layers, depth) = (&self.layers, maps.light.depth());
        let plane = layers.width as usize * layers.height as usize;
        let channels = layers.channels as usize;
        let rgb = |values: &[f32]| [values[0], values[1 % channels], values[2 % channels]];
        let factors = match maps.light {
            MapLight::Fixed { .. } => vec![[1.0; 3]],
            MapLight::Relightable { .. } => light[..depth].to_vec(),
        };
        let function = |k: usize| {
            let mut sum = vec![[0.0f32; 3]; plane];
            for (i, factor) in factors.iter().enumerate() {
                let layer = layers.decode_layer((k * depth + i) as u32);
                for (out, texel) in sum.iter_mut().zip(layer.chunks_exact(channels)) {
                    let texel = rgb(texel);
                    *out = std::array::from_fn(|c| out[c] + factor[c] * texel[c]);
                }
            }
            sum
        };
        let functions = (0..layers.count as usize / depth).map(function).collect();
        Lit { width: layers.width, height: layers.height, functions }
    }
}
