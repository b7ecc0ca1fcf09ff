//! How far a transfer is from the reference, receiver by receiver and under a light.

use coeff_io::Transfer;
use glam::Vec3;
use sh_math::{Bands, zonal};

/// Median, 95th percentile and largest of a set of errors.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Spread {
    /// Half of the receivers are below.
    pub median: f64,
    /// 95 of 100 receivers are below.
    pub p95: f64,
    /// None is above.
    pub worst: f64,
}

impl Spread {
    /// The spread of a set of errors; zeros where it is empty.
    #[must_use]
    pub fn of(errors: &[f32]) -> Self {
        let mut sorted = errors.to_vec();
        sorted.sort_by(f32::total_cmp);
        let at = |share: f64| {
            let index = (sorted.len().saturating_sub(1)) as f64 * share;
            sorted.get(index as usize).map_or(0.0, |&e| f64::from(e))
        };
        Self { median: at(0.5), p95: at(0.95), worst: at(1.0) }
    }
}

/// A transfer that others are compared with, and the light.
#[derive(Debug)]
pub struct Truth {
    /// What is taken for true; three channels or one.
    pub transfer: Transfer,
    /// Coefficients of the light in at least as many bands.
    pub light: Vec<[f32; 3]>,
}

/// How far one transfer is from the [`Truth`].
#[derive(Debug, Clone, PartialEq)]
pub struct Deviation {
    /// Per receiver: Euclidean norm of the difference over the bands of the transfer, against the norm of a receiver
    /// with an open view; the largest of the channels. The unit of `--error`.
    pub receivers: Vec<f32>,
    /// Mean of the absolute difference of outgoing radiance over its mean, in the bands of the transfer.
    pub radiance: f64,
    /// The same against all bands of the truth.
    pub radiance_all_bands: f64,
}

/// Norm of the transfer of a receiver with an open view, in so many bands.
///
/// # Panics
/// Where `bands` is not supported; bakes check it.
#[must_use]
pub fn open_norm(bands: u32) -> f64 {
    let bands = Bands::new(bands).expect("a bake has a supported number of bands");
    let mut open = vec![0.0f32; bands.coefficients()];
    zonal::cosine_transfer(bands, Vec3::Z, &mut open);
    open.iter().map(|&x| f64::from(x) * f64::from(x)).sum::<f64>().sqrt()
}

impl Truth {
    /// Compares a transfer of the same receivers, of as many bands or fewer, with the truth.
    ///
    /// Transfer has no albedo of its own in it, so one channel stands for three equal ones.
    #[must_use]
    pub fn deviation(&self, of: &Transfer) -> Deviation {
        let norm = open_norm(of.bands);
        let (own, all) = ((of.bands * of.bands) as usize, (self.transfer.bands * self.transfer.bands) as usize);
        let receivers = self.transfer.albedo.len().min(of.albedo.len());
        let mut errors = Vec::with_capacity(receivers);
        let (mut off, mut off_all, mut sum, mut sum_all) = (0.0f64, 0.0f64, 0.0f64, 0.0f64);
        for r in 0..receivers {
            let mut largest = 0.0f64;
            for c in 0..3 {
                let (truth, value) = (row(&self.transfer, r, c), row(of, r, c));
                let (mut square, mut difference, mut radiance) = (0.0f64, 0.0f64, 0.0f64);
                for ((t, v), light) in truth.iter().zip(&value).zip(&self.light).take(own) {
                    square += (v - t) * (v - t);
                    difference += (v - t) * f64::from(light[c]);
                    radiance += t * f64::from(light[c]);
                }
                let beyond = (own..all).map(|i| truth[i] * f64::from(self.light[i][c])).sum::<f64>();
                let albedo = f64::from(self.transfer.albedo[r][c]);
                off += albedo * difference.abs();
                sum += albedo * radiance.abs();
                off_all += albedo * (difference - beyond).abs();
                sum_all += albedo * (radiance + beyond).abs();
                largest = largest.max(square);
            }
            errors.push((largest.sqrt() / norm) as f32);
        }
        Deviation { receivers: errors, radiance: share(off, sum), radiance_all_bands: share(off_all, sum_all) }
    }
}

/// The coefficients of one receiver in one channel.
fn row(transfer: &Transfer, receiver: usize, channel: usize) -> Vec<f64> {
    let (n, channels) = ((transfer.bands * transfer.bands) as usize, transfer.channels as usize);
    let at = |i: usize| transfer.values[(receiver * n + i) * channels + channel.min(channels - 1)];
    (0..n).map(|i| f64::from(at(i))).collect()
}

/// `part / whole`; a scene in the dark has no relative error.
fn share(part: f64, whole: f64) -> f64 {
    if whole > 0.0 { part / whole } else { 0.0 }
}
