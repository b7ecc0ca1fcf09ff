//! How large the error is, and how well it is estimated, on a receiver under three round obstacles.
//!
//! The integrand is the one of a bake: visibility times cosine over pi, projected to the 25 harmonics of 5 bands. The
//! obstacles are disjoint caps above the horizon, so each coefficient is known from smooth integrals. As only the
//! norm of the error counts, any orthonormal basis of that space serves; it is made here from monomials.

use glam::{DVec3, Vec3};
use sampling::estimate::{Doubling, Replicates, Verdict, l2_distance};
use sampling::rng::Rng;
use sampling::sequence::{Sequence, point};
use sampling::{frame::Frame, warp};
use std::f64::consts::PI;
use testkit::quadrature::{band_quadrature, sphere_quadrature};

const N: usize = 25;
const REPLICATES: u64 = 40;
/// Axis (not unit) and half angle of each obstacle.
const CAPS: [([f64; 3], f64); 3] = [([0.2, 0.3, 1.0], 0.35), ([1.0, -0.2, 0.8], 0.45), ([-0.9, -0.5, 0.7], 0.30)];

fn monomials(d: DVec3) -> [f64; N] {
    let powers = |v: f64| [1.0, v, v * v, v * v * v, v * v * v * v];
    let (x, y) = (powers(d.x), powers(d.y));
    let mut values = [0.0; N];
    let mut next = values.iter_mut();
    for (degree, height) in (0..5).map(|l| (l, 1.0)).chain((0..4).map(|l| (l, d.z))) {
        for b in 0..=degree {
            *next.next().expect("15 + 10 monomials") = x[degree - b] * y[b] * height;
        }
    }
    values
}

/// Orthonormal functions on the sphere as combinations of the monomials (Gram-Schmidt by Cholesky).
struct Basis {
    lower: [[f64; N]; N],
}

impl Basis {
    fn new() -> Self {
        let mut lower = [[0.0; N]; N];
        for (d, weight) in sphere_quadrature(12) {
            let m = monomials(DVec3::from_array(d));
            for i in 0..N {
                for j in 0..=i {
                    lower[i][j] += weight * m[i] * m[j];
                }
            }
        }
        for i in 0..N {
            for j in 0..=i {
                let dot: f64 = (0..j).map(|k| lower[i][k] * lower[j][k]).sum();
                let rest = lower[i][j] - dot;
                lower[i][j] = if i == j { rest.sqrt() } else { rest / lower[j][j] };
            }
        }
        Self { lower }
    }

    fn evaluate(&self, d: DVec3) -> [f64; N] {
        let mut values = monomials(d);
        for i in 0..N {
            let dot: f64 = (0..i).map(|k| self.lower[i][k] * values[k]).sum();
            values[i] = (values[i] - dot) / self.lower[i][i];
        }
        values
    }

    /// Coefficients of cosine / pi over the visible part.
    fn truth(&self) -> [f64; N] {
        let mut sum = [0.0; N];
        let mut add = |d: DVec3, weight: f64| {
            let values = self.evaluate(d);
            (0..N).for_each(|i| sum[i] += weight * d.z / PI * values[i]);
        };
        band_quadrature(0.0, 1.0, 24).into_iter().for_each(|(d, weight)| add(DVec3::from_array(d), weight));
        for (axis, half_angle) in caps() {
            let frame = Frame::from_normal(axis.as_vec3());
            let [t, b] = [frame.tangent, frame.bitangent].map(|v| v.as_dvec3());
            for (d, weight) in band_quadrature(half_angle.cos(), 1.0, 24) {
                add(t * d[0] + b * d[1] + axis * d[2], -weight);
            }
        }
        sum
    }
}

fn caps() -> impl Iterator<Item = (DVec3, f64)> {
    CAPS.iter().map(|&(axis, half_angle)| (DVec3::from_array(axis).normalize(), half_angle))
}

fn visible(d: DVec3) -> bool {
    caps().all(|(axis, half_angle)| axis.dot(d) < half_angle.cos())
}

/// A way to draw direction `index` of `count`, with its density.
type Sampler = fn(index: u32, count: u32, seed: u64) -> (Vec3, f32);

fn sobol_cosine(index: u32, count: u32, seed: u64) -> (Vec3, f32) {
    let d = warp::square_to_cosine_concentric(point(Sequence::OwenSobol, index, count, seed));
    (d, warp::cosine_concentric_pdf(d))
}

fn fibonacci_cosine(index: u32, count: u32, seed: u64) -> (Vec3, f32) {
    let d = warp::square_to_cosine_hemisphere(point(Sequence::Fibonacci, index, count, seed));
    (d, warp::cosine_hemisphere_pdf(d))
}

fn random_cosine(index: u32, _count: u32, seed: u64) -> (Vec3, f32) {
    let d = warp::square_to_cosine_hemisphere(Rng::new(seed, u64::from(index)).next_square());
    (d, warp::cosine_hemisphere_pdf(d))
}

fn jittered_sphere(index: u32, count: u32, seed: u64) -> (Vec3, f32) {
    let d = warp::square_to_uniform_sphere(point(Sequence::Stratified, index, count, seed));
    (d, warp::uniform_sphere_pdf(d))
}

/// Sum over the samples of a range; the estimate is the sum over the count.
fn partial_sum(basis: &Basis, sampler: Sampler, range: std::ops::Range<u32>, count: u32, seed: u64) -> [f64; N] {
    let mut sum = [0.0; N];
    for index in range {
        let (direction, pdf) = sampler(index, count, seed);
        let d = direction.as_dvec3();
        if pdf > 0.0 && d.z > 0.0 && visible(d) {
            let values = basis.evaluate(d);
            (0..N).for_each(|i| sum[i] += values[i] * d.z / PI / f64::from(pdf));
        }
    }
    sum
}

fn estimate(basis: &Basis, sampler: Sampler, count: u32, seed: u64) -> [f64; N] {
    partial_sum(basis, sampler, 0..count, count, seed).map(|v| v / f64::from(count))
}

fn root_mean_square(values: impl Iterator<Item = f64>) -> f64 {
    let (sum, n) = values.fold((0.0, 0.0), |(sum, n), v| (sum + v * v, n + 1.0));
    (sum / n).sqrt()
}

fn rmse(basis: &Basis, truth: &[f64], sampler: Sampler, count: u32) -> f64 {
    root_mean_square((0..REPLICATES).map(|seed| l2_distance(&estimate(basis, sampler, count, seed), truth)))
}

/// Worst ratio of a sampler's error to that of the jittered sphere at equal counts.
fn worst_ratio(sampler: Sampler) -> f64 {
    let basis = Basis::new();
    let truth = basis.truth();
    let ratio = |count| rmse(&basis, &truth, sampler, count) / rmse(&basis, &truth, jittered_sphere, count);
    [256, 1024, 4096].into_iter().map(ratio).fold(0.0, f64::max)
}

#[test]
fn sobol_cosine_beats_the_jittered_sphere() {
    let ratio = worst_ratio(sobol_cosine);
    assert!(ratio <= 0.65, "error ratio {ratio:.3}");
}

#[test]
fn fibonacci_cosine_beats_the_jittered_sphere() {
    let ratio = worst_ratio(fibonacci_cosine);
    assert!(ratio <= 0.45, "error ratio {ratio:.3}");
}

#[test]
fn random_cosine_can_fail() {
    let ratio = worst_ratio(random_cosine);
    assert!(ratio > 1.0, "independent samples must lose against strata: {ratio:.3}");
}

/// Root mean squares of estimated over true error of the last doubling at 2048 samples.
fn doubling_ratio(sampler: Sampler) -> f64 {
    let basis = Basis::new();
    let truth = basis.truth();
    let rule = Doubling { first: 1024, last: 2048, tolerance: 0.0, confirmation: f64::INFINITY, memory: 1 };
    let (mut estimated, mut real) = (Vec::new(), Vec::new());
    for seed in 0..REPLICATES {
        let mut progress = rule.start();
        let first = estimate(&basis, sampler, 1024, seed);
        assert_eq!(rule.look(&mut progress, 1024, &first), Verdict::Continue { count: 2048 });
        let second = estimate(&basis, sampler, 2048, seed);
        let Verdict::Exhausted { error } = rule.look(&mut progress, 2048, &second) else {
            panic!("the second look is the last");
        };
        estimated.push(error);
        real.push(l2_distance(&second, &truth));
    }
    root_mean_square(estimated.into_iter()) / root_mean_square(real.into_iter())
}

#[test]
fn doubling_overestimates_mildly() {
    let ratio = doubling_ratio(sobol_cosine);
    assert!((1.15..1.75).contains(&ratio), "estimated over true error {ratio:.3}");
}

#[test]
fn doubling_of_a_lattice_can_fail() {
    // The lattice of half the count is another lattice, not a prefix: its change tells more than the error.
    let ratio = doubling_ratio(fibonacci_cosine);
    assert!(!(1.15..1.75).contains(&ratio), "estimated over true error {ratio:.3}");
}

#[test]
fn replicates_estimate_their_error() {
    let basis = Basis::new();
    let truth = basis.truth();
    let (mut estimated, mut real) = (Vec::new(), Vec::new());
    for group in 0..60 {
        let mut replicates = Replicates::default();
        (0..8).for_each(|k| replicates.add(&estimate(&basis, sobol_cosine, 256, 1000 + group * 8 + k)));
        estimated.push(replicates.l2_error());
        real.push(l2_distance(replicates.mean(), &truth));
    }
    let ratio = root_mean_square(estimated.into_iter()) / root_mean_square(real.into_iter());
    assert!((0.85..1.2).contains(&ratio), "estimated over true error {ratio:.3}");
}

#[test]
fn treating_a_net_as_independent_can_fail() {
    let basis = Basis::new();
    let truth = basis.truth();
    let mut samples = Replicates::default();
    for index in 0..1024 {
        samples.add(&partial_sum(&basis, sobol_cosine, index..index + 1, 1024, 1));
    }
    let ratio = samples.l2_error() / rmse(&basis, &truth, sobol_cosine, 1024);
    assert!(ratio > 3.0, "the variance of single samples says far too much: {ratio:.3}");
}
