//! Rays that start on a surface: no self-hit and no leak, whatever the scale and the place.

mod shapes;

use glam::{DVec3, Vec3};
use raytrace::{Ray, Tracer, offset_origin_on};
use shapes::{Random, ball};

const SOLID: &dyn Fn(u32, f32, f32) -> bool = &|_, _, _| true;

/// Least cosine between a ray and the surface it leaves: flatter ones may see a neighbour that rounding lifted.
const LEAST_COSINE: f32 = 0.02;

/// Scale of the ball and its distance from the world's origin.
const CASES: [(f32, f32); 9] =
    [(1e-4, 0.0), (1e-2, 0.0), (1.0, 0.0), (1.0, 100.0), (1e3, 0.0), (1e3, 1e5), (1e6, 0.0), (1e6, 1e7), (2e4, 1e7)];

/// Moves a point of a triangle off it along a normal.
type Offset = fn([Vec3; 3], Vec3, Vec3) -> Vec3;

/// A ball at a scale and a place.
fn placed(levels: u32, scale: f32, distance: f32) -> (Vec<Vec3>, Vec<[u32; 3]>) {
    let (mut positions, triangles) = ball(levels, 0.0);
    positions.iter_mut().for_each(|p| *p = *p * scale + Vec3::new(1.0, -0.7, 0.4) * distance);
    (positions, triangles)
}

/// Rays from random points of the surface: how many hit something outside, and how many miss everything inside.
fn faults(scale: f32, distance: f32, offset: Offset) -> (usize, usize) {
    let (positions, triangles) = placed(3, scale, distance);
    let tracer = Tracer::build(&positions, &triangles, &[]);
    let mut random = Random::new(21);
    let (mut self_hits, mut leaks) = (0, 0);
    for _ in 0..20_000 {
        let triangle = triangles[random.next() as usize % triangles.len()];
        let corners = triangle.map(|i| positions[i as usize]);
        let (point, normal) = point_on(corners, &mut random);
        let from = |n: Vec3| offset(corners, point, n);
        let d = random.direction();
        let d = if d.dot(normal) < 0.0 { -d } else { d };
        if d.dot(normal) < LEAST_COSINE {
            continue;
        }
        self_hits += usize::from(tracer.occluded(&Ray::new(from(normal), d), SOLID));
        leaks += usize::from(!tracer.occluded(&Ray::new(from(-normal), -d), SOLID));
    }
    (self_hits, leaks)
}

/// A point of a triangle as a renderer computes it, and the unit normal on the outside.
fn point_on(corners: [Vec3; 3], random: &mut Random) -> (Vec3, Vec3) {
    let (mut u, mut v) = (random.unit(), random.unit());
    if u + v > 1.0 {
        (u, v) = (1.0 - u, 1.0 - v);
    }
    let [a, b, c] = corners;
    let wide: [DVec3; 3] = corners.map(|p| p.as_dvec3());
    let normal = (wide[1] - wide[0]).cross(wide[2] - wide[0]).normalize().as_vec3();
    (a * (1.0 - u - v) + b * u + c * v, normal)
}

#[test]
fn offsets_neither_hit_their_own_surface_nor_leak() {
    for (scale, distance) in CASES {
        let found = faults(scale, distance, offset_origin_on);
        assert_eq!(found, (0, 0), "scale {scale}, {distance} from the origin");
    }
}

#[test]
fn no_offset_can_fail() {
    let (self_hits, _) = faults(1.0, 100.0, |_, point, _| point);
    assert!(self_hits > 0, "rays from computed points meet their own triangle");
}

#[test]
fn an_offset_of_one_size_can_fail() {
    let fixed: Offset = |_, point, normal| point + normal * 1.0e-3;
    let (self_hits, _) = faults(1.0e6, 0.0, fixed);
    assert!(self_hits > 0, "too small for large scenes");
    let (_, leaks) = faults(1.0e-4, 0.0, fixed);
    assert!(leaks > 0, "too large for small scenes");
}
