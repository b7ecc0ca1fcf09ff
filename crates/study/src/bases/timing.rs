//! How long one evaluation takes.

use glam::Vec3;
use sh_math::hemisphere::Basis;
use std::hint::black_box;
use std::time::Instant;

/// Texels of a batch: their coefficients stay in the second-level cache, not a power of two.
const TEXELS: usize = 1000;
/// Batches between two looks at the clock, so that its own time does not show.
const BATCHES: usize = 8;
/// Rounds over all bases; the fastest of each counts, as the one that nothing disturbed.
const ROUNDS: usize = 300;

/// Nanoseconds per texel of each of [`Basis::ALL`]: functions at its normal times its coefficients, three channels, f32.
///
/// The bases take turns, so that a busy spell of the machine falls on all of them.
pub(super) fn nanoseconds() -> Vec<f64> {
    let normals = normals();
    let coefficients: Vec<[f32; 3]> =
        (0..TEXELS * Basis::MAX_COUNT).map(|i| [0.5, 0.25, (i % 7) as f32 * 0.1]).collect();
    let mut out = vec![[0.0; 3]; TEXELS];
    let mut fastest = vec![f64::INFINITY; Basis::ALL.len()];
    for _ in 0..ROUNDS {
        for (basis, fastest) in Basis::ALL.into_iter().zip(&mut fastest) {
            let coefficients = &coefficients[..TEXELS * basis.count()];
            let began = Instant::now();
            for _ in 0..BATCHES {
                basis.reconstruct_batch(black_box(coefficients), black_box(&normals), black_box(&mut out));
            }
            *fastest = fastest.min(began.elapsed().as_secs_f64());
        }
    }
    fastest.into_iter().map(|seconds| seconds * 1e9 / (TEXELS * BATCHES) as f64).collect()
}

/// Normals all over the hemisphere.
fn normals() -> Vec<Vec3> {
    let normal = |i: usize| {
        let z = (i as f32 + 0.5) / TEXELS as f32;
        let (sine, cosine) = (2.4 * i as f32).sin_cos();
        let radius = (1.0 - z * z).sqrt();
        Vec3::new(radius * cosine, radius * sine, z)
    };
    (0..TEXELS).map(normal).collect()
}
