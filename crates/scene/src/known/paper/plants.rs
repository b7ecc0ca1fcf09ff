//! Three plants in glazed pots.

use glam::{DVec3, Vec2, Vec3};
use std::f64::consts::{PI, TAU};

use super::super::patch::{Patches, camera};
use super::body::{Ends, Grid, closed, half_turn, turned};
use super::shine::{BANDS, CHECKER, coat, ground, metal, pictures};
use super::shown;
use crate::{Mesh, Scene};

/// Outline of a pot of radius 1, from the middle of its foot up the outside, over the rim and down to the earth.
const POT: &[(f64, f64)] = &[
    (0.0, 0.0),
    (0.5, 0.0),
    (0.66, 0.02),
    (0.74, 0.2),
    (0.88, 0.8),
    (0.97, 1.3),
    (1.06, 1.36),
    (1.08, 1.5),
    (1.0, 1.56),
    (0.92, 1.5),
    (0.88, 1.3),
    (0.5, 1.24),
    (0.0, 1.26),
];
/// Quads around a stalk with its leaf, and along it.
const LEAF_QUADS: (usize, usize) = (10, 14);

/// How a plant grows.
struct Plant {
    foot: Vec3,
    /// Of the pot, metres.
    radius: f64,
    leaves: u32,
    /// Length of a stalk with its leaf, half the width of the leaf, metres.
    leaf: (f64, f64),
    /// Share of the length that is stalk.
    stalk: f64,
    /// Angle from the vertical of the innermost and the outermost leaf where they leave the earth, and by how much they bend over, radians.
    lean: (f64, f64),
    bend: f64,
}

/// Pots, stalks and leaves are closed bodies, one mesh of pots and one of leaves for each plant, on a ground of two triangles. The pots stand
/// 1 mm deep in the ground, the stalks in the earth.
pub(super) fn plants() -> Scene {
    let at = |x: f32, z: f32| Vec3::new(x, -0.001, z);
    let plants = [
        // An upright one, a bush of round leaves, and one that hangs over.
        Plant {
            foot: at(-0.42, -0.1),
            radius: 0.13,
            leaves: 17,
            leaf: (0.62, 0.030),
            stalk: 0.05,
            lean: (0.03, 0.32),
            bend: 0.2,
        },
        Plant {
            foot: at(0.02, 0.12),
            radius: 0.12,
            leaves: 20,
            leaf: (0.40, 0.062),
            stalk: 0.5,
            lean: (0.1, 0.95),
            bend: 0.9,
        },
        Plant {
            foot: at(0.45, -0.12),
            radius: 0.15,
            leaves: 19,
            leaf: (0.60, 0.036),
            stalk: 0.2,
            lean: (0.1, 0.8),
            bend: 1.5,
        },
    ];
    let mut meshes = vec![ground(0, 1.1, 8.0)];
    for (index, plant) in (0u32..).zip(&plants) {
        meshes.push(pot(plant, 1 + index));
        meshes.push(leaves(plant, 4 + index));
    }
    shown(
        "paper-plants",
        vec![
            coat("floor", Vec3::new(0.52, 0.46, 0.40), CHECKER),
            metal("copper", Vec3::new(0.86, 0.52, 0.40), BANDS),
            coat("white glaze", Vec3::new(0.72, 0.70, 0.65), BANDS),
            metal("steel", Vec3::new(0.58, 0.58, 0.60), CHECKER),
            coat("dark leaf", Vec3::new(0.07, 0.22, 0.06), BANDS),
            coat("light leaf", Vec3::new(0.20, 0.38, 0.08), BANDS),
            coat("green leaf", Vec3::new(0.10, 0.30, 0.09), BANDS),
        ],
        meshes,
        pictures(),
        [
            camera(Vec3::new(0.25, 0.85, 1.75), Vec3::new(0.0, 0.34, 0.0), 36.0),
            camera(Vec3::new(0.05, 1.15, 0.6), Vec3::new(0.02, 0.1, 0.02), 40.0),
        ],
    )
}

fn pot(plant: &Plant, material: u32) -> Mesh {
    let mut patches = Patches::default();
    let outline: Vec<_> = POT.iter().map(|(r, h)| (r * plant.radius, h * plant.radius)).collect();
    turned(&mut patches, plant.foot, Grid { columns: 24, rows: 24, times: Vec2::new(4.0, 4.0) }, &outline);
    patches.finish("pot", material)
}

fn leaves(plant: &Plant, material: u32) -> Mesh {
    let mut patches = Patches::default();
    for index in 0..plant.leaves {
        // Leaves turn by the golden angle, the outer ones lean more.
        let share = (f64::from(index) + 0.5) / f64::from(plant.leaves);
        let around = PI * (3.0 - 5.0f64.sqrt()) * f64::from(index);
        let away = DVec3::new(libm::sin(around), 0.0, libm::cos(around));
        let root = plant.foot.as_dvec3() + away * (0.5 * plant.radius * share.sqrt()) + DVec3::Y * (1.2 * plant.radius);
        leaf(&mut patches, plant, root, away, share);
    }
    patches.finish("leaves", material)
}

/// One stalk that widens into a leaf, bent over towards `away`.
fn leaf(patches: &mut Patches, plant: &Plant, root: DVec3, away: DVec3, share: f64) {
    let (length, half_width) = (plant.leaf.0 * (0.8 + 0.2 * share), plant.leaf.1);
    let lean = plant.lean.0 + (plant.lean.1 - plant.lean.0) * share;
    // An arc of constant curvature: angle from the vertical lean + bend t.
    let spine = |t: f64| {
        let angle = lean + plant.bend * t;
        let (sin, cos) = (libm::sin(angle), libm::cos(angle));
        let k = length / plant.bend;
        let run = k * (libm::cos(lean) - cos);
        let rise = k * (sin - libm::sin(lean));
        (root + away * run + DVec3::Y * rise, away * cos - DVec3::Y * sin)
    };
    let across = DVec3::Y.cross(away);
    let (columns, rows) = LEAF_QUADS;
    let grid = Grid { columns, rows, times: Vec2::new(2.0, 3.0) };
    closed(patches, grid, Ends::Poles, |s, t| {
        let (centre, under) = spine(t);
        let (width, thick) = section(t, plant.stalk, half_width);
        // Along the way the section's axes are right-handed: under x across = along.
        let (sin, cos) = (libm::sin(TAU * s), libm::cos(TAU * s));
        centre + under * (thick * cos) + across * (width * sin)
    });
}

/// Half width and half thickness at the share `t` of the length.
fn section(t: f64, stalk: f64, half_width: f64) -> (f64, f64) {
    let round = (1.0 - (2.0 * t - 1.0) * (2.0 * t - 1.0)).max(0.0).sqrt();
    let blade = ((t - stalk) / (1.0 - stalk)).max(0.0);
    let (sin, _) = half_turn(blade.sqrt());
    let width = 0.004 + (half_width - 0.004) * sin.max(0.0);
    (width * round.min(1.0), (0.0028 + 0.06 * (width - 0.004)) * round.min(1.0))
}
