//! The evening: a sky that is warm at the horizon, a low sun with a glow, and dark ground.

use glam::Vec3;

/// Rows of the picture, which is twice as wide.
pub(crate) const ROWS: usize = 64;
/// Elevation and azimuth of the sun, degrees, and the angle of its disc from the middle: some texels wide, so that no row misses it.
const SUN: [f64; 3] = [14.0, 50.0, 4.0];
/// Radiance of the disc, RGB.
const DISC: Vec3 = Vec3::new(160.0, 105.0, 55.0);

/// The pixels of an equirectangular light probe, rows from the top, RGB.
pub(crate) fn pixels() -> Vec<[f32; 3]> {
    let columns = 2 * ROWS;
    let pixel = |k: usize| {
        let polar = std::f64::consts::PI * ((k / columns) as f64 + 0.5) / ROWS as f64;
        let around = std::f64::consts::TAU * ((k % columns) as f64 + 0.5) / columns as f64;
        let height = libm::cos(polar);
        let level = libm::sin(polar);
        radiance([level * libm::sin(around), height, -level * libm::cos(around)]).to_array()
    };
    (0..columns * ROWS).map(pixel).collect()
}

/// Radiance from a direction, y up.
fn radiance([x, y, z]: [f64; 3]) -> Vec3 {
    let [elevation, azimuth, disc] = SUN.map(f64::to_radians);
    let level = libm::cos(elevation);
    let sun = [level * libm::sin(azimuth), libm::sin(elevation), level * libm::cos(azimuth)];
    let away = libm::acos((x * sun[0] + y * sun[1] + z * sun[2]).clamp(-1.0, 1.0));
    if y < 0.0 {
        return Vec3::new(0.09, 0.075, 0.06);
    }
    let haze = libm::exp(-4.0 * y) as f32;
    let glow = libm::exp(-3.0 * away) as f32;
    let sky = Vec3::new(0.16, 0.27, 0.52).lerp(Vec3::new(0.75, 0.5, 0.36), haze) + glow * Vec3::new(2.2, 1.2, 0.5);
    // The edge of the disc is as wide as a texel.
    let inside = 1.0 - ((away - disc).to_degrees() / 2.8 + 0.5).clamp(0.0, 1.0) as f32;
    sky + inside * DISC
}
