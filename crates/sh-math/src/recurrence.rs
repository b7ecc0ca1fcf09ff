//! Spherical harmonics of any degree by the normalised Cartesian recurrence.
//!
//! `Y_lm = Q_lm(z) Re (x + i y)^m` and `Y_l-m = Q_lm(z) Im (x + i y)^m`, where `Q_lm` is the normalised associated
//! Legendre function divided by `sin^m`. There is no factorial and no `sqrt(1 - z^2)`: both lose digits.
//! With `a_lm = sqrt((4 l^2 - 1) / (l^2 - m^2))` and `b_lm = sqrt(((l-1)^2 - m^2) / (4 (l-1)^2 - 1))`:
//! `Q_mm = Q_(m-1)(m-1) sqrt((2m+1) / (2m))`, `Q_lm = a_lm (z Q_(l-1)m - b_lm Q_(l-2)m)`.
//!
//! The error is at most `sqrt((2l+1)/(4 pi)) eps (3 + 2.5 l + 0.5 l^2)` for f32 to degree 128 and f64 to degree 1024.
//! Beyond degree 186 in f32 (about 1490 in f64) `Q` overflows next to the poles.

use crate::Bands;
use crate::value::{Real, Value};
use std::sync::OnceLock;

/// Writes the functions of the degrees `0..n_bands` at the unit vector `(x, y, z)` into `out[0..n_bands^2]`.
///
/// # Panics
/// When `out` is shorter than `n_bands^2`.
pub fn evaluate<T: Real>(n_bands: usize, [x, y, z]: [T; 3], out: &mut [T]) {
    let out = &mut out[..n_bands * n_bands];
    evaluate_into(n_bands, [x, y, z], |i, value| out[i] = value);
}

/// The recurrence over any [`Value`]; hands each function to `put` with its index, order by order.
#[inline(always)]
pub(crate) fn evaluate_into<V: Value>(n_bands: usize, [x, y, z]: [V; 3], mut put: impl FnMut(usize, V)) {
    let table = if n_bands <= TABLE { step_table() } else { &[] };
    // (x + i y)^m = cosine + i sine, times sin^m theta
    let (mut cosine, mut sine) = (V::of(1.0), V::of(0.0));
    let mut sectoral = (0.25 / std::f64::consts::PI).sqrt();
    for m in 0..n_bands {
        let (mut before, mut q) = (V::of(0.0), V::of(sectoral));
        for l in m..n_bands {
            if l > m {
                let known = table.get(l * (l - 1) / 2 + m).copied();
                let [a, ab] = known.unwrap_or_else(|| step(l, m));
                (before, q) = (q, V::of(a) * z * q - V::of(ab) * before);
            }
            put(l * (l + 1) + m, q * cosine);
            if m > 0 {
                put(l * (l + 1) - m, q * sine);
            }
        }
        (cosine, sine) = (x * cosine - y * sine, x * sine + y * cosine);
        sectoral *= sectoral_step(m + 1);
    }
}

/// `Q_mm / Q_(m-1)(m-1)`; the real functions of `m > 0` carry one `sqrt(2)`, which enters with m = 1.
fn sectoral_step(m: usize) -> f64 {
    let both = if m == 1 { 2.0 } else { 1.0 };
    (both * (2 * m + 1) as f64 / (2 * m) as f64).sqrt()
}

/// Bands whose constants are kept.
const TABLE: usize = Bands::MAX as usize;

/// `[a_lm, a_lm b_lm]` for `m < l < TABLE`, at `l (l - 1) / 2 + m`.
fn step_table() -> &'static [[f64; 2]] {
    static STEPS: OnceLock<Vec<[f64; 2]>> = OnceLock::new();
    STEPS.get_or_init(|| {
        let pairs = (0..TABLE).flat_map(|l| (0..l).map(move |m| (l, m)));
        pairs.map(|(l, m)| step(l, m)).collect()
    })
}

/// `[a_lm, a_lm b_lm]`, `l > m`, by the formulas at the head of this file.
fn step(l: usize, m: usize) -> [f64; 2] {
    let (l, m, k) = (l as f64, m as f64, l as f64 - 1.0);
    let a = ((4.0 * l * l - 1.0) / (l * l - m * m)).sqrt();
    // zero where Q_(l-2)m does not exist, also at l = 1 where the denominator is negative
    let b = ((k * k - m * m) / (4.0 * k * k - 1.0)).abs().sqrt();
    [a, a * b]
}
