//! Rays as callers give them, hits as they get them, and the form of a ray that the kernels share.

use crate::exact::volume;
use glam::{DVec3, Vec3};

/// A ray: the points origin + t direction with t_min < t < t_max.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ray {
    /// Where it starts, in world units.
    pub origin: Vec3,
    /// Where it goes; any length, t counts in its length.
    pub direction: Vec3,
    /// Hits at or before this parameter do not count; 0 (or less) counts everything ahead of the origin.
    pub t_min: f32,
    /// Hits at or beyond this parameter do not count; infinity for an endless ray.
    pub t_max: f32,
}

impl Ray {
    /// The endless ray from a point.
    pub fn new(origin: Vec3, direction: Vec3) -> Ray {
        Ray { origin, direction, t_min: 0.0, t_max: f32::INFINITY }
    }
}

/// Where a ray meets a triangle: the point (1-u-v) a + u b + v c.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hit {
    /// Index into the triangles the tracer was built from.
    pub triangle: u32,
    /// Ray parameter, in lengths of the direction.
    pub t: f32,
    /// Barycentric weight of the second corner.
    pub u: f32,
    /// Barycentric weight of the third corner.
    pub v: f32,
    /// Whether the ray came from the side where the corners turn counter-clockwise.
    pub front: bool,
}

/// Coordinates beyond this (2^38) are not traced, so that no product of three overflows single precision.
pub(crate) const LARGEST: f32 = 274_877_906_944.0;

/// Components of a direction below this part of the largest (2^-60) are taken as zero, so that reciprocals stay finite.
const SMALLEST: f32 = 8.673_617_4e-19;

/// A ray in the form the kernels share: the direction scaled by a power of two so that its largest component lies
/// in [1/2, 1], which changes no sign and no rounding.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Line {
    pub(crate) origin: Vec3,
    pub(crate) direction: Vec3,
    /// 1/direction; infinite where a component is zero.
    pub(crate) inverse: Vec3,
    /// Given t over t along `direction`.
    pub(crate) scale: f32,
    pub(crate) t_min: f32,
    pub(crate) t_max: f32,
    /// Hits count that come after this parameter and triangle number; before all of them by default.
    pub(crate) after: (f32, u32),
}

/// Before all hits.
pub(crate) const FIRST: (f32, u32) = (f32::NEG_INFINITY, 0);

impl Line {
    /// None where the ray has no direction, an empty range or anything that is not a number.
    pub(crate) fn new(ray: &Ray) -> Option<Line> {
        let largest = ray.direction.abs().max_element();
        let far = ray.origin.abs().max_element() > 2.0 * LARGEST;
        let sane = ray.direction.is_finite() && ray.origin.is_finite() && largest > 0.0 && !far;
        let t_min = if ray.t_min > 0.0 { ray.t_min } else { 0.0 };
        let range = t_min < ray.t_max && !ray.t_min.is_nan();
        if !sane || !range {
            return None;
        }
        let (direction, scale) =
            if (0.5..=1.0).contains(&largest) { (ray.direction, 1.0) } else { rescaled(ray.direction, largest)? };
        let flush = |x: f32| if x.abs() < SMALLEST { 0.0 } else { x };
        let direction = direction.map(flush);
        Some(Line {
            origin: ray.origin,
            direction,
            inverse: direction.recip(),
            scale,
            t_min,
            t_max: ray.t_max,
            after: FIRST,
        })
    }

    /// One bit per axis: set where the direction is negative.
    pub(crate) fn octant(&self) -> usize {
        let negative = |x: f32| usize::from(x.is_sign_negative());
        negative(self.inverse.x) | negative(self.inverse.y) << 1 | negative(self.inverse.z) << 2
    }

    /// Whether every hit ahead of the origin counts.
    pub(crate) fn endless(&self) -> bool {
        self.t_min == 0.0 && self.t_max == f32::INFINITY
    }
}

/// The direction times the power of two that brings its largest component into [1/2, 1), and that power.
fn rescaled(direction: Vec3, largest: f32) -> Option<(Vec3, f32)> {
    let exponent = ((largest.to_bits() >> 23) & 0xff) as i32 - 126;
    // Subnormal lengths and those whose reciprocal would be subnormal are no directions.
    if !(-120..=120).contains(&exponent) {
        return None;
    }
    let scale = f32::from_bits(((127 - exponent) as u32) << 23);
    Some((direction * scale, scale))
}

/// Meets one triangle, exactly in sign (see `exact`); `corners` in world space.
pub(crate) fn meet(line: &Line, corners: [Vec3; 3]) -> Option<Hit> {
    // The vertices as every kernel sees them: translated to the origin, rounded once.
    let [a, b, c] = corners.map(|corner| corner - line.origin);
    let d = line.direction;
    let whole = volume(a, b, c);
    if whole == 0.0 {
        return None;
    }
    let weights = [volume(d, b, c), volume(d, c, a), volume(d, a, b)];
    let inside = |w: f64| if whole > 0.0 { w >= 0.0 } else { w <= 0.0 };
    if !weights.into_iter().all(inside) {
        return None;
    }
    let sum = weights[0] + weights[1] + weights[2];
    let [wa, wb, wc] = weights.map(|w| w / sum);
    // A convex combination of the corners: no cancellation however flat the triangle lies to the ray.
    let point = wa * a.as_dvec3() + wb * b.as_dvec3() + wc * c.as_dvec3();
    let t = along(point, d.as_dvec3()) * f64::from(line.scale);
    let t = (t as f32).max(0.0);
    let in_range = (line.t_min == 0.0 || t > line.t_min) && (line.t_max == f32::INFINITY || t < line.t_max);
    in_range.then_some(Hit { triangle: 0, t, u: wb as f32, v: wc as f32, front: sum < 0.0 })
}

/// Parameter of the point of a line through the origin that is nearest to a point.
fn along(point: DVec3, direction: DVec3) -> f64 {
    point.dot(direction) / direction.length_squared()
}
