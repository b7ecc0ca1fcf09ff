//! Rotation of coefficients.
//!
//! `R = Rz(alpha) Ry(beta) Rz(gamma)` and `Ry(beta) = Rx(-90) Rz(beta) Rx(90)`: three turns about z, which only mix the
//! cosine and the sine of one order, and two constant sparse quarter turns. The matrix is within `eps (4 + 2.5 l)` to
//! degree 128. Turn a direction often? Multiply the quaternions, normalise, and rotate coefficients once.

use crate::euler::{Euler, euler_from_matrix, matrix_from_quaternion};
use crate::quarter_turn::QuarterTurn;
use crate::{Bands, Real};
use glam::{DMat3, DQuat, Quat};

/// The matrix `M` with `Y(R v) = M Y(v)`; on coefficients it gives those of the function turned by `R`.
#[derive(Debug, Clone)]
pub struct Rotation {
    bands: Bands,
    /// Cosine and sine of the multiples `0..bands` of gamma, beta, alpha, in the order in which they are applied.
    turns: [Vec<[f64; 2]>; 3],
}

impl Rotation {
    /// The rotation by `quaternion`, of any finite length but zero.
    #[must_use]
    pub fn new(bands: Bands, quaternion: Quat) -> Self {
        Self::from_f64(bands, quaternion.as_dquat())
    }

    /// [`Rotation::new`] with a quaternion in f64.
    #[must_use]
    pub fn from_f64(bands: Bands, quaternion: DQuat) -> Self {
        debug_assert!(quaternion.length_squared() > 0.0, "a rotation needs a quaternion other than zero");
        Self::from_matrix(bands, matrix_from_quaternion(quaternion))
    }

    /// The rotation by an orthonormal matrix; an entry off by `d` costs about `0.6 l d`.
    #[must_use]
    pub fn from_matrix(bands: Bands, rotation: DMat3) -> Self {
        let Euler { alpha, beta, gamma } = euler_from_matrix(rotation);
        Self { bands, turns: [gamma, beta, alpha].map(|angle| multiples(bands, angle)) }
    }

    /// Number of bands that it was built for.
    #[must_use]
    pub fn bands(&self) -> Bands {
        self.bands
    }

    /// Rotates one vector of coefficients in place; fewer bands than it was built for are fine.
    ///
    /// # Panics
    /// When `values` ends inside a band, or has more bands than the rotation.
    pub fn apply<T: Real>(&self, values: &mut [T]) {
        self.apply_interleaved(values, 1);
    }

    /// Rotates `channels` vectors at once that lie interleaved: `values[coefficient * channels + channel]`.
    ///
    /// All arithmetic is in f64; f32 is rounded once at the end.
    ///
    /// # Panics
    /// As [`Rotation::apply`], and when `channels` is zero.
    pub fn apply_interleaved<T: Real>(&self, values: &mut [T], channels: usize) {
        let count = (values.len() / channels).isqrt();
        assert!(count * count * channels == values.len(), "coefficients end inside a band");
        assert!(count <= self.bands.count(), "more bands than the rotation was built for");
        let mut scratch = vec![0.0; 4 * count];
        let (band, turned) = scratch.split_at_mut(2 * count);
        for l in 1..count {
            let rows = &mut values[l * l * channels..(l + 1) * (l + 1) * channels];
            let (band, turned) = (&mut band[..2 * l + 1], &mut turned[..2 * l + 1]);
            for channel in 0..channels {
                let own = rows[channel..].iter().step_by(channels);
                band.iter_mut().zip(own).for_each(|(to, from)| *to = from.to_f64());
                self.rotate_band(l, band, turned);
                let own = rows[channel..].iter_mut().step_by(channels);
                own.zip(&*band).for_each(|(to, from)| *to = T::from_f64(*from));
            }
        }
    }

    /// The matrix of degree `l`, row-major, `(2 l + 1)^2` entries, orders `-l..=l`.
    ///
    /// # Panics
    /// When `l` is not below the number of bands.
    #[must_use]
    pub fn matrix(&self, l: usize) -> Vec<f64> {
        assert!(l < self.bands.count(), "the rotation has no such band");
        let size = 2 * l + 1;
        let mut matrix = vec![0.0; size * size];
        let (mut band, mut turned) = (vec![0.0; size], vec![0.0; size]);
        for column in 0..size {
            band.fill(0.0);
            band[column] = 1.0;
            self.rotate_band(l, &mut band, &mut turned);
            for (row, value) in band.iter().enumerate() {
                matrix[row * size + column] = *value;
            }
        }
        matrix
    }

    /// The five turns on one band, orders `-l..=l`; `turned` is scratch of the same length.
    fn rotate_band(&self, l: usize, band: &mut [f64], turned: &mut [f64]) {
        let quarter = QuarterTurn::of_degree(l);
        turn_about_z(&self.turns[0], band);
        quarter.turn(band, turned);
        turn_about_z(&self.turns[1], turned);
        quarter.turn_back(turned, band);
        turn_about_z(&self.turns[2], band);
    }
}

/// Cosine and sine of `m * angle` for `m` in `0..bands`.
fn multiples(bands: Bands, angle: f64) -> Vec<[f64; 2]> {
    let cosine_and_sine = |m| {
        let (sine, cosine) = libm::sincos(m as f64 * angle);
        [cosine, sine]
    };
    bands.degrees().map(cosine_and_sine).collect()
}

/// Turns one band about z: the pair of order m by m times the angle.
fn turn_about_z(multiples: &[[f64; 2]], band: &mut [f64]) {
    let l = band.len() / 2;
    for m in 1..=l {
        let [cosine, sine] = multiples[m];
        let (c, s) = (band[l + m], band[l - m]);
        band[l + m] = cosine * c - sine * s;
        band[l - m] = sine * c + cosine * s;
    }
}
