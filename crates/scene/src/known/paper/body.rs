//! Closed bodies with first texture coordinates, made of grids.

use glam::{DVec3, Quat, Vec2, Vec3};
use std::f64::consts::{FRAC_PI_4, PI, TAU};

use super::super::patch::Patches;
use super::super::round::direction;

/// What happens at the two ends of the t of a grid; its s always closes.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Ends {
    /// Each end is one point.
    Poles,
    /// The end is the beginning.
    Ring,
}

/// Quads along s and t, and pictures along both.
#[derive(Clone, Copy)]
pub(super) struct Grid {
    pub(super) columns: usize,
    pub(super) rows: usize,
    pub(super) times: Vec2,
}

/// Adds a closed body whose surface is `point` over [0, 1] squared; it faces (d/ds) x (d/dt). Normals are those of the chords
/// between the neighbours in the grid.
pub(super) fn closed(patches: &mut Patches, grid: Grid, ends: Ends, point: impl Fn(f64, f64) -> DVec3) {
    let Grid { columns, rows, times } = grid;
    let base = patches.mesh.positions.len();
    // Whatever happens to rounding, equal places are computed from equal numbers.
    let place = |i: usize, j: usize| match ends {
        Ends::Poles if j == 0 || j == rows => (0, j),
        Ends::Poles => (i % columns, j),
        Ends::Ring => (i % columns, j % rows),
    };
    let mut points = Vec::with_capacity(columns * (rows + 1));
    for j in 0..=rows {
        for i in 0..columns {
            let (i, j) = place(i, j);
            points.push(point(i as f64 / columns as f64, j as f64 / rows as f64));
        }
    }
    let at = |i: usize, j: usize| points[j * columns + i % columns];
    for j in 0..=rows {
        let (before, after) = match ends {
            Ends::Poles => (j.saturating_sub(1), (j + 1).min(rows)),
            Ends::Ring => ((j + rows - 1) % rows, (j + 1) % rows),
        };
        // A pole has no circle about it: that of its neighbours serves.
        let circle = if ends == Ends::Poles { j.clamp(1, rows - 1) } else { j };
        for i in 0..=columns {
            let along_s = at(i + 1, circle) - at(i + columns - 1, circle);
            let along_t = at(i, after) - at(i, before);
            patches.mesh.positions.push(at(i, j).as_vec3());
            patches.mesh.normals.push(along_s.cross(along_t).normalize().as_vec3());
            let (s, t) = (i as f32 / columns as f32, j as f32 / rows as f32);
            patches.mesh.uv0.push(Vec2::new(s, 1.0 - t) * times);
        }
    }
    quads(patches, base, columns, rows);
}

/// The triangles of a grid whose vertices begin at `base`.
fn quads(patches: &mut Patches, base: usize, columns: usize, rows: usize) {
    for j in 0..rows {
        for i in 0..columns {
            let a = (base + j * (columns + 1) + i) as u32;
            let (b, c, d) = (a + 1, a + columns as u32 + 2, a + columns as u32 + 1);
            patches.triangle([a, b, c]);
            patches.triangle([a, c, d]);
        }
    }
}

/// Adds a closed body about the origin whose surface lies at `reach` of the unit direction.
pub(super) fn star(patches: &mut Patches, grid: Grid, reach: impl Fn(DVec3) -> DVec3) {
    closed(patches, grid, Ends::Poles, |s, t| reach(direction(s as f32, 1.0 - t as f32).as_dvec3()));
}

/// Adds a closed surface of revolution about the vertical through `foot`: (radius, height) from one point of the axis to another, joined
/// smoothly; the outside lies at the right of the way.
pub(super) fn turned(patches: &mut Patches, foot: Vec3, grid: Grid, outline: &[(f64, f64)]) {
    let radii: Vec<f64> = outline.iter().map(|p| p.0).collect();
    let heights: Vec<f64> = outline.iter().map(|p| p.1).collect();
    closed(patches, grid, Ends::Poles, |s, t| {
        let (radius, height) = (between(&radii, t), between(&heights, t));
        foot.as_dvec3() + DVec3::new(radius * libm::sin(TAU * s), height, radius * libm::cos(TAU * s))
    });
}

/// Value at the share `t` of the way through `values`: Hermite's cubics whose slope at a value is the harmonic mean of those beside it, 0 at an
/// extremum, so that they never overshoot (Fritsch and Butland 1984).
fn between(values: &[f64], t: f64) -> f64 {
    let last = values.len() - 1;
    let along = t * last as f64;
    let k = (along as usize).min(last - 1);
    let step = |k: usize| values[k + 1] - values[k];
    let slope = |k: usize| {
        let (a, b) = (step(k.max(1) - 1), step(k.min(last - 1)));
        if a * b > 0.0 { 2.0 * a * b / (a + b) } else { 0.0 }
    };
    let x = along - k as f64;
    let (from, to) = (slope(k), slope(k + 1));
    values[k] + x * (from + x * (3.0 * step(k) - 2.0 * from - to + x * (from + to - 2.0 * step(k))))
}

/// A box with round edges on its way to the world.
#[derive(Clone, Copy)]
pub(super) struct Cushion {
    pub(super) middle: Vec3,
    /// Half edges, of which `round` is the radius of the edges and less than any.
    pub(super) half: Vec3,
    pub(super) round: f32,
    /// Turn about the vertical, radians.
    pub(super) turn: f32,
}

/// Adds a closed box with edges rounded in `2 * steps` steps: 12 (2 `steps` + 1)^2 triangles.
pub(super) fn cushion(patches: &mut Patches, cushion: &Cushion, steps: i32) {
    let Cushion { middle, half, round, turn } = *cushion;
    let spin = Quat::from_xyzw(0.0, libm::sinf(0.5 * turn), 0.0, libm::cosf(0.5 * turn));
    let columns = 2 * steps + 1;
    // Where the lines of the grid lie beside the middle: the tangents of equal angles beyond the flat.
    let line = |k: i32, half: f32| {
        let from_middle = if k > steps { k - steps - 1 } else { steps - k };
        let beyond = libm::tan(FRAC_PI_4 * f64::from(from_middle) / f64::from(steps)) as f32;
        let length = if from_middle == steps { half } else { half - round + round * beyond };
        if k > steps { length } else { -length }
    };
    for axis in 0..3 {
        for side in [-1.0f32, 1.0] {
            let base = patches.mesh.positions.len();
            let (u, v) = if side > 0.0 { ((axis + 1) % 3, (axis + 2) % 3) } else { ((axis + 2) % 3, (axis + 1) % 3) };
            for (j, i) in (0..=columns).flat_map(|j| (0..=columns).map(move |i| (j, i))) {
                let mut on_box = Vec3::ZERO;
                on_box[axis] = side * half[axis];
                on_box[u] = line(i, half[u]);
                on_box[v] = line(j, half[v]);
                let inner = on_box.clamp(round - half, half - round);
                let normal = (on_box - inner).normalize();
                patches.mesh.positions.push(middle + spin * (inner + round * normal));
                patches.mesh.normals.push(spin * normal);
                patches.mesh.uv0.push(Vec2::new(i as f32, (columns - j) as f32) / columns as f32);
            }
            quads(patches, base, columns as usize, columns as usize);
        }
    }
}

/// Sine and cosine of a share of half a turn.
pub(super) fn half_turn(share: f64) -> (f64, f64) {
    (libm::sin(PI * share), libm::cos(PI * share))
}
