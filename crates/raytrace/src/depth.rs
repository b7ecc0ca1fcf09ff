//! How far off the planes of a block's triangles lie from one origin, within bounds that hold for the exact answer.
//!
//! A ray along `d` meets the plane of (a, b, c), corners from the origin, at t = V / (d · n) with n = (b - a) × (c - a)
//! and V = a · n. Both are had in single precision with bounds on their rounding, so that t lies in a known range. Only
//! where the ranges of two triangles overlap does the exact meeting have to decide which is the nearer.

use crate::block::{Point, SLACK, UNDERFLOW, corners, cross, dot, size, sub};
use crate::lanes::Lanes;
use crate::tree::{BLOCK, Block};
use glam::Vec3;

/// Bound on the rounding of the exact meeting, which counts in double precision, over the cube of the largest
/// coordinate: 18 products, each off by 5 x 2^-53 of itself, move the point by up to 3.5 times the largest
/// coordinate; all doubled (2^-42).
const MEETING: f32 = 2.273_736_8e-13;

/// Roundings of a quotient (two units of 2^-24), doubled.
const QUOTIENT: f32 = 2.0 * f32::EPSILON;

/// The planes of four triangles.
#[repr(C, align(32))]
#[derive(Clone, Copy, Debug)]
pub(crate) struct Depths {
    /// x, y, z of n, turned so that its product with directions that meet the triangle is positive.
    normals: [[f32; BLOCK]; 3],
    /// Bound on the rounding of such a product, for directions of components up to 1.
    slack: [f32; BLOCK],
    /// Least and greatest V.
    volume: [[f32; BLOCK]; 2],
}

/// The plane of one triangle, or of several side by side.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Depth<L> {
    normal: Point<L>,
    slack: L,
    volume: [L; 2],
}

impl Depths {
    pub(crate) const NOTHING: Depths =
        Depths { normals: [[0.0; BLOCK]; 3], slack: [0.0; BLOCK], volume: [[0.0; BLOCK]; 2] };

    /// The planes of a block from a point.
    #[inline(always)]
    pub(crate) fn of<F: Lanes>(block: &Block, origin: Vec3) -> Depths {
        let [a, b, c] = corners::<F>(block, origin);
        let (ab, ac) = (sub(b, a), sub(c, a));
        let normal = cross(ab, ac);
        let slack = size(ab).mul(size(ac)).mul(F::splat(SLACK)).add(F::splat(UNDERFLOW));
        let volume = dot(a, normal);
        let largest = size(a).max(size(b)).max(size(c));
        let meeting = largest.mul(largest).mul(largest).mul(F::splat(MEETING));
        let rounding = size(a).mul(slack).add(meeting).add(F::splat(UNDERFLOW));
        let (zero, one) = (F::splat(0.0), F::splat(1.0));
        let turn = F::where_less(volume, zero, F::splat(-1.0), one);
        let amount = volume.abs();
        // Where the side is in doubt so is the distance: a normal of 0 and a slack of 1 make the range endless.
        let known = |yes: F, no: F| F::where_less(rounding, amount, yes, no);
        let mut depths = Depths::NOTHING;
        for (axis, component) in normal.into_iter().enumerate() {
            known(component.mul(turn), zero).store(&mut depths.normals[axis]);
        }
        known(slack, one).store(&mut depths.slack);
        known(amount.sub(rounding), zero).store(&mut depths.volume[0]);
        amount.add(rounding).store(&mut depths.volume[1]);
        depths
    }

    /// One triangle, for many directions.
    #[inline(always)]
    pub(crate) fn one<R: Lanes>(&self, lane: usize) -> Depth<R> {
        Depth {
            normal: self.normals.map(|row| R::splat(row[lane])),
            slack: R::splat(self.slack[lane]),
            volume: self.volume.map(|row| R::splat(row[lane])),
        }
    }

    /// All four, for one direction.
    #[inline(always)]
    pub(crate) fn all<F: Lanes>(&self) -> Depth<F> {
        Depth {
            normal: self.normals.map(|row| F::load(&row)),
            slack: F::load(&self.slack),
            volume: self.volume.map(|row| F::load(&row)),
        }
    }
}

impl<L: Lanes> Depth<L> {
    /// Between which parameters a direction that meets the triangle meets it.
    #[inline(always)]
    pub(crate) fn range(&self, direction: Point<L>) -> (L, L) {
        let product = dot(direction, self.normal);
        let (least, most) = (product.sub(self.slack), product.add(self.slack));
        let near = self.volume[0].div(most).mul(L::splat(1.0 - QUOTIENT));
        let far = self.volume[1].div(least).mul(L::splat(1.0 + QUOTIENT));
        (near, L::where_less(L::splat(0.0), least, far, L::splat(f32::INFINITY)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lanes::{Lanes, Row};
    use crate::ray::{Line, Ray, meet};

    /// A block of four triangles from random corners, and how often the exact parameter leaves a range that was
    /// narrowed by `share` of itself on both sides; with how many rays met.
    fn escapes(share: f32, flat: f32, far: f32) -> (usize, usize) {
        let mut state = 5u64;
        let mut unit = || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (state >> 40) as f32 / 8_388_608.0 - 1.0
        };
        let (mut out, mut met) = (0, 0);
        for _ in 0..4_000 {
            let centre = Vec3::new(unit(), unit(), unit()) * far;
            let corners: [[Vec3; 3]; BLOCK] =
                std::array::from_fn(|_| std::array::from_fn(|_| centre + Vec3::new(unit(), unit(), unit() * flat)));
            let mut block = Block { corners: [[0.0; BLOCK]; 9], triangles: [0; BLOCK], valid: 15, masked: 0 };
            for (lane, corners) in corners.iter().enumerate() {
                for (k, corner) in corners.iter().enumerate() {
                    (0..3).for_each(|axis| block.corners[3 * k + axis][lane] = corner[axis]);
                }
            }
            let origin = Vec3::new(unit(), unit(), unit() * flat.sqrt());
            let depths = Depths::of::<Row<4>>(&block, origin);
            for (lane, [a, b, c]) in corners.into_iter().enumerate() {
                let target = a + (b - a) * (0.3 + 0.3 * unit()) + (c - a) * (0.2 + 0.2 * unit());
                let direction = (target - origin).normalize();
                let Some(hit) = Line::new(&Ray::new(origin, direction)).and_then(|line| meet(&line, [a, b, c])) else {
                    continue;
                };
                met += 1;
                let (near, far) = depths.all::<Row<4>>().range(direction.to_array().map(Row::splat));
                let (mut nears, mut fars) = ([0.0; BLOCK], [0.0; BLOCK]);
                near.store(&mut nears);
                far.store(&mut fars);
                let margin = share * (fars[lane] - nears[lane]).min(f32::MAX);
                out += usize::from(!(nears[lane] + margin <= hit.t && hit.t <= fars[lane] - margin));
            }
        }
        (out, met)
    }

    #[test]
    fn ranges_hold_the_exact_parameter() {
        for flat in [1.0, 1.0e-2, 1.0e-5, 0.0] {
            for far in [0.0, 1.0, 30.0, 1.0e3, 1.0e5] {
                let (out, met) = escapes(0.0, flat, far);
                assert_eq!(out, 0, "of {met} with flatness {flat} at {far}");
            }
        }
    }

    #[test]
    fn ranges_can_fail() {
        let (out, met) = escapes(0.499, 1.0, 1.0e3);
        assert!(out > met / 4, "a range of a five-hundredth of itself is left: {out} of {met}");
    }
}
