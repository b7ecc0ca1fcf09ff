//! A furnished room.

use glam::{Vec2, Vec3};

use super::super::patch::{Patches, camera};
use super::body::{Cushion, Grid, cushion, turned};
use super::shine::{BANDS, CHECKER, TILES, coat, metal, pictures, sheet, slot};
use super::shown;
use crate::{Material, Mesh, Scene, tangents};

/// Half width (x), height and half depth (z), metres.
const ROOM: Vec3 = Vec3::new(2.6, 2.6, 2.2);
/// Depth to which what stands presses into what carries it, metres.
const PRESS: f32 = 0.002;
/// Materials by their place in the list.
const FLOOR: u32 = 0;
const PLASTER: u32 = 1;
const RED: u32 = 2;
const LEATHER: u32 = 3;
const WOOD: u32 = 4;
const BRASS: u32 = 5;
const GLAZE: u32 = 6;
const STEEL: u32 = 7;

/// A room of 5.2 x 4.4 m, open above and in front (+z): a floor with a normal map and three walls of two triangles each, in it a sofa, a table
/// with a vase and cups, a lamp, a shelf of books and a ball. Furniture is closed and presses 2 mm into what carries it.
pub(super) fn room() -> Scene {
    let mut meshes = shell();
    meshes.extend([sofa(), rug(), table(), legs(), vase(), cups(), lamp(), shelf(), books(), ball()]);
    shown(
        "paper-room",
        vec![
            Material { normal_texture: Some(slot(TILES)), ..coat("tiles", Vec3::new(0.46, 0.42, 0.37), BANDS) },
            coat("plaster", Vec3::new(0.66, 0.64, 0.58), BANDS),
            coat("red paint", Vec3::new(0.50, 0.12, 0.09), CHECKER),
            coat("leather", Vec3::new(0.12, 0.20, 0.34), BANDS),
            coat("wood", Vec3::new(0.36, 0.20, 0.10), BANDS),
            metal("brass", Vec3::new(0.88, 0.68, 0.36), BANDS),
            coat("glaze", Vec3::new(0.70, 0.68, 0.62), BANDS),
            metal("steel", Vec3::new(0.60, 0.60, 0.62), CHECKER),
        ],
        meshes,
        pictures(),
        [
            camera(Vec3::new(0.5, 1.75, 5.6), Vec3::new(0.0, 0.85, 0.0), 38.0),
            camera(Vec3::new(0.35, 2.2, 1.35), Vec3::new(0.25, 0.1, 0.35), 42.0),
        ],
    )
}

/// The floor and the three walls, facing inwards.
fn shell() -> Vec<Mesh> {
    let Vec3 { x, y, z } = ROOM;
    let (across, back, up) = (Vec3::X * 2.0 * x, Vec3::NEG_Z * 2.0 * z, Vec3::Y * y);
    let mut floor = sheet("floor", FLOOR, [Vec3::new(-x, 0.0, z), across, back], Vec2::new(13.0, 11.0));
    tangents::generate(&mut floor, 0);
    let wall = |name: &str, material: u32, edges: [Vec3; 3]| sheet(name, material, edges, Vec2::new(4.0, 2.0));
    vec![
        floor,
        wall("back wall", PLASTER, [Vec3::new(-x, 0.0, -z), across, up]),
        wall("left wall", RED, [Vec3::new(-x, 0.0, z), back, up]),
        wall("right wall", PLASTER, [Vec3::new(x, 0.0, -z), -back, up]),
    ]
}

/// Rounded boxes given by middle, half edges and radius.
fn boxes(name: &str, material: u32, steps: i32, parts: &[(Vec3, Vec3, f32)]) -> Mesh {
    let mut patches = Patches::default();
    for &(middle, half, round) in parts {
        cushion(&mut patches, &Cushion { middle, half, round, turn: 0.0 }, steps);
    }
    patches.finish(name, material)
}

fn sofa() -> Mesh {
    let at = |x: f32, y: f32, z: f32| Vec3::new(x, y, z - 1.5);
    boxes(
        "sofa",
        LEATHER,
        3,
        &[
            (at(-0.5, 0.2, 0.0), Vec3::new(1.0, 0.2 + PRESS, 0.45), 0.06),
            (at(-0.5, 0.62, -0.36), Vec3::new(1.0, 0.3, 0.14), 0.1),
            (at(-1.55, 0.32, 0.0), Vec3::new(0.12, 0.32 + PRESS, 0.46), 0.08),
            (at(0.55, 0.32, 0.0), Vec3::new(0.12, 0.32 + PRESS, 0.46), 0.08),
            (at(-0.96, 0.47, 0.08), Vec3::new(0.45, 0.09, 0.36), 0.08),
            (at(-0.04, 0.47, 0.08), Vec3::new(0.45, 0.09, 0.36), 0.08),
        ],
    )
}

fn rug() -> Mesh {
    boxes("rug", RED, 3, &[(Vec3::new(0.1, 0.01, 0.1), Vec3::new(1.2, 0.01 + PRESS, 0.8), 0.009)])
}

/// The top of the table, 0.45 m above the floor.
fn table() -> Mesh {
    boxes("table top", WOOD, 3, &[(Vec3::new(0.1, 0.45, 0.1), Vec3::new(0.75, 0.03, 0.42), 0.025)])
}

/// Turned legs that reach into the top and stand on the rug.
fn legs() -> Mesh {
    let outline = [
        (0.0, 0.0),
        (0.022, 0.0),
        (0.03, 0.03),
        (0.02, 0.08),
        (0.034, 0.2),
        (0.04, 0.32),
        (0.03, 0.4),
        (0.02, 0.42),
        (0.0, 0.42),
    ];
    let mut patches = Patches::default();
    for (x, z) in [(-0.5, -0.2), (0.7, -0.2), (-0.5, 0.4), (0.7, 0.4)] {
        let foot = Vec3::new(x, 0.02, z);
        turned(&mut patches, foot, Grid { columns: 16, rows: 24, times: Vec2::new(1.0, 2.0) }, &outline);
    }
    patches.finish("table legs", BRASS)
}

fn vase() -> Mesh {
    let outline = [
        (0.0, 0.0),
        (0.06, 0.0),
        (0.08, 0.03),
        (0.12, 0.12),
        (0.11, 0.2),
        (0.055, 0.28),
        (0.05, 0.33),
        (0.075, 0.38),
        (0.068, 0.382),
        (0.04, 0.33),
        (0.045, 0.28),
        (0.09, 0.2),
        (0.1, 0.12),
        (0.05, 0.03),
        (0.0, 0.02),
    ];
    let mut patches = Patches::default();
    let foot = Vec3::new(0.28, 0.48 - PRESS, 0.02);
    turned(&mut patches, foot, Grid { columns: 32, rows: 42, times: Vec2::new(3.0, 3.0) }, &outline);
    patches.finish("vase", GLAZE)
}

fn cups() -> Mesh {
    let outline = [
        (0.0, 0.0),
        (0.025, 0.0),
        (0.034, 0.02),
        (0.042, 0.075),
        (0.038, 0.078),
        (0.03, 0.025),
        (0.015, 0.012),
        (0.0, 0.012),
    ];
    let mut patches = Patches::default();
    for (x, z) in [(-0.25, 0.22), (-0.05, 0.34), (0.5, 0.3)] {
        let foot = Vec3::new(x, 0.48 - PRESS, z);
        turned(&mut patches, foot, Grid { columns: 20, rows: 24, times: Vec2::ONE }, &outline);
    }
    patches.finish("cups", STEEL)
}

/// A foot, a pole and a shade, turned in one.
fn lamp() -> Mesh {
    let outline = [
        (0.0, 0.0),
        (0.15, 0.0),
        (0.16, 0.02),
        (0.03, 0.05),
        (0.015, 0.1),
        (0.015, 0.8),
        (0.015, 1.28),
        (0.06, 1.3),
        (0.26, 1.24),
        (0.27, 1.26),
        (0.2, 1.5),
        (0.12, 1.62),
        (0.0, 1.64),
    ];
    let mut patches = Patches::default();
    let foot = Vec3::new(1.2, -PRESS, -1.55);
    turned(&mut patches, foot, Grid { columns: 28, rows: 48, times: Vec2::new(2.0, 4.0) }, &outline);
    patches.finish("lamp", BRASS)
}

/// Two uprights and four boards at the right wall, which the uprights do not touch.
fn shelf() -> Mesh {
    let x = ROOM.x - 0.2;
    let upright = |z: f32| (Vec3::new(x, 0.85, z), Vec3::new(0.16, 0.85 + PRESS, 0.02), 0.008);
    let board = |y: f32| (Vec3::new(x, y, -0.5), Vec3::new(0.15, 0.015, 0.61), 0.006);
    boxes("shelf", WOOD, 1, &[upright(-1.1), upright(0.1), board(0.25), board(0.7), board(1.15), board(1.6)])
}

/// Rows of books of different heights on three boards.
fn books() -> Mesh {
    let mut patches = Patches::default();
    for (row, board) in [0.25f32, 0.7, 1.15].into_iter().enumerate() {
        for k in 0..7usize {
            let tall = 0.12 + 0.012 * ((3 * k + 5 * row) % 5) as f32;
            let z = -1.0 + 0.075 * k as f32 + 0.3 * (row % 2) as f32;
            let half = Vec3::new(0.1, tall, 0.024 + 0.002 * ((k + row) % 4) as f32);
            let middle = Vec3::new(ROOM.x - 0.22, board + 0.015 - PRESS + tall, z);
            cushion(&mut patches, &Cushion { middle, half, round: 0.006, turn: 0.03 * ((k * 2 + row) % 3) as f32 }, 1);
        }
    }
    patches.finish("books", RED)
}

/// A steel ball beside the table.
fn ball() -> Mesh {
    let centre = Vec3::new(1.55, 0.3 - PRESS, 0.95);
    let mut patches = Patches::default();
    let grid = Grid { columns: 40, rows: 28, times: Vec2::new(8.0, 4.0) };
    super::body::star(&mut patches, grid, |d| centre.as_dvec3() + 0.3 * d);
    patches.finish("ball", STEEL)
}
