//! What an encoding costs where it is seen: the error of irradiance at the normals that a normal map may ask for.

use crate::Lit;
use glam::Vec3;
use sh_math::hemisphere::Basis;

/// Difference of irradiance / pi over texels, normals and channels.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MapError {
    /// Root of the mean square.
    pub rms: f64,
    /// The largest.
    pub worst: f64,
    /// Mean of the exact irradiance / pi, which relative errors are told against.
    pub mean: f64,
    /// Row and column where it is largest.
    pub worst_texel: [u32; 2],
    /// Texels that were compared.
    pub texels: u64,
}

impl MapError {
    /// [`MapError::rms`] against the mean; 0 where nothing differs.
    #[must_use]
    pub fn rms_relative(&self) -> f64 {
        relative(self.rms, self.mean)
    }

    /// [`MapError::worst`] against the mean; 0 where nothing differs.
    #[must_use]
    pub fn worst_relative(&self) -> f64 {
        relative(self.worst, self.mean)
    }
}

fn relative(error: f64, mean: f64) -> f64 {
    if error == 0.0 { 0.0 } else { error / mean.abs() }
}

/// `count` unit vectors of the upper hemisphere (tangent space), each of the same solid angle: a golden spiral.
#[must_use]
pub fn normals(count: u32) -> Vec<Vec3> {
    let turn = std::f64::consts::PI * (3.0 - 5.0_f64.sqrt());
    let normal = |i: u32| {
        let z = 1.0 - (f64::from(i) + 0.5) / f64::from(count);
        let (sine, cosine) = libm::sincos(turn * f64::from(i));
        let radius = (1.0 - z * z).sqrt();
        Vec3::new((radius * cosine) as f32, (radius * sine) as f32, z as f32)
    };
    (0..count).map(normal).collect()
}

impl Lit {
    /// The error of these coefficients of `basis` against the exact ones, over the texels that belong to a chart (all where `charts` is
    /// empty, see [`crate::Coding::charts`]) and `normals` (tangent space).
    ///
    /// # Panics
    /// When the sizes differ, or there are fewer functions than those of the basis.
    #[must_use]
    pub fn error(&self, exact: &Self, basis: Basis, charts: &[u32], normals: &[Vec3]) -> MapError {
        assert_eq!((self.width, self.height), (exact.width, exact.height), "the same texels");
        let plane = self.width as usize * self.height as usize;
        let at = |lit: &Self, texel: usize| -> [[f32; 3]; Basis::MAX_COUNT] {
            std::array::from_fn(|k| if k < basis.count() { lit.functions[k][texel] } else { [0.0; 3] })
        };
        let (mut square, mut sum, mut worst, mut texels) = (0.0, 0.0, (0.0, 0), 0_u64);
        for texel in (0..plane).filter(|texel| charts.get(*texel).is_none_or(|chart| *chart != u32::MAX)) {
            let (ours, theirs) = (at(self, texel), at(exact, texel));
            for normal in normals {
                let (a, b) = (basis.reconstruct(&ours, *normal), basis.reconstruct(&theirs, *normal));
                for c in 0..3 {
                    let difference = (f64::from(a[c]) - f64::from(b[c])).abs();
                    square += difference * difference;
                    sum += f64::from(b[c]);
                    worst = if difference > worst.0 { (difference, texel) } else { worst };
                }
            }
            texels += 1;
        }
        let numbers = (texels as f64 * normals.len() as f64 * 3.0).max(1.0);
        let place = [worst.1 as u32 / self.width.max(1), worst.1 as u32 % self.width.max(1)];
        MapError { rms: (square / numbers).sqrt(), worst: worst.0, mean: sum / numbers, worst_texel: place, texels }
    }
}
