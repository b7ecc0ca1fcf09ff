//! Random soups against brute force: the tree loses nothing and invents nothing.

mod shapes;

use glam::Vec3;
use raytrace::{Hit, Ray, Tracer};
use shapes::{Random, brute_closest, soup};

const SOLID: &dyn Fn(u32, f32, f32) -> bool = &|_, _, _| true;

/// Counts rays whose answers differ between the tracer and a loop over all triangles.
fn disagreements(positions: &[Vec3], triangles: &[[u32; 3]], n_rays: usize, spread: f32) -> (usize, usize) {
    let tracer = Tracer::build(positions, triangles, &[]);
    let mut random = Random::new(11);
    let (mut wrong, mut hits) = (0, 0);
    for _ in 0..n_rays {
        let ray = Ray::new(random.point() * spread, random.direction());
        let expected = brute_closest(positions, triangles, &ray);
        let found = tracer.closest(&ray, SOLID);
        hits += usize::from(expected.is_some());
        wrong += usize::from(!agree(expected, found, 1.0));
        wrong += usize::from(tracer.occluded(&ray, SOLID) != expected.is_some());
    }
    (wrong, hits)
}

/// The same distance but for rounding, and the same triangle or another as near. Corners count from the ray's origin
/// in single precision, which moves them by 2^-24 of the `extent` at most; a flat ray meets them so much earlier.
fn agree(expected: Option<(u32, f64)>, found: Option<Hit>, extent: f64) -> bool {
    match (expected, found) {
        (None, None) => true,
        (Some((triangle, t)), Some(hit)) => {
            let rounding = 4.0e-6 * t + 2.5e-7 * extent;
            let apart = (f64::from(hit.t) - t).abs();
            apart <= rounding && (hit.triangle == triangle || apart <= 0.25 * rounding)
        }
        _ => false,
    }
}

#[test]
fn soups_of_every_size_agree_with_brute_force() {
    for (n, size) in [(0, 0.1), (1, 1.0), (2, 1.0), (5, 1.0), (33, 0.5), (400, 0.3), (2_000, 0.1)] {
        let (positions, triangles) = soup(n, size, n as u64);
        let (wrong, hits) = disagreements(&positions, &triangles, 3_000, 1.5);
        assert_eq!(wrong, 0, "{n} triangles of size {size}, {hits} hits");
    }
}

#[test]
fn slivers_agree_with_brute_force() {
    let (mut positions, triangles) = soup(500, 0.5, 9);
    for corners in positions.chunks_exact_mut(3) {
        // The third corner lies next to the first: triangles 10 000 times as long as wide.
        corners[2] = corners[0] + (corners[2] - corners[0]) * 1.0e-4;
    }
    let (wrong, _) = disagreements(&positions, &triangles, 20_000, 1.5);
    assert_eq!(wrong, 0, "slivers");
}

#[test]
fn large_coordinates_agree_with_brute_force() {
    let (mut positions, triangles) = soup(500, 0.3, 10);
    positions.iter_mut().for_each(|p| *p = *p * 1.0e6 + Vec3::new(1.0e7, 0.0, -1.0e7));
    let tracer = Tracer::build(&positions, &triangles, &[]);
    tracer.validate().expect("a sound tree");
    let mut random = Random::new(4);
    let (mut wrong, mut hits) = (0, 0);
    for _ in 0..5_000 {
        let origin = random.point() * 1.0e6 + Vec3::new(1.0e7, 0.0, -1.0e7);
        let ray = Ray::new(origin, random.direction());
        let expected = brute_closest(&positions, &triangles, &ray);
        hits += usize::from(expected.is_some());
        wrong += usize::from(!agree(expected, tracer.closest(&ray, SOLID), 1.0e6));
    }
    assert_eq!(wrong, 0, "of {hits} hits");
}

#[test]
fn ranges_are_kept() {
    let positions: Vec<Vec3> =
        (0..4).flat_map(|i| [(-1.0, -1.0), (2.0, -1.0), (-1.0, 2.0)].map(|(x, y)| Vec3::new(x, y, i as f32))).collect();
    let triangles: Vec<[u32; 3]> = (0..4).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
    let tracer = Tracer::build(&positions, &triangles, &[]);
    let ray =
        |t_min: f32, t_max: f32| Ray { origin: Vec3::new(0.1, 0.1, -1.0), direction: Vec3::Z * 0.5, t_min, t_max };
    let triangle = |ray: Ray| tracer.closest(&ray, SOLID).map(|hit| (hit.triangle, hit.t));
    assert_eq!(triangle(ray(0.0, f32::INFINITY)), Some((0, 2.0)), "the first");
    assert_eq!(triangle(ray(2.0, f32::INFINITY)), Some((1, 4.0)), "strictly after t_min");
    assert_eq!(triangle(ray(2.5, 4.0)), None, "strictly before t_max");
    assert!(tracer.occluded(&ray(7.5, 8.5), SOLID) && !tracer.occluded(&ray(8.0, 100.0), SOLID), "any hit likewise");
}

#[test]
fn equal_distances_go_to_the_smaller_number() {
    let positions = [Vec3::ZERO, Vec3::X, Vec3::Y];
    let tracer = Tracer::build(&positions, &[[0, 1, 2]; 11], &[]);
    let hit = tracer.closest(&Ray::new(Vec3::new(0.2, 0.2, 1.0), Vec3::NEG_Z), SOLID);
    assert_eq!(hit.map(|hit| hit.triangle), Some(0), "of eleven in one place");
}

#[test]
fn agreement_can_fail() {
    let (positions, triangles) = soup(400, 0.3, 400);
    let mut moved = positions.clone();
    moved.iter_mut().for_each(|p| *p += Vec3::splat(1.0e-3));
    let tracer = Tracer::build(&moved, &triangles, &[]);
    let mut random = Random::new(1);
    let rays: Vec<Ray> = (0..3_000).map(|_| Ray::new(random.point(), random.direction())).collect();
    let differs = |ray: &&Ray| !agree(brute_closest(&positions, &triangles, ray), tracer.closest(ray, SOLID), 1.0);
    assert!(rays.iter().filter(differs).count() > 100, "a thousandth of a unit shows");
}

/// A soup of which each triangle is there twice, once from each side.
fn doubled() -> (Vec<Vec3>, Vec<[u32; 3]>) {
    let (positions, mut triangles) = soup(300, 0.5, 12);
    triangles.extend(triangles.clone().into_iter().map(|[a, b, c]| [a, c, b]));
    (positions, triangles)
}

/// Number of hits along rays, by asking for the one after each.
fn met(next: &dyn Fn(&Tracer, &Ray, &Hit) -> Option<Hit>) -> [usize; 2] {
    let (positions, triangles) = doubled();
    let tracer = Tracer::build(&positions, &triangles, &[]);
    let alone: Vec<Tracer> = triangles.iter().map(|&one| Tracer::build(&positions, &[one], &[])).collect();
    let mut random = Random::new(13);
    let (mut all, mut found) = (0, 0);
    for _ in 0..200 {
        let ray = Ray::new(random.point() * 1.5, random.direction());
        all += alone.iter().filter(|one| one.closest(&ray, SOLID).is_some()).count();
        let hits = std::iter::successors(tracer.closest(&ray, SOLID), |hit| next(&tracer, &ray, hit));
        let mut hits: Vec<u32> = hits.map(|hit| hit.triangle).collect();
        found += hits.len();
        hits.sort_unstable();
        assert!(hits.windows(2).all(|pair| pair[0] < pair[1]), "none is met twice");
    }
    [all, found]
}

/// One hit after another leads to all triangles that a ray meets, those in one place too.
#[test]
fn hits_follow_each_other() {
    let [all, found] = met(&|tracer, ray, hit| tracer.closest_after(ray, hit, SOLID));
    assert_eq!(all, found);
}

/// Going on from just behind each loses one of every two.
#[test]
fn hits_follow_each_other_can_fail() {
    let [all, found] = met(&|tracer, ray, hit| tracer.closest(&Ray { t_min: hit.t.next_up(), ..*ray }, SOLID));
    assert!(all > 500 && 2 * found <= all, "{found} of {all}");
}
