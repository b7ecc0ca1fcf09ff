//! The spherical harmonics of the paper's listing: factorials, the unnormalised Legendre function, angles.

use glam::DVec3;
use std::f64::consts::PI;

/// Precision and powers of one reading of the listing.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Listing {
    /// Rounds every intermediate value.
    pub(crate) round: fn(f64) -> f64,
    /// The power of `1 - z^2` for the order m.
    pub(crate) exponent: fn(i32) -> f64,
}

/// In f64, with the right exponent.
pub(crate) const DOUBLE: Listing = Listing { round: |v| v, exponent: |m| 0.5 * f64::from(m) };
/// In f32, with the right exponent.
pub(crate) const SINGLE: Listing = Listing { round: |v| f64::from(v as f32), ..DOUBLE };
/// In f64, with the printed division of integers, `m / 2`.
pub(crate) const PRINTED: Listing = Listing { exponent: |m| f64::from(m / 2), ..DOUBLE };

impl Listing {
    /// All functions of the degrees `0..n_bands` at a unit direction.
    pub(crate) fn evaluate(&self, n_bands: usize, direction: DVec3) -> Vec<f64> {
        let (z, phi) = (direction.z, libm::atan2(direction.y, direction.x));
        let mut out = Vec::with_capacity(n_bands * n_bands);
        for l in 0..n_bands as i32 {
            for m in -l..=l {
                let order = m.abs();
                let angle = f64::from(order) * phi;
                let turn = match m {
                    0 => 1.0,
                    1.. => std::f64::consts::SQRT_2 * libm::cos(angle),
                    _ => std::f64::consts::SQRT_2 * libm::sin(angle),
                };
                out.push((self.round)(self.norm(l, order) * self.legendre(l, order, z) * turn));
            }
        }
        out
    }

    /// `sqrt((2l + 1) / (4 pi) (l - m)! / (l + m)!)`.
    fn norm(&self, l: i32, m: i32) -> f64 {
        let ratio =
            (self.round)(f64::from(2 * l + 1) * self.factorial(l - m)) / (self.round)(4.0 * PI * self.factorial(l + m));
        (self.round)(ratio.sqrt())
    }

    fn factorial(&self, n: i32) -> f64 {
        (1..=n).fold(1.0, |product, k| (self.round)(product * f64::from(k)))
    }

    /// `P_lm` from `P_mm = (2m - 1)!! (1 - z^2)^(m/2)`, without the phase.
    fn legendre(&self, l: i32, m: i32, z: f64) -> f64 {
        let round = self.round;
        let double_factorial = (1..=m).fold(1.0, |product, k| round(product * f64::from(2 * k - 1)));
        let power = round(libm::pow(round(1.0 - round(z * z)), (self.exponent)(m)));
        let (mut before, mut p) = (0.0, round(double_factorial * power));
        for k in m + 1..=l {
            let next = (f64::from(2 * k - 1) * z * p - f64::from(k + m - 1) * before) / f64::from(k - m);
            (before, p) = (p, round(next));
        }
        p
    }
}
