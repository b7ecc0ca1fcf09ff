//! Many texels at once, each with coefficients and a normal of its own.

use super::Basis;
use glam::Vec3;

/// Calls `Basis::each` with the basis as a constant, so that its functions are laid out straight in the loop.
macro_rules! each {
    ($basis:expr, $arguments:tt: $($name:ident)*) => {
        match $basis { $(Basis::$name => Basis::$name.each $arguments,)* }
    };
}

impl Basis {
    /// Writes the signal of texel `j` at the unit vector `normals[j]` (its tangent space) into `out[j]`; `coefficients` are
    /// `[texel][function][channel]`.
    ///
    /// Every value equals [`Basis::reconstruct`] bit for bit.
    ///
    /// # Panics
    /// When `out` is not as long as `normals`, or `coefficients` not `self.count()` times as long.
    pub fn reconstruct_batch(self, coefficients: &[[f32; 3]], normals: &[Vec3], out: &mut [[f32; 3]]) {
        assert_eq!(normals.len(), out.len(), "one result per normal");
        assert_eq!(normals.len() * self.count(), coefficients.len(), "each texel needs its own coefficients");
        each!(self, (coefficients, normals, out):
            Sh4 Sh9 Hl2 Hsh4 Hsh9 Makhotkin4 Makhotkin9 Zernike3 Zernike6 H4 H6 ModifiedH1 ModifiedH4 ModifiedH6);
    }

    #[inline(always)]
    fn each(self, coefficients: &[[f32; 3]], normals: &[Vec3], out: &mut [[f32; 3]]) {
        let texels = coefficients.chunks_exact(self.count()).zip(normals);
        for ((coefficients, normal), out) in texels.zip(out) {
            *out = self.reconstruct(coefficients, *normal);
        }
    }
}
