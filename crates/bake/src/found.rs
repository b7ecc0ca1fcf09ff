//! What blocks the directions of a point, and the sum of what it sends.

use glam::Vec3;
use raytrace::Hit;
use sh_math::Bands;

/// The surfaces that block the directions of a point.
#[derive(Debug, Default)]
pub(crate) struct Found {
    /// Direction, what it meets, and its share of the domain.
    pub(crate) hits: Vec<(Vec3, Hit, f32)>,
    /// Mean of every function over the directions that are not open.
    pub(crate) closed: Vec<f32>,
    /// Of the domain.
    pub(crate) angle: f32,
}

impl Found {
    /// The coefficients `[function][number]` over directions of what surfaces send; `send` writes what one does.
    ///
    /// Few directions miss the mean of every function over the directions that are not open, so their mean goes with what they miss. A
    /// surrounding that sends the same everywhere is exact.
    pub(crate) fn gather(
        &self,
        functions: Bands,
        numbers: usize,
        send: &mut dyn FnMut(&Hit, Vec3, &mut [f32]) -> bool,
    ) -> Vec<f32> {
        let mut values = vec![0.0; functions.coefficients() * numbers];
        if !self.hits.is_empty() {
            add_sent(&self.hits, &self.closed, (functions, numbers), send, &mut values);
            values.iter_mut().for_each(|value| *value *= self.angle);
        }
        values
    }
}

/// Adds what surfaces send along the directions that meet them, by their shares of the domain: [`Found::gather`].
pub(crate) fn add_sent(
    found: &[(Vec3, Hit, f32)],
    closed: &[f32],
    (bands, numbers): (Bands, usize),
    send: &mut dyn FnMut(&Hit, Vec3, &mut [f32]) -> bool,
    values: &mut [f32],
) {
    let mut missed = closed.to_vec();
    let (mut mean, mut total) = (vec![0.0f32; numbers], 0.0f32);
    let (mut harmonics, mut sent) = (vec![0.0; bands.coefficients()], vec![0.0f32; numbers]);
    for (direction, hit, weight) in found {
        sh_math::evaluate(bands, *direction, &mut harmonics);
        missed.iter_mut().zip(&harmonics).for_each(|(rest, y)| *rest -= weight * y);
        total += weight;
        if !send(hit, *direction, &mut sent) {
            continue;
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
