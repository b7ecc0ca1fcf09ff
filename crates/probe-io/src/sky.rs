//! A clear sky with a sun: sunlight scattered once in a flat atmosphere, in closed form.
//!
//! The model is this project's own. Air and dust share one height profile, so the light scattered once on the way
//! down has a closed form; light scattered again is added as a geometric series. Distances through the air use the
//! air mass of F. Kasten and A. T. Young, "Revised optical air mass tables and approximation formula", Applied
//! Optics 28, 1989. The Rayleigh coefficients at 680, 550 and 440 nm are those of E. Bruneton and F. Neyret,
//! "Precomputed Atmospheric Scattering", 2008, over a scale height of 8 km.

use crate::{Environment, Lamp};
use glam::DVec3;
use std::f64::consts::{PI, TAU};

/// Vertical optical depth of the air: 5.8, 13.5 and 33.1 per 1000 km times 8 km.
const AIR: [f64; 3] = [0.0464, 0.108, 0.2648];

/// Vertical optical depth of fine dust on a clear day: `0.05 (wavelength in um)^-1.3`.
const DUST: [f64; 3] = [0.0826, 0.1088, 0.1454];

/// Vertical optical depth of the ozone layer, which only absorbs.
const OZONE: [f64; 3] = [0.0098, 0.0282, 0.0013];

/// Share of the light met by dust that is scattered, and how far forward (Henyey and Greenstein's g).
const DUST_ALBEDO: f64 = 0.92;
const DUST_FORWARD: f64 = 0.76;

/// Colour of dry ground.
const GROUND: [f64; 3] = [0.22, 0.19, 0.15];

/// Irradiance of the sun above the air; white ground under the default sky then has a radiance near 1.
const SUN: f64 = 5.5;

/// Angular radius of the sun, radians.
const SUN_RADIUS: f32 = 0.004_652;

/// Rows of the picture.
const ROWS: usize = 128;

/// The sky for a sun at an elevation of 1 to 90 degrees in a unit direction; `None` for other elevations.
pub(crate) fn clear_sky(elevation: f64, sun: DVec3) -> Option<Environment> {
    if !(1.0..=90.0).contains(&elevation) {
        return None;
    }
    let day = Day::new(sun);
    let ground = day.ground();
    let mut environment = Environment::from_function("sky", ROWS, |d| day.radiance(d, ground));
    environment.lamps.push(Lamp {
        direction: sun.as_vec3().normalize(),
        half_angle: SUN_RADIUS,
        irradiance: day.direct.map(|e| e as f32),
    });
    Some(environment)
}

/// What depends on the sun only.
#[derive(Debug)]
struct Day {
    sun: DVec3,
    /// Air mass towards the sun.
    mass: f64,
    /// Irradiance on a surface that faces the sun at the ground.
    direct: [f64; 3],
}

/// Vertical optical depth of everything.
fn depth(channel: usize) -> f64 {
    AIR[channel] + DUST[channel] + OZONE[channel]
}

/// Relative length of the way through the air at a sine of elevation (Kasten and Young 1989, eq. 3).
fn air_mass(sine: f64) -> f64 {
    let sine = sine.clamp(0.0, 1.0);
    let degrees = libm::asin(sine).to_degrees();
    1.0 / (sine + 0.50572 * libm::pow(degrees + 6.07995, -1.6364))
}

impl Day {
    fn new(sun: DVec3) -> Day {
        let mass = air_mass(sun.y);
        let direct = std::array::from_fn(|c| SUN * libm::exp(-depth(c) * mass));
        Day { sun, mass, direct }
    }

    /// Radiance of the sky in a unit direction on or above the horizon.
    fn sky(&self, d: DVec3) -> [f64; 3] {
        let cos = d.dot(self.sun);
        let air = 3.0 / (16.0 * PI) * (1.0 + cos * cos);
        let g = DUST_FORWARD;
        let spread = 1.0 + g * g - 2.0 * g * cos;
        let dust = (1.0 - g * g) / (4.0 * PI * spread * libm::sqrt(spread));
        let (view, sun) = (air_mass(d.y), self.mass);
        std::array::from_fn(|c| {
            let tau = depth(c);
            let scattered = (AIR[c] * air + DUST_ALBEDO * DUST[c] * dust) / tau;
            // Integral over the depth t from the top: exp(-t sun) in, exp(-(tau - t) view) out, view dt long.
            let difference = (view - sun) * tau;
            let way = if difference.abs() < 1e-6 {
                tau * libm::exp(-tau * sun)
            } else {
                tau * libm::exp(-tau * sun) * -libm::expm1(-difference) / difference
            };
            SUN * scattered * view * way * again(c)
        })
    }

    /// Irradiance of the whole sky and the sun on flat ground, reflected: the ground's radiance.
    fn ground(&self) -> [f64; 3] {
        const RINGS: usize = 24;
        const SPOKES: usize = 48;
        let mut sum = self.direct.map(|e| e * self.sun.y);
        for ring in 0..RINGS {
            // Equal parts of sin^2 of the angle from the zenith have equal cosine-weighted solid angles.
            let flat = libm::sqrt((ring as f64 + 0.5) / RINGS as f64);
            let up = libm::sqrt(1.0 - flat * flat);
            for spoke in 0..SPOKES {
                let (s, c) = libm::sincos(TAU * (spoke as f64 + 0.5) / SPOKES as f64);
                let sky = self.sky(DVec3::new(flat * s, up, flat * c));
                sum = std::array::from_fn(|k| sum[k] + sky[k] * PI / (RINGS * SPOKES) as f64);
            }
        }
        std::array::from_fn(|c| sum[c] * GROUND[c] / PI)
    }

    /// Radiance in any unit direction, without the sun's disc.
    fn radiance(&self, d: DVec3, ground: [f64; 3]) -> [f64; 3] {
        if d.y >= 0.0 {
            return self.sky(d);
        }
        // Far ground fades into the horizon: haze over a way of a hundredth of an optical depth per eye height.
        let level = DVec3::new(d.x, 0.0, d.z);
        let horizon = self.sky(level.normalize_or(DVec3::Z));
        let clear = libm::exp(-0.01 / -d.y);
        std::array::from_fn(|c| ground[c] * clear + horizon[c] * (1.0 - clear))
    }
}

/// Growth of the sky's light by what is scattered more than once: a geometric series in the share of scattered
/// light that meets the air again on a vertical way.
fn again(channel: usize) -> f64 {
    let tau = depth(channel);
    let kept = (AIR[channel] + DUST_ALBEDO * DUST[channel]) / tau;
    1.0 / (1.0 - kept * -libm::expm1(-tau))
}
