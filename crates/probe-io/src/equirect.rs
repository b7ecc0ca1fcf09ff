//! The panorama: columns are longitude, rows are latitude.

use crate::patch::{Patch, Rect};
use glam::DVec3;
use std::f64::consts::{PI, TAU};

/// The direction at picture position `(x, y)` in pixels from the top left corner.
///
/// `phi = 2 pi (x/w - 1/2)`, `theta = pi y/h`; +z in the centre, +x to the left of it, +y up.
pub(crate) fn direction(width: usize, height: usize, x: f64, y: f64) -> DVec3 {
    let phi = TAU * (x / width as f64 - 0.5);
    let theta = PI * y / height as f64;
    let (sin_phi, cos_phi) = libm::sincos(phi);
    let (sin_theta, cos_theta) = libm::sincos(theta);
    DVec3::new(-sin_phi * sin_theta, cos_theta, cos_phi * sin_theta)
}

/// The picture position of a direction: the inverse of [`direction`].
pub(crate) fn locate(width: usize, height: usize, d: DVec3) -> (f64, f64) {
    let flat = libm::sqrt(d.x * d.x + d.z * d.z);
    let phi = if flat > 0.0 { libm::atan2(-d.x, d.z) } else { 0.0 };
    let theta = libm::atan2(flat, d.y);
    let x = (phi / TAU + 0.5) * width as f64;
    (x, theta / PI * height as f64)
}

/// A rectangle of the picture on the sphere; its solid angle is a band of latitude cut by longitude:
/// `(phi1 - phi0) (cos theta0 - cos theta1)`.
pub(crate) fn patch(width: usize, height: usize, rect: &Rect) -> Patch {
    let theta0 = PI * rect.y0 / height as f64;
    let theta1 = PI * rect.y1 / height as f64;
    // cos a - cos b = 2 sin((a+b)/2) sin((b-a)/2) keeps all digits near the poles.
    let band = 2.0 * libm::sin(0.5 * (theta0 + theta1)) * libm::sin(0.5 * (theta1 - theta0));
    let (x, y) = rect.centre();
    Patch { direction: direction(width, height, x, y), solid_angle: TAU * (rect.x1 - rect.x0) / width as f64 * band }
}

/// Solid angle of one pixel of a row.
pub(crate) fn row_solid_angle(width: usize, height: usize, y: usize) -> f64 {
    patch(width, height, &Rect::pixel(0, y)).solid_angle
}

/// The four pixels around a direction with their bilinear weights; columns wrap around, rows go over the pole.
pub(crate) fn taps(width: usize, height: usize, d: DVec3) -> [(usize, f32); 4] {
    let (x, y) = locate(width, height, d);
    let (x, y) = (x - 0.5, y - 0.5);
    let (x0, y0) = (libm::floor(x), libm::floor(y));
    let (fx, fy) = ((x - x0) as f32, (y - y0) as f32);
    let at = |dx: i64, dy: i64| pixel(width, height, x0 as i64 + dx, y0 as i64 + dy);
    [(at(0, 0), (1.0 - fx) * (1.0 - fy)), (at(1, 0), fx * (1.0 - fy)), (at(0, 1), (1.0 - fx) * fy), (at(1, 1), fx * fy)]
}

/// The index of a pixel that may lie up to one row over a pole or any number of columns around.
fn pixel(width: usize, height: usize, x: i64, y: i64) -> usize {
    let (w, h) = (width as i64, height as i64);
    let (x, y) = match y {
        y if y < 0 => (x + w / 2, 0),
        y if y >= h => (x + w / 2, h - 1),
        y => (x, y),
    };
    (y * w + x.rem_euclid(w)) as usize
}
