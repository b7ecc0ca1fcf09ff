//! The error where it is seen: at the normals that normal maps hold.

use super::residual::harmonics;
use super::sheet::Plate;
use super::{Drawn, PICKED, against};
use bake::Directional;
use glam::{DVec3, Vec3};
use sh_math::hemisphere::Basis;

/// Texels that are looked at, evenly picked.
const MOST_TEXELS: usize = 1 << 14;
/// Bits of an f32 that errors are not told apart by: 9 of its digits are left, steps of 0.2 %.
const DROPPED: u32 = 14;

/// Texels, the normals that each is drawn with, and the truth there.
pub(super) struct Views<'a> {
    /// Of each sheet the normals that it is drawn with.
    normals: Vec<Vec<DVec3>>,
    looks: Vec<Look<'a>>,
    /// Mean of irradiance / pi over texels, normals and channels.
    pub(super) mean: f64,
    /// Share of it that is below 0.
    pub(super) negative: f64,
}

/// One texel.
struct Look<'a> {
    plate: usize,
    place: &'a [u32; 2],
    /// Irradiance / pi at each normal of its sheet.
    truth: Vec<[f64; 3]>,
}

impl<'a> Views<'a> {
    /// Sheets with normal maps are drawn with the normals `picked`, others with the surface's own.
    pub(super) fn new(plates: &[Plate], found: &'a Directional, picked: &[Vec3]) -> Self {
        let own = vec![DVec3::Z];
        let bent: Vec<DVec3> = picked.iter().map(|normal| normal.as_dvec3().normalize()).collect();
        let of = |plate: &Plate| if plate.is_bent && !bent.is_empty() { bent.clone() } else { own.clone() };
        let normals: Vec<Vec<DVec3>> = plates.iter().map(of).collect();
        let values: Vec<Vec<_>> = normals.iter().map(|list| list.iter().map(|&n| harmonics(n)).collect()).collect();
        let step = found.texels.len().div_ceil(MOST_TEXELS).max(1);
        let look = |texel: &'a bake::DirectionalTexel| {
            let at = |harmonics: &[f64; sh_math::hemisphere::HARMONICS]| {
                let channel =
                    |c: usize| harmonics.iter().zip(&texel.coefficients).map(|(y, rgb)| y * f64::from(rgb[c])).sum();
                [0, 1, 2].map(channel)
            };
            let plate = texel.sheet as usize;
            Look { plate, place: &texel.place, truth: values[plate].iter().map(at).collect() }
        };
        let looks: Vec<Look<'_>> = found.texels.iter().step_by(step).map(look).collect();
        let of_look = |look: &Look<'_>| look.truth.iter().flatten().sum::<f64>() / (3 * look.truth.len()) as f64;
        let mean = looks.iter().map(of_look).sum::<f64>() / looks.len().max(1) as f64;
        let below = |look: &Look<'_>| {
            look.truth.iter().flatten().filter(|value| **value < 0.0).count() as f64 / (3 * look.truth.len()) as f64
        };
        let negative = looks.iter().map(below).sum::<f64>() / looks.len().max(1) as f64;
        Self { normals, looks, mean, negative }
    }

    /// The error of coefficients of `basis` as decoded, `[sheet][function][row][column][channel]`.
    pub(super) fn error(&self, basis: Basis, plates: &[Plate], decoded: &[Vec<f32>]) -> Drawn {
        let functions: Vec<Vec<[f64; Basis::MAX_COUNT]>> = plates
            .iter()
            .zip(&self.normals)
            .map(|(plate, normals)| normals.iter().map(|&normal| evaluated(plate.held(basis), normal)).collect())
            .collect();
        let (mut square, mut spread) = (0.0, Spread::new());
        for look in &self.looks {
            let (plate, values) = (&plates[look.plate], &decoded[look.plate]);
            let plane = (plate.size[0] as usize) * plate.size[1] as usize;
            let count = plate.held(basis).count();
            let start = |k: usize| 3 * (k * plane + plate.index(*look.place));
            let own: Vec<[f64; 3]> = (0..count).map(|k| [0, 1, 2].map(|c| f64::from(values[start(k) + c]))).collect();
            let mut sum = 0.0;
            for (truth, functions) in look.truth.iter().zip(&functions[look.plate]) {
                for c in 0..3 {
                    let value: f64 = own.iter().zip(functions).map(|(rgb, function)| rgb[c] * function).sum();
                    let difference = value - truth[c];
                    sum += difference * difference;
                    spread.add(difference, (PICKED / look.truth.len()) as u64);
                }
            }
            square += sum / (3 * look.truth.len()) as f64;
        }
        let rms = (square / self.looks.len().max(1) as f64).sqrt();
        Drawn { rms: against(rms, self.mean), p99: against(spread.below(0.99), self.mean) }
    }
}

fn evaluated(basis: Basis, normal: DVec3) -> [f64; Basis::MAX_COUNT] {
    let mut values = [0.0; Basis::MAX_COUNT];
    basis.evaluate_f64(normal, &mut values);
    values
}

/// How often errors of each size were met: memory that does not grow with their number.
struct Spread(Vec<u64>);

impl Spread {
    fn new() -> Self {
        Self(vec![0; 1 << (31 - DROPPED)])
    }

    fn add(&mut self, difference: f64, times: u64) {
        self.0[((difference.abs() as f32).to_bits() >> DROPPED) as usize] += times;
    }

    /// The size that a share of the errors does not exceed; 0 where there are none.
    fn below(&self, share: f64) -> f64 {
        let total: u64 = self.0.iter().sum();
        let wanted = (share * total as f64).ceil() as u64;
        let mut seen = 0;
        let bucket = self.0.iter().position(|count| {
            seen += count;
            seen >= wanted && seen > 0
        });
        // The lower end of a bucket: what is exact stays 0.
        bucket.map_or(0.0, |bucket| f64::from(f32::from_bits((bucket as u32) << DROPPED)))
    }
}
