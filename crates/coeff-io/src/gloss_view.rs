//! How gloss is drawn: the lobe, the way of the product, and what of that a file can show.

use crate::{Bounced, Prt};
use glam::Quat;
use sh_math::lobe::Lobe;
use sh_math::{Bands, Rgb};

/// Half the angle of a rotation that counts as none: rounding.
const MOST_TURN: f32 = 1e-6;
/// Difference of a coefficient of the light, against the largest, that counts as rounding.
const SAME_LIGHT: f32 = 1e-3;

/// How gloss is drawn.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct GlossView {
    /// The family of lobes.
    pub lobe: Lobe,
    /// One roughness for all that shines, in place of the materials' own.
    pub roughness: Option<f32>,
    /// The way of the product; none lets the renderer choose.
    pub way: Option<GlossWay>,
    /// Whether what the lobe holds beyond the bands comes from the prefiltered reflection.
    pub tail: bool,
    /// The finest level of transfer textures that is shown.
    pub level: u32,
}

impl Default for GlossView {
    fn default() -> Self {
        Self { lobe: Lobe::Ggx, roughness: None, way: None, tail: true, level: 0 }
    }
}

/// How light, transfer and lobe are multiplied: all give the same picture.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum GlossWay {
    /// The triple product for every fragment or vertex that is drawn (\[T\] TP).
    Tp,
    /// The matrix of the light for every fragment or vertex that is drawn (\[T\] TPFL).
    Tpfl,
    /// Light times transfer once per texel or vertex and light, kept; a dot product where it is drawn.
    Cache,
}

impl GlossWay {
    /// All ways, the slowest to draw first.
    pub const ALL: [Self; 3] = [Self::Tp, Self::Tpfl, Self::Cache];

    /// The name as typed and printed.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Tp => "tp",
            Self::Tpfl => "tpfl",
            Self::Cache => "cache",
        }
    }

    /// The way with the fewest multiply-adds for a frame: `receivers` are lit for the cache once per `frames_per_light` frames, `drawn`
    /// fragments or vertices are shaded in each.
    ///
    /// A product takes `3 n^4`, a dot product with what is kept `4 n^2`; TP is never the fewest.
    #[must_use]
    pub fn cheapest(bands: Bands, receivers: u64, drawn: u64, frames_per_light: f64) -> Self {
        let k = bands.coefficients() as f64;
        let cache = receivers as f64 * 3.0 * k * k / frames_per_light.max(1.0) + drawn as f64 * 4.0 * k;
        let direct = drawn as f64 * (3.0 * k * k + 4.0 * k);
        if cache <= direct { Self::Cache } else { Self::Tpfl }
    }
}

impl GlossView {
    /// Says what of the view a file cannot show under a light as it lies, turned by `rotation`.
    ///
    /// # Errors
    /// Half a sentence: a roughness outside [0, 1], a level that does not exist, and, where bounces were baked under one light and one set
    /// of materials, anything that changes either.
    pub fn check_for(&self, prt: &Prt, light: &Rgb, rotation: Quat) -> Result<(), String> {
        if let Some(roughness) = self.roughness.filter(|r| !(0.0..=1.0).contains(r)) {
            return Err(format!("a roughness of {roughness}; it must lie in [0, 1]"));
        }
        if self.level > 0 {
            let levels = prt.transfer_textures.iter().flat_map(|textures| &textures.sheets).map(|s| s.levels.len());
            let levels = levels.max().unwrap_or(0);
            if self.level as usize >= levels {
                return Err(format!("level {} of the transfer textures; there are {levels}", self.level));
            }
        }
        let Some(gloss) = &prt.gloss else { return Ok(()) };
        let Some(Bounced::Fixed { probe, light: baked, materials, .. }) = &gloss.bounced else { return Ok(()) };
        let advice = "leave it, or bake bounces that can be relit";
        if rotation.xyz().length() > MOST_TURN {
            return Err(format!("the light is turned, but gloss bounces under `{probe}` as it lay; {advice}"));
        }
        let largest = baked.as_flattened().iter().fold(0.0f32, |most, v| most.max(v.abs()));
        let same = baked
            .iter()
            .zip(&light.values)
            .all(|(a, b)| a.iter().zip(b).all(|(a, b)| (a - b).abs() <= SAME_LIGHT * largest));
        if !same || light.values.len() < baked.len() {
            return Err(format!(
                "another light than `{probe}`, under which gloss bounces were baked; use that, or bake again"
            ));
        }
        if self.roughness.is_some() || prt.materials_mark() != *materials {
            return Err(format!(
                "other materials than those that gloss bounces were baked with under `{probe}`; {advice}"
            ));
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// 3,600 frames of a still light: the cache; a light that changes with every frame and few fragments: the product.
    #[test]
    fn the_way_follows_what_changes_more_often() {
        let bands = Bands::new(5).unwrap();
        assert_eq!(GlossWay::cheapest(bands, 1 << 20, 2_000_000, 3600.0), GlossWay::Cache);
        assert_eq!(GlossWay::cheapest(bands, 1 << 20, 100_000, 1.0), GlossWay::Tpfl);
        assert_eq!(GlossWay::cheapest(bands, 1 << 20, 100_000, 20.0), GlossWay::Cache);
    }
}
