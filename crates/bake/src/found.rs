//! What blocks the directions of a point, and the sum of what it sends.

use glam::Vec3;
use raytrace::Hit;
use sh_math::Bands;

/// The surfaces that block the directions of a point.
#[derive(Debug, Default)]
pub(crate) struct Found {
    /// Direction, what it meets, and its share of the domain.
    pub(crate) hits: Vec<(Vec3, Hit, f32)>,
    /// Of each: the factor of its light on the way through translucent surfaces, RGB; empty where there are none.
    pub(crate) filters: Vec<Vec3>,
    /// Mean of every function over the directions that are not open.
    pub(crate) closed: Vec<f32>,
    /// Of the domain.
    pub(crate) angle: f32,
}

impl Found {
    /// The coefficients `[function][depth][channel]` over directions of what surfaces send; `send` writes what one does.
    ///
    /// Few directions miss the mean of every function over the directions that are not open, so their mean goes with what they miss. A
    /// surrounding that sends the same everywhere is exact.
    pub(crate) fn gather(
        &self,
        functions: Bands,
        [depth, channels]: [usize; 2],
        send: &mut dyn FnMut(&Hit, Vec3, &mut [f32]) -> bool,
    ) -> Vec<f32> {
        let mut values = vec![0.0; functions.coefficients() * depth * channels];
        if !self.hits.is_empty() {
            let found = (&self.hits[..], &self.filters[..]);
            add_sent(found, &self.closed, (functions, [depth, channels]), send, &mut values);
            values.iter_mut().for_each(|value| *value *= self.angle);
        }
        values
    }
}

/// Adds what surfaces send along the directions that meet them, by their shares of the domain: [`Found::gather`].
pub(crate) fn add_sent(
    (found, filters): (&[(Vec3, Hit, f32)], &[Vec3]),
    closed: &[f32],
    (bands, [depth, channels]): (Bands, [usize; 2]),
    send: &mut dyn FnMut(&Hit, Vec3, &mut [f32]) -> bool,
    values: &mut [f32],
) {
    let numbers = depth * channels;
    let mut missed = closed.to_vec();
    let (mut mean, mut total) = (vec![0.0f32; numbers], 0.0f32);
    let (mut harmonics, mut sent) = (vec![0.0; bands.coefficients()], vec![0.0f32; numbers]);
    for (k, (direction, hit, weight)) in found.iter().enumerate() {
        sh_math::evaluate(bands, *direction, &mut harmonics);
        missed.iter_mut().zip(&harmonics).for_each(|(rest, y)| *rest -= weight * y);
        total += weight;
        if !send(hit, *direction, &mut sent) {
            continue;
        }
        if let Some(filter) = filters.get(k) {
            pass(*filter, channels, &mut sent);
        }
        mean.iter_mut().zip(&sent).for_each(|(sum, s)| *sum += weight * s);
        for (out, harmonic) in values.chunks_exact_mut(numbers).zip(&harmonics) {
            let factor = weight * harmonic;
            out.iter_mut().zip(&sent).for_each(|(sum, s)| *sum += factor * s);
        }
    }
    if total > 0.0 {
        for (out, rest) in values.chunks_exact_mut(numbers).zip(missed) {
            out.iter_mut().zip(&mean).for_each(|(sum, m)| *sum += rest / total * m);
        }
    }
}

/// Light of `[depth][channel]` after a filter; of a single channel its mean.
fn pass(filter: Vec3, channels: usize, light: &mut [f32]) {
    let factors = if channels == 1 { Vec3::splat(mean(filter)) } else { filter }.to_array();
    light.chunks_exact_mut(channels).for_each(|row| row.iter_mut().zip(factors).for_each(|(x, factor)| *x *= factor));
}

/// Mean of three channels.
pub(crate) fn mean(channels: Vec3) -> f32 {
    channels.element_sum() / 3.0
}
