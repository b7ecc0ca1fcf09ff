//! Glossy materials whose roughness varies over the surface, and their pictures.

use glam::{Affine2, Vec2, Vec3};
use std::f64::consts::TAU;

use super::super::patch::{Patches, matte};
use crate::{Material, Mesh, Texture, TextureSlot, Wrap};

/// Texels along a side of the pictures.
const SIDE: u32 = 64;
/// Where the pictures stand in [`pictures`].
pub(super) const CHECKER: u32 = 0;
pub(super) const BANDS: u32 = 1;
pub(super) const TILES: u32 = 2;

/// A metal of that reflectance, its roughness from picture `texture`.
pub(super) fn metal(name: &str, rgb: Vec3, texture: u32) -> Material {
    Material { metallic: 1.0, ..coat(name, rgb, texture) }
}

/// A smooth dielectric of that diffuse colour, its roughness from picture `texture`.
pub(super) fn coat(name: &str, rgb: Vec3, texture: u32) -> Material {
    Material { metallic_roughness_texture: Some(slot(texture)), ..matte(name, rgb) }
}

pub(super) fn slot(texture: u32) -> TextureSlot {
    TextureSlot { texture, uv_set: 0, transform: Affine2::IDENTITY }
}

/// The pictures that the materials refer to. In the first two green is roughness and blue, metal, is full.
pub(super) fn pictures() -> Vec<Texture> {
    vec![
        // Two squares by two, of which two are polished.
        picture("checker", |u, v| [255, byte(if (u < 0.5) == (v < 0.5) { 0.16 } else { 0.42 }), 255]),
        // Polished to satin and back along u, waved along v.
        picture("bands", |u, v| {
            let wave = libm::cos(TAU * u + 0.6 * libm::sin(TAU * v));
            [255, byte(0.32 - 0.2 * wave), 255]
        }),
        picture("tiles", tile_normal),
    ]
}

/// The tangent-space normal of a square tile with rounded edges, green up; `[0, 1]` is one tile.
fn tile_normal(u: f64, v: f64) -> [u8; 3] {
    // Slope of the height towards the middle: falls to 0 at 8 % of the tile's edge.
    let slope = |x: f64| {
        let from_edge = x.min(1.0 - x) / 0.08;
        let steep = if from_edge < 1.0 { 0.6 * (1.0 - from_edge) } else { 0.0 };
        if x < 0.5 { steep } else { -steep }
    };
    // Up is falling v, so that the slope along it has the other sign.
    let (x, y) = (-slope(u), slope(v));
    let length = (x * x + y * y + 1.0).sqrt();
    [x, y, 1.0].map(|n| byte(0.5 * (n / length + 1.0)))
}

fn byte(share: f64) -> u8 {
    libm::round(255.0 * share) as u8
}

fn picture(name: &str, texel: impl Fn(f64, f64) -> [u8; 3]) -> Texture {
    let at = |i: u32| (f64::from(i) + 0.5) / f64::from(SIDE);
    let rgba = (0..SIDE * SIDE)
        .map(|i| {
            let [r, g, b] = texel(at(i % SIDE), at(i / SIDE));
            [r, g, b, 255]
        })
        .collect();
    Texture { name: name.into(), width: SIDE, height: SIDE, rgba, wrap: [Wrap::Repeat; 2] }
}

/// A sheet of two triangles that spans the edges `s` and `t` from `corner`, under `times` pictures; it faces s x t.
pub(super) fn sheet(name: &str, material: u32, [corner, s, t]: [Vec3; 3], times: Vec2) -> Mesh {
    let mut mesh = Patches::default().flat(corner, s, t, 1, 1).finish(name, material);
    mesh.uv0 = [(0.0, 1.0), (1.0, 1.0), (0.0, 0.0), (1.0, 0.0)].map(|(u, v)| Vec2::new(u, v) * times).into();
    mesh
}

/// A level square sheet about the origin in y = 0, of half edge `half`.
pub(super) fn ground(material: u32, half: f32, times: f32) -> Mesh {
    let edges = [Vec3::new(-half, 0.0, half), Vec3::X * 2.0 * half, Vec3::NEG_Z * 2.0 * half];
    sheet("ground", material, edges, Vec2::splat(times))
}
