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
        wrong += usize::from(!agree(expected, found));
        wrong += usize::from(tracer.occluded(&ray, SOLID) != expected.is_some());
    }
    (wrong, hits)
}

/// The same triangle, or another at the same distance to double precision's rounding into single.
fn agree(expected: Option<(u32, f64)>, found: Option<Hit>) -> bool {
    match (expected, found) {
        (None, None) => true,
        (Some((triangle, t)), Some(hit)) => {
            let near = (f64::from(hit.t) - t).abs() <= 4.0e-6 * t;
            near && (hit.triangle == triangle || (f64::from(hit.t) - t).abs() <= 1.0e-6 * t)
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
