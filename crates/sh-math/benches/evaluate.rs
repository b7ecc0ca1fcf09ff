//! Time per direction of evaluation, and per vector of rotation. `cargo bench -p sh-math`.

use divan::counter::ItemsCount;
use divan::{Bencher, black_box};
use glam::{Quat, Vec3};
use sh_math::rotate::Rotation;
use sh_math::{Bands, evaluate, evaluate_batch, recurrence};

/// Directions per run. Not a power of two: rows of the batch 4096 bytes apart would share one cache set.
const DIRECTIONS: usize = 1000;

fn main() {
    divan::main();
}

/// Directions spread over the sphere.
fn directions() -> Vec<Vec3> {
    let direction = |i: usize| {
        let z = 1.0 - (2 * i + 1) as f32 / DIRECTIONS as f32;
        let (sine, cosine) = (2.4 * i as f32).sin_cos();
        let radius = (1.0 - z * z).sqrt();
        Vec3::new(radius * cosine, radius * sine, z)
    };
    (0..DIRECTIONS).map(direction).collect()
}

fn bands(count: u32) -> Bands {
    Bands::new(count).expect("benchmarked counts are in range")
}

#[divan::bench(args = [3, 5, 8, 16])]
fn scalar(bencher: Bencher, count: u32) {
    let (bands, directions) = (bands(count), directions());
    let mut out = vec![0.0; bands.coefficients() * DIRECTIONS];
    bencher.counter(ItemsCount::new(DIRECTIONS)).bench_local(|| {
        for (direction, row) in directions.iter().zip(out.chunks_exact_mut(bands.coefficients())) {
            evaluate(bands, *direction, row);
        }
        black_box(&mut out);
    });
}

#[divan::bench(args = [3, 5, 8, 16])]
fn scalar_recurrence(bencher: Bencher, count: u32) {
    let (bands, directions) = (bands(count), directions());
    let mut out = vec![0.0; bands.coefficients() * DIRECTIONS];
    bencher.counter(ItemsCount::new(DIRECTIONS)).bench_local(|| {
        for (direction, row) in directions.iter().zip(out.chunks_exact_mut(bands.coefficients())) {
            recurrence::evaluate(bands.count(), direction.to_array(), row);
        }
        black_box(&mut out);
    });
}

#[divan::bench(args = [3, 5, 8, 16], types = [f32, f64])]
fn batch<T: sh_math::Real>(bencher: Bencher, count: u32) {
    let (bands, directions) = (bands(count), directions());
    let [xs, ys, zs] = [0, 1, 2].map(|axis| directions.iter().map(|d| T::from_f64(d[axis].into())).collect::<Vec<T>>());
    let mut out = vec![T::default(); bands.coefficients() * DIRECTIONS];
    bencher.counter(ItemsCount::new(DIRECTIONS)).bench_local(|| {
        evaluate_batch(bands, &xs, &ys, &zs, &mut out);
        black_box(&mut out);
    });
}

#[divan::bench(args = [3, 5, 8, 33])]
fn rotate_rgb(bencher: Bencher, count: u32) {
    let bands = bands(count);
    let rotation = Rotation::new(bands, Quat::from_xyzw(0.1, 0.2, 0.3, 0.9));
    let mut values = vec![0.5_f32; 3 * bands.coefficients()];
    bencher.bench_local(|| {
        rotation.apply_interleaved(&mut values, 3);
        black_box(&mut values);
    });
}

#[divan::bench(args = [5, 8])]
fn build_rotation(bencher: Bencher, count: u32) {
    let quaternion = black_box(Quat::from_xyzw(0.1, 0.2, 0.3, 0.9));
    bencher.bench_local(|| Rotation::new(bands(count), quaternion));
}
