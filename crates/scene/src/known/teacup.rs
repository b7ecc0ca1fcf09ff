//! A glazed cup with a handle on a saucer, with tea in it.

use std::f64::consts::PI;

use glam::Vec3;

use super::patch::{Patches, camera, matte, scene, turn};
use crate::{Material, Mesh, Scene};

/// One point of a lathe profile: radius, height, and the normal's radial and upward parts.
type Profile = Vec<(f32, f32, f32, f32)>;

/// Outline of the cup, centimetres, from the middle of its foot up the outside, over the lip, down the inside.
const CUP: &[(f32, f32)] = &[
    (0.0, 0.25),
    (1.7, 0.25),
    (1.9, 0.0),
    (2.3, 0.0),
    (2.4, 0.5),
    (3.0, 1.2),
    (3.7, 2.4),
    (4.1, 3.8),
    (4.35, 5.2),
    (4.6, 6.4),
    (4.62, 6.6),
    (4.5, 6.65),
    (4.38, 6.5),
    (4.1, 5.2),
    (3.85, 3.8),
    (3.4, 2.5),
    (2.7, 1.5),
    (1.6, 0.95),
    (0.0, 0.8),
];
/// Outline of the saucer, centimetres, in the same order.
const SAUCER: &[(f32, f32)] = &[
    (0.0, 0.2),
    (2.6, 0.2),
    (2.8, 0.0),
    (3.3, 0.0),
    (3.5, 0.3),
    (5.0, 0.75),
    (6.6, 1.45),
    (7.6, 1.95),
    (7.7, 2.08),
    (7.55, 2.12),
    (6.5, 1.75),
    (4.9, 1.1),
    (3.4, 0.72),
    (2.8, 0.55),
    (0.0, 0.5),
];
/// Height of the saucer's well above the table, metres: the cup stands in it.
const WELL: f32 = 0.0057;

/// Cup, handle, saucer and tea in metres, on a cloth of 0.5 m edge; cup, handle and saucer are closed surfaces
/// (the handle's ends lie inside the wall of the cup).
pub(super) fn teacup() -> Scene {
    let glaze = |name: &str, rgb: Vec3| Material { roughness: 0.25, ..matte(name, rgb) };
    let materials = vec![
        matte("cloth", Vec3::new(0.35, 0.42, 0.55)),
        glaze("white glaze", Vec3::new(0.8, 0.78, 0.73)),
        glaze("blue glaze", Vec3::new(0.16, 0.3, 0.58)),
        Material { roughness: 0.05, ..matte("tea", Vec3::new(0.28, 0.10, 0.03)) },
    ];
    let cloth = Patches::default()
        .flat(Vec3::new(-0.25, 0.0, 0.25), Vec3::X * 0.5, Vec3::NEG_Z * 0.5, 56, 56)
        .finish("cloth", 0);
    let cup = Patches::default().lathe(Vec3::Y * WELL, 72, &profile(CUP, 3)).finish("cup", 1);
    let saucer = Patches::default().lathe(Vec3::ZERO, 72, &profile(SAUCER, 3)).finish("saucer", 2);
    let meshes = vec![cloth, cup, saucer, handle(), tea()];
    scene("teacup", materials, meshes, camera(Vec3::new(0.17, 0.17, 0.24), Vec3::new(0.0, 0.03, 0.0), 38.0))
}

/// Points along a smooth curve through the outline (Catmull-Rom, `steps` a span) with their normals, metres.
fn profile(outline: &[(f32, f32)], steps: usize) -> Profile {
    let at = |i: isize| outline[i.clamp(0, outline.len() as isize - 1) as usize];
    let mut points = Vec::new();
    for span in 0..outline.len() - 1 {
        let i = span as isize;
        let [a, b, c, d] = [at(i - 1), at(i), at(i + 1), at(i + 2)];
        for step in 0..steps {
            let t = step as f32 / steps as f32;
            points.push((catmull_rom([a.0, b.0, c.0, d.0], t).max(0.0), catmull_rom([a.1, b.1, c.1, d.1], t)));
        }
    }
    points.push(at(outline.len() as isize - 1));
    (0..points.len()).map(|i| with_normal(&points, i)).collect()
}

/// Uniform Catmull-Rom spline between the second and third of four values.
fn catmull_rom([a, b, c, d]: [f32; 4], t: f32) -> f32 {
    b + 0.5 * t * ((c - a) + t * ((2.0 * a - 5.0 * b + 4.0 * c - d) + t * (3.0 * (b - c) + d - a)))
}

/// The outline's point `i` in metres; its normal is the tangent turned right, so that it points out of the body.
fn with_normal(points: &[(f32, f32)], i: usize) -> (f32, f32, f32, f32) {
    let (before, after) = (points[i.saturating_sub(1)], points[(i + 1).min(points.len() - 1)]);
    let (along_radius, along_height) = (after.0 - before.0, after.1 - before.1);
    let length = (along_radius * along_radius + along_height * along_height).sqrt();
    let (radius, height) = points[i];
    // On the axis only the vertical is smooth.
    let (radial, up) =
        if radius == 0.0 { (0.0, -along_radius.signum()) } else { (along_height / length, -along_radius / length) };
    (0.01 * radius, 0.01 * height, radial, up)
}

/// A bent tube of elliptic section from the upper to the lower part of the wall, closed by flat ends inside it.
fn handle() -> Mesh {
    let mut patches = Patches::default();
    let centre = |t: f32| {
        // Three quarters of an ear in the plane z = 0, radii 2.0 x 2.1 cm about (4.3, 4.0) cm.
        let angle = (0.62 - 1.24 * f64::from(t)) * PI;
        Vec3::new(0.040 + 0.024 * libm::cos(angle) as f32, WELL + 0.038 + 0.019 * libm::sin(angle) as f32, 0.0)
    };
    let ring = |s: f32, t: f32| {
        let tangent = (centre(t + 1e-3) - centre(t - 1e-3)).normalize();
        let outward = Vec3::Z.cross(tangent).normalize();
        let (sin, cos) = turn(s);
        let normal = (outward * cos / 0.0028 + Vec3::Z * sin / 0.0038).normalize();
        (outward * (0.0028 * cos) + Vec3::Z * (0.0038 * sin), normal, tangent)
    };
    patches.grid(16, 28, |s, t| {
        let (offset, normal, _) = ring(s, t);
        (centre(t) + offset, normal)
    });
    for (t, sign) in [(0.0, -1.0), (1.0, 1.0)] {
        patches.grid(16, 1, |s, share| {
            let (offset, _, tangent) = ring(s, t);
            let inward = if sign < 0.0 { share } else { 1.0 - share };
            (centre(t) + offset * inward, tangent * sign)
        });
    }
    patches.finish("handle", 1)
}

/// The surface of the tea, a disc inside the cup that reaches into its wall.
fn tea() -> Mesh {
    let (height, radius) = (WELL + 0.051, 0.0412);
    Patches::default()
        .grid(48, 12, |s, t| {
            let (sin, cos) = turn(s);
            (Vec3::new(sin * radius * (1.0 - t), height, cos * radius * (1.0 - t)), Vec3::Y)
        })
        .finish("tea", 3)
}
