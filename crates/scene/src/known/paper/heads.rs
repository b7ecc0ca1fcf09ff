//! Two heads and a monkey's.

use glam::{DVec3, Vec2, Vec3};

use super::super::patch::{Patches, camera};
use super::body::{Grid, star};
use super::shine::{BANDS, CHECKER, coat, ground, metal, pictures};
use super::shown;
use crate::{Mesh, Scene};

/// Quads around each head and from its foot to its crown.
const QUADS: (usize, usize) = (384, 192);
/// Depth of the feet in the ground, metres.
const SUNK: f64 = 0.006;
/// Height of the middle of a head above its foot, metres.
const MIDDLE: f64 = 0.62;

/// Where a face swells or is hollow: direction (of both sides where x is not 0; faces look along z), width in radians, height as share of the radius.
type Swelling = ([f64; 3], f64, f64);

const FACE: &[Swelling] = &[
    ([0.0, -0.08, 1.0], 0.10, 0.20),
    ([0.0, 0.06, 1.0], 0.08, 0.09),
    ([0.10, -0.12, 1.0], 0.06, 0.05),
    ([0.30, 0.28, 0.92], 0.13, 0.07),
    ([0.30, 0.10, 0.95], 0.14, -0.15),
    ([0.29, 0.09, 0.95], 0.075, 0.12),
    ([0.50, -0.22, 0.80], 0.22, 0.05),
    ([0.07, -0.30, 0.95], 0.06, 0.08),
    ([0.16, -0.34, 0.95], 0.05, 0.03),
    ([0.07, -0.43, 0.95], 0.06, 0.08),
    ([0.0, -0.62, 0.80], 0.17, 0.16),
    ([1.0, 0.02, -0.06], 0.12, 0.20),
    ([0.98, 0.10, -0.10], 0.08, 0.05),
];
const MONKEY: &[Swelling] = &[
    ([0.0, -0.38, 0.92], 0.34, 0.26),
    ([0.09, -0.16, 1.0], 0.06, -0.03),
    ([0.0, -0.10, 1.0], 0.10, 0.06),
    ([0.28, 0.36, 0.90], 0.17, 0.16),
    ([0.28, 0.14, 0.95], 0.15, -0.24),
    ([0.28, 0.14, 0.95], 0.09, 0.22),
    ([0.30, -0.48, 0.85], 0.10, -0.09),
    ([0.0, -0.52, 0.85], 0.09, -0.11),
    ([1.0, 0.18, -0.05], 0.20, 0.55),
    ([0.96, 0.16, 0.22], 0.12, -0.26),
];

/// Three closed bodies of 146,688 triangles each, one mesh each so that each can have a texture of its own, on a ground of two triangles:
/// a bronze head, one of red lacquer, and between them a monkey's of blue lacquer.
pub(super) fn heads() -> Scene {
    shown(
        "paper-heads",
        vec![
            coat("floor", Vec3::new(0.5, 0.48, 0.44), CHECKER),
            metal("bronze", Vec3::new(0.82, 0.58, 0.34), BANDS),
            coat("blue lacquer", Vec3::new(0.08, 0.20, 0.42), BANDS),
            coat("red lacquer", Vec3::new(0.48, 0.09, 0.06), BANDS),
        ],
        vec![
            ground(0, 2.4, 10.0),
            head("first head", 1, DVec3::new(-1.0, -SUNK, -0.1), 0.35, |d| hairy(d, 13.0)),
            head("monkey", 2, DVec3::new(0.0, -SUNK, 0.35), 0.0, |d| swollen(d, MONKEY)),
            head("second head", 3, DVec3::new(1.0, -SUNK, -0.1), -0.35, |d| hairy(d, 22.0)),
        ],
        pictures(),
        [
            camera(Vec3::new(0.0, 1.25, 3.9), Vec3::new(0.0, 0.58, 0.0), 31.0),
            camera(Vec3::new(0.0, 2.6, 1.05), Vec3::new(0.0, 0.35, 0.12), 39.0),
        ],
    )
}

/// A head at its foot, turned about the vertical by `turn` radians; `radius` is by direction, as share of 0.5 m.
fn head(name: &str, material: u32, foot: DVec3, turn: f64, radius: impl Fn(DVec3) -> f64) -> Mesh {
    let (sin, cos) = (libm::sin(turn), libm::cos(turn));
    let mut patches = Patches::default();
    let grid = Grid { columns: QUADS.0, rows: QUADS.1, times: Vec2::new(6.0, 3.0) };
    star(&mut patches, grid, |d| {
        let p = 0.5 * radius(d) * d * DVec3::new(0.82, 1.06, 0.94);
        // The foot is cut level, with an edge of 3 cm.
        let above = p.y + MIDDLE;
        let y = 0.03 * libm::log1p(libm::exp(above / 0.03));
        foot + DVec3::new(cos * p.x + sin * p.z, y, cos * p.z - sin * p.x)
    });
    patches.finish(name, material)
}

/// A smooth head with a neck, and its swellings.
fn swollen(d: DVec3, swellings: &[Swelling]) -> f64 {
    let neck = 0.55 * hill(d, DVec3::new(0.0, -1.0, -0.12), 0.36);
    let mut radius = 1.0 + neck;
    for &([x, y, z], width, height) in swellings {
        radius += height * hill(d, DVec3::new(x, y, z), width);
        if x != 0.0 {
            radius += height * hill(d, DVec3::new(-x, y, z), width);
        }
    }
    radius
}

/// A face under combed hair with `strands` waves in half a turn.
fn hairy(d: DVec3, strands: f64) -> f64 {
    // Hair grows behind a line that rises from the ears to the brow.
    let behind = (0.42 - d.z + 0.75 * (d.y - 0.42)) / 0.16;
    let above = (d.y + 0.62) / 0.16;
    let hair = step(behind) * step(above);
    let around = libm::atan2(d.x, 0.9 - d.z);
    let waves = libm::cos(2.0 * strands * around + 5.0 * d.y);
    swollen(d, FACE) + hair * (0.09 + 0.15 / strands * waves)
}

/// 1 in the direction `towards`, falling like a Gaussian over the angle.
fn hill(d: DVec3, towards: DVec3, width: f64) -> f64 {
    libm::exp((d.dot(towards.normalize()) - 1.0) / (width * width))
}

/// Rises smoothly from 0 at -1 to 1 at 1.
fn step(x: f64) -> f64 {
    let x = (0.5 * x + 0.5).clamp(0.0, 1.0);
    x * x * (3.0 - 2.0 * x)
}
