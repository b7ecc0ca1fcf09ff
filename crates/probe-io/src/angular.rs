//! Debevec's angular map: a disc whose radius is the angle from forward.
//!
//! With u right and v up in [-1, 1] over the picture and `r = hypot(u, v)`, the angle from forward is `pi r`:
//! the centre looks along +z, the rim straight back, and the corners outside the disc hold no light.

use crate::gauss::gauss5;
use crate::patch::{Patch, Rect};
use glam::DVec3;
use std::f64::consts::PI;

/// Disc coordinates (u right, v up) of a picture position in pixels.
fn disc(side: usize, x: f64, y: f64) -> (f64, f64) {
    let n = side as f64;
    (2.0 * x / n - 1.0, 1.0 - 2.0 * y / n)
}

/// Whether the centre of a pixel lies on the disc.
pub(crate) fn is_inside(side: usize, x: usize, y: usize) -> bool {
    let (u, v) = disc(side, x as f64 + 0.5, y as f64 + 0.5);
    u * u + v * v <= 1.0
}

/// Whether any of a pixel lies on the disc: its corner nearest to the centre does.
pub(crate) fn touches(side: usize, x: usize, y: usize) -> bool {
    let near = |k: usize| {
        let (low, high) = (2 * k, 2 * k + 2);
        if low <= side && side <= high {
            return 0;
        }
        low.abs_diff(side).min(high.abs_diff(side))
    };
    near(x).pow(2) + near(y).pow(2) < side * side
}

/// The direction at disc coordinates; beyond the rim it stays straight back.
fn direction(u: f64, v: f64) -> DVec3 {
    let r = libm::sqrt(u * u + v * v);
    if r == 0.0 {
        return DVec3::Z;
    }
    let (sin, cos) = libm::sincos(PI * r.min(1.0));
    // Right is -x: +x lies to the left of +z.
    DVec3::new(-u / r * sin, v / r * sin, cos)
}

/// The picture position of a direction in pixels; straight back is a point of the rim.
fn locate(side: usize, d: DVec3) -> (f64, f64) {
    let flat = libm::sqrt(d.x * d.x + d.y * d.y);
    let r = libm::atan2(flat, d.z) / PI;
    let (u, v) = if flat > 0.0 { (-d.x / flat * r, d.y / flat * r) } else { (r, 0.0) };
    let n = side as f64;
    ((u + 1.0) * 0.5 * n, (1.0 - v) * 0.5 * n)
}

/// `sin(pi r) pi / r`, the solid angle per area of the disc.
fn density(u: f64, v: f64) -> f64 {
    let r = libm::sqrt(u * u + v * v);
    if r < 1e-9 {
        return PI * PI;
    }
    libm::sin(PI * r) * PI / r
}

/// Integral of [`density`] over the part of `[u0,u1] x [v0,v1]` on the disc; each line is cut at the rim.
fn integrate(u: (f64, f64), v: (f64, f64), rule: &[(f64, f64); 5]) -> f64 {
    let mut sum = 0.0;
    for &(b, line_weight) in rule {
        let y = 0.5 * (v.0 + v.1) + 0.5 * (v.1 - v.0) * b;
        let reach = libm::sqrt((1.0 - y * y).max(0.0));
        let (x0, x1) = (u.0.max(-reach), u.1.min(reach));
        if x0 >= x1 {
            continue;
        }
        let line: f64 = rule.iter().map(|&(a, w)| w * density(0.5 * (x0 + x1) + 0.5 * (x1 - x0) * a, y)).sum();
        sum += line_weight * line * 0.5 * (x1 - x0);
    }
    sum * 0.5 * (v.1 - v.0)
}

/// Widest step of the quadrature inside the disc, and across its rim, where a line may end within the cell.
const STEP_INSIDE: f64 = 0.25;
const STEP_RIM: f64 = 1.0 / 128.0;

/// Solid angle of a rectangle of the disc's square, by quadrature on pieces small enough for about ten digits.
fn solid_angle(u: (f64, f64), v: (f64, f64), rule: &[(f64, f64); 5]) -> f64 {
    let far = |a: (f64, f64)| a.0.abs().max(a.1.abs());
    let near = |a: (f64, f64)| {
        if a.0 * a.1 <= 0.0 { 0.0 } else { a.0.abs().min(a.1.abs()) }
    };
    let square = |a: f64, b: f64| a * a + b * b;
    if square(near(u), near(v)) >= 1.0 {
        return 0.0;
    }
    let crosses = square(far(u), far(v)) > 1.0;
    let widest = if crosses { STEP_RIM } else { STEP_INSIDE };
    if (u.1 - u.0).max(v.1 - v.0) <= widest {
        return integrate(u, v, rule);
    }
    let (mu, mv) = (0.5 * (u.0 + u.1), 0.5 * (v.0 + v.1));
    solid_angle((u.0, mu), (v.0, mv), rule)
        + solid_angle((mu, u.1), (v.0, mv), rule)
        + solid_angle((u.0, mu), (mv, v.1), rule)
        + solid_angle((mu, u.1), (mv, v.1), rule)
}

/// A rectangle of the picture on the sphere, or `None` where it lies outside the disc.
pub(crate) fn patch(side: usize, rect: &Rect) -> Option<Patch> {
    let (u0, v1) = disc(side, rect.x0, rect.y0);
    let (u1, v0) = disc(side, rect.x1, rect.y1);
    let solid_angle = solid_angle((u0, u1), (v0, v1), &gauss5());
    (solid_angle > 0.0).then(|| Patch { direction: direction(0.5 * (u0 + u1), 0.5 * (v0 + v1)), solid_angle })
}

/// The pixel of the disc nearest to a picture position: positions beyond the last whole pixel move inwards.
fn inward(side: usize, x: f64, y: f64) -> usize {
    let n = side as f64;
    let (mut dx, mut dy) = (x - 0.5 * n, y - 0.5 * n);
    loop {
        let clamp = |t: f64| libm::floor(t + 0.5 * n).clamp(0.0, n - 1.0) as usize;
        let (px, py) = (clamp(dx), clamp(dy));
        let reach = dx.abs().max(dy.abs());
        if is_inside(side, px, py) || reach < 1.0 {
            return py * side + px;
        }
        // Half a pixel towards the centre: one or two steps reach a pixel of the disc.
        let shrink = (reach - 0.5) / reach;
        dx *= shrink;
        dy *= shrink;
    }
}

/// The pixel whose colour stands for a pixel: itself on the disc, else the next one towards the centre.
pub(crate) fn stand_in(side: usize, x: usize, y: usize) -> usize {
    inward(side, x as f64 + 0.5, y as f64 + 0.5)
}

/// The pixel whose texel holds the direction.
pub(crate) fn nearest(side: usize, d: DVec3) -> usize {
    let (x, y) = locate(side, d);
    inward(side, x, y)
}

/// The four pixels around a direction with their bilinear weights; those beyond the rim move inwards.
pub(crate) fn taps(side: usize, d: DVec3) -> [(usize, f32); 4] {
    let (x, y) = locate(side, d);
    let (x0, y0) = (libm::floor(x - 0.5), libm::floor(y - 0.5));
    let (fx, fy) = ((x - 0.5 - x0) as f32, (y - 0.5 - y0) as f32);
    let at = |dx: f64, dy: f64| inward(side, x0 + dx + 0.5, y0 + dy + 0.5);
    [
        (at(0.0, 0.0), (1.0 - fx) * (1.0 - fy)),
        (at(1.0, 0.0), fx * (1.0 - fy)),
        (at(0.0, 1.0), (1.0 - fx) * fy),
        (at(1.0, 1.0), fx * fy),
    ]
}
