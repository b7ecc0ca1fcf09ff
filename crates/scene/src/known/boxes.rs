//! Closed boxes and the Cornell box.

use glam::{Quat, Vec3};

use super::patch::{Patches, camera, matte, scene};
use crate::{Mesh, Scene};

/// Edge of the Cornell box, metres.
const ROOM: f32 = 5.5;
/// Quads along an edge of the Cornell box.
const ROOM_QUADS: u32 = 22;

/// A closed cube of 2 m edge seen from outside, 8 x 8 quads a face, albedo 0.5.
///
/// Convex: every receiver sees its whole hemisphere, so radiance = a under a sky of 1 for any number of bounces.
pub(super) fn furnace_box() -> Scene {
    let mut cube = Patches::default();
    block(&mut cube, Vec3::NEG_ONE, Vec3::ONE, 8);
    scene(
        "furnace-box",
        vec![matte("grey", Vec3::splat(0.5))],
        vec![cube.finish("cube", 0)],
        camera(Vec3::new(3.0, 2.5, 5.0), Vec3::ZERO, 40.0),
    )
}

/// A closed cube of 2 m edge seen from inside, 8 x 8 quads a face, albedo 0.8.
///
/// No ray leaves it: transfer is 0 in every band, for any number of bounces. The test for leaks.
pub(super) fn closed_room() -> Scene {
    let mut cube = Patches::default();
    block(&mut cube, Vec3::NEG_ONE, Vec3::ONE, 8);
    let mut room = cube.finish("room", 0);
    turn_inside_out(&mut room);
    scene(
        "closed-room",
        vec![matte("white", Vec3::splat(0.8))],
        vec![room],
        camera(Vec3::new(0.0, 0.0, 0.9), Vec3::ZERO, 60.0),
    )
}

/// A room of 5.5 m edge, open at the front (+z) and by a square of 1.5 m in the roof: white but for the red left
/// (-x) and green right wall; a short and a tall block without bottoms stand on the floor.
///
/// Each wall is a single inward-facing sheet; front and roof opening are the only ways for light.
pub(super) fn cornell_box() -> Scene {
    let white = Vec3::new(0.73, 0.72, 0.68);
    let materials = vec![
        matte("white", white),
        matte("red", Vec3::new(0.61, 0.06, 0.06)),
        matte("green", Vec3::new(0.13, 0.44, 0.10)),
    ];
    let (h, n) = (0.5 * ROOM, ROOM_QUADS);
    let mut left = Patches::default();
    left.flat(Vec3::new(-h, 0.0, h), Vec3::NEG_Z * ROOM, Vec3::Y * ROOM, n, n);
    let mut right = Patches::default();
    right.flat(Vec3::new(h, 0.0, -h), Vec3::Z * ROOM, Vec3::Y * ROOM, n, n);
    let mut shell = Patches::default();
    shell.flat(Vec3::new(-h, 0.0, h), Vec3::X * ROOM, Vec3::NEG_Z * ROOM, 2 * n, 2 * n);
    shell.flat(Vec3::new(-h, 0.0, -h), Vec3::X * ROOM, Vec3::Y * ROOM, n, n);
    roof(&mut shell, h);
    let meshes = vec![
        shell.finish("shell", 0),
        left.finish("left wall", 1),
        right.finish("right wall", 2),
        standing_block("short block", Vec3::new(0.95, 0.0, 0.85), Vec3::new(1.65, 1.65, 1.65), 0.29),
        standing_block("tall block", Vec3::new(-0.95, 0.0, -0.75), Vec3::new(1.65, 3.3, 1.65), -0.32),
    ];
    scene(
        "cornell-box",
        materials,
        meshes,
        camera(Vec3::new(0.0, 0.5 * ROOM, 10.6), Vec3::new(0.0, 0.5 * ROOM, 0.0), 39.0),
    )
}

/// Four strips of roof around the opening, facing down.
fn roof(shell: &mut Patches, h: f32) {
    let o = 0.75;
    let mut strip = |x0: f32, x1: f32, z0: f32, z1: f32, columns: u32, rows: u32| {
        shell.flat(Vec3::new(x0, ROOM, z0), Vec3::X * (x1 - x0), Vec3::Z * (z1 - z0), columns, rows);
    };
    strip(-h, -o, -h, h, 8, 22);
    strip(o, h, -h, h, 8, 22);
    strip(-o, o, -h, -o, 6, 8);
    strip(-o, o, o, h, 6, 8);
}

/// A block on the floor, turned about y by `angle` radians, without its bottom.
fn standing_block(name: &str, foot: Vec3, size: Vec3, angle: f32) -> Mesh {
    let mut patches = Patches::default();
    let (n, m) = (8, (8.0 * size.y / size.x) as u32);
    let (a, b) = (Vec3::new(-0.5, 0.0, -0.5) * size, Vec3::new(0.5, 1.0, 0.5) * size);
    upright_sides(&mut patches, a, b, n, m);
    patches.flat(Vec3::new(a.x, b.y, b.z), Vec3::X * size.x, Vec3::NEG_Z * size.z, n, n);
    let mut mesh = patches.finish(name, 0);
    let turn = Quat::from_xyzw(0.0, libm::sinf(0.5 * angle), 0.0, libm::cosf(0.5 * angle));
    for (position, normal) in mesh.positions.iter_mut().zip(&mut mesh.normals) {
        *position = foot + turn * *position;
        *normal = (turn * *normal).normalize();
    }
    mesh
}

/// Adds a closed axis-aligned box with outward faces of `n` x `n` quads.
pub(super) fn block(patches: &mut Patches, a: Vec3, b: Vec3, n: u32) {
    let d = b - a;
    upright_sides(patches, a, b, n, n);
    patches.flat(Vec3::new(a.x, b.y, b.z), Vec3::X * d.x, Vec3::NEG_Z * d.z, n, n);
    patches.flat(a, Vec3::X * d.x, Vec3::Z * d.z, n, n);
}

/// The four sides of a box, `columns` x `rows` quads each, facing out.
pub(super) fn upright_sides(patches: &mut Patches, a: Vec3, b: Vec3, columns: u32, rows: u32) {
    let d = b - a;
    let up = Vec3::Y * d.y;
    patches.flat(Vec3::new(a.x, a.y, b.z), Vec3::X * d.x, up, columns, rows);
    patches.flat(Vec3::new(b.x, a.y, b.z), Vec3::NEG_Z * d.z, up, columns, rows);
    patches.flat(Vec3::new(b.x, a.y, a.z), Vec3::NEG_X * d.x, up, columns, rows);
    patches.flat(a, Vec3::Z * d.z, up, columns, rows);
}

/// Makes a mesh face the other way.
pub(super) fn turn_inside_out(mesh: &mut Mesh) {
    mesh.triangles.iter_mut().for_each(|t| t.swap(1, 2));
    mesh.normals.iter_mut().for_each(|n| *n = -*n);
}
