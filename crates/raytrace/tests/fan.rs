//! A fan answers as its rays do one by one, at every level of the processor.

mod shapes;

use glam::Vec3;
use raytrace::{FanState, Level, Ray, Tracer};
use shapes::{Random, hemisphere, soup};

/// Half of the triangles are masked, and solid in half of their area.
fn half_solid(triangle: u32, u: f32, v: f32) -> bool {
    triangle.is_multiple_of(3) ^ (u > v)
}

/// Bits of a fan, and the same from single rays.
fn both(tracer: &Tracer, origin: Vec3, directions: &[[f32; 3]], state: &mut FanState) -> (Vec<u64>, Vec<u64>) {
    let axis = |k: usize| directions.iter().map(|d| d[k]).collect::<Vec<f32>>();
    let (xs, ys, zs) = (axis(0), axis(1), axis(2));
    let mut fan = vec![u64::MAX; directions.len().div_ceil(64)];
    tracer.occluded_fan(origin, &xs, &ys, &zs, &half_solid, state, &mut fan);
    let mut single = vec![0u64; fan.len()];
    for (i, &d) in directions.iter().enumerate() {
        let hit = tracer.occluded(&Ray::new(origin, Vec3::from_array(d)), &half_solid);
        single[i / 64] |= u64::from(hit) << (i % 64);
    }
    (fan, single)
}

/// Directions of several kinds: near each other, anywhere, along axes.
fn directions(random: &mut Random, n: usize) -> Vec<[f32; 3]> {
    let mut list: Vec<[f32; 3]> = hemisphere(random.direction(), n).iter().map(|d| d.to_array()).collect();
    list.extend((0..n / 4).map(|_| random.direction().to_array()));
    list.extend([[1.0, 0.0, 0.0], [0.0, -1.0, 0.0], [0.0, 0.0, 1.0], [0.6, 0.0, -0.8], [-0.0, 0.6, 0.8]]);
    list
}

#[test]
fn fans_equal_single_rays_at_every_level() {
    let mut state = FanState::new();
    for (n, size) in [(3, 1.5), (60, 0.6), (3_000, 0.08)] {
        let (positions, triangles) = soup(n, size, 3);
        let masked: Vec<bool> = (0..n).map(|i| i % 2 == 0).collect();
        let mut reference: Vec<Vec<u64>> = Vec::new();
        for (round, level) in Level::available().into_iter().enumerate() {
            let tracer = Tracer::build(&positions, &triangles, &masked).at_level(level).expect("it is available");
            let mut rays = Random::new(9);
            for case in 0..40 {
                let origin = if case % 3 == 0 { positions[case % positions.len()] } else { rays.point() };
                let list = directions(&mut rays, 16 + 13 * case);
                let (fan, single) = both(&tracer, origin, &list, &mut state);
                assert_eq!(fan, single, "{level:?}, {n} triangles, case {case}");
                if round == 0 {
                    reference.push(fan);
                } else {
                    assert_eq!(fan, reference[case], "{level:?} against the portable level, case {case}");
                }
            }
        }
    }
}

#[test]
fn equality_can_fail() {
    let (positions, triangles) = soup(60, 0.6, 3);
    let whole = Tracer::build(&positions, &triangles, &[]);
    let less = Tracer::build(&positions, &triangles[10..], &[]);
    let list = directions(&mut Random::new(1), 1_000);
    let mut state = FanState::new();
    let (of_whole, _) = both(&whole, Vec3::ZERO, &list, &mut state);
    let (_, of_less) = both(&less, Vec3::ZERO, &list, &mut state);
    assert_ne!(of_whole, of_less, "ten triangles less show");
}

#[test]
fn hits_of_a_fan_equal_those_of_its_rays() {
    let (positions, triangles) = soup(800, 0.2, 3);
    let masked: Vec<bool> = (0..800).map(|i| i % 2 == 0).collect();
    let mut state = FanState::new();
    for level in Level::available() {
        let tracer = Tracer::build(&positions, &triangles, &masked).at_level(level).expect("it is available");
        let mut random = Random::new(6);
        for case in 0..30 {
            let origin = random.point();
            let list = directions(&mut random, 100 + case);
            let axis = |k: usize| list.iter().map(|d| d[k]).collect::<Vec<f32>>();
            let wanted: Vec<u64> = (0..list.len().div_ceil(64)).map(|_| random.next()).collect();
            let mut hits = vec![None; list.len()];
            let (xs, ys, zs) = (axis(0), axis(1), axis(2));
            tracer.closest_fan(origin, &xs, &ys, &zs, &wanted, &half_solid, &mut state, &mut hits);
            for (i, hit) in hits.iter().enumerate() {
                let asked = wanted[i / 64] >> (i % 64) & 1 == 1;
                let single = tracer.closest(&Ray::new(origin, Vec3::from_array(list[i])), &half_solid);
                assert_eq!(*hit, single.filter(|_| asked), "{level:?}, case {case}, direction {i}");
            }
        }
    }
}
