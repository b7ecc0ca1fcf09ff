//! Surfaces that come out for a short way between two bodies: neither body's other sides tell how dark it is there.

mod support;

use coeff_io::{Prt, Refine, Sampler, Settings};
use glam::Vec3;
use scene::{Material, Mesh, Scene};
use support::{drawn, fixed, quiet, rectangle, under_white};

/// Half the length of all, metres: ends are too far off to matter.
const HALF: f32 = 10.0;
/// Height of the gap between two beams on a wall, how far they reach out, and their height, metres. The vertices of the wall are 25 cm apart, and
/// the nearest lie inside the beams.
const GAP: [f32; 3] = [0.1, 0.5, 0.25];
/// Bound of the difference at any place, of a sky of 1.
const AGREE: f64 = 0.02;

fn beam(low: Vec3, size: Vec3) -> Vec<Mesh> {
    let [x, y, z] = [Vec3::X * size.x, Vec3::Y * size.y, Vec3::Z * size.z];
    let high = low + size;
    let face = |corner, along, across, cells| rectangle(corner, along, across, cells);
    vec![
        face(low, y, x, [1, 40]),
        face(low, z, y, [1, 1]),
        face(low, x, z, [40, 1]),
        face(high, -x, -y, [40, 1]),
        face(high, -y, -z, [1, 1]),
        face(high, -z, -x, [1, 40]),
    ]
}

/// A wall with two long beams run into it.
fn scene() -> Scene {
    let [gap, out, height] = GAP;
    let corner = Vec3::new(-HALF, -3.125, 0.0);
    let mut meshes = vec![rectangle(corner, Vec3::X * 2.0 * HALF, Vec3::Y * 6.25, [80, 25])];
    let size = Vec3::new(2.0 * HALF + 2.0, height, out + 0.3);
    for low in [0.5 * gap, -0.5 * gap - height] {
        meshes.extend(beam(Vec3::new(-HALF - 1.0, low, -0.3), size));
    }
    Scene { meshes, materials: vec![Material::default()], ..Scene::default() }
}

fn settings(refine: Refine) -> Settings {
    Settings { refine, ..fixed(2, Sampler::OwenSobol, 1024, 0) }
}

/// Share of the sky that a place in the gap sees, which is that far from its middle: a slot without end.
fn expected(height: f64) -> f64 {
    let [gap, out, _] = GAP.map(f64::from);
    let sine = |rise: f64| rise / rise.hypot(out);
    0.5 * (sine(0.5 * gap - height) + sine(0.5 * gap + height))
}

/// Largest difference from the closed form over places in the gap.
fn worst(prt: &Prt) -> f64 {
    let radiance = under_white(prt);
    let away = |k: u32| {
        let (x, y) = (2.0 * (f64::from(k) * 0.618_034).fract() - 1.0, 0.0008 * f64::from(k) - 0.04);
        (drawn(prt, &radiance, x, y) - expected(y)).abs()
    };
    (0..=100).map(away).fold(0.0, f64::max)
}

#[test]
fn a_gap_between_beams_is_dark() {
    let away = worst(&quiet(&scene(), &settings(Refine::Auto)));
    assert!(away < AGREE, "{away}");
}

/// Twin: without vertices of its own the gap has the light of the wall above and below the beams.
#[test]
fn a_gap_between_beams_is_dark_can_fail() {
    let away = worst(&quiet(&scene(), &settings(Refine::Off)));
    assert!(away > 10.0 * AGREE, "{away}");
}

/// The same with a board within the lower beam, flush with its upper side, in which no vertex of the wall lies.
fn scene_with_board() -> Scene {
    let mut scene = scene();
    let (low, size) = (Vec3::new(-HALF - 0.5, -0.5 * GAP[0] - 0.02, -0.2), Vec3::new(2.0 * HALF + 1.0, 0.02, 0.24));
    let mut board = beam(low, size);
    // Sums round.
    let upper = scene.meshes[7..].iter().flat_map(|mesh| mesh.positions.iter().map(|p| p.y)).fold(f32::MIN, f32::max);
    let all = board.iter_mut().flat_map(|mesh| &mut mesh.positions);
    all.filter(|p| p.y > low.y + 0.01).for_each(|p| p.y = upper);
    scene.meshes.extend(board);
    scene
}

/// Where a way comes out of two bodies in one place it leaves both.
#[test]
fn a_gap_above_a_flush_board_is_dark() {
    let away = worst(&quiet(&scene_with_board(), &settings(Refine::Auto)));
    assert!(away < AGREE, "{away}");
}
