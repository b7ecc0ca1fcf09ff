//! The least window that lifts a light's reconstruction above zero.

use super::laplacian;
use crate::evaluate::visit;
use crate::{Bands, Rgb, evaluate_f64};
use glam::DVec3;

/// Grid directions per coefficient: about twelve per wavelength, so the lowest one errs by 3 % before it is refined.
const DIRECTIONS_PER_COEFFICIENT: usize = 48;
/// Share of the range above the lowest grid value from where a refined minimum could still be the lowest.
const CANDIDATE_SHARE: f64 = 0.06;
/// Most starting points of the refinement.
const MOST_CANDIDATES: usize = 48;
/// Lambdas tried before giving up: at the last one only the mean is left.
const LAMBDAS: std::ops::RangeInclusive<i32> = -24..=24;

/// Smallest `lambda` for which the reconstruction with [`laplacian`] is nowhere negative in any channel; 0 where it does
/// not ring, `None` where no lambda helps because a channel has no positive mean.
#[must_use]
pub fn find_lambda(light: &Rgb) -> Option<f64> {
    let field = Field::new(light);
    let lifts = |lambda: f64| field.minimum(&laplacian(lambda, light.bands)) >= 0.0;
    if lifts(0.0) {
        return Some(0.0);
    }
    let mut high = LAMBDAS.map(|power| libm::exp2(f64::from(power))).find(|&lambda| lifts(lambda))?;
    let mut low = 0.0;
    while high - low > 1e-6 * high {
        let middle = 0.5 * (low + high);
        *(if lifts(middle) { &mut high } else { &mut low }) = middle;
    }
    Some(high)
}

/// Lowest value of the windowed reconstruction over all directions and channels.
#[must_use]
pub fn minimum(light: &Rgb, window: &[f64]) -> f64 {
    Field::new(light).minimum(window)
}

/// A light split into its bands over a grid of directions, so that trying a window costs one short sum per direction.
struct Field<'a> {
    light: &'a Rgb,
    directions: Vec<DVec3>,
    /// `[direction][channel][band]`.
    parts: Vec<f64>,
}

impl<'a> Field<'a> {
    fn new(light: &'a Rgb) -> Self {
        let directions = spiral(DIRECTIONS_PER_COEFFICIENT * light.bands.coefficients());
        let mut parts = Vec::with_capacity(directions.len() * 3 * light.bands.count());
        let mut basis = vec![0.0; light.bands.coefficients()];
        for &direction in &directions {
            evaluate_f64(light.bands, direction, &mut basis);
            for channel in 0..3 {
                parts.extend(light.bands.degrees().map(|l| band_sum(light, &basis, l, channel)));
            }
        }
        Self { light, directions, parts }
    }

    /// Lowest value over directions and channels: the grid's lowest points, each followed downhill.
    fn minimum(&self, window: &[f64]) -> f64 {
        let values: Vec<f64> =
            self.parts.chunks_exact(self.light.bands.count()).map(|bands| weighted(bands, window)).collect();
        (0..3).map(|channel| self.channel_minimum(&values, window, channel)).fold(f64::INFINITY, f64::min)
    }

    /// Lowest value of one channel; `values` are those of the grid, `[direction][channel]`.
    fn channel_minimum(&self, values: &[f64], window: &[f64], channel: usize) -> f64 {
        let own = || values.iter().skip(channel).step_by(3).copied();
        let (lowest, highest) = own().fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), v| (l.min(v), h.max(v)));
        if highest <= lowest {
            return lowest;
        }
        let reach = lowest + CANDIDATE_SHARE * (highest - lowest);
        let mut candidates: Vec<(f64, usize)> = own().zip(0..).filter(|&(value, _)| value <= reach).collect();
        candidates.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        candidates.truncate(MOST_CANDIDATES);
        let coefficients = windowed_channel(self.light, window, channel);
        let refined = candidates.into_iter().map(|(value, at)| self.descend(self.directions[at], value, &coefficients));
        refined.fold(lowest, f64::min)
    }

    /// Compass search from one direction: steps along two tangents, halved when none leads down.
    fn descend(&self, start: DVec3, value: f64, coefficients: &[f64]) -> f64 {
        let (mut at, mut lowest) = (start, value);
        let mut step = 0.5 / self.light.bands.count() as f64;
        // next to a minimum the value errs by the square of this
        while step > 1e-5 {
            let (tangent, bitangent) = at.any_orthonormal_pair();
            let tries = [tangent, -tangent, bitangent, -bitangent].map(|along| (at + along * step).normalize());
            let best = tries
                .map(|direction| (reconstruct(self.light.bands, coefficients, direction), direction))
                .into_iter()
                .min_by(|a, b| a.0.total_cmp(&b.0));
            match best {
                Some((value, direction)) if value < lowest => (lowest, at) = (value, direction),
                _ => step *= 0.5,
            }
        }
        lowest
    }
}

/// The coefficients of one channel under a window.
fn windowed_channel(light: &Rgb, window: &[f64], channel: usize) -> Vec<f64> {
    let factor = |i: usize| window.get(i.isqrt()).copied().unwrap_or(0.0);
    light.values.iter().enumerate().map(|(i, value)| factor(i) * f64::from(value[channel])).collect()
}

/// Value of one channel along a direction.
fn reconstruct(bands: Bands, coefficients: &[f64], direction: DVec3) -> f64 {
    let mut sum = 0.0;
    visit(bands, direction.to_array(), |i, y| sum += coefficients[i] * y);
    sum
}

/// What degree `l` of one channel adds where the basis functions are `basis`.
fn band_sum(light: &Rgb, basis: &[f64], l: usize, channel: usize) -> f64 {
    let range = l * l..(l + 1) * (l + 1);
    light.values[range.clone()].iter().zip(&basis[range]).fold(0.0, |sum, (v, y)| sum + f64::from(v[channel]) * y)
}

/// The bands weighted by the window; those beyond its end count nothing.
fn weighted(bands: &[f64], window: &[f64]) -> f64 {
    bands.iter().zip(window).fold(0.0, |sum, (band, factor)| sum + band * factor)
}

/// `count` directions spread evenly: z in equal steps, longitude by the golden angle.
fn spiral(count: usize) -> Vec<DVec3> {
    let golden_angle = std::f64::consts::PI * (3.0 - 5.0_f64.sqrt());
    let direction = |i: usize| {
        let z = 1.0 - (2 * i + 1) as f64 / count as f64;
        let radius = (1.0 - z * z).sqrt();
        let (sine, cosine) = libm::sincos(i as f64 * golden_angle);
        DVec3::new(radius * cosine, radius * sine, z)
    };
    (0..count).map(direction).collect()
}
