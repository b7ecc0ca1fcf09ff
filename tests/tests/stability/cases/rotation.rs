//! Rotation of coefficients where angles are not unique, tiny, many, or of high degree.

use super::Case;
use super::case::{difference, worse, worst};
use glam::{DMat3, DQuat, DVec3, Mat3, Quat};
use sampling::rng::Rng;
use sh_math::rotate::Rotation;
use sh_math::{Bands, evaluate_f64};
use std::f64::consts::PI;

#[path = "../../../../crates/sh-math/tests/ivanic_ruedenberg/mod.rs"]
mod ivanic_ruedenberg;
use ivanic_ruedenberg::{Text, matrices};

const EULER: &str = "error of Y(Rv) = M Y(v) at 9 bands: ε (4 + 2.5 l) for each of the 17 entries of a row at l = 8";

pub(crate) fn gimbal() -> Case {
    Case {
        title: "rotation next to gimbal lock, from rounded matrices",
        bound: EULER,
        limit: 3e-14,
        ours: || turn_error(&gimbals(), |matrix| Rotation::from_matrix(bands(9), matrix)),
        naive_method: "both Euler angles read off independently",
        naive: || turn_error(&gimbals(), |matrix| Rotation::from_matrix(bands(9), by_separate_angles(matrix))),
    }
}

pub(crate) fn half_turns() -> Case {
    Case {
        title: "rotation by 180°, and by 1e-7 less",
        bound: EULER,
        limit: 3e-14,
        ours: || turn_error(&about_axes(&[PI, PI - 1e-7, -PI]), |matrix| Rotation::from_matrix(bands(9), matrix)),
        naive_method: "angle from the trace, axis from the skew part",
        naive: || turn_error(&about_axes(&[PI, PI - 1e-7, -PI]), by_trace),
    }
}

pub(crate) fn tiny_turns() -> Case {
    Case {
        title: "rotation by 1e-3 to 1e-9",
        bound: EULER,
        limit: 3e-14,
        ours: || turn_error(&about_axes(&[1e-3, 1e-5, 1e-7, 1e-9]), |matrix| Rotation::from_matrix(bands(9), matrix)),
        naive_method: "angle from the trace, axis from the skew part",
        naive: || turn_error(&about_axes(&[1e-3, 1e-5, 1e-7, 1e-9]), by_trace),
    }
}

pub(crate) fn degree_128() -> Case {
    Case {
        title: "rotation matrix of degree 128",
        bound: "largest entry of M Mᵀ - 1 over 8 ε: five orthogonal factors, each within rounding",
        limit: 1.0,
        ours: || orthogonality(|turn| Rotation::from_f64(bands(129), turn).matrix(128)),
        naive_method: "Ivanic-Ruedenberg's recursion (ten times worse every ten degrees past 20)",
        naive: || orthogonality(|turn| matrices(129, DMat3::from_quat(turn), Text::Corrected).swap_remove(128)),
    }
}

pub(crate) fn turned_directions() -> Case {
    Case {
        title: "rotate then evaluate, evaluate where rotated; degree 128",
        bound: "error over sqrt((2l+1)/4π) ε ((4 + 2.5 l) + 2 (3 + 4 l)): one matrix, two evaluations away from the poles",
        limit: 1.0,
        ours: || turned_direction_error(|turn| Rotation::from_f64(bands(129), turn).matrix(128)),
        naive_method: "Ivanic-Ruedenberg's recursion",
        naive: || {
            turned_direction_error(|turn| matrices(129, DMat3::from_quat(turn), Text::Corrected).swap_remove(128))
        },
    }
}

pub(crate) fn ten_thousand_turns() -> Case {
    Case {
        title: "10,000 rotations in f32, random ones and 10,000 times the same",
        bound: "error of a unit vector of 9 bands: a quaternion loses up to ε/2 a step, 1e4 steps partly at random, times l = 8",
        limit: 1e-4,
        ours: || many_turns(one_rotation_at_the_end).error,
        naive_method: "coefficients rotated each time by Ivanic-Ruedenberg matrices in f32",
        naive: || many_turns(coefficients_each_time).error,
    }
}

pub(crate) fn length_after_ten_thousand_turns() -> Case {
    Case {
        title: "length of the coefficients after these 10,000 rotations",
        bound: "change of a length of 1: the one rotation at the end is orthogonal, 81 roundings to f32",
        limit: 3e-6,
        ours: || many_turns(one_rotation_at_the_end).drift,
        naive_method: "matrices multiplied in f32, never made orthonormal again",
        naive: || many_turns(matrices_multiplied).drift,
    }
}

pub(crate) fn composition_and_inverse() -> Case {
    Case {
        title: "R₂ R₁ and its inverse at 2 to 10 bands",
        bound: "error of a unit vector: three rotations at ε (4 + 2.5 l) an entry",
        limit: 1e-14,
        ours: || composition_error(|n, turn, values| Rotation::from_f64(bands(n), turn).apply(values)),
        naive_method: "Ivanic-Ruedenberg as printed: sqrt(1 - δ) in V for m < 0",
        naive: || {
            composition_error(|n, turn, values| {
                apply(&matrices(n as usize, DMat3::from_quat(turn), Text::Printed), values);
            })
        },
    }
}

fn bands(count: u32) -> Bands {
    Bands::new(count).expect("in range")
}

fn basis(bands: Bands, direction: DVec3) -> Vec<f64> {
    let mut out = vec![0.0; bands.coefficients()];
    evaluate_f64(bands, direction, &mut out);
    out
}

fn random_turn(rng: &mut Rng) -> DQuat {
    let mut number = || 2.0 * rng.next_f64() - 1.0;
    DQuat::from_xyzw(number(), number(), number(), number()).normalize()
}

/// Products of three turns, the middle one near 0 or π, with the rounding that such products carry.
fn gimbals() -> Vec<DMat3> {
    let noise = DMat3::from_cols(DVec3::Z * 1e-17, DVec3::ZERO, DVec3::X * 1e-17);
    let product =
        |beta: f64| DMat3::from_rotation_z(0.7) * DMat3::from_rotation_y(beta) * DMat3::from_rotation_z(-1.9) + noise;
    [0.0, 1e-17, 1e-12, 1e-9, 1e-5, PI - 1e-9, PI].map(product).to_vec()
}

fn about_axes(angles: &[f64]) -> Vec<DMat3> {
    let axes = [DVec3::X, DVec3::Y, DVec3::Z, DVec3::new(1.0, 1.0, 0.0), DVec3::ONE, DVec3::new(2.0, -3.0, 6.0)];
    let turns =
        axes.iter().flat_map(|axis| angles.iter().map(|&angle| DQuat::from_axis_angle(axis.normalize(), angle)));
    turns.map(DMat3::from_quat).collect()
}

/// Worst error of `Y(R v) = M Y(v)` at 9 bands.
fn turn_error(turns: &[DMat3], rotation: impl Fn(DMat3) -> Rotation) -> f64 {
    let direction = DVec3::new(2.0, -3.0, 6.0) / 7.0;
    let error = |&matrix: &DMat3| {
        let mut turned = basis(bands(9), direction);
        rotation(matrix).apply(&mut turned);
        difference(&turned, &basis(bands(9), matrix * direction))
    };
    worst(turns.iter().map(error))
}

/// The matrix rebuilt from Euler angles of which each was read off on its own.
fn by_separate_angles(matrix: DMat3) -> DMat3 {
    let [c0, c1, c2] = matrix.to_cols_array_2d();
    let (alpha, gamma) = (libm::atan2(c2[1], c2[0]), libm::atan2(c1[2], -c0[2]));
    let beta = libm::atan2(libm::hypot(c2[0], c2[1]), c2[2]);
    DMat3::from_rotation_z(alpha) * DMat3::from_rotation_y(beta) * DMat3::from_rotation_z(gamma)
}

/// The textbook's way from a matrix to an axis and an angle.
fn by_trace(matrix: DMat3) -> Rotation {
    let [c0, c1, c2] = matrix.to_cols_array_2d();
    let angle = libm::acos((0.5 * (c0[0] + c1[1] + c2[2] - 1.0)).clamp(-1.0, 1.0));
    let axis = DVec3::new(c1[2] - c2[1], c2[0] - c0[2], c0[1] - c1[0]) / (2.0 * libm::sin(angle));
    Rotation::from_matrix(bands(9), DMat3::from_axis_angle(axis, angle))
}

/// Largest entry of `M M^T - 1` of degree 128 over 8 eps, three random rotations.
fn orthogonality(matrix: impl Fn(DQuat) -> Vec<f64>) -> f64 {
    let mut rng = Rng::new(4, 0);
    let defect = |matrix: Vec<f64>| {
        let rows: Vec<&[f64]> = matrix.chunks_exact(257).collect();
        let entry = |(i, j): (usize, usize)| {
            let product: f64 = rows[i].iter().zip(rows[j]).map(|(a, b)| a * b).sum();
            (product - f64::from(u8::from(i == j))).abs() / (8.0 * f64::EPSILON)
        };
        worst((0..257).flat_map(|i| (0..=i).map(move |j| (i, j))).map(entry))
    };
    worst((0..3).map(|_| defect(matrix(random_turn(&mut rng)))))
}

/// Worst error of `Y(R v) = M Y(v)` at degree 128, as a share of what rounding may leave.
fn turned_direction_error(matrix: impl Fn(DQuat) -> Vec<f64>) -> f64 {
    let mut rng = Rng::new(11, 0);
    let l = 128;
    let size = (f64::from(2 * l + 1) / (4.0 * PI)).sqrt();
    let allowed = size * f64::EPSILON * (4.0 + 2.5 * f64::from(l) + 2.0 * (3.0 + 4.0 * f64::from(l)));
    let mut error = || {
        let turn = random_turn(&mut rng);
        let mut next = || random_turn(&mut rng) * DVec3::X;
        // both ends away from the poles, where a direction's own rounding weighs more
        let mut pairs = std::iter::from_fn(|| Some(next())).filter(|v| v.z.abs() < 0.9 && (turn * *v).z.abs() < 0.9);
        let direction = pairs.next().expect("most directions are");
        let band = |v: DVec3| basis(bands(129), v).split_off((l * l) as usize);
        let from = band(direction);
        let turned: Vec<f64> =
            matrix(turn).chunks_exact(257).map(|row| row.iter().zip(&from).map(|(m, y)| m * y).sum()).collect();
        difference(&turned, &band(turn * direction)) / allowed
    };
    worst((0..3).map(|_| error()))
}

/// How a unit vector of f32 coefficients is turned by many rotations.
type Turned = fn(&[f32], &[Quat]) -> Vec<f32>;

/// What 10,000 rotations in f32 do to a unit vector, against one rotation by the product of f64 quaternions.
struct Lost {
    error: f64,
    drift: f64,
}

/// The worst of 10,000 random turns, and of one turn of 0.1 and one of 2 radians, 10,000 times.
fn many_turns(turned: Turned) -> Lost {
    let mut rng = Rng::new(9, 0);
    let axis = DVec3::new(2.0, 3.0, -4.0).normalize();
    let same = |angle: f64| vec![DQuat::from_axis_angle(axis, angle); 10_000];
    let all: [Vec<DQuat>; 3] = [(0..10_000).map(|_| random_turn(&mut rng)).collect(), same(0.1), same(2.0)];
    let mut lost = Lost { error: 0.0, drift: 0.0 };
    for turns in all {
        // what all ways are given: quaternions in f32
        let turns: Vec<Quat> = turns.into_iter().map(DQuat::as_quat).collect();
        let start: Vec<f64> = (0..81).map(|_| rng.next_f64() - 0.5).collect();
        let mut truth: Vec<f64> = start.iter().map(|v| v / length(&start)).collect();
        let start: Vec<f32> = truth.iter().map(|&v| v as f32).collect();
        let step = |product: DQuat, turn: &Quat| (turn.as_dquat().normalize() * product).normalize();
        Rotation::from_f64(bands(9), turns.iter().fold(DQuat::IDENTITY, step)).apply(&mut truth);
        let found: Vec<f64> = turned(&start, &turns).into_iter().map(f64::from).collect();
        lost.error = worse(lost.error, difference(&found, &truth));
        lost.drift = worse(lost.drift, (length(&found) - length(&truth)).abs());
    }
    lost
}

fn length(values: &[f64]) -> f64 {
    values.iter().map(|v| v * v).sum::<f64>().sqrt()
}

fn one_rotation_at_the_end(start: &[f32], turns: &[Quat]) -> Vec<f32> {
    let product = turns.iter().fold(Quat::IDENTITY, |product, &turn| (turn * product).normalize());
    let mut values = start.to_vec();
    Rotation::new(bands(9), product).apply(&mut values);
    values
}

/// A product of 10,000 matrices in f32 that nobody made orthonormal again.
fn matrices_multiplied(start: &[f32], turns: &[Quat]) -> Vec<f32> {
    let product = turns.iter().fold(Mat3::IDENTITY, |product, &turn| Mat3::from_quat(turn) * product);
    let mut values: Vec<f64> = start.iter().map(|&v| f64::from(v)).collect();
    apply(&matrices(9, product.as_dmat3(), Text::Corrected), &mut values);
    values.into_iter().map(|v| v as f32).collect()
}

fn coefficients_each_time(start: &[f32], turns: &[Quat]) -> Vec<f32> {
    let mut values = start.to_vec();
    for &turn in turns {
        let rounded = Mat3::from_quat(turn).as_dmat3();
        for (l, matrix) in matrices(9, rounded, Text::Corrected).into_iter().enumerate() {
            let matrix: Vec<f32> = matrix.into_iter().map(|m| m as f32).collect();
            let band = &mut values[l * l..(l + 1) * (l + 1)];
            let turned: Vec<f32> =
                matrix.chunks_exact(2 * l + 1).map(|row| row.iter().zip(&*band).map(|(m, v)| m * v).sum()).collect();
            band.copy_from_slice(&turned);
        }
    }
    values
}

/// Multiplies each band by its matrix.
fn apply(matrices: &[Vec<f64>], values: &mut [f64]) {
    for (l, matrix) in matrices.iter().enumerate() {
        let band = &mut values[l * l..(l + 1) * (l + 1)];
        let turned: Vec<f64> =
            matrix.chunks_exact(2 * l + 1).map(|row| row.iter().zip(&*band).map(|(m, v)| m * v).sum()).collect();
        band.copy_from_slice(&turned);
    }
}

/// Two rotations against their product, and the product's inverse back to the start.
fn composition_error(rotate: impl Fn(u32, DQuat, &mut [f64])) -> f64 {
    let mut rng = Rng::new(5, 0);
    let error = |n: u32| {
        let (first, second) = (random_turn(&mut rng), random_turn(&mut rng));
        let start: Vec<f64> = (0..n * n).map(|_| rng.next_f64() - 0.5).collect();
        let start: Vec<f64> = start.iter().map(|v| v / length(&start)).collect();
        let (mut steps, mut once) = (start.clone(), start.clone());
        rotate(n, first, &mut steps);
        rotate(n, second, &mut steps);
        rotate(n, second * first, &mut once);
        let composed = difference(&steps, &once);
        rotate(n, (second * first).inverse(), &mut once);
        worse(composed, difference(&start, &once))
    };
    worst((2..=10).map(error))
}
