//! Discs and points of distant light, found by sampling their cone.

use glam::Vec3;
use probe_io::Lamp;
use sampling::frame::Frame;
use sampling::warp::{cone_height, square_to_cone};
use std::f32::consts::{FRAC_PI_2, PI, TAU};

/// A lamp as paths need it.
#[derive(Debug, Clone, Copy)]
pub(crate) struct LampLight {
    frame: Frame,
    /// 1 - cos(half angle); 0 for a point.
    height: f32,
    /// Radiance of the disc times its solid angle; for a point the irradiance on a surface that faces it.
    pub(crate) flux: Vec3,
}

impl LampLight {
    pub(crate) fn new(lamp: &Lamp) -> Self {
        let height = cone_height(lamp.half_angle);
        // A surface that faces a disc of radiance 1 receives pi sin²(half angle); beyond the hemisphere all is behind.
        let sin = libm::sinf(lamp.half_angle.min(FRAC_PI_2));
        let per_irradiance = if height > 0.0 { TAU * height / (PI * sin * sin) } else { 1.0 };
        Self {
            frame: Frame::from_normal(lamp.direction.normalize()),
            height,
            flux: Vec3::from_array(lamp.irradiance) * per_irradiance,
        }
    }

    /// A direction to the lamp, uniform over its disc, and its radiance over the density of that direction.
    pub(crate) fn sample(&self, square: [f32; 2]) -> (Vec3, Vec3) {
        let direction = if self.height > 0.0 {
            self.frame.to_world(square_to_cone(square, self.height))
        } else {
            self.frame.normal
        };
        (direction, self.flux)
    }

    /// Density per solid angle of [`Self::sample`] over the disc; none for a point, which no direction meets by chance.
    pub(crate) fn density(&self) -> Option<f32> {
        (self.height > 0.0).then(|| 1.0 / (TAU * self.height))
    }

    /// Whether a unit direction meets the disc. The chord keeps what a cosine near 1 rounds off.
    pub(crate) fn meets(&self, direction: Vec3) -> bool {
        0.5 * (direction - self.frame.normal).length_squared() < self.height
    }
}
