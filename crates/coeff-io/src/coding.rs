//! How coefficients are put into fewer bytes, and what that costs at once: numbers that do not fit.

use crate::block::{Bc1, Bc6h};
use crate::{Encoding, Layers, MapLight, block, eight_bits};
use half::f16;
use serde::{Deserialize, Serialize};
use sh_math::hemisphere::Basis;

/// What [`Layers::encode`] is asked for.
#[derive(Debug, Clone, Copy)]
pub struct Coding<'a> {
    /// How the numbers are held.
    pub encoding: Encoding,
    /// The chart of each texel, `[row][column]`, `u32::MAX` where there is none; empty where all belong to one. What texels of no chart
    /// hold is lost but in [`Encoding::F32`] and [`Encoding::F16`].
    pub charts: &'a [u32],
    /// How codes of each layer follow its numbers, see [`curves`]; empty where all are linear. For [`Encoding::U8`] and
    /// [`Encoding::Bc1`]; halves and [`Encoding::Bc6h`] follow a curve of their own.
    pub curves: &'a [Curve],
    /// Between which numbers the codes of [`Encoding::U8`] lie.
    pub ranges: Ranges,
    /// How long [`Encoding::Bc6h`] searches.
    pub effort: Effort,
}

impl Coding<'static> {
    /// All texels in one chart, all layers linear, ranges from the data, the basic effort.
    #[must_use]
    pub const fn plain(encoding: Encoding) -> Self {
        Self { encoding, charts: &[], curves: &[], ranges: Ranges::Charts, effort: Effort::Basic }
    }
}

/// How codes of a layer follow its numbers.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Curve {
    /// In even steps.
    Linear,
    /// By the curve of sRGB, from 0 on: finer steps in the dark. Negative numbers become 0.
    Srgb,
}

/// Between which numbers eight bits lie.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Ranges {
    /// Between the least and the greatest of each chart and layer: nothing is clipped, and both are held exactly.
    Charts,
    /// The same for all, as \[N\] section 2.2.3 has it: [`Curve::Srgb`] from 0 to `constant`, [`Curve::Linear`] from `-rest` to `rest`.
    Fixed {
        /// The greatest number of the layers of the constant function, 1 in the paper.
        constant: f32,
        /// The greatest magnitude of all other layers, 0.75 in the paper: too little at grazing light.
        rest: f32,
    },
}

/// How long the encoder of BC6H searches for each block.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Effort {
    /// About ten times as fast as [`Effort::Basic`], with a third more error.
    Fast,
    /// The default.
    Basic,
    /// About five times as slow, with a little less error.
    Slow,
}

/// Layers in fewer bytes, and what did not fit into them.
#[derive(Debug, Clone, PartialEq)]
pub struct Encoded {
    /// The layers.
    pub layers: Layers,
    /// Numbers beyond what the encoding or a fixed range holds, which were brought to its border.
    pub clipped: u64,
    /// Numbers below 0 in layers of [`Curve::Srgb`], which became 0.
    pub negative: u64,
}

/// The curve of each layer of a sheet: sRGB for the constant function of fixed light, which is irradiance and not negative but by noise;
/// linear for all others, and for transfer, which is signed.
///
/// The constant function is the first of every basis but HL2, which has none (its three are alike).
#[must_use]
pub fn curves(basis: Basis, light: &MapLight) -> Vec<Curve> {
    let mut curves = vec![Curve::Linear; basis.count() * light.depth()];
    if matches!(light, MapLight::Fixed { .. }) && basis != Basis::Hl2 {
        curves[0] = Curve::Srgb;
    }
    curves
}

impl Curve {
    /// The share of the range, in [0, 1], that stands for `value`.
    pub(crate) fn share(self, value: f32, [low, high]: [f32; 2]) -> f32 {
        let share = match self {
            Self::Linear if high > low => (value * 0.5 - low * 0.5) / (high * 0.5 - low * 0.5),
            Self::Srgb if high > 0.0 => srgb_of_linear((value / high).clamp(0.0, 1.0)),
            _ => 0.0,
        };
        share.clamp(0.0, 1.0)
    }

    /// The number that a share of the range stands for; both ends exactly.
    pub(crate) fn value(self, share: f32, [low, high]: [f32; 2]) -> f32 {
        match self {
            Self::Linear => low * (1.0 - share) + high * share,
            Self::Srgb => high * linear_of_srgb(share),
        }
    }

    /// The number in a file.
    pub(crate) fn to_byte(self) -> u8 {
        self as u8
    }

    /// The inverse of [`Curve::to_byte`].
    pub(crate) fn of_byte(byte: u8) -> Option<Self> {
        [Self::Linear, Self::Srgb].into_iter().find(|curve| curve.to_byte() == byte)
    }
}

/// The curve of sRGB over [0, 1], IEC 61966-2-1: not the power of 1/2.2.
#[must_use]
pub fn srgb_of_linear(linear: f32) -> f32 {
    if linear <= 0.003_130_8 { 12.92 * linear } else { 1.055 * libm::powf(linear, 1.0 / 2.4) - 0.055 }
}

/// The inverse of [`srgb_of_linear`].
#[must_use]
pub fn linear_of_srgb(code: f32) -> f32 {
    if code <= 0.040_45 { code / 12.92 } else { libm::powf((code + 0.055) / 1.055, 2.4) }
}

impl Layers {
    /// The numbers `[layer][row][column][channel]` of shape `[width, height, count, channels]` in the encoding asked for.
    ///
    /// # Panics
    /// When the numbers are not as many as the shape says or not finite, or charts and curves are not as many as texels and layers.
    #[must_use]
    pub fn encode(shape: [u32; 4], values: &[f32], coding: &Coding) -> Encoded {
        let [width, height, count, channels] = shape;
        let expected = shape.map(|n| n as usize).iter().product::<usize>();
        assert_eq!(values.len(), expected, "one value per layer, texel and channel");
        assert!(values.iter().all(|v| v.is_finite()), "coefficients are finite");
        let layers = Self { width, height, count, channels, encoding: coding.encoding, bytes: Vec::new() };
        assert!(coding.charts.is_empty() || coding.charts.len() == layers.plane(), "one chart per texel");
        assert!(coding.curves.is_empty() || coding.curves.len() == count as usize, "one curve per layer");
        let mut encoded = Encoded { layers, clipped: 0, negative: 0 };
        match coding.encoding {
            Encoding::F32 => encoded.layers = Self::exact(shape, values),
            Encoding::F16 => halves(&mut encoded, values),
            Encoding::U8 => eight_bits::encode(&mut encoded, values, coding),
            Encoding::Bc1 => block::encode::<Bc1>(&mut encoded, values, coding),
            Encoding::Bc6h => block::encode::<Bc6h>(&mut encoded, values, coding),
        }
        encoded
    }
}

fn halves(encoded: &mut Encoded, values: &[f32]) {
    let largest = f16::MAX.to_f32();
    encoded.clipped = values.iter().filter(|v| v.abs() > largest).count() as u64;
    let half = |v: &f32| f16::from_f32(v.clamp(-largest, largest)).to_le_bytes();
    encoded.layers.bytes = values.iter().flat_map(half).collect();
}

impl Coding<'_> {
    /// The curve of a layer.
    pub(crate) fn curve(&self, layer: usize) -> Curve {
        self.curves.get(layer).copied().unwrap_or(Curve::Linear)
    }
}
