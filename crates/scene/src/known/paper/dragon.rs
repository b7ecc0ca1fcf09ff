//! A knotted serpent with scales.

use glam::{DVec3, Vec2, Vec3};
use std::f64::consts::TAU;

use super::super::patch::{Patches, camera};
use super::body::{Ends, Grid, closed};
use super::shine::{BANDS, CHECKER, coat, ground, metal, pictures};
use super::shown;
use crate::{Mesh, Scene, vertices};

/// Quads around the body and along it.
const QUADS: (usize, usize) = (320, 2028);
/// Scales around the body and along it.
const SCALES: (f64, f64) = (16.0, 160.0);
/// Radii of the ring about which the body winds, of its windings, and of the body itself, metres.
const RADII: (f64, f64, f64) = (1.0, 0.42, 0.24);
/// Height of a scale and of the crest, metres.
const RELIEF: (f64, f64) = (0.016, 0.05);
/// Pieces of the body in the sheet of light maps, each a square of a quarter of its side; a fourth of the sheet remains for the ground.
const PIECES: usize = 12;
/// Free margin of each piece, as share of the sheet: 4 texels of 1024.
const MARGIN: f32 = 0.004;
/// Height of the middle of the knot above the ground: its lowest scales press 1 cm into it.
const MIDDLE: f64 = 0.672;

/// A trefoil of bronze, twice about the vertical and three times about a ring of 1 m: one closed body of 1,297,920 triangles in scales that
/// lie in staggered rows, with a crest along its outer side, on a ground of two triangles. It brings light-map coordinates, one sheet for all,
/// as unwrapping it takes minutes.
pub(super) fn dragon() -> Scene {
    let mut ground = ground(0, 2.6, 10.0);
    let corner = |p: &Vec3| Vec2::new(p.x, p.z) / (2.0 * 2.6) + 0.5;
    ground.uv1 = ground.positions.iter().map(|p| within(Vec2::ZERO, 0.5, corner(p))).collect();
    shown(
        "paper-dragon",
        vec![coat("floor", Vec3::new(0.42, 0.44, 0.46), CHECKER), metal("bronze", Vec3::new(0.78, 0.52, 0.28), BANDS)],
        vec![ground, serpent()],
        pictures(),
        [
            camera(Vec3::new(1.3, 2.9, 3.3), Vec3::new(0.0, 0.42, 0.1), 36.0),
            camera(Vec3::new(0.4, 2.6, 1.7), Vec3::new(0.1, 0.2, 0.15), 34.0),
        ],
    )
}

fn serpent() -> Mesh {
    let mut patches = Patches::default();
    let grid = Grid { columns: QUADS.0, rows: QUADS.1, times: Vec2::new(2.0, 24.0) };
    closed(&mut patches, grid, Ends::Ring, |s, t| {
        let (centre, out) = spine(t);
        let along = (spine(t + 1e-5).0 - spine(t - 1e-5).0).normalize();
        let across = along.cross(out).normalize();
        let out = across.cross(along);
        let thick = RADII.2 * (1.0 + 0.16 * libm::cos(TAU * t)) + relief(s, t);
        centre + thick * (out * libm::cos(TAU * s) + across * libm::sin(TAU * s))
    });
    let mut mesh = patches.finish("serpent", 1);
    unroll(&mut mesh);
    mesh
}

/// Cuts the grid across into pieces of as many rows, whose borders are doubled, and lays them out around the ground's corner.
fn unroll(mesh: &mut Mesh) {
    let (columns, rows) = QUADS;
    let (wide, high) = (columns + 1, rows / PIECES);
    let mut kept = Vec::new();
    for piece in 0..PIECES {
        // Two by two at the right of the ground, the others in two rows below.
        let (column, row) = if piece < 4 { (2 + piece % 2, piece / 2) } else { (piece % 4, 1 + piece / 4) };
        let corner = 0.25 * Vec2::new(column as f32, row as f32);
        for (j, i) in (0..=high).flat_map(|j| (0..wide).map(move |i| (j, i))) {
            kept.push(((piece * high + j) * wide + i) as u32);
            mesh.uv1.push(within(corner, 0.25, Vec2::new(i as f32 / columns as f32, j as f32 / high as f32)));
        }
    }
    for (index, triangle) in mesh.triangles.iter_mut().enumerate() {
        // Two triangles a quad; each piece before this one has doubled one row of vertices.
        let piece = index / (2 * columns * high);
        triangle.iter_mut().for_each(|v| *v += (piece * wide) as u32);
    }
    let uv1 = std::mem::take(&mut mesh.uv1);
    vertices::select(mesh, &kept);
    mesh.uv1 = uv1;
}

/// The place `at` of [0, 1] squared in a square of the sheet, without its margin.
fn within(corner: Vec2, side: f32, at: Vec2) -> Vec2 {
    corner + MARGIN + at * (side - 2.0 * MARGIN)
}

/// Middle of the body and the way out from the ring that it winds about.
fn spine(t: f64) -> (DVec3, DVec3) {
    let (ring, winding) = (2.0 * TAU * t, 3.0 * TAU * t);
    let level = DVec3::new(libm::sin(ring), 0.0, libm::cos(ring));
    let out = level * libm::cos(winding) + DVec3::Y * libm::sin(winding);
    (level * RADII.0 + DVec3::Y * MIDDLE + out * RADII.1, out)
}

/// Height above the smooth body: domes in staggered rows, and spikes along s = 0.
fn relief(s: f64, t: f64) -> f64 {
    let (u, v) = (s * SCALES.0, t * SCALES.1);
    let beside = |x: f64| x - libm::round(x);
    let squared = |u: f64, v: f64| beside(u) * beside(u) + beside(v) * beside(v);
    let near = squared(u, v).min(squared(u + 0.5, v + 0.5));
    let from_crest = beside(s) / 0.03;
    let spikes = 0.55 + 0.45 * libm::cos(TAU * 0.5 * SCALES.1 * t);
    RELIEF.0 * (1.0 - 4.0 * near) + RELIEF.1 * spikes * libm::exp(-from_crest * from_crest)
}
