//! Rays per second on a scene that needs no files: bumpy ground under which and on which receivers lie.

use divan::Bencher;
use divan::counter::ItemsCount;
use glam::Vec3;
use raytrace::{FanState, Ray, Tracer, offset_origin};

/// Points along a side of the ground.
const SIDE: u32 = 200;
const RAYS: u32 = 1_024;

fn main() {
    divan::main();
}

/// Ground with waves, seen from one of its points.
fn ground() -> (Tracer, Vec3) {
    let height = |x: f32, y: f32| 4.0 * (x * 0.21).sin() * (y * 0.17).cos();
    let at = |i: u32| ((i % SIDE) as f32, (i / SIDE) as f32);
    let positions: Vec<Vec3> = (0..SIDE * SIDE).map(at).map(|(x, y)| Vec3::new(x, y, height(x, y))).collect();
    let cells = (0..(SIDE - 1) * (SIDE - 1)).map(|i| i % (SIDE - 1) + i / (SIDE - 1) * SIDE);
    let triangles: Vec<[u32; 3]> =
        cells.flat_map(|i| [[i, i + 1, i + SIDE], [i + 1, i + SIDE + 1, i + SIDE]]).collect();
    let origin = offset_origin(positions[(SIDE * SIDE / 2 + SIDE / 3) as usize], Vec3::Z);
    (Tracer::build(&positions, &triangles, &[]), origin)
}

/// Cosine-distributed directions about +z, row by row.
fn directions() -> [Vec<f32>; 3] {
    let mut each = [vec![], vec![], vec![]];
    for i in 0..RAYS {
        let d = sampling::warp::square_to_cosine_concentric([
            (i % 32) as f32 / 32.0 + 0.013,
            (i / 32) as f32 / 32.0 + 0.017,
        ]);
        each.iter_mut().zip(d.to_array()).for_each(|(row, value)| row.push(value));
    }
    each
}

#[divan::bench]
fn occluded_fan(bencher: Bencher) {
    let ((tracer, origin), [xs, ys, zs]) = (ground(), directions());
    let (mut state, mut bits) = (FanState::new(), vec![0u64; RAYS.div_ceil(64) as usize]);
    bencher.counter(ItemsCount::new(RAYS)).bench_local(|| {
        tracer.occluded_fan(origin, &xs, &ys, &zs, &|_, _, _| true, &mut state, &mut bits);
        bits[0]
    });
}

#[divan::bench]
fn closest_fan(bencher: Bencher) {
    let ((tracer, origin), [xs, ys, zs]) = (ground(), directions());
    let (mut state, mut hits) = (FanState::new(), vec![None; RAYS as usize]);
    let wanted = vec![u64::MAX; RAYS.div_ceil(64) as usize];
    bencher.counter(ItemsCount::new(RAYS)).bench_local(|| {
        tracer.closest_fan(origin, &xs, &ys, &zs, &wanted, &|_, _, _| true, &mut state, &mut hits);
        hits[0]
    });
}

#[divan::bench]
fn single_rays(bencher: Bencher) {
    let ((tracer, origin), [xs, ys, zs]) = (ground(), directions());
    let ray = |i: usize| Ray::new(origin, Vec3::new(xs[i], ys[i], zs[i]));
    bencher
        .counter(ItemsCount::new(RAYS))
        .bench_local(|| (0..xs.len()).filter(|&i| tracer.occluded(&ray(i), &|_, _, _| true)).count());
}

#[divan::bench]
fn build(bencher: Bencher) {
    bencher.counter(ItemsCount::new(2 * (SIDE - 1) * (SIDE - 1))).bench_local(ground);
}
