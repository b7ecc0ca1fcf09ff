//! Planes under the open sky, alone and partly hidden, with exact form factors.

use std::f64::consts::PI;

use glam::Vec3;

use super::patch::{Patches, camera, matte, scene};
use super::round;
use crate::Scene;

/// Albedo of the receiving planes of this file.
const ALBEDO: Vec3 = Vec3::new(0.5, 0.5, 0.5);
/// Half-blocked plane: edge of the ground nearest to the wall, and the wall's height and half length, metres.
const WALL: (f64, f64, f64) = (0.02, 40.0, 60.0);
/// Facing planes: half edge and distance, metres.
const FACING: (f64, f64) = (1.0, 1.0);
/// Radius of the sphere that rests on the plane, metres.
const SPHERE_RADIUS: f64 = 0.5;

/// A square of 4 m edge in y = 0 that faces up, 16 x 16 quads.
///
/// Nothing hides the sky: transfer is the clamped cosine about +y, radiance = a for any number of bounces.
pub(super) fn plane() -> Scene {
    let ground = Patches::default()
        .flat(Vec3::new(-2.0, 0.0, 2.0), Vec3::X * 4.0, Vec3::NEG_Z * 4.0, 16, 16)
        .finish("ground", 0);
    scene("plane", vec![matte("ground", ALBEDO)], vec![ground], camera(Vec3::new(3.0, 3.0, 5.0), Vec3::ZERO, 45.0))
}

/// The plane in y = 0 from x = 0.02 m on, beside a black closed wall that fills x < 0 up to 40 m and
/// reaches 60 m to each side and 1 m below.
///
/// Direct radiance = a times [`half_blocked_plane_share`]; it tends to a/2 at the foot of the wall. The wall
/// reflects nothing, so bounces change nothing on the ground.
pub(super) fn half_blocked_plane() -> Scene {
    let (start, height, half) = (WALL.0 as f32, WALL.1 as f32, WALL.2 as f32);
    let ground = Patches::default()
        .flat(Vec3::new(start, 0.0, 2.0), Vec3::X * 4.0, Vec3::NEG_Z * 4.0, 24, 24)
        .finish("ground", 0);
    let mut wall = Patches::default();
    super::boxes::block(&mut wall, Vec3::new(-1.0, -1.0, -half), Vec3::new(0.0, height, half), 1);
    scene(
        "half-blocked-plane",
        vec![matte("ground", ALBEDO), matte("black wall", Vec3::ZERO)],
        vec![ground, wall.finish("wall", 1)],
        camera(Vec3::new(6.0, 3.0, 4.0), Vec3::new(1.0, 0.0, 0.0), 45.0),
    )
}

/// Share of the sky seen by the ground of `half-blocked-plane` at (x, 0, z), metres.
pub fn half_blocked_plane_share(x: f64, z: f64) -> f64 {
    let (_, height, half) = WALL;
    1.0 - perpendicular(x, half - z, height) - perpendicular(x, half + z, height)
}

/// Two squares of 2 m edge, 1 m apart, in y = 0 facing up and in y = 1 facing down.
///
/// Direct radiance at (x, z) of either = a times [`facing_planes_share`].
pub(super) fn facing_planes() -> Scene {
    let (half, distance) = (FACING.0 as f32, FACING.1 as f32);
    let mut lower = Patches::default();
    lower.flat(Vec3::new(-half, 0.0, half), Vec3::X * 2.0 * half, Vec3::NEG_Z * 2.0 * half, 16, 16);
    let mut upper = Patches::default();
    upper.flat(Vec3::new(-half, distance, -half), Vec3::X * 2.0 * half, Vec3::Z * 2.0 * half, 16, 16);
    scene(
        "facing-planes",
        vec![matte("lower", ALBEDO), matte("upper", Vec3::new(0.8, 0.3, 0.2))],
        vec![lower.finish("lower", 0), upper.finish("upper", 1)],
        camera(Vec3::new(2.5, 0.7, 3.5), Vec3::new(0.0, 0.4, 0.0), 40.0),
    )
}

/// Share of the sky-side hemisphere of a point (x, z) of either facing plane that is not the other plane.
pub fn facing_planes_share(x: f64, z: f64) -> f64 {
    let (half, distance) = FACING;
    let corner = |a: f64, b: f64| a.signum() * b.signum() * parallel(a.abs(), b.abs(), distance);
    1.0 - [half - x, half + x].iter().flat_map(|&a| [corner(a, half - z), corner(a, half + z)]).sum::<f64>()
}

/// A sphere of radius 0.5 m that touches a square of 6 m edge in y = 0 at the origin.
///
/// Direct radiance of the plane = a times [`sphere_on_plane_share`] (exact sphere; the mesh of 96 x 48 quads
/// is inscribed, so it hides up to 0.3 % less).
pub(super) fn sphere_on_plane() -> Scene {
    let ground = Patches::default()
        .flat(Vec3::new(-3.0, 0.0, 3.0), Vec3::X * 6.0, Vec3::NEG_Z * 6.0, 72, 72)
        .finish("ground", 0);
    let radius = SPHERE_RADIUS as f32;
    let ball = round::ball(Vec3::Y * radius, radius, 96, 48);
    scene(
        "sphere-on-plane",
        vec![matte("ground", ALBEDO), matte("ball", Vec3::new(0.7, 0.25, 0.2))],
        vec![ground, ball.clone_as("ball", 1)],
        camera(Vec3::new(1.6, 1.4, 2.6), Vec3::new(0.0, 0.35, 0.0), 40.0),
    )
}

/// Share of the sky seen by the plane of `sphere-on-plane` at distance `rho` (metres) from the contact.
///
/// The sphere lies wholly above the horizon, so its form factor is (r/d)^2 cos = (r/d)^3 with d the distance
/// to its centre.
pub fn sphere_on_plane_share(rho: f64) -> f64 {
    let sine = SPHERE_RADIUS / rho.hypot(SPHERE_RADIUS);
    1.0 - sine * sine * sine
}

/// Form factor from a point to a rectangle of height `h` and length `b` in a plane perpendicular to the point's
/// own, at distance `c`, one corner in line with the point. Howell, configuration factor catalogue, B-4.
fn perpendicular(c: f64, b: f64, h: f64) -> f64 {
    let slant = c.hypot(h);
    (libm::atan(b / c) - c / slant * libm::atan(b / slant)) / (2.0 * PI)
}

/// Form factor from a point to a parallel rectangle a x b at distance `c`, one corner above the point.
/// Howell, configuration factor catalogue, B-3.
fn parallel(a: f64, b: f64, c: f64) -> f64 {
    let (p, q) = (a.hypot(c), b.hypot(c));
    (a / p * libm::atan(b / p) + b / q * libm::atan(a / q)) / (2.0 * PI)
}
