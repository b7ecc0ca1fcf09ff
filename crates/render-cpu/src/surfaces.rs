//! What a scene's texels and vertices know of what arrives, kept for one light.

use crate::gloss::{Gloss, Receivers};
use crate::lit::LitSurfaces;
use coeff_io::{GlossView, Prt};
use glam::{Quat, Vec3, Vec4};
use sh_math::light_matrix::LightProduct;
use sh_math::{Bands, Rgb};
use std::sync::{Arc, Mutex, PoisonError};

/// What is the same for all lights, and what is kept of the last one.
#[derive(Debug)]
pub(crate) struct Surfaces {
    /// The mesh of each triangle; empty where neither texels nor vertices know what arrives.
    meshes: Vec<u32>,
    /// Products of light and visibility; none where no surface knows what arrives.
    product: Option<LightProduct>,
    /// Receivers under the light of the last frame.
    lit: Mutex<Option<Arc<LitSurfaces>>>,
}

/// Surfaces in one frame.
#[derive(Debug)]
pub(crate) struct Drawn<'a> {
    meshes: &'a [u32],
    lit: Option<Arc<LitSurfaces>>,
    /// The lobe; present where the file tells what arrives at surfaces.
    pub(crate) gloss: Option<Gloss>,
    /// `[vertex]`: mirrored light and visibility; empty where no vertex shines.
    vertices: Vec<Vec4>,
}

impl Surfaces {
    /// Those of a sound file.
    pub(crate) fn new(prt: &Prt) -> Self {
        let bands = prt.gloss.as_ref().and_then(|gloss| Bands::new(gloss.bands));
        Self { meshes: meshes(prt), product: bands.map(LightProduct::new), lit: Mutex::default() }
    }

    /// Forgets the last light.
    pub(crate) fn forget(&mut self) {
        self.lit = Mutex::default();
    }

    /// Under `light`, turned by `rotation` already, seen from `eye`.
    pub(crate) fn draw(&self, prt: &Prt, light: &Rgb, rotation: Quat, view: GlossView, eye: [f32; 3]) -> Drawn<'_> {
        let lit = (!self.meshes.is_empty()).then(|| self.under(prt, light, rotation));
        let gloss = self.product.as_ref().map(|product| Gloss::new(product.bands(), view, light));
        let vertices = match (&gloss, &lit) {
            (Some(gloss), Some(lit)) => gloss.at_vertices(prt, lit, Vec3::from(eye)),
            _ => Vec::new(),
        };
        Drawn { meshes: &self.meshes, lit, gloss, vertices }
    }

    /// The receivers under the turned light: those of the last frame where it has not turned since.
    fn under(&self, prt: &Prt, light: &Rgb, rotation: Quat) -> Arc<LitSurfaces> {
        // A panic elsewhere leaves whole surfaces or none.
        let mut held = self.lit.lock().unwrap_or_else(PoisonError::into_inner);
        match held.take().filter(|lit| lit.rotation == rotation) {
            Some(lit) => held.insert(lit).clone(),
            None => held.insert(Arc::new(LitSurfaces::new(prt, self.product.as_ref(), light, rotation))).clone(),
        }
    }
}

impl Drawn<'_> {
    /// What triangles read; none where the file has vertices without gloss only.
    pub(crate) fn receivers(&self) -> Option<Receivers<'_>> {
        let lit = self.lit.as_deref()?;
        Some(Receivers { meshes: self.meshes, lit, vertices: &self.vertices })
    }
}

/// The mesh of each triangle, where texels or vertices know what arrives.
fn meshes(prt: &Prt) -> Vec<u32> {
    let vertices = prt.gloss.as_ref().is_some_and(|gloss| gloss.vertices.is_some());
    if !vertices && prt.transfer_textures.is_none() {
        return Vec::new();
    }
    let mut out = vec![0; prt.geometry.triangles.len()];
    for (index, mesh) in (0..).zip(&prt.meshes) {
        let first = mesh.first_triangle as usize;
        out[first..first + mesh.triangles as usize].fill(index);
    }
    out
}
