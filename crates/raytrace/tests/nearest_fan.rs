//! The nearest hits of a fan: those of its rays one by one and those of a loop over all triangles, at every level.

mod shapes;

use glam::Vec3;
use raytrace::{FanState, Hit, Level, Ray, Tracer};
use shapes::{Random, brute_closest, hemisphere, soup};

type Filter<'a> = &'a dyn Fn(u32, f32, f32) -> bool;

const SOLID: Filter<'static> = &|_, _, _| true;

/// The hits of the wanted directions of a fan.
fn fan(
    tracer: &Tracer,
    origin: Vec3,
    list: &[Vec3],
    wanted: &[u64],
    solid: Filter<'_>,
    state: &mut FanState,
) -> Vec<Option<Hit>> {
    let axis = |k: usize| list.iter().map(|d| d[k]).collect::<Vec<f32>>();
    let (xs, ys, zs) = (axis(0), axis(1), axis(2));
    // What was there before must not stay.
    let stale = Hit { triangle: 9, t: 9.0, u: 9.0, v: 9.0, front: true };
    let mut hits = vec![Some(stale); list.len()];
    tracer.closest_fan(origin, &xs, &ys, &zs, wanted, solid, state, &mut hits);
    hits
}

/// Counts directions whose hit in a fan is not that of a single ray of the same or another tracer.
fn differing(fans: &Tracer, singles: &Tracer, solid: Filter<'_>, cases: &[(Vec3, Vec<Vec3>, Vec<u64>)]) -> usize {
    let mut state = FanState::new();
    let mut differ = 0;
    for (origin, list, wanted) in cases {
        let hits = fan(fans, *origin, list, wanted, solid, &mut state);
        for (i, hit) in hits.into_iter().enumerate() {
            let asked = wanted[i / 64] >> (i % 64) & 1 == 1;
            let single = singles.closest(&Ray::new(*origin, list[i]), solid);
            differ += usize::from(hit != single.filter(|_| asked));
        }
    }
    differ
}

/// Masks in which every bit, about half, one in sixteen, a single one or none is set.
fn masks(random: &mut Random, n: usize) -> Vec<Vec<u64>> {
    let words = n.div_ceil(64);
    let half: Vec<u64> = (0..words).map(|_| random.next()).collect();
    let few: Vec<u64> = half.iter().map(|w| w & random.next() & random.next() & random.next()).collect();
    let mut one = vec![0; words];
    one[n / 2 / 64] |= 1 << (n / 2 % 64);
    vec![vec![u64::MAX; words], half, few, one, vec![0; words]]
}

/// Fans from points of a cube: coherent ones, ones of mixed signs, and such with rays along axes among them.
fn cases(seed: u64, origins: impl Iterator<Item = Vec3>) -> Vec<(Vec3, Vec<Vec3>, Vec<u64>)> {
    let mut random = Random::new(seed);
    let mut cases = Vec::new();
    for (i, origin) in origins.enumerate() {
        let n = 90 + 37 * (i % 5);
        let coherent = hemisphere(random.direction(), n);
        let scattered: Vec<Vec3> = (0..n).map(|_| random.direction()).collect();
        let mut with_axes = coherent.clone();
        (0..n).step_by(29).for_each(|k| with_axes[k] = [Vec3::X, Vec3::NEG_Y, Vec3::new(0.0, 0.6, -0.8)][k % 3]);
        for list in [coherent, scattered, with_axes] {
            let masks = masks(&mut random, n);
            cases.extend(masks.into_iter().map(|mask| (origin, list.clone(), mask)));
        }
    }
    cases
}

/// A wall of coplanar triangles that lie over each other, some of them there twice with their corners turned round,
/// with others across it.
fn layers() -> (Vec<Vec3>, Vec<[u32; 3]>) {
    let mut positions = Vec::new();
    let mut random = Random::new(31);
    for i in 0..300 {
        // Whole multiples of 1/64: hits on one plane at equal distances.
        let snap = |p: Vec3| (p * 64.0).round() / 64.0;
        let centre = random.point();
        for _ in 0..3 {
            let mut corner = snap(centre + random.point() * 0.4);
            if i % 3 != 0 {
                corner.z = 0.25 * (i % 2) as f32;
            }
            positions.push(corner);
        }
    }
    let once = (0..300).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]);
    let again = (0..300).map(|i| [3 * i + 2, 3 * i + 1, 3 * i]);
    let triangles = once.chain(again).collect();
    (positions, triangles)
}

/// Solid in half of the area of a masked triangle.
fn half_solid(triangle: u32, u: f32, v: f32) -> bool {
    triangle.is_multiple_of(3) ^ (u > v)
}

#[test]
fn hits_equal_those_of_single_rays_at_every_level() {
    let mut random = Random::new(2);
    let cases = cases(8, (0..8).map(|_| random.point()));
    for (n, size) in [(2, 1.5), (60, 0.6), (3_000, 0.08)] {
        let (positions, triangles) = soup(n, size, 3);
        let masked: Vec<bool> = (0..n).map(|i| i % 2 == 0).collect();
        for level in Level::available() {
            let tracer = Tracer::build(&positions, &triangles, &masked).at_level(level).expect("it is available");
            assert_eq!(differing(&tracer, &tracer, &half_solid, &cases), 0, "{level:?}, {n} triangles");
        }
    }
}

#[test]
fn equally_near_hits_go_to_the_smaller_number_in_fans() {
    let (positions, triangles) = layers();
    let none = vec![];
    let some: Vec<bool> = (0..triangles.len()).map(|i| i % 5 == 0).collect();
    // On the planes of the layers, on corners of triangles and anywhere.
    let mut random = Random::new(3);
    let points: Vec<Vec3> = (0..9).map(|_| random.point()).collect();
    let origins = points.iter().enumerate().map(|(i, p)| match i % 3 {
        0 => Vec3::new(p.x, p.y, 0.25),
        1 => positions[11 * i],
        _ => *p,
    });
    let cases = cases(4, origins);
    for masked in [none, some] {
        let plain = Tracer::build(&positions, &triangles, &masked).at_level(Level::Portable).expect("always there");
        for level in Level::available() {
            let tracer = Tracer::build(&positions, &triangles, &masked).at_level(level).expect("it is available");
            assert_eq!(differing(&tracer, &plain, &half_solid, &cases), 0, "{level:?}, {} masked", masked.len());
        }
    }
}

#[test]
fn comparison_with_single_rays_can_fail() {
    let (positions, triangles) = layers();
    let tracer = Tracer::build(&positions, &triangles, &[]);
    let turned: Vec<[u32; 3]> = triangles.iter().rev().copied().collect();
    let other = Tracer::build(&positions, &turned, &[]);
    let mut random = Random::new(2);
    let cases = cases(8, (0..4).map(|_| random.point()));
    assert!(differing(&tracer, &other, SOLID, &cases) > 300, "other numbers show");
    let masked = Tracer::build(&positions, &triangles, &vec![true; triangles.len()]);
    assert!(differing(&tracer, &masked, &half_solid, &cases) > 300, "a filter shows");
}

/// Directions of fans over a soup whose nearest hit is not the one a loop over all triangles finds, and those that hit.
fn against_brute_force(removed: usize) -> (usize, usize) {
    let (positions, triangles) = soup(700, 0.25, 12);
    let (mut wrong, mut hits) = (0, 0);
    for level in Level::available() {
        let tracer = Tracer::build(&positions, &triangles[removed..], &[]).at_level(level).expect("it is available");
        let mut random = Random::new(14);
        let mut state = FanState::new();
        for _ in 0..12 {
            let origin = random.point() * 1.3;
            let list = hemisphere(random.direction(), 130);
            let found = fan(&tracer, origin, &list, &[u64::MAX; 3], SOLID, &mut state);
            for (hit, &direction) in found.into_iter().zip(&list) {
                let expected = brute_closest(&positions, &triangles, &Ray::new(origin, direction));
                hits += usize::from(expected.is_some());
                let same = match (expected, hit) {
                    (None, None) => true,
                    // Corners count from the origin in single precision: a few units of 2^-24 of 3 units of length.
                    (Some((_, t)), Some(hit)) => (f64::from(hit.t) - t).abs() <= 4.0e-6 * t + 7.5e-7,
                    _ => false,
                };
                wrong += usize::from(!same);
            }
        }
    }
    (wrong, hits)
}

#[test]
fn fans_agree_with_brute_force() {
    let (wrong, hits) = against_brute_force(0);
    assert_eq!(wrong, 0, "of {hits} hits");
    assert!(hits > 500, "{hits} hits are enough to tell");
}

#[test]
fn agreement_with_brute_force_can_fail() {
    let (wrong, _) = against_brute_force(50);
    assert!(wrong > 10, "fifty triangles less show: {wrong}");
}

#[test]
fn state_of_other_fans_changes_nothing() {
    let (positions, triangles) = soup(500, 0.2, 5);
    let tracer = Tracer::build(&positions, &triangles, &[]);
    let other = Tracer::build(&positions[..900], &triangles[..300], &[]);
    let list = hemisphere(Vec3::Z, 256);
    let wanted = [u64::MAX; 4];
    let mut state = FanState::new();
    let fresh = fan(&tracer, Vec3::ZERO, &list, &wanted, SOLID, &mut FanState::new());
    for round in 0..3 {
        assert_eq!(fan(&tracer, Vec3::ZERO, &list, &wanted, SOLID, &mut state), fresh, "round {round}");
        // From the same point in another tree, then from elsewhere.
        fan(&other, Vec3::ZERO, &list, &wanted, SOLID, &mut state);
        assert_eq!(fan(&tracer, Vec3::ZERO, &list, &wanted, SOLID, &mut state), fresh, "round {round}, another tree");
        fan(&tracer, Vec3::splat(0.1), &list, &wanted, SOLID, &mut state);
    }
    let behind = fan(&other, Vec3::ZERO, &list, &wanted, SOLID, &mut state);
    assert_ne!(behind, fresh, "the two trees differ where it matters");
}
