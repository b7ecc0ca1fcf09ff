//! Two rooms side by side, of which one sees the sky.

use glam::Vec3;

use super::boxes::{block, turn_inside_out, upright_sides};
use super::patch::{Patches, camera, matte, scene};
use crate::{Mesh, Scene};

/// Edge of a room and thickness of the walls, metres: sums of powers of two, so that corners meet exactly.
const EDGE: f32 = 2.0;
const WALL: f32 = 1.0 / 16.0;
/// Quads along an edge of a room.
const QUADS: u32 = 8;

/// Two cubes of 2 m edge hollowed out of one block with walls of 1/16 m, side by side along x: at -x a sealed one, at +x one without a
/// roof. The wall between them is in x = 0, the floors are in y = 0, the rooms reach from -1 to 1 along z; albedo 0.8.
///
/// No ray leaves the sealed room: transfer is 0 there in every band, for any number of bounces, one wall away from the sky. The test for
/// leaks through thin walls.
pub(super) fn two_rooms() -> Scene {
    let half = Vec3::new(0.0, 0.0, 0.5 * EDGE);
    let dark = Vec3::X * (-EDGE - 0.5 * WALL) - half;
    let bright = Vec3::X * (0.5 * WALL) - half;
    let mut sealed = Patches::default();
    block(&mut sealed, dark, dark + EDGE, QUADS);
    let mut open = Patches::default();
    let top = bright + Vec3::new(EDGE, EDGE + WALL, EDGE);
    upright_sides(&mut open, bright, top, QUADS, QUADS);
    open.flat(bright, Vec3::X * EDGE, Vec3::Z * EDGE, QUADS, QUADS);
    let inward = |mut patches: Patches, name: &str| {
        let mut mesh = patches.finish(name, 0);
        turn_inside_out(&mut mesh);
        mesh
    };
    scene(
        "two-rooms",
        vec![matte("plaster", Vec3::splat(0.8))],
        vec![inward(sealed, "sealed room"), inward(open, "open room"), shell(dark - WALL, bright, top)],
        camera(Vec3::new(4.0, 5.0, 4.5), Vec3::new(0.5, 0.8, 0.0), 35.0),
    )
}

/// The outside, and the top around the opening of the open room, whose lowest and highest corner are given.
fn shell(low: Vec3, bright: Vec3, top: Vec3) -> Mesh {
    let high = top + Vec3::new(WALL, 0.0, WALL);
    let mut patches = Patches::default();
    upright_sides(&mut patches, low, high, QUADS, QUADS);
    patches.flat(low, Vec3::X * (high.x - low.x), Vec3::Z * (high.z - low.z), QUADS, QUADS);
    let at = |x: f32, z: f32| Vec3::new(x, top.y, z);
    let outer = [at(low.x, high.z), at(high.x, high.z), at(high.x, low.z), at(low.x, low.z)];
    let inner = [at(bright.x, top.z), at(top.x, top.z), at(top.x, bright.z), at(bright.x, bright.z)];
    for (i, j) in [(0, 1), (1, 2), (2, 3), (3, 0)] {
        patches.grid(QUADS, 4, |s, t| {
            let along = |ring: &[Vec3; 4]| ring[i] + s * (ring[j] - ring[i]);
            (along(&outer) + t * (along(&inner) - along(&outer)), Vec3::Y)
        });
    }
    patches.finish("shell", 0)
}
