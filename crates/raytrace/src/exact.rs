//! The sign of a triple product, exactly: the only judge of what a ray hits.
//!
//! A ray from the origin along `d` meets the triangle (a, b, c) when `d` lies in the cone that the three corners span,
//! that is when the volumes (d, b, c), (d, c, a) and (d, a, b) have the sign of (a, b, c) or are zero. Each is the
//! determinant of three vectors of single precision, so its sign can be decided without error: in double precision
//! nearly always, in an expansion of doubles where that is too close. Two triangles on an edge ask for the same
//! volume of opposite sign, so that nothing slips between them, nor between the triangles around a vertex.

use glam::Vec3;

/// Bound on the relative error of the determinant in double precision: five roundings at most, doubled for safety.
const ROUNDING: f64 = 10.0 * f64::EPSILON;

/// Three numbers in double precision.
pub(crate) type Wide = [f64; 3];

/// The volume in double precision, and the sum of its products by amount.
#[inline(always)]
pub(crate) fn quick_volume([ax, ay, az]: Wide, [bx, by, bz]: Wide, [cx, cy, cz]: Wide) -> (f64, f64) {
    // Products of two singles fit a double without rounding.
    let (yz, zy) = (by * cz, bz * cy);
    let (zx, xz) = (bz * cx, bx * cz);
    let (xy, yx) = (bx * cy, by * cx);
    let value = ax * (yz - zy) + ay * (zx - xz) + az * (xy - yx);
    let size = ax.abs() * (yz.abs() + zy.abs()) + ay.abs() * (zx.abs() + xz.abs()) + az.abs() * (xy.abs() + yx.abs());
    (value, size)
}

/// Whether the sign of a quick volume is beyond doubt.
#[inline(always)]
pub(crate) fn is_certain((value, size): (f64, f64)) -> bool {
    value.abs() > ROUNDING * size
}

/// Volume of the parallelepiped on three vectors: the sign is exact, the value good to double precision at least
/// relative to its largest product.
pub(crate) fn volume(a: Vec3, b: Vec3, c: Vec3) -> f64 {
    let wide = |v: Vec3| [f64::from(v.x), f64::from(v.y), f64::from(v.z)];
    let (a, b, c) = (wide(a), wide(b), wide(c));
    let quick = quick_volume(a, b, c);
    if is_certain(quick) {
        return quick.0;
    }
    if quick.1 == 0.0 {
        // Flat in an axis plane through the origin, as walls and floors often are.
        return 0.0;
    }
    close_volume(a, b, c)
}

/// The volume where double precision leaves its sign in doubt.
#[cold]
fn close_volume([ax, ay, az]: Wide, [bx, by, bz]: Wide, [cx, cy, cz]: Wide) -> f64 {
    let terms = [(ax, by * cz), (-ax, bz * cy), (ay, bz * cx), (-ay, bx * cz), (az, bx * cy), (-az, by * cx)];
    expansion_sum(terms)
}

/// Sum of six products of a single and a double of at most 48 bits, with the exact sign.
fn expansion_sum(products: [(f64, f64); 6]) -> f64 {
    let mut expansion = [0.0f64; 12];
    let mut length = 0;
    for (single, double) in products {
        let high = f64::from_bits(double.to_bits() & !((1 << 27) - 1));
        let low = double - high;
        // 24 bits times at most 27: both products are exact.
        for term in [single * high, single * low] {
            let mut carry = term;
            for part in &mut expansion[..length] {
                (carry, *part) = two_sum(carry, *part);
            }
            expansion[length] = carry;
            length += 1;
        }
    }
    // The parts do not overlap and grow, so the last one that is not zero carries the sign of the sum.
    expansion.iter().sum()
}

/// Sum of two doubles and its rounding error (Knuth).
fn two_sum(a: f64, b: f64) -> (f64, f64) {
    let sum = a + b;
    let b_part = sum - a;
    let a_part = sum - b_part;
    (sum, (a - a_part) + (b - b_part))
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::vec3;

    #[test]
    fn planes_through_the_origin_have_no_volume() {
        // c = 3a + 5b exactly, with wild mantissas.
        let a = vec3(1.000_000_1, 2.5e-3, -7.25);
        let b = vec3(-3.0e-3, 1.5, 0.125_000_01);
        let c = a + b;
        let wide = |v: Vec3| v.as_dvec3();
        if wide(c) == wide(a) + wide(b) {
            assert_eq!(volume(a, b, c), 0.0, "coplanar");
        }
        assert_eq!(volume(a, a, b), 0.0, "two equal");
        assert_eq!(volume(a, b, b), 0.0, "two equal");
    }

    #[test]
    fn sign_agrees_with_integers() {
        let mut state = 7u64;
        let mut next = |range: i64| {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
            ((state >> 33) as i64).rem_euclid(2 * range + 1) - range
        };
        for _ in 0..20_000 {
            // Nearly coplanar: the third is the sum of the first two, one unit off.
            let a: [i64; 3] = std::array::from_fn(|_| next(1 << 22));
            let b: [i64; 3] = std::array::from_fn(|_| next(1 << 22));
            let c: [i64; 3] = std::array::from_fn(|i| a[i] + b[i] + next(1));
            let cross = |i: usize, j: usize| i128::from(b[i] * c[j] - b[j] * c[i]);
            let exact =
                i128::from(a[0]) * cross(1, 2) + i128::from(a[1]) * cross(2, 0) + i128::from(a[2]) * cross(0, 1);
            let single = |v: [i64; 3]| Vec3::from_array(v.map(|x| x as f32));
            let found = volume(single(a), single(b), single(c));
            assert_eq!(found.partial_cmp(&0.0), exact.partial_cmp(&0), "{a:?} {b:?} {c:?}");
        }
    }

    #[test]
    fn single_precision_sign_can_fail() {
        let a = vec3(1.0, 1.0, 1.0);
        let b = vec3(1.0, 1.000_000_1, 1.000_000_2);
        let c = vec3(1.000_000_1, 1.000_000_4, 1.000_000_1);
        let exact = volume(a, b, c);
        let single = a.dot(b.cross(c));
        assert!(exact != 0.0, "a true volume");
        assert!((f64::from(single) - exact).abs() > 0.1 * exact.abs(), "single precision loses it: {single} {exact}");
    }
}
