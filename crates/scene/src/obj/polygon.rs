//! Polygons cut into triangles.

use super::ears::{Ears, area};
use glam::{DVec2, DVec3, Vec3};

/// Triangles of all faces; `arities` holds their numbers of corners and is empty where all have three.
pub(super) fn triangulate(positions: &[Vec3], indices: &[u32], arities: &[u32]) -> Vec<[u32; 3]> {
    if arities.is_empty() {
        return indices.as_chunks::<3>().0.to_vec();
    }
    let mut triangles = Vec::new();
    let mut rest = indices;
    for &arity in arities {
        let (face, after) = rest.split_at((arity as usize).min(rest.len()));
        rest = after;
        cut(positions, face, &mut triangles);
    }
    triangles
}

fn cut(positions: &[Vec3], face: &[u32], triangles: &mut Vec<[u32; 3]>) {
    let fan = |triangles: &mut Vec<[u32; 3]>, corners: &[u32]| {
        triangles.extend(corners.windows(2).skip(1).map(|w| [corners[0], w[0], w[1]]));
    };
    let points = projected(positions, face);
    if face.len() <= 3 || is_convex(&points) {
        return fan(triangles, face);
    }
    let mut ears = Ears::of(&points);
    while let Some(ear) = ears.cut() {
        triangles.push(ear.map(|k| face[k]));
    }
    // Without an ear left a fan keeps the corners at least.
    let rest: Vec<u32> = ears.rest().into_iter().map(|k| face[k]).collect();
    fan(triangles, &rest);
}

/// The corners in the polygon's mean plane (Newell's normal), counter-clockwise.
fn projected(positions: &[Vec3], face: &[u32]) -> Vec<DVec2> {
    let points: Vec<DVec3> = face.iter().map(|&i| positions[i as usize].as_dvec3()).collect();
    let Some(&origin) = points.first() else { return Vec::new() };
    let next = |k: usize| points[(k + 1) % points.len()] - origin;
    let normal: DVec3 = (0..points.len()).map(|k| (points[k] - origin).cross(next(k))).sum();
    let (s, t) = normal.try_normalize().unwrap_or(DVec3::Z).any_orthonormal_pair();
    points.iter().map(|p| DVec2::new((*p - origin).dot(s), (*p - origin).dot(t))).collect()
}

/// Whether the outline turns left at every corner and goes round once: a pentagram turns left too, and goes round twice.
fn is_convex(points: &[DVec2]) -> bool {
    let n = points.len();
    (0..n).all(|i| area(points[i], points[(i + 1) % n], points[(i + 2) % n]) >= 0.0) && rounds(points) == 1
}

/// How often an outline that turns left goes round: how often its way turns from down to up.
fn rounds(points: &[DVec2]) -> usize {
    let n = points.len();
    let ways = (0..n).map(|i| points[(i + 1) % n] - points[i]).filter(|way| *way != DVec2::ZERO);
    let up: Vec<bool> = ways.map(|way| way.y > 0.0 || way.y == 0.0 && way.x > 0.0).collect();
    (0..up.len()).filter(|&i| !up[i] && up[(i + 1) % up.len()]).count()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The same by definition: the first ear in order, looked for anew after each cut.
    fn first_ears(points: &[DVec2]) -> Vec<[usize; 3]> {
        let mut left: Vec<usize> = (0..points.len()).collect();
        let mut found = Vec::new();
        let is_ear = |left: &[usize], i: usize| {
            let n = left.len();
            let [a, b, c] = [left[(i + n - 1) % n], left[i], left[(i + 1) % n]].map(|k| points[k]);
            let holds = |p: DVec2| area(a, b, p) >= 0.0 && area(b, c, p) >= 0.0 && area(c, a, p) >= 0.0;
            let other = |p: DVec2| p != a && p != b && p != c;
            area(a, b, c) > 0.0 && !left.iter().map(|&k| points[k]).any(|p| other(p) && holds(p))
        };
        while left.len() > 3 {
            let n = left.len();
            let Some(i) = (0..n).find(|&i| is_ear(&left, i)) else { break };
            found.push([left[(i + n - 1) % n], left[i], left[(i + 1) % n]]);
            left.remove(i);
        }
        found
    }

    fn cut_ears(points: &[DVec2]) -> Vec<[usize; 3]> {
        let mut ears = Ears::of(points);
        std::iter::from_fn(|| ears.cut()).collect()
    }

    /// A wheel whose corners lie at distances that `radius` tells.
    fn wheel(n: usize, radius: impl Fn(usize) -> f64) -> Vec<DVec2> {
        (0..n).map(|k| radius(k) * DVec2::from_angle(std::f64::consts::TAU * k as f64 / n as f64)).collect()
    }

    /// Teeth of a comb, some of them ending on a common line.
    fn comb(n: usize) -> Vec<DVec2> {
        let tooth =
            |k: usize| DVec2::new(k as f64, if k.is_multiple_of(2) { 0.0 } else { 5.0 - 0.25 * (k % 7) as f64 });
        let mut points: Vec<DVec2> = (0..n).rev().map(tooth).collect();
        points.extend([DVec2::new(0.0, -1.0), DVec2::new(n as f64, -1.0)]);
        points
    }

    /// Stars of n points that are drawn in one line: convex where each corner leads to the next one.
    #[test]
    fn a_pentagram_is_not_convex() {
        for n in [3usize, 5, 7, 12, 101] {
            for step in 1..n.div_ceil(2) {
                let points: Vec<DVec2> = (0..n).map(|k| wheel(n, |_| 1.0)[k * step % n]).collect();
                assert_eq!(is_convex(&points), step == 1, "every {step}th of {n} corners");
            }
        }
        // Corners on a side, and corners that stand twice, leave an outline convex.
        let square = [[0.0, 0.0], [1.0, 0.0], [2.0, 0.0], [2.0, 0.0], [2.0, 2.0], [0.0, 2.0]].map(DVec2::from);
        assert!(is_convex(&square));
        for turns in 0..6 {
            let turned: Vec<DVec2> = square.iter().map(|p| DVec2::from_angle(f64::from(turns)).rotate(*p)).collect();
            assert_eq!(rounds(&turned), 1);
        }
    }

    /// Left turns alone do not tell: a pentagram has no others.
    #[test]
    fn a_pentagram_is_not_convex_can_fail() {
        let star: Vec<DVec2> = (0..5).map(|k| wheel(5, |_| 1.0)[k * 2 % 5]).collect();
        assert!((0..5).all(|i| area(star[i], star[(i + 1) % 5], star[(i + 2) % 5]) > 0.0));
        assert_eq!(rounds(&star), 2);
    }

    fn outlines(n: usize) -> Vec<Vec<DVec2>> {
        let uneven = |k: usize| 1.0 + ((k * 7_919) % 101) as f64 / 50.0;
        vec![
            wheel(n, |k| 1.0 + (k % 2) as f64),
            wheel(n, uneven),
            wheel(n, |k| 1.0 + 0.3 * f64::sin(0.3 * k as f64)),
            comb(n),
            // Crosses itself.
            wheel(n, |k| if k.is_multiple_of(5) { -0.7 } else { 1.0 }),
        ]
    }

    #[test]
    fn ears_are_the_first_in_order() {
        for n in [5, 12, 33, 100, 301] {
            for points in outlines(n) {
                assert_eq!(cut_ears(&points), first_ears(&points), "{n} corners");
            }
        }
    }

    #[test]
    fn ears_are_the_first_in_order_can_fail() {
        let points = comb(33);
        let turned: Vec<DVec2> = points.iter().copied().cycle().skip(1).take(points.len()).collect();
        assert_ne!(cut_ears(&turned), first_ears(&points), "the order matters");
    }

    /// Area of a concave polygon, by the shoelace formula; a fan would cover more. Looking for each ear among all corners is
    /// hopeless at this size.
    #[test]
    fn large_concave_polygons_are_covered_once() {
        for points in outlines(30_000).into_iter().take(4) {
            let positions: Vec<Vec3> = points.iter().map(|p| p.as_vec2().extend(0.0)).collect();
            let face: Vec<u32> = (0..points.len() as u32).collect();
            let size = |t: &[u32; 3]| {
                let [a, b, c] = t.map(|k| positions[k as usize].as_dvec3());
                0.5 * (b - a).cross(c - a).length()
            };
            let covered: f64 = triangulate(&positions, &face, &[face.len() as u32]).iter().map(size).sum();
            let flat: Vec<DVec2> = positions.iter().map(|p| p.as_dvec3().truncate()).collect();
            let lace: f64 = (0..flat.len()).map(|k| 0.5 * flat[k].perp_dot(flat[(k + 1) % flat.len()])).sum();
            assert!((covered / lace - 1.0).abs() < 1e-9, "{covered} covered of {lace}");
            let fan: f64 = (1..face.len() as u32 - 1).map(|k| size(&[0, k, k + 1])).sum();
            assert!(fan > 1.001 * lace, "can fail: a fan covers {fan}");
        }
    }
}
