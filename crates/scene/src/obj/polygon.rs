//! Polygons cut into triangles.

use glam::{DVec2, DVec3, Vec3};

/// Most corners of a polygon that are cut by ears, whose cost grows with the square; larger ones become fans.
const MAX_EARS: usize = 1024;

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
    if face.len() <= 3 || face.len() > MAX_EARS || is_convex(&points) {
        return fan(triangles, face);
    }
    let mut left: Vec<usize> = (0..face.len()).collect();
    while left.len() > 3 {
        let n = left.len();
        let ear = (0..n).find(|&i| is_ear(&points, &left, i));
        // Self-crossing outlines may have none; a fan of the rest keeps their corners at least.
        let Some(i) = ear else { break };
        triangles.push([left[(i + n - 1) % n], left[i], left[(i + 1) % n]].map(|k| face[k]));
        left.remove(i);
    }
    let rest: Vec<u32> = left.iter().map(|&k| face[k]).collect();
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

/// Twice the signed area of a triangle.
fn area(a: DVec2, b: DVec2, c: DVec2) -> f64 {
    (b - a).perp_dot(c - a)
}

fn is_convex(points: &[DVec2]) -> bool {
    let n = points.len();
    (0..n).all(|i| area(points[i], points[(i + 1) % n], points[(i + 2) % n]) >= 0.0)
}

/// Whether corner `i` of what is left is convex and its triangle holds no other corner.
fn is_ear(points: &[DVec2], left: &[usize], i: usize) -> bool {
    let n = left.len();
    let [before, at, after] = [left[(i + n - 1) % n], left[i], left[(i + 1) % n]];
    let (a, b, c) = (points[before], points[at], points[after]);
    let inside = |p: DVec2| area(a, b, p) >= 0.0 && area(b, c, p) >= 0.0 && area(c, a, p) >= 0.0;
    area(a, b, c) > 0.0
        && left.iter().filter(|&&k| k != before && k != at && k != after).all(|&k| {
            let p = points[k];
            // Corners that touch the ear's own, as where a hole is joined by a slit, do not count.
            p == a || p == b || p == c || !inside(p)
        })
}
