//! A ball beside a plane, both with one bumpy normal map: what directional light maps are looked at with.

use glam::{Affine2, Vec2, Vec3};
use std::f64::consts::TAU;

use super::patch::{Patches, camera, matte, scene};
use super::round::direction;
use crate::{Material, Mesh, Scene, Texture, TextureSlot, Wrap, tangents, vertices};

/// Texels along a side of the normal map.
const SIDE: u32 = 128;
/// Steepest slope of the bumps.
const SLOPE: f64 = 1.1;

/// A ball of radius 0.8 m that hovers over a square of 5 m edge, 48 x 24 and 12 x 12 quads, under one map of round bumps and hollows; both
/// lie side by side in the sheet of their second texture coordinates. Third paper, figures 3.3 and 3.4.
pub(super) fn bumps() -> Scene {
    let half = 2.5;
    let mut ground = Patches::default()
        .flat(Vec3::new(-half, 0.0, half), Vec3::X * 2.0 * half, Vec3::NEG_Z * 2.0 * half, 12, 12)
        .finish("ground", 0);
    // The grid runs along x and against z.
    let place = |p: &Vec3| Vec2::new(p.x + half, p.z + half) / (2.0 * half);
    lay_out(&mut ground, &place, 5.0, 0.02);
    let mut ball = unrolled_ball(Vec3::new(0.0, 1.0, 0.0), 0.8);
    for mesh in [&mut ground, &mut ball] {
        tangents::generate(mesh, 0);
    }
    let mut scene = scene(
        "bumps",
        vec![bumpy("ground", Vec3::splat(0.6)), bumpy("ball", Vec3::new(0.7, 0.45, 0.3))],
        vec![ground, ball],
        camera(Vec3::new(2.2, 2.0, 3.6), Vec3::new(0.0, 0.7, 0.0), 42.0),
    );
    scene.textures = vec![normal_map()];
    scene
}

/// Gives a mesh both texture coordinates: the picture `times` over, the sheet in a square of nearly half its side at `corner`.
fn lay_out(mesh: &mut Mesh, place: &dyn Fn(&Vec3) -> Vec2, times: f32, corner: f32) {
    mesh.uv0 = mesh.positions.iter().map(|p| place(p) * times).collect();
    mesh.uv1 = mesh.positions.iter().map(|p| Vec2::splat(corner) + place(p) * 0.46).collect();
}

/// A ball whose rows of quads lie side by side in the sheet, cut along one meridian.
fn unrolled_ball(centre: Vec3, radius: f32) -> Mesh {
    let (around, rows) = (48u32, 24u32);
    let mut mesh = Mesh { name: "ball".into(), material: 1, ..Mesh::default() };
    for j in 0..=rows {
        for i in 0..=around {
            let at = Vec2::new(i as f32 / around as f32, 1.0 - j as f32 / rows as f32);
            let outward = direction(at.x, at.y);
            mesh.positions.push(centre + radius * outward);
            mesh.normals.push(outward);
            mesh.uv0.push(at * Vec2::new(8.0, 4.0));
            mesh.uv1.push(Vec2::new(0.52, 0.02) + at * 0.46);
        }
    }
    for j in 0..rows {
        for i in 0..around {
            let a = j * (around + 1) + i;
            let (b, c, d) = (a + 1, a + around + 2, a + around + 1);
            // At a pole one of the two is flat.
            mesh.triangles.extend([[a, b, c]].into_iter().filter(|_| j > 0));
            mesh.triangles.extend([[a, c, d]].into_iter().filter(|_| j + 1 < rows));
        }
    }
    vertices::drop_unused(&mut mesh);
    mesh
}

fn bumpy(name: &str, color: Vec3) -> Material {
    let slot = TextureSlot { texture: 0, uv_set: 0, transform: Affine2::IDENTITY };
    Material { normal_texture: Some(slot), ..matte(name, color) }
}

/// The normals of the heights `SLOPE / (4 pi) (cos 4 pi u + cos 4 pi v)`, green up.
fn normal_map() -> Texture {
    let texel = |i: u32| {
        let [u, v] = [i % SIDE, i / SIDE].map(|k| 2.0 * TAU * (f64::from(k) + 0.5) / f64::from(SIDE));
        // Up is falling v, so the slope along it is that along v with the other sign.
        let [x, y] = [SLOPE * libm::sin(u), -SLOPE * libm::sin(v)];
        let length = (x * x + y * y + 1.0).sqrt();
        let [r, g, b] = [x, y, 1.0].map(|n| libm::round(127.5 * (n / length + 1.0)) as u8);
        [r, g, b, 255]
    };
    let rgba = (0..SIDE * SIDE).map(texel).collect();
    Texture { name: "bumps".into(), width: SIDE, height: SIDE, rgba, wrap: [Wrap::Repeat; 2] }
}
