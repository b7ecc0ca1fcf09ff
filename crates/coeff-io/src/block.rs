//! Blocks of 4x4 texels: how layers are cut into them, and the ranges between which their codes lie.
//!
//! The bytes: `[layer]` u8, the curve; `[layer][range][2]` f32; then the blocks, `[layer][row of blocks][column of blocks]`. Where a side is
//! no multiple of 4 the last column or row is repeated. Texels of no chart hold what makes their block easy.

use crate::layers::f32_at;
use crate::{Coding, Curve, Effort, Encoded, Encoding, Layers, bc1, bc6h};
use block_compression::encode::{compress_rgba8, compress_rgba16};
use block_compression::{BC6HSettings, CompressionVariant};
use half::f16;

/// RGB of the texels of a block, row by row, as shares of the range.
pub(crate) type Texels = [[f32; 3]; 16];

/// A format of blocks.
pub(crate) trait Format {
    /// Bytes of a block.
    const BYTES: usize;
    /// Ranges of a layer of so many channels.
    fn ranges(channels: usize) -> usize;
    /// Blocks of a picture of shares whose sides are multiples of 4.
    fn encode(shares: &[[f32; 3]], size: [u32; 2], effort: Effort) -> Vec<u8>;
    /// The shares of a block.
    fn decode(block: &[u8]) -> Texels;
}

/// RGB at 5, 6 and 5 bits, two of them per block: a range per channel.
pub(crate) struct Bc1;

/// Unsigned halves, two or four of them per block: one range for all channels.
pub(crate) struct Bc6h;

impl Format for Bc1 {
    const BYTES: usize = 8;

    fn ranges(channels: usize) -> usize {
        channels
    }

    fn encode(shares: &[[f32; 3]], [width, height]: [u32; 2], _: Effort) -> Vec<u8> {
        let code = |share: f32| libm::roundf(share * 255.0) as u8;
        let rgba: Vec<u8> = shares.iter().flat_map(|s| [code(s[0]), code(s[1]), code(s[2]), 255]).collect();
        let mut blocks = vec![0; shares.len() / 16 * Self::BYTES];
        compress_rgba8(CompressionVariant::BC1, &rgba, &mut blocks, width, height, width * 4);
        blocks
    }

    fn decode(block: &[u8]) -> Texels {
        bc1::decode(std::array::from_fn(|i| block[i]))
    }
}

impl Format for Bc6h {
    const BYTES: usize = 16;

    fn ranges(_: usize) -> usize {
        1
    }

    fn encode(shares: &[[f32; 3]], [width, height]: [u32; 2], effort: Effort) -> Vec<u8> {
        let settings = match effort {
            Effort::Fast => BC6HSettings::very_fast(),
            Effort::Basic => BC6HSettings::basic(),
            Effort::Slow => BC6HSettings::very_slow(),
        };
        let half = f16::from_f32;
        let rgba: Vec<f16> = shares.iter().flat_map(|s| [half(s[0]), half(s[1]), half(s[2]), f16::ONE]).collect();
        let mut blocks = vec![0; shares.len() / 16 * Self::BYTES];
        compress_rgba16(CompressionVariant::BC6H(settings), &rgba, &mut blocks, width, height, width * 4);
        blocks
    }

    fn decode(block: &[u8]) -> Texels {
        bc6h::decode(std::array::from_fn(|i| block[i]))
    }
}

/// Where the parts of the bytes begin: ranges, blocks, end. None where sizes overflow.
fn places<F: Format>(layers: &Layers) -> Option<[usize; 3]> {
    let count = layers.count as usize;
    let blocks = (layers.width.div_ceil(4) as usize).checked_mul(layers.height.div_ceil(4) as usize)?;
    let first = count.checked_mul(8 * F::ranges(layers.channels as usize))?.checked_add(count)?;
    let end = blocks.checked_mul(count)?.checked_mul(F::BYTES)?.checked_add(first)?;
    Some([count, first, end])
}

/// The bytes that the sizes demand.
pub(crate) fn length<F: Format>(layers: &Layers) -> Option<usize> {
    places::<F>(layers).map(|[_, _, end]| end)
}

/// Layers of blocks as graphics hardware takes them: what it reads, and what the shader must do to the result.
#[derive(Debug, Clone, PartialEq)]
pub struct Blocks<'a> {
    /// `[layer][row of blocks][column of blocks]` blocks.
    pub bytes: &'a [u8],
    /// Per layer the curve and per channel the least and the greatest number: `low (1 - share) + high share`.
    pub layers: Vec<(Curve, [[f32; 2]; 3])>,
}

impl Layers {
    /// The blocks of [`Encoding::Bc1`] and [`Encoding::Bc6h`]; none in other encodings.
    #[must_use]
    pub fn blocks(&self) -> Option<Blocks<'_>> {
        match self.encoding {
            Encoding::Bc1 => blocks::<Bc1>(self),
            Encoding::Bc6h => blocks::<Bc6h>(self),
            _ => None,
        }
    }
}

fn blocks<F: Format>(layers: &Layers) -> Option<Blocks<'_>> {
    let [ranges, first, _] = places::<F>(layers)?;
    let own = F::ranges(layers.channels as usize);
    let layer = |layer: usize| {
        let curve = Curve::of_byte(*layers.bytes.get(layer)?)?;
        Some((curve, std::array::from_fn(|channel| range_of(layers, ranges, layer * own + channel.min(own - 1)))))
    };
    let ranges = (0..layers.count as usize).map(layer).collect::<Option<_>>()?;
    Some(Blocks { bytes: layers.bytes.get(first..)?, layers: ranges })
}

/// The least and the greatest number of range `number`, of those that begin at byte `ranges`.
fn range_of(layers: &Layers, ranges: usize, number: usize) -> [f32; 2] {
    let at = ranges + 8 * number;
    [f32_at(&layers.bytes, at), f32_at(&layers.bytes, at + 4)]
}

/// What stands before the blocks of layers of so many channels: the inverse of [`Layers::blocks`].
pub(crate) fn head(encoding: Encoding, channels: usize, layers: &[(Curve, [[f32; 2]; 3])]) -> Vec<u8> {
    let own = if encoding == Encoding::Bc1 { Bc1::ranges(channels) } else { Bc6h::ranges(channels) };
    let mut bytes: Vec<u8> = layers.iter().map(|(curve, _)| curve.to_byte()).collect();
    bytes.extend(layers.iter().flat_map(|(_, ranges)| ranges.iter().take(own).flatten()).flat_map(|v| v.to_le_bytes()));
    bytes
}

/// As [`Layers::fault`], of bytes whose length is right. Every block decodes to shares in finite numbers.
pub(crate) fn fault<F: Format>(layers: &Layers) -> Option<(usize, String)> {
    let [ranges, first, _] = places::<F>(layers)?;
    if let Some(i) = layers.bytes[..ranges].iter().position(|byte| Curve::of_byte(*byte).is_none()) {
        return Some((i, format!("layer {i} has an unknown curve")));
    }
    let place = layers.bytes[ranges..first].chunks_exact(4).position(|b| !f32_at(b, 0).is_finite())?;
    Some((ranges + 4 * place, "a range is not finite".into()))
}

/// As [`Layers::decode_layer`].
pub(crate) fn decode<F: Format>(layers: &Layers, layer: usize) -> Vec<f32> {
    let [ranges, first, _] = places::<F>(layers).expect("the sizes fit into memory");
    let (width, height, channels) = (layers.width as usize, layers.height as usize, layers.channels as usize);
    let (across, own) = (width.div_ceil(4), F::ranges(channels));
    let curve = Curve::of_byte(layers.bytes[layer]).expect("the curve is known");
    let range = |channel: usize| range_of(layers, ranges, layer * own + channel.min(own - 1));
    let mut values = vec![0.0; layers.plane() * channels];
    let size = across * height.div_ceil(4) * F::BYTES;
    for (place, block) in layers.bytes[first + layer * size..][..size].chunks_exact(F::BYTES).enumerate() {
        for (i, shares) in F::decode(block).iter().enumerate() {
            let (column, row) = (place % across * 4 + i % 4, place / across * 4 + i / 4);
            if column >= width || row >= height {
                continue;
            }
            let at = (row * width + column) * channels;
            for (channel, value) in values[at..at + channels].iter_mut().enumerate() {
                // One channel stands in all three; green has the most bits.
                *value = curve.value(shares[if channels == 1 { 1 } else { channel }], range(channel));
            }
        }
    }
    values
}

/// As [`Layers::encode`]; `encoded` has its sizes.
pub(crate) fn encode<F: Format>(encoded: &mut Encoded, values: &[f32], coding: &Coding) {
    let layers = &encoded.layers;
    let (plane, channels, own) = (layers.plane(), layers.channels as usize, F::ranges(layers.channels as usize));
    let [ranges_at, first, end] = places::<F>(layers).expect("the sizes fit into memory");
    let mut bytes = Vec::with_capacity(end);
    // Halves follow a curve of their own.
    let curve_of = |layer| if F::BYTES == Bc6h::BYTES { Curve::Linear } else { coding.curve(layer) };
    bytes.extend((0..layers.count as usize).map(|layer| curve_of(layer).to_byte()));
    bytes.resize(first, 0);
    let mut negative = 0;
    for (layer, numbers) in values.chunks_exact(plane * channels).enumerate() {
        let constant = coding.curve(layer) == Curve::Srgb;
        let used = used(numbers, channels, coding.charts);
        negative += if constant { used.clone().flatten().filter(|value| **value < 0.0).count() as u64 } else { 0 };
        let mut ranges = vec![[f32::INFINITY, f32::NEG_INFINITY]; own];
        for texel in used {
            for (channel, value) in texel.iter().enumerate() {
                let [low, high] = &mut ranges[channel.min(own - 1)];
                (*low, *high) = (low.min(*value), high.max(*value));
            }
        }
        for (i, range) in ranges.iter_mut().enumerate() {
            *range = match *range {
                [low, high] if low > high => [0.0; 2],
                [_, high] if constant => [0.0, high.max(0.0)],
                range => range,
            };
            let at = ranges_at + 8 * (layer * own + i);
            bytes[at..at + 4].copy_from_slice(&range[0].to_le_bytes());
            bytes[at + 4..at + 8].copy_from_slice(&range[1].to_le_bytes());
        }
        let share = |value: f32, channel: usize| curve_of(layer).share(value, ranges[channel.min(own - 1)]);
        let (shares, size) = picture(numbers, layers, coding.charts, share);
        bytes.extend(F::encode(&shares, size, coding.effort));
    }
    encoded.layers.bytes = bytes;
    encoded.negative = negative;
}

/// The texels that belong to a chart.
fn used<'a>(numbers: &'a [f32], channels: usize, charts: &'a [u32]) -> impl Iterator<Item = &'a [f32]> + Clone {
    let counts = |texel: &usize| charts.get(*texel).is_none_or(|chart| *chart != u32::MAX);
    let texels = numbers.chunks_exact(channels).enumerate();
    texels.filter(move |(texel, _)| counts(texel)).map(|(_, numbers)| numbers)
}

/// The shares of a layer with sides that are multiples of 4. What belongs to no chart gets the mean of its block.
fn picture(
    numbers: &[f32],
    layers: &Layers,
    charts: &[u32],
    share: impl Fn(f32, usize) -> f32,
) -> (Vec<[f32; 3]>, [u32; 2]) {
    let (width, height, channels) = (layers.width as usize, layers.height as usize, layers.channels as usize);
    let size = [layers.width, layers.height].map(|side| side.next_multiple_of(4));
    let mut shares = vec![[0.0_f32; 3]; size[0] as usize * size[1] as usize];
    let corners = (0..height).step_by(4).flat_map(|top| (0..width).step_by(4).map(move |left| (left, top)));
    for (left, top) in corners {
        let (mut sum, mut weight) = ([0.0_f32; 3], 0.0_f32);
        let mut block = [None; 16];
        for (i, place) in block.iter_mut().enumerate() {
            let texel = (top + i / 4).min(height - 1) * width + (left + i % 4).min(width - 1);
            if charts.get(texel).is_some_and(|chart| *chart == u32::MAX) {
                continue;
            }
            let rgb: [f32; 3] = std::array::from_fn(|c| {
                let c = c.min(channels - 1);
                share(numbers[texel * channels + c], c)
            });
            sum = std::array::from_fn(|c| sum[c] + rgb[c]);
            weight += 1.0;
            *place = Some(rgb);
        }
        let mean = sum.map(|s| if weight > 0.0 { s / weight } else { 0.0 });
        for (i, place) in block.into_iter().enumerate() {
            shares[(top + i / 4) * size[0] as usize + left + i % 4] = place.unwrap_or(mean);
        }
    }
    (shares, size)
}
