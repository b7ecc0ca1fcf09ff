//! Eight bits per number, between the least and the greatest of its chart and layer.
//!
//! The bytes: the number of charts N as u32; a byte per layer, its curve; `[chart][layer][2]` f32, the range; the chart of each texel,
//! in one byte where N is below 256, in two below 65,536, else in four, all bits set where there is none; the codes,
//! `[layer][row][column][channel]`.

use crate::layers::f32_at;
use crate::{Coding, Curve, Encoded, Layers, Ranges};

/// Where each part of the bytes begins.
struct Places {
    curves: usize,
    ranges: usize,
    charts: usize,
    codes: usize,
    end: usize,
    /// Bytes of the number of a chart.
    wide: usize,
}

impl Places {
    /// None where sizes overflow.
    fn of(layers: &Layers, charts: usize) -> Option<Self> {
        let wide = match charts {
            0..0x100 => 1,
            0x100..0x1_0000 => 2,
            _ => 4,
        };
        let (count, plane) = (layers.count as usize, (layers.width as usize).checked_mul(layers.height as usize)?);
        let ranges = 4_usize.checked_add(count)?;
        let charts = charts.checked_mul(count)?.checked_mul(8)?.checked_add(ranges)?;
        let codes = plane.checked_mul(wide)?.checked_add(charts)?;
        let end = plane.checked_mul(count)?.checked_mul(layers.channels as usize)?.checked_add(codes)?;
        Some(Self { curves: 4, ranges, charts, codes, end, wide })
    }

    /// The chart of a texel; none where all bits are set.
    fn chart(&self, bytes: &[u8], texel: usize) -> Option<usize> {
        let from = &bytes[self.charts + texel * self.wide..][..self.wide];
        let none = from.iter().all(|byte| *byte == u8::MAX);
        (!none).then(|| from.iter().rev().fold(0, |number, byte| number << 8 | usize::from(*byte)))
    }

    fn range(&self, bytes: &[u8], of: usize) -> [f32; 2] {
        let at = self.ranges + 8 * of;
        [f32_at(bytes, at), f32_at(bytes, at + 4)]
    }
}

fn chart_count(bytes: &[u8]) -> Option<usize> {
    let number = bytes.first_chunk::<4>()?;
    usize::try_from(u32::from_le_bytes(*number)).ok()
}

/// As [`Layers::fault`].
pub(crate) fn fault(layers: &Layers) -> Option<(usize, String)> {
    let bytes = &layers.bytes;
    let places = chart_count(bytes).and_then(|charts| Some((charts, Places::of(layers, charts)?)));
    let Some((charts, places)) = places.filter(|(_, places)| places.end == bytes.len()) else {
        return Some((0, format!("{} bytes are not what its sizes and charts demand", bytes.len())));
    };
    if let Some(i) = bytes[places.curves..places.ranges].iter().position(|byte| Curve::of_byte(*byte).is_none()) {
        return Some((places.curves + i, format!("layer {i} has an unknown curve")));
    }
    let ranges = &bytes[places.ranges..places.charts];
    if let Some(i) = ranges.chunks_exact(4).position(|b| !f32_at(b, 0).is_finite()) {
        return Some((places.ranges + 4 * i, "a range is not finite".into()));
    }
    let known = |texel: &usize| places.chart(bytes, *texel).is_some_and(|chart| chart >= charts);
    let texel = (0..layers.plane()).find(known)?;
    Some((places.charts + texel * places.wide, format!("texel {texel} is of a chart that does not exist")))
}

/// As [`Layers::decode_layer`].
pub(crate) fn decode(layers: &Layers, layer: usize) -> Vec<f32> {
    let bytes = &layers.bytes;
    let charts = chart_count(bytes).expect("the bytes begin with the number of charts");
    let places = Places::of(layers, charts).expect("the sizes fit into memory");
    let (count, plane, channels) = (layers.count as usize, layers.plane(), layers.channels as usize);
    let curve = Curve::of_byte(bytes[places.curves + layer]).expect("the curve is known");
    // Of a code its share of the range under the curve, so that no curve is evaluated per texel.
    let shares: Vec<f32> = (0..=u8::MAX).map(|code| curve.value(f32::from(code) / 255.0, [0.0, 1.0])).collect();
    let codes = &bytes[places.codes + layer * plane * channels..][..plane * channels];
    let mut values = vec![0.0; plane * channels];
    for texel in 0..plane {
        let Some(chart) = places.chart(bytes, texel) else { continue };
        let range = places.range(bytes, chart * count + layer);
        let range = if curve == Curve::Srgb { [0.0, range[1]] } else { range };
        let at = texel * channels;
        for (value, code) in values[at..at + channels].iter_mut().zip(&codes[at..at + channels]) {
            *value = Curve::Linear.value(shares[usize::from(*code)], range);
        }
    }
    values
}

/// Charts as they are counted in the bytes: those that occur, in the order of their numbers.
fn charts_of(charts: &[u32], plane: usize) -> (usize, Vec<Option<usize>>) {
    if charts.is_empty() {
        return (1, vec![Some(0); plane]);
    }
    let mut known: Vec<u32> = charts.iter().copied().filter(|chart| *chart != u32::MAX).collect();
    known.sort_unstable();
    known.dedup();
    let number = |chart: &u32| known.binary_search(chart).ok();
    (known.len(), charts.iter().map(number).collect())
}

/// As [`Layers::encode`]; `encoded` has its sizes.
pub(crate) fn encode(encoded: &mut Encoded, values: &[f32], coding: &Coding) {
    let layers = &encoded.layers;
    let (count, plane, channels) = (layers.count as usize, layers.plane(), layers.channels as usize);
    let (charts, chart_of) = charts_of(coding.charts, plane);
    let places = Places::of(layers, charts).expect("the sizes fit into memory");
    let mut bytes = vec![0; places.end];
    bytes[..4].copy_from_slice(&(charts as u32).to_le_bytes());
    for (texel, chart) in chart_of.iter().enumerate() {
        let number = chart.map_or(u32::MAX, |chart| chart as u32).to_le_bytes();
        bytes[places.charts + texel * places.wide..][..places.wide].copy_from_slice(&number[..places.wide]);
    }
    let (mut clipped, mut negative) = (0, 0);
    for layer in 0..count {
        let curve = coding.curve(layer);
        bytes[places.curves + layer] = curve.to_byte();
        let numbers = &values[layer * plane * channels..][..plane * channels];
        let ranges = ranges(numbers, &chart_of, charts, curve, coding.ranges);
        for (chart, range) in ranges.iter().enumerate() {
            let at = places.ranges + 8 * (chart * count + layer);
            bytes[at..at + 4].copy_from_slice(&range[0].to_le_bytes());
            bytes[at + 4..at + 8].copy_from_slice(&range[1].to_le_bytes());
        }
        let codes = &mut bytes[places.codes + layer * plane * channels..][..plane * channels];
        for (i, (code, value)) in codes.iter_mut().zip(numbers).enumerate() {
            let Some(chart) = chart_of[i / channels] else { continue };
            let range = ranges[chart];
            let below = *value < range[0];
            negative += u64::from(below && curve == Curve::Srgb);
            clipped += u64::from(*value > range[1] || (below && curve == Curve::Linear));
            *code = libm::roundf(curve.share(*value, range) * 255.0) as u8;
        }
    }
    encoded.layers.bytes = bytes;
    (encoded.clipped, encoded.negative) = (clipped, negative);
}

/// The range of each chart in one layer.
fn ranges(numbers: &[f32], chart_of: &[Option<usize>], charts: usize, curve: Curve, asked: Ranges) -> Vec<[f32; 2]> {
    if let Ranges::Fixed { constant, rest } = asked {
        let range = if curve == Curve::Srgb { [0.0, constant] } else { [-rest, rest] };
        return vec![range; charts];
    }
    let mut ranges = vec![[f32::INFINITY, f32::NEG_INFINITY]; charts];
    let channels = numbers.len() / chart_of.len();
    for (texel, chart) in numbers.chunks_exact(channels).zip(chart_of) {
        let Some(chart) = chart else { continue };
        let [low, high] = &mut ranges[*chart];
        for value in texel {
            (*low, *high) = (low.min(*value), high.max(*value));
        }
    }
    let curved = |range: [f32; 2]| if curve == Curve::Srgb { [0.0, range[1].max(0.0)] } else { range };
    ranges.into_iter().map(curved).collect()
}
