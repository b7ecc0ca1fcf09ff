//! Cube maps: six square faces, as a strip, a folder or an unfolded cross, and OpenEXR's own strip.
//!
//! Face files and crosses are named as the viewer sees them: `pz` looks forward (world +z), `px` to the viewer's
//! right, which is world -x because +x lies to the left of +z. OpenEXR's strip is named by world axes.

use crate::Layout;
use crate::patch::{Patch, Rect};
use glam::DVec3;

/// Where a face lies in a cross: tile column, tile row, and whether it stands on its head.
const VERTICAL: [(usize, usize); 6] = [(2, 1), (0, 1), (1, 0), (1, 2), (1, 1), (1, 3)];
const HORIZONTAL: [(usize, usize); 6] = [(2, 1), (0, 1), (1, 0), (1, 2), (1, 1), (3, 1)];

/// The back face of a vertical cross hangs below the bottom face, turned by 180 degrees.
const TURNED: usize = 5;

/// The side of a face in pixels.
fn side(layout: Layout, width: usize) -> usize {
    let (columns, _) = layout.tiles().unwrap_or((1, 1));
    width / columns
}

/// The face on tile `(column, row)`, or `None` where a cross is empty.
fn face_at(layout: Layout, column: usize, row: usize) -> Option<usize> {
    let find = |tiles: &[(usize, usize); 6]| tiles.iter().position(|t| *t == (column, row));
    match layout {
        Layout::VerticalCross => find(&VERTICAL),
        Layout::HorizontalCross => find(&HORIZONTAL),
        _ => Some(row),
    }
}

/// The tile of a face.
fn tile_of(layout: Layout, face: usize) -> (usize, usize) {
    match layout {
        Layout::VerticalCross => VERTICAL[face],
        Layout::HorizontalCross => HORIZONTAL[face],
        _ => (0, face),
    }
}

/// Whether the pixels of this face run backwards.
fn is_turned(layout: Layout, face: usize) -> bool {
    layout == Layout::VerticalCross && face == TURNED
}

/// The point of the unit cube at `(u, v)` of a face, u right and v down in [-1, 1], in world axes; not unit.
fn cube_point(layout: Layout, face: usize, u: f64, v: f64) -> DVec3 {
    if layout == Layout::ExrCube {
        return match face {
            0 => DVec3::new(1.0, -v, u),
            1 => DVec3::new(-1.0, -v, -u),
            2 => DVec3::new(u, 1.0, -v),
            3 => DVec3::new(u, -1.0, v),
            4 => DVec3::new(-u, -v, 1.0),
            _ => DVec3::new(u, -v, -1.0),
        };
    }
    // The viewer's axes (right, up, forward).
    let p = match face {
        0 => DVec3::new(1.0, -v, -u),
        1 => DVec3::new(-1.0, -v, u),
        2 => DVec3::new(u, 1.0, v),
        3 => DVec3::new(u, -1.0, -v),
        4 => DVec3::new(u, -v, 1.0),
        _ => DVec3::new(-u, -v, -1.0),
    };
    DVec3::new(-p.x, p.y, p.z)
}

/// The face that a direction meets and where on it: the inverse of [`cube_point`].
fn face_of(layout: Layout, d: DVec3) -> (usize, f64, f64) {
    let p = match layout {
        Layout::ExrCube => d,
        _ => DVec3::new(-d.x, d.y, d.z),
    };
    let a = p.abs();
    let negative = |value: f64| usize::from(value < 0.0);
    let (face, major) = if a.x >= a.y && a.x >= a.z {
        (negative(p.x), a.x)
    } else if a.y >= a.z {
        (2 + negative(p.y), a.y)
    } else {
        (4 + negative(p.z), a.z)
    };
    let (u, v) = match (layout, face) {
        (Layout::ExrCube, 0) => (p.z, -p.y),
        (Layout::ExrCube, 1) => (-p.z, -p.y),
        (Layout::ExrCube, 2) => (p.x, -p.z),
        (Layout::ExrCube, 3) => (p.x, p.z),
        (Layout::ExrCube, 4) => (-p.x, -p.y),
        (Layout::ExrCube, _) => (p.x, -p.y),
        (_, 0) => (-p.z, -p.y),
        (_, 1) => (p.z, -p.y),
        (_, 2) => (p.x, p.z),
        (_, 3) => (p.x, -p.z),
        (_, 4) => (p.x, -p.y),
        (_, _) => (-p.x, -p.y),
    };
    (face, u / major, v / major)
}

/// Face and texel of a pixel, or `None` on an empty tile.
fn texel_of(layout: Layout, width: usize, x: usize, y: usize) -> Option<(usize, usize, usize)> {
    let n = side(layout, width);
    let face = face_at(layout, x / n, y / n)?;
    let (i, j) = (x % n, y % n);
    if is_turned(layout, face) {
        return Some((face, n - 1 - i, n - 1 - j));
    }
    Some((face, i, j))
}

/// Whether a pixel lies on a face.
pub(crate) fn covers(layout: Layout, width: usize, x: usize, y: usize) -> bool {
    texel_of(layout, width, x, y).is_some()
}

/// The pixel of a texel: the inverse of [`texel_of`].
fn pixel_of(layout: Layout, width: usize, face: usize, i: usize, j: usize) -> usize {
    let n = side(layout, width);
    let (column, row) = tile_of(layout, face);
    let (i, j) = if is_turned(layout, face) { (n - 1 - i, n - 1 - j) } else { (i, j) };
    (row * n + j) * width + column * n + i
}

/// The span of texel `i` over the face in [-1, 1].
///
/// Texels of OpenEXR's strip stand on the edges, at `i/(n-1)`, so the first and the last own half a step.
fn span(layout: Layout, n: usize, i: usize) -> (f64, f64) {
    if layout == Layout::ExrCube && n > 1 {
        let step = 2.0 / (n - 1) as f64;
        let centre = -1.0 + step * i as f64;
        return ((centre - 0.5 * step).max(-1.0), (centre + 0.5 * step).min(1.0));
    }
    let step = 2.0 / n as f64;
    (-1.0 + step * i as f64, -1.0 + step * (i + 1) as f64)
}

/// Where texel `i` stands on the face in [-1, 1].
fn position(layout: Layout, n: usize, i: i64) -> f64 {
    if layout == Layout::ExrCube && n > 1 {
        return -1.0 + 2.0 * i as f64 / (n - 1) as f64;
    }
    -1.0 + (2.0 * i as f64 + 1.0) / n as f64
}

/// Solid angle of the part of a face between its centre and the corner `(u, v)`: `atan(u v / sqrt(u^2 + v^2 + 1))`.
fn corner_angle(u: f64, v: f64) -> f64 {
    libm::atan2(u * v, libm::sqrt(u * u + v * v + 1.0))
}

/// A cell of a pixel on the sphere, or `None` on an empty tile of a cross.
pub(crate) fn patch(
    layout: Layout,
    width: usize,
    (x, y): (usize, usize),
    (split, a, b): (usize, usize, usize),
) -> Option<Patch> {
    let n = side(layout, width);
    let (face, i, j) = texel_of(layout, width, x, y)?;
    let (u, v) = (span(layout, n, i), span(layout, n, j));
    let cell = Rect { x0: u.0, y0: v.0, x1: u.1, y1: v.1 }.cell(split, a, b);
    let (cu, cv) = match split {
        1 => (position(layout, n, i as i64), position(layout, n, j as i64)),
        _ => cell.centre(),
    };
    let solid_angle = corner_angle(cell.x1, cell.y1) - corner_angle(cell.x0, cell.y1) - corner_angle(cell.x1, cell.y0)
        + corner_angle(cell.x0, cell.y0);
    Some(Patch { direction: cube_point(layout, face, cu, cv).normalize(), solid_angle })
}

/// The texel of a face whose area holds `(u, v)`.
fn nearest_on_face(layout: Layout, width: usize, (face, u, v): (usize, f64, f64)) -> usize {
    let n = side(layout, width);
    let index = |t: f64| {
        let i = if layout == Layout::ExrCube {
            libm::floor((t + 1.0) * 0.5 * (n - 1) as f64 + 0.5)
        } else {
            libm::floor((t + 1.0) * 0.5 * n as f64)
        };
        i.clamp(0.0, (n - 1) as f64) as usize
    };
    pixel_of(layout, width, face, index(u), index(v))
}

/// The pixel whose texel holds the direction.
pub(crate) fn nearest(layout: Layout, width: usize, d: DVec3) -> usize {
    nearest_on_face(layout, width, face_of(layout, d))
}

/// The four pixels around a direction with their bilinear weights, across the edges of the cube too.
pub(crate) fn taps(layout: Layout, width: usize, d: DVec3) -> [(usize, f32); 4] {
    let n = side(layout, width);
    let (face, u, v) = face_of(layout, d);
    let place = |t: f64| {
        if layout == Layout::ExrCube { (t + 1.0) * 0.5 * (n - 1) as f64 } else { (t + 1.0) * 0.5 * n as f64 - 0.5 }
    };
    let (x, y) = (place(u), place(v));
    let (x0, y0) = (libm::floor(x), libm::floor(y));
    let (fx, fy) = ((x - x0) as f32, (y - y0) as f32);
    let at = |dx: i64, dy: i64| {
        let (i, j) = (x0 as i64 + dx, y0 as i64 + dy);
        let inside = 0..n as i64;
        if inside.contains(&i) && inside.contains(&j) {
            return pixel_of(layout, width, face, i as usize, j as usize);
        }
        // The neighbour stands on another face: ask the cube which texel lies that way.
        let over = cube_point(layout, face, position(layout, n, i), position(layout, n, j));
        nearest(layout, width, over)
    };
    [(at(0, 0), (1.0 - fx) * (1.0 - fy)), (at(1, 0), fx * (1.0 - fy)), (at(0, 1), (1.0 - fx) * fy), (at(1, 1), fx * fy)]
}
