//! Euler angles of a rotation, also where they are not unique.

use glam::{DMat3, DQuat};

/// Angles of `R = Rz(alpha) Ry(beta) Rz(gamma)`, radians.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Euler {
    pub(crate) alpha: f64,
    pub(crate) beta: f64,
    pub(crate) gamma: f64,
}

/// The rotation matrix of a quaternion of any length but zero; normalised in f64.
pub(crate) fn matrix_from_quaternion(quaternion: DQuat) -> DMat3 {
    DMat3::from_quat(quaternion.normalize())
}

/// Angles one after the other: gamma is read off *after* alpha has been undone.
///
/// Reading alpha and gamma each on its own from `R` is wrong by O(1) where beta is near 0 or pi: there only their sum (or
/// difference) is determined, and rounding splits it differently in the two readings.
pub(crate) fn euler_from_matrix(rotation: DMat3) -> Euler {
    // columns of R: R[row][column] = columns[column][row]
    let [c0, c1, c2] = rotation.to_cols_array_2d();
    let horizontal = libm::hypot(c2[0], c2[1]);
    let beta = libm::atan2(horizontal, c2[2]);
    let alpha = if horizontal == 0.0 { 0.0 } else { libm::atan2(c2[1], c2[0]) };
    let (sin_alpha, cos_alpha) = libm::sincos(alpha);
    // second row of Rz(-alpha) R = Ry(beta) Rz(gamma) is (sin gamma, cos gamma, 0)
    let sin_gamma = cos_alpha * c0[1] - sin_alpha * c0[0];
    let cos_gamma = cos_alpha * c1[1] - sin_alpha * c1[0];
    Euler { alpha, beta, gamma: libm::atan2(sin_gamma, cos_gamma) }
}
