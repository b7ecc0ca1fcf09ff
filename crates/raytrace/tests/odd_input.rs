//! Input that is empty, broken or out of range: no panic, and what is sound is still traced.

mod shapes;

use glam::{Vec3, vec3};
use raytrace::{FanState, Ray, Tracer};
use shapes::{Random, soup};

const SOLID: &dyn Fn(u32, f32, f32) -> bool = &|_, _, _| true;

#[test]
fn an_empty_scene_blocks_nothing() {
    let tracer = Tracer::build(&[], &[], &[]);
    let ray = Ray::new(Vec3::ZERO, Vec3::X);
    assert!(tracer.closest(&ray, SOLID).is_none() && !tracer.occluded(&ray, SOLID), "nothing there");
    let mut bits = [u64::MAX];
    tracer.occluded_fan(Vec3::ZERO, &[1.0], &[0.0], &[0.0], SOLID, &mut FanState::new(), &mut bits);
    assert_eq!(bits, [0], "all bits are cleared");
    assert!(!tracer.anything_above(Vec3::ZERO, Vec3::Y), "nothing there");
}

#[test]
fn broken_triangles_are_left_out() {
    let (mut positions, mut triangles) = soup(200, 0.4, 1);
    let sound = Tracer::build(&positions, &triangles, &[]);
    let n = positions.len() as u32;
    positions.extend([vec3(f32::NAN, 0.0, 0.0), vec3(0.0, f32::INFINITY, 0.0), vec3(0.0, 0.0, 1.0e30)]);
    triangles.extend([[0, 1, n], [n + 1, 2, 3], [4, n + 2, 5], [0, 0, 1], [1, 2, n + 99]]);
    let tracer = Tracer::build(&positions, &triangles, &[]);
    tracer.validate().expect("a sound tree");
    let mut random = Random::new(2);
    for _ in 0..5_000 {
        let ray = Ray::new(random.point(), random.direction());
        assert_eq!(tracer.closest(&ray, SOLID), sound.closest(&ray, SOLID), "{ray:?}");
    }
}

#[test]
fn rays_without_sense_hit_nothing() {
    let (positions, triangles) = soup(200, 1.0, 1);
    let tracer = Tracer::build(&positions, &triangles, &[]);
    let odd = [f32::NAN, f32::INFINITY, f32::NEG_INFINITY, f32::MAX, f32::MIN_POSITIVE, 0.0, -0.0, 1.0e-42];
    let mut state = FanState::new();
    for x in odd {
        for y in odd {
            let d = vec3(x, y, 0.0);
            let _ = tracer.closest(&Ray::new(Vec3::ZERO, d), SOLID);
            assert!(!tracer.occluded(&Ray::new(vec3(x, f32::NAN, y), Vec3::X), SOLID), "no place");
            let mut bits = [0];
            tracer.occluded_fan(Vec3::ZERO, &[x; 20], &[y; 20], &[0.0; 20], SOLID, &mut state, &mut bits);
            let single = tracer.occluded(&Ray::new(Vec3::ZERO, d), SOLID);
            assert_eq!(bits[0], if single { (1 << 20) - 1 } else { 0 }, "{d}");
        }
    }
    let empty = Ray { origin: Vec3::ZERO, direction: Vec3::X, t_min: 2.0, t_max: 1.0 };
    assert!(!tracer.occluded(&empty, SOLID), "an empty range");
}

#[test]
fn a_filter_may_trace_rays_itself() {
    let (positions, triangles) = soup(100, 1.0, 1);
    let inner = Tracer::build(&positions, &triangles, &[]);
    let outer = Tracer::build(&positions, &triangles, &[true; 100]);
    let ray = Ray::new(vec3(0.1, 0.2, 0.3), Vec3::X);
    let nested = outer.occluded(&ray, &|_, _, _| inner.occluded(&ray, SOLID));
    assert_eq!(nested, inner.occluded(&ray, SOLID), "the same triangles");
}

#[test]
fn nothing_above_agrees_with_a_loop() {
    let (positions, triangles) = soup(300, 0.3, 6);
    let tracer = Tracer::build(&positions, &triangles, &[]);
    let mut random = Random::new(12);
    let (mut above, mut below) = (0, 0);
    for _ in 0..2_000 {
        let normal = random.direction();
        let origin = normal * (0.6 + 1.4 * random.unit());
        let height = |p: &Vec3| (p.as_dvec3() - origin.as_dvec3()).dot(normal.as_dvec3());
        let expected =
            positions.iter().any(|p| height(p) > 2.4e-7 * f64::from(p.abs().max(origin.abs()).max_element()));
        assert_eq!(tracer.anything_above(origin, normal), expected, "{origin} {normal}");
        above += usize::from(expected);
        below += usize::from(!expected);
    }
    assert!(above > 100 && below > 100, "both answers occur: {above} {below}");
}

/// A square in y = 0 touches what rests on it at its foot; seen from above it is only the own ground.
#[test]
fn ground_that_is_touched_is_faced() {
    let corners = [vec3(-1.0, 0.0, 1.0), vec3(1.0, 0.0, 1.0), vec3(0.0, 0.0, -1.0)];
    let up = Tracer::build(&corners, &[[0, 1, 2]], &[]);
    let down = Tracer::build(&corners, &[[0, 2, 1]], &[]);
    assert!(up.anything_faced(Vec3::ZERO, Vec3::NEG_Y, 1e-4), "the foot of a body on the ground");
    assert!(up.anything_faced(vec3(0.0, -0.9e-4, 0.0), Vec3::NEG_Y, 1e-4), "sunk by less than the slack");
    assert!(!up.anything_faced(vec3(0.0, -1.2e-4, 0.0), Vec3::NEG_Y, 1e-4), "can fail: sunk by more");
    assert!(!up.anything_faced(Vec3::ZERO, Vec3::Y, 1e-4), "a point of the ground itself");
    assert!(!down.anything_faced(Vec3::ZERO, Vec3::NEG_Y, 1e-4), "ground that faces the other way");
}
