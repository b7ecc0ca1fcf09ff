//! Radiance at single points, with its standard error.

use crate::render::arriving;
use crate::world::Surface;
use crate::{Light, Settings, World, path};
use glam::{DVec3, Vec3};
use rayon::prelude::*;
use raytrace::offset_origin;
use sampling::rng::Rng;

/// A point of a diffuse surface, on one side; it mirrors nothing itself, whatever the world does.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Receiver {
    /// World, metres.
    pub position: Vec3,
    /// Unit; the cosine counts from it.
    pub normal: Vec3,
    /// Unit; rays start on this side of the surface.
    pub geometric_normal: Vec3,
    /// Diffuse, RGB in [0, 1].
    pub albedo: Vec3,
}

impl Receiver {
    fn surface(&self) -> Surface {
        let origin = offset_origin(self.position, self.geometric_normal);
        Surface { origin, normal: self.normal, facing: self.normal, albedo: self.albedo, mirror: None }
    }
}

/// A ray of a camera.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Gaze {
    /// World, metres.
    pub eye: Vec3,
    /// Unit, away from the eye.
    pub direction: Vec3,
}

/// A mean over independent paths.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Estimate {
    /// Radiance, RGB.
    pub mean: [f32; 3],
    /// Standard error of the mean; NaN from a single path.
    pub std_error: [f32; 3],
}

/// Radiance that leaves each receiver towards any viewer on its side; runs on all threads, to the same bits on any
/// number of them.
#[must_use]
pub fn radiance_at(world: &World, light: &Light, receivers: &[Receiver], settings: &Settings) -> Vec<Estimate> {
    let estimate = |(index, receiver): (usize, &Receiver)| {
        let mut rng = Rng::new(settings.seed, index as u64);
        let start = receiver.surface();
        average(settings.samples, || path::outgoing(world, light, start, settings.max_bounces, &mut rng))
    };
    receivers.par_iter().enumerate().map(estimate).collect()
}

/// Radiance that arrives at the eye of each gaze, as in a picture; runs on all threads, to the same bits on any number of them.
#[must_use]
pub fn radiance_seen(world: &World, light: &Light, gazes: &[Gaze], settings: &Settings) -> Vec<Estimate> {
    let estimate = |(index, gaze): (usize, &Gaze)| {
        let mut rng = Rng::new(settings.seed, index as u64);
        average(settings.samples, || arriving(world, light, gaze.eye, gaze.direction, settings.max_bounces, &mut rng))
    };
    gazes.par_iter().enumerate().map(estimate).collect()
}

/// Mean and standard error of `samples` independent values.
pub(crate) fn average(samples: u32, mut value: impl FnMut() -> Vec3) -> Estimate {
    let (mut mean, mut squares) = (DVec3::ZERO, DVec3::ZERO);
    for n in 1..=samples {
        let value = value().as_dvec3();
        // Welford's update: the spread of a bright sun and a dark sky does not cancel.
        let before = value - mean;
        mean += before / f64::from(n);
        squares += before * (value - mean);
    }
    let variance_of_mean = squares / (f64::from(samples) * (f64::from(samples) - 1.0));
    let std_error = variance_of_mean.to_array().map(|v| v.sqrt() as f32);
    Estimate { mean: mean.as_vec3().to_array(), std_error }
}
