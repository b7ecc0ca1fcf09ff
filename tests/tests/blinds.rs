//! A room that is closed but for a window with blinds: no receiver is black that paths find lit.

#[path = "../../crates/bake/tests/support/rectangle.rs"]
mod rectangle;

use bake::Receivers;
use coeff_io::{Bounces, Quality, Settings};
use glam::{Quat, Vec3, Vec4};
use rectangle::rectangle;
use reference::{Light, World, radiance_at};
use scene::{Material, Mesh, Scene};
use std::ops::ControlFlow;

/// Half the length and width of the room and its height, and half the size of the window in the far wall, metres.
const ROOM: Vec3 = Vec3::new(1.5, 1.5, 2.5);
const WINDOW: f32 = 0.5;
/// Slats, their depth, and how far they are apart, metres.
const SLATS: (u32, f32, f32) = (20, 0.04, 0.048);
/// What a receiver must see to count as lit, of a white sky of radiance 1.
const LIT: f32 = 0.05;
/// Receivers that are compared, and paths of each.
const COMPARED: (usize, u32) = (600, 512);
/// Bound of the mean difference over receivers, as a share of the mean radiance; the noise of the paths is 0.04 of it.
const AGREE: f32 = 0.08;

/// The walls, seen from inside, with a hole for the window.
fn room() -> Vec<Mesh> {
    let Vec3 { x, y: z, z: height } = ROOM;
    let (right, up, front) = (Vec3::X * 2.0 * x, Vec3::Y * height, Vec3::Z * 2.0 * z);
    let corner = Vec3::new(-x, 0.0, -z);
    let mut meshes = vec![
        rectangle(corner, front, right, [8, 8]),
        rectangle(corner + up, right, front, [8, 8]),
        rectangle(corner + front, -front, up, [8, 8]),
        rectangle(corner + right, front, up, [8, 8]),
        rectangle(corner + front + right, -right, up, [8, 8]),
    ];
    let (low, high) = (0.5 * height - WINDOW, 0.5 * height + WINDOW);
    let frame = [[-x, x, 0.0, low], [-x, x, high, height], [-x, -WINDOW, low, high], [WINDOW, x, low, high]];
    meshes.extend(frame.map(|[left, right, low, high]| {
        rectangle(Vec3::new(left, low, -z), Vec3::X * (right - left), Vec3::Y * (high - low), [6, 4])
    }));
    meshes
}

/// The faces of a slat of a thickness, or its upper side alone, at the origin.
fn slat(thickness: Option<f32>) -> Vec<Mesh> {
    let size = Vec3::new(1.96 * WINDOW, thickness.unwrap_or(0.0), SLATS.1);
    let [x, y, z] = [Vec3::X * size.x, Vec3::Y * size.y, Vec3::Z * size.z];
    let (low, high) = (-0.5 * size, 0.5 * size);
    let top = rectangle(high, -z, -x, [2, 10]);
    if thickness.is_none() {
        return vec![top];
    }
    vec![
        top,
        rectangle(low, x, z, [10, 2]),
        rectangle(low, y, x, [1, 10]),
        rectangle(low, z, y, [2, 1]),
        rectangle(high, -x, -y, [10, 1]),
        rectangle(high, -y, -z, [1, 2]),
    ]
}

fn blinds(thickness: Option<f32>, tilt: f32) -> Scene {
    let mut meshes = room();
    for k in 0..SLATS.0 {
        let at = Vec3::new(0.0, 0.5 * ROOM.z + (k as f32 - 0.5 * (SLATS.0 - 1) as f32) * SLATS.2, 0.05 - ROOM.y);
        let turn = Quat::from_rotation_x(tilt);
        for mut mesh in slat(thickness) {
            mesh.positions.iter_mut().for_each(|p| *p = at + turn * *p);
            mesh.normals.iter_mut().for_each(|n| *n = turn * *n);
            meshes.push(mesh);
        }
    }
    let white = Material { base_color: Vec4::new(0.8, 0.8, 0.8, 1.0), ..Material::default() };
    Scene { meshes, materials: vec![white], ..Scene::default() }
}

/// Of some receivers what the bake and paths say under a white sky, for albedo 1.
fn compared(scene: &Scene) -> Vec<[f32; 2]> {
    let (bounces, quality) = (Bounces::Fixed(1), Quality::Rays(512));
    let settings = Settings { bands: 2, bounces, quality, ..bake::settings::standard() };
    let prt = bake::bake(scene, &settings, &|_| ControlFlow::Continue(())).expect("the scene bakes");
    let receivers = Receivers::of(&bake::refine(scene, &settings).expect("the bake has split it before"));
    let step = (receivers.permanent / COMPARED.0).max(1);
    let rows: Vec<usize> = (0..receivers.permanent).step_by(step).filter(|&r| receivers.list[r].sound).collect();
    let point = |&row: &usize| {
        let r = receivers.list[row];
        reference::Receiver {
            position: r.position,
            normal: r.normal,
            geometric_normal: r.geometric_normal,
            albedo: Vec3::ONE,
        }
    };
    let points: Vec<reference::Receiver> = rows.iter().map(point).collect();
    let light = Light::from_equirect(8, vec![[1.0; 3]; 32]).expect("full rows");
    let paths = reference::Settings { samples: COMPARED.1, seed: 5, max_bounces: Some(1) };
    let traced = radiance_at(&World::new(scene), &light, &points, &paths);
    let row_of = (prt.transfer.bands * prt.transfer.bands * prt.transfer.channels) as usize;
    let baked = |row: usize| prt.transfer.values[row * row_of] * (4.0 * std::f32::consts::PI).sqrt();
    rows.iter().zip(traced).map(|(&row, traced)| [baked(row), traced.mean[0]]).collect()
}

/// Share of the lit receivers that the bake has black.
fn black(compared: &[[f32; 2]]) -> f32 {
    let lit: Vec<_> = compared.iter().filter(|[_, traced]| *traced > LIT).collect();
    assert!(lit.len() > 100, "{} receivers are lit", lit.len());
    lit.iter().filter(|[baked, _]| *baked <= 0.0).count() as f32 / lit.len() as f32
}

fn check(name: &str, thickness: Option<f32>, tilt: f32) {
    let compared = compared(&blinds(thickness, tilt));
    assert!(black(&compared) <= 0.0, "{name}: {} of the lit receivers are black", black(&compared));
    let total: f32 = compared.iter().map(|[_, traced]| traced).sum();
    let away = compared.iter().map(|[baked, traced]| (baked - traced).abs()).sum::<f32>() / total;
    assert!(away < AGREE, "{name}: {away} of the mean");
}

#[test]
fn slats_are_lit() {
    check("slats of 1.5 mm", Some(1.5e-3), 0.5);
    check("slats of 1 mm that face away", Some(1e-3), -0.9);
    check("sheets", None, 0.5);
    check("sheets that face away", None, -0.9);
}

/// What was wrong: sheets whose backs others see counted as bodies, and receivers between them as buried.
#[test]
fn slats_are_lit_can_fail() {
    let mut compared = compared(&blinds(None, 0.5));
    compared.iter_mut().step_by(5).for_each(|[baked, _]| *baked = 0.0);
    let share = black(&compared);
    assert!((0.1..0.3).contains(&share), "{share}");
}
