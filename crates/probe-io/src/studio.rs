//! A photographer's room: four soft boxes before a dim backdrop.

use crate::Environment;
use glam::DVec3;

/// A rectangle of light with soft edges.
#[derive(Debug)]
struct SoftBox {
    /// Towards its middle: azimuth from +z towards +x, and elevation, degrees.
    azimuth: f64,
    elevation: f64,
    /// Half its width and height at distance 1.
    half: [f64; 2],
    /// Linear RGB.
    radiance: [f64; 3],
}

/// Key, fill, rim and top light: one warm, one cold, two neutral.
const BOXES: [SoftBox; 4] = [
    SoftBox { azimuth: 40.0, elevation: 35.0, half: [0.42, 0.55], radiance: [9.0, 8.4, 7.6] },
    SoftBox { azimuth: -65.0, elevation: 15.0, half: [0.30, 0.75], radiance: [2.4, 2.8, 3.4] },
    SoftBox { azimuth: 170.0, elevation: 30.0, half: [0.18, 0.70], radiance: [7.0, 7.2, 7.6] },
    SoftBox { azimuth: 0.0, elevation: 88.0, half: [0.75, 0.35], radiance: [3.0, 3.0, 3.0] },
];

/// Width of a box's soft edge at distance 1.
const EDGE: f64 = 0.06;

/// Radiance of the floor, the walls and the ceiling.
const FLOOR: [f64; 3] = [0.10, 0.09, 0.08];
const WALL: [f64; 3] = [0.16, 0.16, 0.17];
const CEILING: [f64; 3] = [0.30, 0.31, 0.33];

/// The studio's light.
pub(crate) fn studio() -> Environment {
    Environment::from_function("studio", 128, radiance)
}

/// Radiance in a unit direction.
fn radiance(d: DVec3) -> [f64; 3] {
    let (far, share) = if d.y < 0.0 { (FLOOR, -d.y) } else { (CEILING, d.y) };
    let share = smooth(share);
    let mut sum: [f64; 3] = std::array::from_fn(|c| WALL[c] + (far[c] - WALL[c]) * share);
    for light in &BOXES {
        let cover = light.cover(d);
        sum = std::array::from_fn(|c| sum[c] + (light.radiance[c] - sum[c]) * cover);
    }
    sum
}

/// Rises smoothly from 0 to 1.
fn smooth(t: f64) -> f64 {
    let t = t.clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}

impl SoftBox {
    /// How much of a unit direction the box fills, 0 to 1.
    fn cover(&self, d: DVec3) -> f64 {
        let (sin_a, cos_a) = libm::sincos(self.azimuth.to_radians());
        let (sin_e, cos_e) = libm::sincos(self.elevation.to_radians());
        let axis = DVec3::new(sin_a * cos_e, sin_e, cos_a * cos_e);
        let side = DVec3::new(cos_a, 0.0, -sin_a);
        let up = DVec3::new(-sin_a * sin_e, cos_e, -cos_a * sin_e);
        let forward = d.dot(axis);
        if forward <= 0.0 {
            return 0.0;
        }
        let within = |along: DVec3, half: f64| smooth((half - (d.dot(along) / forward).abs()) / EDGE + 0.5);
        within(side, self.half[0]) * within(up, self.half[1])
    }
}
