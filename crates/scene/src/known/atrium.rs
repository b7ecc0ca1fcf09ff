//! A small court with columns, arches, a gallery roof and coloured walls.

use std::f64::consts::PI;

use glam::Vec3;

use super::boxes::upright_sides;
use super::patch::{Patches, camera, matte, scene, turn};
use crate::{Mesh, Scene};

/// Half length (x) and half width (z) of the court between the walls, and height of the walls, metres.
const COURT: Vec3 = Vec3::new(7.0, 5.0, 4.5);
/// Columns along each long side and their distance, metres.
const COLUMNS: (u32, f32) = (6, 2.2);
/// z of the two arcades, half their thickness, and height at which the arches spring, metres.
const ARCADE: (f32, f32, f32) = (2.9, 0.18, 2.3);
/// Radius of the arches, metres: leaves 2 x 0.2 m on the capitals.
const ARCH_RADIUS: f32 = 0.9;
/// Lower side of the gallery roof = top of the arcades, metres.
const ROOF: f32 = 3.7;

/// A court of 14 x 10 m under the open sky. Floor of light and dark tiles; two arcades of six columns carry
/// gallery roofs; the end walls are red and blue, the long ones ochre. About 17 thousand vertices; normals face the
/// court. Columns and arcades are closed where they do not stand on one another.
pub(super) fn atrium() -> Scene {
    let materials = vec![
        matte("tiles", Vec3::ONE),
        matte("ochre plaster", Vec3::new(0.65, 0.48, 0.27)),
        matte("red plaster", Vec3::new(0.60, 0.12, 0.08)),
        matte("blue plaster", Vec3::new(0.10, 0.24, 0.55)),
        matte("limestone", Vec3::new(0.72, 0.69, 0.61)),
        matte("timber", Vec3::new(0.36, 0.21, 0.11)),
    ];
    let mut meshes = vec![floor()];
    meshes.extend(walls());
    for side in [-1.0, 1.0] {
        for i in 0..COLUMNS.0 {
            meshes.push(column(Vec3::new(column_x(i), 0.0, side * ARCADE.0)));
        }
        meshes.push(arcade(side));
        meshes.push(gallery_roof(side));
    }
    scene("atrium", materials, meshes, camera(Vec3::new(-6.2, 2.0, 1.9), Vec3::new(3.0, 1.5, -1.1), 62.0))
}

fn column_x(i: u32) -> f32 {
    (i as f32 - 0.5 * (COLUMNS.0 - 1) as f32) * COLUMNS.1
}

/// Tiles of 1 m, 3 x 3 quads each, light and dark in turn; vertices of different tiles are apart.
fn floor() -> Mesh {
    let mut patches = Patches::default();
    let (columns, rows) = (2 * COURT.x as i32, 2 * COURT.y as i32);
    for i in 0..columns {
        for j in 0..rows {
            let corner = Vec3::new(i as f32 - COURT.x, 0.0, COURT.y - j as f32);
            let light = (i + j) % 2 == 0;
            patches.flat(corner, Vec3::X, Vec3::NEG_Z, 3, 3);
            patches.paint(if light { Vec3::new(0.66, 0.63, 0.56) } else { Vec3::new(0.24, 0.20, 0.18) });
        }
    }
    patches.finish("floor", 0)
}

/// Four inward-facing sheets.
fn walls() -> [Mesh; 4] {
    let Vec3 { x, y: z, z: height } = COURT;
    let up = Vec3::Y * height;
    let sheet = |name: &str, material: u32, corner: Vec3, along: Vec3, columns: u32| {
        Patches::default().flat(corner, along, up, columns, 12).finish(name, material)
    };
    [
        sheet("north wall", 1, Vec3::new(-x, 0.0, -z), Vec3::X * 2.0 * x, 36),
        sheet("south wall", 1, Vec3::new(x, 0.0, z), Vec3::NEG_X * 2.0 * x, 36),
        sheet("west wall", 2, Vec3::new(-x, 0.0, z), Vec3::NEG_Z * 2.0 * z, 26),
        sheet("east wall", 3, Vec3::new(x, 0.0, -z), Vec3::Z * 2.0 * z, 26),
    ]
}

/// Plinth, tapered shaft and capital, without the hidden top and bottom.
fn column(foot: Vec3) -> Mesh {
    let mut patches = Patches::default();
    let half = |h: f32| Vec3::new(h, 0.0, h);
    upright_sides(&mut patches, foot - half(0.26), foot + half(0.26) + Vec3::Y * 0.2, 2, 2);
    lid(&mut patches, foot + Vec3::Y * 0.2, 0.26, 1.0);
    let profile: Vec<_> = (0..=14)
        .map(|k| {
            let t = k as f32 / 14.0;
            // Slight swelling (entasis) of 1 cm in the middle, 4 cm of taper.
            (0.19 - 0.04 * t + 0.04 * t * (1.0 - t), 0.2 + 1.85 * t, 1.0, 0.0)
        })
        .collect();
    patches.lathe(foot, 20, &profile);
    let neck = foot + Vec3::Y * 2.05;
    upright_sides(&mut patches, neck - half(0.24), neck + half(0.24) + Vec3::Y * 0.25, 2, 2);
    lid(&mut patches, neck, 0.24, -1.0);
    lid(&mut patches, neck + Vec3::Y * 0.25, 0.24, 1.0);
    patches.finish("column", 4)
}

/// A horizontal square of half edge `half` that faces up (`side` = 1) or down (-1).
fn lid(patches: &mut Patches, center: Vec3, half: f32, side: f32) {
    let corner = center + Vec3::new(-half, 0.0, side * half);
    patches.flat(corner, Vec3::X * 2.0 * half, Vec3::NEG_Z * (side * 2.0 * half), 4, 4);
}

/// The wall above the columns of one side: two faces with round arches, and the arches' undersides.
fn arcade(side: f32) -> Mesh {
    let mut patches = Patches::default();
    let (z, half, _) = ARCADE;
    for span in 0..COLUMNS.0 - 1 {
        let middle = 0.5 * (column_x(span) + column_x(span + 1));
        for face in [-1.0, 1.0] {
            spandrel(&mut patches, middle, side * z + face * half, face);
        }
        // Underside of the arch: normals point to its axis.
        patches.grid(20, 2, |s, t| {
            let (sin, cos) = half_turn(s);
            let outward = Vec3::new(cos, sin, 0.0);
            let rim = Vec3::new(middle, ARCADE.2, side * z + half) - Vec3::Z * (2.0 * half * t);
            (rim + outward * ARCH_RADIUS, -outward)
        });
        for edge in [-1.0f32, 1.0] {
            // The flat bearing between the arch and the middle of the capital.
            let start = middle + edge * ARCH_RADIUS;
            let width = 0.5 * COLUMNS.1 - ARCH_RADIUS;
            let left = if edge < 0.0 { start - width } else { start };
            patches.flat(Vec3::new(left, ARCADE.2, side * z - half), Vec3::X * width, Vec3::Z * 2.0 * half, 1, 2);
        }
    }
    arcade_ends(&mut patches, side);
    patches.finish("arcade", 4)
}

/// One face of the wall over one arch, between the arch and the roof; `face` is the sign of its normal's z.
fn spandrel(patches: &mut Patches, middle: f32, z: f32, face: f32) {
    let half_span = 0.5 * COLUMNS.1;
    let bottom = |s: f32| {
        // s in [0, 1]: bearing, arch, bearing; the arch takes the middle 20 of 24 parts.
        let part = s * 24.0;
        if part <= 2.0 {
            (-half_span + (half_span - ARCH_RADIUS) * part / 2.0, 0.0)
        } else if part >= 22.0 {
            (half_span - (half_span - ARCH_RADIUS) * (24.0 - part) / 2.0, 0.0)
        } else {
            let (sin, cos) = half_turn(1.0 - (part - 2.0) / 20.0);
            (ARCH_RADIUS * cos, ARCH_RADIUS * sin)
        }
    };
    patches.grid(24, 5, |s, t| {
        let s = if face > 0.0 { s } else { 1.0 - s };
        let (x, rise) = bottom(s);
        let low = ARCADE.2 + rise;
        (Vec3::new(middle + x, low + (ROOF - low) * t, z), Vec3::Z * face)
    });
}

/// The short ends of an arcade, over its outermost columns.
fn arcade_ends(patches: &mut Patches, side: f32) {
    let (z, half, spring) = ARCADE;
    let x = column_x(COLUMNS.0 - 1);
    let up = Vec3::Y * (ROOF - spring);
    patches.flat(Vec3::new(x, spring, side * z + half), Vec3::NEG_Z * 2.0 * half, up, 2, 5);
    patches.flat(Vec3::new(-x, spring, side * z - half), Vec3::Z * 2.0 * half, up, 2, 5);
}

/// A slab from the arcade to the long wall: underside, upper side and the edge towards the court.
fn gallery_roof(side: f32) -> Mesh {
    let mut patches = Patches::default();
    let (inner, outer, thickness) = (ARCADE.0 - 0.35, COURT.y, 0.18);
    let (near, far) = if side > 0.0 { (inner, outer) } else { (-outer, -inner) };
    let along = Vec3::X * 2.0 * COURT.x;
    let depth = Vec3::Z * (far - near);
    patches.flat(Vec3::new(-COURT.x, ROOF, near), along, depth, 42, 8);
    patches.flat(Vec3::new(-COURT.x, ROOF + thickness, far), along, -depth, 42, 8);
    let edge = Vec3::Y * thickness;
    if side > 0.0 {
        patches.flat(Vec3::new(COURT.x, ROOF, near), -along, edge, 42, 1);
    } else {
        patches.flat(Vec3::new(-COURT.x, ROOF, far), along, edge, 42, 1);
    }
    patches.finish("gallery roof", 5)
}

/// Sine and cosine over half a turn, from +x over +y to -x.
fn half_turn(s: f32) -> (f32, f32) {
    if s == 0.0 || s == 1.0 || s == 0.5 {
        return turn(0.5 * s);
    }
    let angle = PI * f64::from(s);
    (libm::sin(angle) as f32, libm::cos(angle) as f32)
}
