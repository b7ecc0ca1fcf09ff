//! No ray leaves a closed mesh: anywhere, along its edges or through its vertices.

mod shapes;

use glam::Vec3;
use raytrace::{FanState, Ray, Tracer};
use shapes::{Random, ball};

const SOLID: &dyn Fn(u32, f32, f32) -> bool = &|_, _, _| true;

/// Rays per fan and fans per thread: ten million rays on two threads.
const RAYS: usize = 1_000;
const FANS: usize = 5_000;

/// A direction from an origin: anywhere, at a vertex, or at a point of an edge.
fn aimed(random: &mut Random, origin: Vec3, positions: &[Vec3], triangles: &[[u32; 3]]) -> Vec3 {
    let triangle = triangles[random.next() as usize % triangles.len()];
    let corner = |k: usize| positions[triangle[k] as usize];
    let target = match random.next() % 3 {
        0 => return random.direction(),
        1 => corner(0),
        _ => corner(0) + (corner(1) - corner(0)) * random.unit(),
    };
    (target - origin).normalize()
}

/// Rays of one thread's fans that escape, of those counted.
fn escapes(tracer: &Tracer, positions: &[Vec3], triangles: &[[u32; 3]], fans: usize, seed: u64) -> u64 {
    let mut random = Random::new(seed);
    let mut state = FanState::new();
    let (mut xs, mut ys, mut zs) = (vec![0.0; RAYS], vec![0.0; RAYS], vec![0.0; RAYS]);
    let mut bits = vec![0u64; RAYS.div_ceil(64)];
    let mut escaped = 0;
    for _ in 0..fans {
        let origin = random.direction() * 0.6 * random.unit();
        for i in 0..RAYS {
            let d = aimed(&mut random, origin, positions, triangles);
            (xs[i], ys[i], zs[i]) = (d.x, d.y, d.z);
        }
        tracer.occluded_fan(origin, &xs, &ys, &zs, SOLID, &mut state, &mut bits);
        let blocked: u32 = bits.iter().map(|word| word.count_ones()).sum();
        escaped += RAYS as u64 - u64::from(blocked);
    }
    escaped
}

#[test]
fn ten_million_rays_do_not_leave_a_closed_mesh() {
    let (positions, triangles) = ball(5, 0.2);
    let tracer = Tracer::build(&positions, &triangles, &[]);
    tracer.validate().expect("a sound tree");
    let escaped: u64 = std::thread::scope(|scope| {
        let run = |seed| {
            let (tracer, positions, triangles) = (&tracer, &positions, &triangles);
            scope.spawn(move || escapes(tracer, positions, triangles, FANS, seed))
        };
        [run(1), run(2)].map(|thread| thread.join().expect("no panic")).iter().sum()
    });
    assert_eq!(escaped, 0, "of {} rays", 2 * FANS * RAYS);
}

#[test]
fn watertightness_can_fail() {
    let (positions, mut triangles) = ball(5, 0.2);
    triangles.pop();
    let tracer = Tracer::build(&positions, &triangles, &[]);
    assert!(escapes(&tracer, &positions, &triangles, 300, 3) > 0, "one triangle of {} is open", triangles.len() + 1);
}

#[test]
fn single_rays_and_hits_do_not_leave_either() {
    let (positions, triangles) = ball(4, 0.2);
    let tracer = Tracer::build(&positions, &triangles, &[]);
    let mut random = Random::new(8);
    for _ in 0..200_000 {
        let origin = random.direction() * 0.6 * random.unit();
        let ray = Ray::new(origin, aimed(&mut random, origin, &positions, &triangles) * 3.0);
        let hit = tracer.closest(&ray, SOLID).expect("a closed mesh");
        assert!(tracer.occluded(&ray, SOLID), "{ray:?}");
        // At a vertex or an edge a triangle that faces away may be as near, and have the smaller number.
        let within = hit.u.min(hit.v).min(1.0 - hit.u - hit.v) > 1.0e-4;
        assert!(!(within && hit.front), "seen from inside: {ray:?} {hit:?}");
        let corners = triangles[hit.triangle as usize].map(|i| positions[i as usize]);
        let point = corners[0] * (1.0 - hit.u - hit.v) + corners[1] * hit.u + corners[2] * hit.v;
        let along = ray.origin + ray.direction * hit.t;
        assert!(point.distance(along) < 1.0e-6, "{ray:?} {hit:?}");
    }
}

/// The test as first published: in single precision, with 1e-5 as the least determinant.
fn published(origin: Vec3, d: Vec3, [a, b, c]: [Vec3; 3]) -> bool {
    let (e1, e2) = (b - a, c - a);
    let p = d.cross(e2);
    let det = e1.dot(p);
    if det.abs() < 1.0e-5 {
        return false;
    }
    let s = origin - a;
    let (u, v, t) = (s.dot(p) / det, d.dot(s.cross(e1)) / det, e2.dot(s.cross(e1)) / det);
    u >= 0.0 && v >= 0.0 && u + v <= 1.0 && t > 0.0
}

#[test]
fn an_absolute_least_determinant_can_fail() {
    let (mut positions, triangles) = ball(4, 0.1);
    positions.iter_mut().for_each(|p| *p *= 0.01);
    let tracer = Tracer::build(&positions, &triangles, &[]);
    let mut random = Random::new(4);
    let mut lost = 0;
    for _ in 0..200 {
        let ray = Ray::new(Vec3::ZERO, random.direction());
        let corners = |t: &[u32; 3]| t.map(|i| positions[i as usize]);
        lost += usize::from(!triangles.iter().any(|t| published(ray.origin, ray.direction, corners(t))));
        assert!(tracer.occluded(&ray, SOLID), "a small closed mesh");
    }
    assert!(lost > 100, "the published test loses small triangles: {lost} of 200 rays escape");
}
