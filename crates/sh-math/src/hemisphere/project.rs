//! From samples over the hemisphere to coefficients of a basis.

use super::Basis;
use crate::{Bands, project, zonal};
use glam::DVec3;

impl Basis {
    /// Least-squares coefficients (`[function][channel]`) of a signal over normals, such as irradiance / pi, from samples
    /// `(unit normal in tangent space, value * solid angle of the sample)`.
    ///
    /// N normals spread evenly over the hemisphere have the solid angle `2 pi / N`. Sums are in f64, in the order of the
    /// samples.
    pub fn project_irradiance(self, samples: impl IntoIterator<Item = (DVec3, [f64; 3])>) -> Vec<[f32; 3]> {
        let rows = self.least_squares(samples);
        rows.into_iter().map(|row| row.map(|channel| channel as f32)).collect()
    }

    /// Coefficients (`[function][channel]`) of irradiance / pi over normals, from samples of the radiance that arrives:
    /// `(unit direction in tangent space, radiance * solid angle of the sample)` (eqs. 2.1 to 2.4).
    ///
    /// By way of 3 bands of spherical harmonics, convolved with the clamped cosine: what the paper bakes. Light of a small
    /// lamp at the horizon is smeared by that; the exact irradiance of each normal goes to [`Basis::project_irradiance`].
    pub fn project_radiance(self, samples: impl IntoIterator<Item = (DVec3, [f64; 3])>) -> Vec<[f32; 3]> {
        let bands = Bands::new(3).expect("3 bands exist");
        let factors = [0, 1, 2].map(zonal::clamped_cosine);
        self.conversion().apply(&project(bands, samples).windowed(&factors))
    }
}
