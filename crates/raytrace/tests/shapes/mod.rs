//! Shapes and rays for the tests, and the loop over all triangles that they are compared with.

#![allow(dead_code, reason = "each test file uses its own part of this module")]

use glam::{DVec3, Vec3};
use raytrace::Ray;

/// A small generator with a fixed seed.
pub(crate) struct Random(u64);

impl Random {
    pub(crate) fn new(seed: u64) -> Random {
        Random(seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) ^ 0x1234_5678_9abc_def1)
    }

    pub(crate) fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// In [0, 1).
    pub(crate) fn unit(&mut self) -> f32 {
        (self.next() >> 40) as f32 / 16_777_216.0
    }

    /// In the cube from -1 to 1.
    pub(crate) fn point(&mut self) -> Vec3 {
        Vec3::new(self.unit(), self.unit(), self.unit()) * 2.0 - 1.0
    }

    /// Uniform on the sphere.
    pub(crate) fn direction(&mut self) -> Vec3 {
        loop {
            let p = self.point();
            if (0.01..=1.0).contains(&p.length_squared()) {
                return p.normalize();
            }
        }
    }
}

/// Triangles of a given size scattered in the cube from -1 to 1.
pub(crate) fn soup(n: usize, size: f32, seed: u64) -> (Vec<Vec3>, Vec<[u32; 3]>) {
    let mut random = Random::new(seed);
    let mut positions = Vec::new();
    for _ in 0..n {
        let centre = random.point();
        positions.extend((0..3).map(|_| centre + random.point() * size));
    }
    let triangles = (0..n as u32).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
    (positions, triangles)
}

/// The nearest hit by the textbook formula in double precision, over all triangles: number and t.
pub(crate) fn brute_closest(positions: &[Vec3], triangles: &[[u32; 3]], ray: &Ray) -> Option<(u32, f64)> {
    let mut best: Option<(u32, f64)> = None;
    for (number, corners) in triangles.iter().enumerate() {
        let [a, b, c] = corners.map(|i| positions[i as usize].as_dvec3());
        if let Some(t) = textbook(ray.origin.as_dvec3(), ray.direction.as_dvec3(), [a, b, c])
            && best.is_none_or(|(_, t_best)| t < t_best)
        {
            best = Some((number as u32, t));
        }
    }
    best
}

/// Solves origin + t d = a + u (b - a) + v (c - a) by Cramer's rule.
fn textbook(origin: DVec3, d: DVec3, [a, b, c]: [DVec3; 3]) -> Option<f64> {
    let (e1, e2, s) = (b - a, c - a, origin - a);
    let det = d.cross(e2).dot(e1);
    if det == 0.0 {
        return None;
    }
    let u = d.cross(e2).dot(s) / det;
    let v = s.cross(e1).dot(d) / det;
    let t = s.cross(e1).dot(e2) / det;
    (u >= 0.0 && v >= 0.0 && u + v <= 1.0 && t > 0.0).then_some(t)
}

/// Cosine-distributed directions around a normal, neighbours in the list near each other on the sphere.
pub(crate) fn hemisphere(normal: Vec3, n: usize) -> Vec<Vec3> {
    let (x, y) = normal.any_orthonormal_pair();
    let side = (n as f32).sqrt().ceil() as usize;
    let cell = |i: usize| {
        let (row, column) = (i / side, i % side);
        let column = if row % 2 == 0 { column } else { side - 1 - column };
        let radius = ((row as f32 + 0.5) / side as f32).sqrt();
        let (sin, cos) = ((column as f32 + 0.5) / side as f32 * std::f32::consts::TAU).sin_cos();
        (x * cos + y * sin) * radius + normal * (1.0 - radius * radius).sqrt()
    };
    (0..n).map(|i| cell(i).normalize()).collect()
}

/// A closed mesh around the origin with shared vertices: an octahedron divided `levels` times, its radius between
/// 1 - bump and 1 + bump at random.
pub(crate) fn ball(levels: u32, bump: f32) -> (Vec<Vec3>, Vec<[u32; 3]>) {
    let mut positions = vec![Vec3::X, Vec3::NEG_X, Vec3::Y, Vec3::NEG_Y, Vec3::Z, Vec3::NEG_Z];
    let mut triangles: Vec<[u32; 3]> =
        vec![[0, 2, 4], [2, 1, 4], [1, 3, 4], [3, 0, 4], [2, 0, 5], [1, 2, 5], [3, 1, 5], [0, 3, 5]];
    for _ in 0..levels {
        let mut middles = std::collections::BTreeMap::new();
        let mut middle = |a: u32, b: u32, positions: &mut Vec<Vec3>| {
            *middles.entry((a.min(b), a.max(b))).or_insert_with(|| {
                positions.push((positions[a as usize] + positions[b as usize]).normalize());
                positions.len() as u32 - 1
            })
        };
        let mut finer = Vec::new();
        for [a, b, c] in triangles {
            let (ab, bc, ca) =
                (middle(a, b, &mut positions), middle(b, c, &mut positions), middle(c, a, &mut positions));
            finer.extend([[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]);
        }
        triangles = finer;
    }
    let mut random = Random::new(77);
    positions.iter_mut().for_each(|p| *p *= 1.0 + bump * (2.0 * random.unit() - 1.0));
    (positions, triangles)
}
