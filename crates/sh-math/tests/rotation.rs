//! Rotation of coefficients against rotated directions, quadrature, another recursion and golden values.

mod ivanic_ruedenberg;

use glam::{DMat3, DQuat, DVec3, Quat};
use ivanic_ruedenberg::Text;
use sh_math::{Bands, Rgb, evaluate_f64, rotate::Rotation};
use std::f64::consts::{FRAC_PI_2, PI};
use testkit::quadrature::sphere_quadrature;

fn bands(count: u32) -> Bands {
    Bands::new(count).expect("in range")
}

/// Allowed error of an entry of the matrix of degree `l`.
fn bound(l: usize) -> f64 {
    f64::EPSILON * (4.0 + 2.5 * l as f64)
}

fn basis(bands: Bands, direction: DVec3) -> Vec<f64> {
    let mut out = vec![0.0; bands.coefficients()];
    evaluate_f64(bands, direction, &mut out);
    out
}

/// Numbers of a fixed seed in -1..1.
struct Random(u64);

impl Random {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    }

    fn rotation(&mut self) -> DQuat {
        DQuat::from_xyzw(self.next(), self.next(), self.next(), self.next()).normalize()
    }
}

/// Rotations that break careless implementations, and some of no special kind.
fn rotations() -> Vec<DQuat> {
    let mut all = vec![DQuat::IDENTITY, DQuat::from_xyzw(2.0, 3.0, 4.0, 1.0).normalize()];
    for axis in [DVec3::X, DVec3::Y, DVec3::Z, DVec3::new(1.0, 1.0, 0.0).normalize(), DVec3::ONE.normalize()] {
        for angle in [PI, FRAC_PI_2, -FRAC_PI_2, PI / 3.0, 1e-3, 1e-7, PI - 1e-7] {
            all.push(DQuat::from_axis_angle(axis, angle));
        }
    }
    // gimbal: beta next to 0 and pi between other turns
    for beta in [0.0, 1e-9, PI - 1e-9, PI] {
        let turn = DQuat::from_rotation_z(0.7) * DQuat::from_rotation_y(beta) * DQuat::from_rotation_z(-1.9);
        all.push(turn);
    }
    let mut random = Random(7);
    all.extend((0..10).map(|_| random.rotation()));
    all
}

/// Largest entry of `M M^T - 1`.
fn defect(matrix: &[f64]) -> f64 {
    let size = matrix.len().isqrt();
    let rows: Vec<&[f64]> = matrix.chunks_exact(size).collect();
    let mut worst = 0.0_f64;
    for (i, a) in rows.iter().enumerate() {
        for (j, b) in rows.iter().enumerate() {
            let product: f64 = a.iter().zip(*b).map(|(a, b)| a * b).sum();
            worst = worst.max((product - f64::from(u8::from(i == j))).abs());
        }
    }
    worst
}

fn distance(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
}

/// Golden matrices, and how far those of `quaternion` are from them as a share of the bound.
fn from_golden(quaternion: DQuat) -> f64 {
    let file: serde_json::Value =
        serde_json::from_str(include_str!("golden/golden_rot.json")).expect("the golden file is JSON");
    let rotation = Rotation::from_f64(bands(9), quaternion);
    let share = |l: usize| {
        let entries = file["bands"][l.to_string()].as_array().expect("each degree is a list");
        let golden: Vec<f64> = entries.iter().map(|e| e.as_str().expect("string").parse().expect("number")).collect();
        assert_eq!(golden.len(), (2 * l + 1) * (2 * l + 1), "the golden matrix is whole");
        distance(&rotation.matrix(l), &golden) / bound(l)
    };
    (0..9).map(share).fold(0.0, f64::max)
}

#[test]
fn matrices_equal_golden_ones() {
    let share = from_golden(DQuat::from_xyzw(2.0, 3.0, 4.0, 1.0));
    assert!(share <= 1.0, "{share} of the bound");
}

#[test]
fn golden_matrices_of_the_inverse_can_fail() {
    assert!(from_golden(DQuat::from_xyzw(-2.0, -3.0, -4.0, 1.0)) > 1e10, "the turn back must be far off");
}

/// `Y(R v) = M Y(v)` for every kind of rotation, 9 bands.
#[test]
fn basis_turns_with_direction() {
    let mut random = Random(3);
    for turn in rotations() {
        let rotation = Rotation::from_f64(bands(9), turn);
        let direction = DVec3::new(random.next(), random.next(), random.next()).normalize();
        let mut turned = basis(bands(9), direction);
        rotation.apply(&mut turned);
        let error = distance(&turned, &basis(bands(9), turn * direction));
        assert!(error < 3e-14, "{turn}: {error:e}");
    }
}

/// Every entry against another recursion, where that one is good: to degree 20.
#[test]
fn matrices_equal_another_recursion() {
    for turn in rotations() {
        let rotation = Rotation::from_f64(bands(21), turn);
        let others = ivanic_ruedenberg::matrices(21, DMat3::from_quat(turn.normalize()), Text::Corrected);
        for (l, other) in others.iter().enumerate() {
            let error = distance(&rotation.matrix(l), other);
            assert!(error <= 2.0 * bound(l), "{turn}, degree {l}: {error:e}");
        }
    }
}

/// The recursion as printed, with `sqrt(1 - d)` in V for m < 0.
#[test]
fn another_recursion_as_printed_can_fail() {
    let turn = Random(7).rotation();
    let rotation = Rotation::from_f64(bands(3), turn);
    let printed = ivanic_ruedenberg::matrices(3, DMat3::from_quat(turn), Text::Printed);
    assert!(distance(&rotation.matrix(2), &printed[2]) > 0.1, "the missing term must be seen");
}

#[test]
fn matrices_are_orthogonal_to_degree_128() {
    for turn in rotations().into_iter().step_by(7) {
        let rotation = Rotation::from_f64(bands(129), turn);
        for l in [1, 2, 4, 8, 16, 32, 64, 128] {
            let defect = defect(&rotation.matrix(l)) / f64::EPSILON;
            assert!(defect <= 8.0, "{turn}, degree {l}: {defect} eps");
        }
    }
}

/// Some columns of degree 128 by turning the directions of a quadrature rule and projecting again.
#[test]
fn degree_128_equals_quadrature() {
    let (l, turn) = (128, Random(11).rotation());
    let matrix = Rotation::from_f64(bands(129), turn).matrix(l);
    let columns = [0, 37, 127, 128, 129, 200, 256];
    let mut sums = vec![[0.0; 7]; 257];
    for (d, weight) in sphere_quadrature(l + 1) {
        let direction = DVec3::from_array(d);
        let (before, after) = (basis(bands(129), direction), basis(bands(129), turn * direction));
        for (row, y) in sums.iter_mut().zip(&after[l * l..]) {
            row.iter_mut().zip(columns).for_each(|(sum, column)| *sum += weight * y * before[l * l + column]);
        }
    }
    let errors = sums.iter().enumerate().flat_map(|(row, sums)| {
        let matrix = &matrix;
        sums.iter().zip(columns).map(move |(sum, column)| (sum - matrix[row * 257 + column]).abs())
    });
    let worst = errors.fold(0.0, f64::max);
    assert!(worst <= bound(l), "{} of the bound", worst / bound(l));
}

/// Rotations given as rounded products of matrices, next to gimbal lock.
#[test]
fn noisy_gimbal_is_harmless() {
    for beta in [0.0, 1e-12, 1e-9, 1e-5, PI - 1e-9, PI] {
        let noisy = DMat3::from_rotation_z(0.7) * DMat3::from_rotation_y(beta) * DMat3::from_rotation_z(-1.9);
        let rotation = Rotation::from_matrix(bands(9), noisy);
        let direction = DVec3::new(2.0, -3.0, 6.0) / 7.0;
        let mut turned = basis(bands(9), direction);
        rotation.apply(&mut turned);
        let error = distance(&turned, &basis(bands(9), noisy * direction));
        assert!(error < 3e-14, "beta {beta}: {error:e}");
    }
}

/// Reading alpha and gamma each on its own, as one would first write it.
#[test]
fn noisy_gimbal_with_separate_angles_can_fail() {
    let noisy = DMat3::from_rotation_z(0.7) * DMat3::from_rotation_y(1e-17) * DMat3::from_rotation_z(-1.9);
    let noise = DMat3::from_cols(DVec3::Z * 1e-17, DVec3::ZERO, DVec3::X * 1e-17);
    let [c0, c1, c2] = (noisy + noise).to_cols_array_2d();
    let (alpha, gamma) = (libm::atan2(c2[1], c2[0]), libm::atan2(c1[2], -c0[2]));
    let beta = libm::atan2(libm::hypot(c2[0], c2[1]), c2[2]);
    let rebuilt = DMat3::from_rotation_z(alpha) * DMat3::from_rotation_y(beta) * DMat3::from_rotation_z(gamma);
    assert!(!rebuilt.abs_diff_eq(noisy, 0.1), "separate angles must be wrong by O(1) here");
    let rotation = Rotation::from_matrix(bands(2), noisy + noise);
    let [_, y, z, x] = [0, 1, 2, 3].map(|i| i);
    let mut vector = [0.0, 0.6, 0.0, 0.8];
    rotation.apply(&mut vector);
    let expected = noisy * DVec3::new(0.8, 0.6, 0.0);
    assert!(distance(&[vector[x], vector[y], vector[z]], &expected.to_array()) < 1e-15, "one after the other is right");
}

#[test]
fn composition_and_inverse_hold() {
    let mut random = Random(5);
    for n in 2..=10 {
        let (first, second) = (random.rotation(), random.rotation());
        let start: Vec<f64> = (0..n * n).map(|_| random.next()).collect();
        let n = bands(n as u32);
        let mut steps = start.clone();
        Rotation::from_f64(n, first).apply(&mut steps);
        Rotation::from_f64(n, second).apply(&mut steps);
        let mut once = start.clone();
        Rotation::from_f64(n, second * first).apply(&mut once);
        assert!(distance(&steps, &once) < 1e-14, "{n:?}: two turns are not their product");
        let mut other = start.clone();
        Rotation::from_f64(n, first * second).apply(&mut other);
        assert!(distance(&steps, &other) > 0.1, "{n:?}: the order of the turns must be seen");
        Rotation::from_f64(n, (second * first).inverse()).apply(&mut once);
        assert!(distance(&start, &once) < 1e-14, "{n:?}: the inverse does not lead back");
    }
}

/// 10,000 turns, as quaternions with one rotation at the end, and as rotated coefficients.
#[test]
fn ten_thousand_turns_stay_on_the_sphere() {
    let mut random = Random(9);
    let start: Vec<f64> = (0..81).map(|_| random.next()).collect();
    let length = |values: &[f64]| values.iter().map(|v| v * v).sum::<f64>().sqrt();
    // the bounds are those of a vector of length 1
    let start: Vec<f64> = start.iter().map(|value| value / length(&start)).collect();
    let start_f32: Vec<f32> = start.iter().map(|&v| v as f32).collect();
    let (mut exact, mut turned, mut turned_f32) = (DQuat::IDENTITY, start.clone(), start_f32.clone());
    let mut rounded = Quat::IDENTITY;
    for _ in 0..10_000 {
        let turn = random.rotation();
        exact = (turn * exact).normalize();
        rounded = (turn.as_quat() * rounded).normalize();
        let rotation = Rotation::from_f64(bands(9), turn);
        rotation.apply(&mut turned);
        rotation.apply(&mut turned_f32);
    }
    let mut once = start.clone();
    Rotation::from_f64(bands(9), exact).apply(&mut once);
    let widened = |values: &[f32]| values.iter().map(|&v| f64::from(v)).collect::<Vec<f64>>();
    assert!(distance(&turned, &once) < 2e-12, "f64 coefficients drift by {:e}", distance(&turned, &once));
    assert!(distance(&widened(&turned_f32), &once) < 1e-3, "f32 coefficients drift");
    let mut once_f32 = start_f32;
    Rotation::new(bands(9), rounded).apply(&mut once_f32);
    assert!(distance(&widened(&once_f32), &once) < 1e-4, "f32 quaternions drift by more than 1e-4");
    assert!((length(&once) / length(&start) - 1.0).abs() < 1e-14, "one rotation must keep the length");
    assert!((length(&widened(&once_f32)) / length(&start) - 1.0).abs() < 3e-6, "in f32 too");
}

/// What a light sent along `d` it sends along `R d`.
#[test]
fn lights_turn_with_their_frame() {
    let mut random = Random(13);
    let values = (0..25).map(|_| [random.next() as f32, random.next() as f32, random.next() as f32]).collect();
    let light = Rgb { bands: bands(5), values };
    let turn = random.rotation().as_quat();
    let direction = DVec3::new(2.0, -3.0, 6.0).as_vec3() / 7.0;
    let (before, after) = (light.reconstruct(direction), light.rotated(turn).reconstruct(turn * direction));
    let back = light.rotated(turn.inverse()).reconstruct(turn * direction);
    let apart = |a: [f32; 3], b: [f32; 3]| (0..3).map(|i| (a[i] - b[i]).abs()).fold(0.0, f32::max);
    assert!(apart(before, after) < 1e-5, "{before:?} does not turn along, it is {after:?}");
    assert!(apart(before, back) > 0.1, "turning the wrong way must be seen: {before:?}, {back:?}");
}
