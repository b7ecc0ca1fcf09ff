//! Which samples a triangle covers, and how deep it is there.

use crate::clip::Polygon;
use crate::facet::Facet;
use crate::view::View;
use glam::DVec3;

/// Steps per sample that corners snap to, as on a GPU.
const STEPS: i64 = 256;

/// A triangle, or a part of one that was clipped, in fixed-point sample coordinates.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Piece {
    /// Index of the triangle that this is a part of.
    pub(crate) triangle: u32,
    /// First and last column and row that it can touch.
    pub(crate) columns: [u32; 2],
    pub(crate) rows: [u32; 2],
    /// Clockwise as seen, y down.
    corners: [[i64; 2]; 3],
    /// Depth is this · (column, row, 1).
    depth: DVec3,
    /// Snapping can move samples off the triangle; their depth stays within that of its corners.
    depth_range: [f32; 2],
}

/// A rectangle of samples: columns and rows, ends excluded.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Window {
    pub(crate) columns: [u32; 2],
    pub(crate) rows: [u32; 2],
}

impl Window {
    /// Columns of the window.
    pub(crate) fn width(&self) -> usize {
        (self.columns[1] - self.columns[0]) as usize
    }

    /// Rows of the window.
    pub(crate) fn height(&self) -> usize {
        (self.rows[1] - self.rows[0]) as usize
    }

    /// Where a sample of the window stands, row by row.
    pub(crate) fn index(&self, column: u32, row: u32) -> usize {
        (row - self.rows[0]) as usize * self.width() + (column - self.columns[0]) as usize
    }
}

/// Appends the pieces of one triangle, given in projective space, that may cover samples of the view.
pub(crate) fn pieces(triangle: u32, corners: [DVec3; 3], view: &View, out: &mut Vec<Piece>) {
    let Some(polygon) = Polygon::clipped(corners, view.near) else {
        return;
    };
    let Some(plane) = Facet::new(corners).inverse_depth(corners) else {
        return;
    };
    let depth = sample_plane(plane * view.near, view);
    let (mut least, mut most) = (f32::INFINITY, 0.0_f32);
    for corner in polygon.corners() {
        let d = (view.near / corner.z) as f32;
        (least, most) = (least.min(d), most.max(d));
    }
    let fixed = |v: DVec3| (view.sample(v) * STEPS as f64).round().to_array().map(|x| x as i64);
    let first = fixed(polygon.corners()[0]);
    for pair in polygon.corners()[1..].windows(2) {
        // The picture's y points down, so the counter-clockwise front turns the other way here.
        let corners = [first, fixed(pair[1]), fixed(pair[0])];
        if let Some((columns, rows)) = bounds(&corners, view.samples) {
            out.push(Piece { triangle, columns, rows, corners, depth, depth_range: [least, most] });
        }
    }
}

/// A linear function of the place on the picture as one of column and row.
fn sample_plane(k: DVec3, view: &View) -> DVec3 {
    let [width, height] = view.samples.map(f64::from);
    let (per_column, per_row) = (k.x * 2.0 / width, -k.y * 2.0 / height);
    DVec3::new(per_column, per_row, k.z + k.x * (1.0 / width - 1.0) + k.y * (1.0 - 1.0 / height))
}

/// First and last column and row whose centres lie within a front-facing triangle's box; `None` where there are none.
fn bounds(corners: &[[i64; 2]; 3], samples: [u32; 2]) -> Option<([u32; 2], [u32; 2])> {
    let [a, b, c] = corners;
    if (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]) <= 0 {
        return None;
    }
    let range = |axis: usize| {
        let values = [a[axis], b[axis], c[axis]];
        let least = values.into_iter().min()?;
        let most = values.into_iter().max()?;
        // The centre of sample i is at (i + 1/2) · STEPS.
        let first = (least + STEPS / 2 - 1).div_euclid(STEPS).max(0);
        let last = (most - STEPS / 2).div_euclid(STEPS).min(i64::from(samples[axis]) - 1);
        (first <= last).then_some([first as u32, last as u32])
    };
    Some((range(0)?, range(1)?))
}

impl Piece {
    /// Calls `visit(column, row, depth)` for each sample of the window that belongs to this piece by the top-left rule.
    pub(crate) fn scan(&self, window: &Window, mut visit: impl FnMut(u32, u32, f32)) {
        let first_row = self.rows[0].max(window.rows[0]);
        let end_row = (self.rows[1] + 1).min(window.rows[1]);
        let edges = [0, 1, 2].map(|i| Edge::new(self.corners[i], self.corners[(i + 1) % 3]));
        let columns = [
            i64::from(self.columns[0].max(window.columns[0])),
            i64::from((self.columns[1] + 1).min(window.columns[1])),
        ];
        for row in first_row..end_row {
            let [mut begin, mut end] = columns;
            for edge in &edges {
                edge.narrow(row, &mut begin, &mut end);
            }
            let row_depth = self.depth.y * f64::from(row) + self.depth.z;
            for column in begin..end {
                let depth = (self.depth.x * column as f64 + row_depth) as f32;
                visit(column as u32, row, depth.clamp(self.depth_range[0], self.depth_range[1]));
            }
        }
    }
}

/// One side of a triangle as the linear function across·column + down·row + offset that is not negative inside.
#[derive(Debug, Clone, Copy)]
struct Edge {
    across: i64,
    down: i64,
    offset: i64,
}

impl Edge {
    fn new(from: [i64; 2], to: [i64; 2]) -> Self {
        let (dx, dy) = (to[0] - from[0], to[1] - from[1]);
        // Samples exactly on an edge belong to it where it is a top or a left one.
        let owns = dy < 0 || (dy == 0 && dx > 0);
        let half = STEPS / 2;
        let offset = dx * (half - from[1]) - dy * (half - from[0]) - i64::from(!owns);
        Self { across: -dy * STEPS, down: dx * STEPS, offset }
    }

    /// Narrows columns `begin..end` of a row to those inside.
    fn narrow(&self, row: u32, begin: &mut i64, end: &mut i64) {
        let value = self.down * i64::from(row) + self.offset;
        if self.across > 0 {
            *begin = (*begin).max(-value.div_euclid(self.across));
        } else if self.across < 0 {
            *end = (*end).min(value.div_euclid(-self.across) + 1);
        } else if value < 0 {
            *end = *begin;
        }
    }
}
