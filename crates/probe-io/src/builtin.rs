//! Lights from formulas, by name.
//!
//! A name may carry numbers: `sky:25`, `cone:10,60,30`. Angles are degrees; azimuth counts from +z towards +x,
//! elevation from the horizon. Lamps give the irradiance pi, so that a white surface facing them has radiance 1.

use crate::{Environment, Lamp, sky, studio};
use glam::{DVec3, Vec3};
use std::f32::consts::PI;

/// Every analytic light: its name with optional numbers, and what it is.
pub const BUILTINS: &[(&str, &str)] = &[
    ("constant[:GREY|:R,G,B]", "the same radiance from everywhere (1 unless stated)"),
    ("white", "constant radiance 1"),
    ("two-lights", "two soft lights by formula: max(0, 5 cos theta - 4) and a second one, theta from +z"),
    ("directional[:ELEVATION,AZIMUTH]", "parallel light (50, 40)"),
    ("cone[:HALF_ANGLE,ELEVATION,AZIMUTH]", "a uniform disc of light (20, 50, 40)"),
    ("sphere[:DISTANCE,ELEVATION,AZIMUTH]", "a far glowing sphere, its distance in radii (4, 50, 40)"),
    ("hemisphere[:SKY,GROUND]", "one grey above the horizon, another below (1, 0)"),
    ("sky[:ELEVATION,AZIMUTH]", "clear sky over dry ground with the sun as a lamp (40, 40)"),
    ("studio", "a dim room with four soft boxes"),
];

/// Builds an analytic light from its name, with or without `builtin:` before it; `None` where the name is not
/// known or its numbers make no sense.
pub fn builtin(name: &str) -> Option<Environment> {
    let bare = name.strip_prefix("builtin:").unwrap_or(name);
    let (kind, numbers) = match bare.split_once(':') {
        Some((kind, list)) => (kind, parse(list)?),
        None => (bare, Vec::new()),
    };
    let mut environment = build(kind, &numbers)?;
    environment.name = format!("builtin:{bare}");
    Some(environment)
}

/// Reads numbers between commas.
fn parse(list: &str) -> Option<Vec<f64>> {
    let number = |text: &str| text.trim().parse().ok().filter(|v: &f64| v.is_finite());
    list.split(',').map(number).collect()
}

/// Finds the light of a kind.
fn build(kind: &str, numbers: &[f64]) -> Option<Environment> {
    match (kind, numbers) {
        ("white", []) => Some(Environment::constant([1.0; 3])),
        ("constant", _) => constant(numbers),
        ("two-lights", []) => Some(Environment::from_function("two-lights", 256, two_lights)),
        ("directional", _) => {
            let [elevation, azimuth] = with_defaults(numbers, [50.0, 40.0])?;
            lamp(0.0, elevation, azimuth)
        }
        ("cone", _) => {
            let [half_angle, elevation, azimuth] = with_defaults(numbers, [20.0, 50.0, 40.0])?;
            lamp(half_angle, elevation, azimuth)
        }
        ("sphere", _) => {
            let [distance, elevation, azimuth] = with_defaults(numbers, [4.0, 50.0, 40.0])?;
            let half_angle = (distance >= 1.0).then(|| libm::asin(1.0 / distance))?;
            lamp(half_angle.to_degrees(), elevation, azimuth)
        }
        ("hemisphere", _) => hemisphere(with_defaults(numbers, [1.0, 0.0])?),
        ("sky", _) => {
            let [elevation, azimuth] = with_defaults(numbers, [40.0, 40.0])?;
            sky::clear_sky(elevation, toward(elevation, azimuth))
        }
        ("studio", []) => Some(studio::studio()),
        _ => None,
    }
}

/// Replaces the first defaults by the numbers given; `None` for too many.
fn with_defaults<const N: usize>(numbers: &[f64], mut defaults: [f64; N]) -> Option<[f64; N]> {
    defaults.get_mut(..numbers.len())?.copy_from_slice(numbers);
    Some(defaults)
}

/// The unit direction at an elevation and azimuth in degrees.
fn toward(elevation: f64, azimuth: f64) -> DVec3 {
    let (sin_e, cos_e) = libm::sincos(elevation.to_radians());
    let (sin_a, cos_a) = libm::sincos(azimuth.to_radians());
    DVec3::new(sin_a * cos_e, sin_e, cos_a * cos_e)
}

/// Grey or RGB radiance from everywhere.
fn constant(numbers: &[f64]) -> Option<Environment> {
    let rgb = match *numbers {
        [] => [1.0; 3],
        [grey] => [grey; 3],
        [r, g, b] => [r, g, b],
        _ => return None,
    };
    let sound = rgb.iter().all(|v| *v >= 0.0 && *v <= f64::from(f32::MAX));
    sound.then(|| Environment::constant(rgb.map(|v| v as f32)))
}

/// The light function of the PRT introduction: two soft spots.
///
/// `max(0, 5 cos theta - 4) + max(0, -4 sin(theta - pi) cos(phi - 2.5) - 3)` with theta from +z and phi from +x
/// towards +y, so that its coefficients are those that the introduction prints (without its sign convention).
pub(crate) fn two_lights(d: DVec3) -> [f64; 3] {
    let (sin, cos) = libm::sincos(2.5);
    let first = (5.0 * d.z - 4.0).max(0.0);
    let second = (4.0 * (d.x * cos + d.y * sin) - 3.0).max(0.0);
    [first + second; 3]
}

/// A lamp in the dark.
fn lamp(half_angle: f64, elevation: f64, azimuth: f64) -> Option<Environment> {
    if !(0.0..=90.0).contains(&half_angle) {
        return None;
    }
    let mut environment = Environment::constant([0.0; 3]);
    environment.lamps.push(Lamp {
        direction: toward(elevation, azimuth).as_vec3().normalize_or(Vec3::Y),
        half_angle: half_angle.to_radians() as f32,
        irradiance: [PI; 3],
    });
    Some(environment)
}

/// One radiance above the horizon, another below.
fn hemisphere([sky, ground]: [f64; 2]) -> Option<Environment> {
    if sky < 0.0 || ground < 0.0 {
        return None;
    }
    let radiance = |d: DVec3| [if d.y > 0.0 { sky } else { ground }; 3];
    Some(Environment::from_function("hemisphere", 64, radiance))
}
