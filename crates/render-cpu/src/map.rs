//! Directional light maps under a light: docs/shading.md, "Light maps".

use crate::texture::neighbours;
use coeff_io::{Prt, Wrap};
use glam::{Quat, Vec2, Vec3};
use rayon::prelude::*;
use sh_math::{Rgb, hemisphere::Basis};

/// Marks triangles whose light comes from their vertices.
const NO_SHEET: u32 = u32::MAX;

/// All light maps of a scene, ready to be looked up.
#[derive(Debug)]
pub(crate) struct LitMaps {
    /// What they are made for.
    pub(crate) rotation: Quat,
    pub(crate) basis: Basis,
    pub(crate) sheets: Vec<Sheet>,
}

/// One light map: the coefficients of a texel lie together.
#[derive(Debug)]
pub(crate) struct Sheet {
    basis: Basis,
    width: u32,
    height: u32,
    /// `[row][column][function]`, RGB.
    coefficients: Vec<[f32; 3]>,
}

impl LitMaps {
    /// Lights the maps of a sound file by `light` (turned by `rotation` already) and brings them into `basis`.
    pub(crate) fn new(prt: &Prt, light: &Rgb, rotation: Quat, basis: Basis) -> Self {
        let sheets = prt.maps.as_ref().map_or_else(Vec::new, |maps| {
            maps.sheets.par_iter().map(|sheet| Sheet::new(maps.lit_in(sheet, light, basis))).collect()
        });
        Self { rotation, basis, sheets }
    }
}

impl Sheet {
    fn new((basis, lit): (Basis, coeff_io::Lit)) -> Self {
        let texels = lit.functions.first().map_or(0, Vec::len);
        let coefficients = (0..texels).flat_map(|texel| lit.functions.iter().map(move |function| function[texel]));
        Self { basis, width: lit.width, height: lit.height, coefficients: coefficients.collect() }
    }

    /// Radiance of a white surface whose normal in the tangent frame is the unit vector `normal`; not clamped.
    pub(crate) fn radiance(&self, uv: Vec2, normal: Vec3) -> Vec3 {
        let count = self.basis.count();
        let mut functions = [0.0; Basis::MAX_COUNT];
        self.basis.evaluate(normal, &mut functions);
        let (columns, fx) = neighbours(uv.x, self.width, Wrap::Clamp);
        let (rows, fy) = neighbours(uv.y, self.height, Wrap::Clamp);
        let texel = |i: usize, j: usize| {
            let first = (rows[j] * self.width as usize + columns[i]) * count;
            let pairs = self.coefficients[first..first + count].iter().zip(functions);
            pairs.map(|(&coefficient, function)| Vec3::from(coefficient) * function).sum::<Vec3>()
        };
        texel(0, 0).lerp(texel(1, 0), fx).lerp(texel(0, 1).lerp(texel(1, 1), fx), fy)
    }
}

/// The light map of each triangle; empty where no mesh has one.
pub(crate) fn sheet_of_triangle(prt: &Prt) -> Vec<u32> {
    let Some(maps) = prt.maps.as_ref().filter(|maps| maps.are_shown()) else {
        return Vec::new();
    };
    let mut out = vec![NO_SHEET; prt.geometry.triangles.len()];
    for (mesh, sheet) in prt.meshes.iter().zip(&maps.sheet_of_mesh) {
        let first = mesh.first_triangle as usize;
        out[first..first + mesh.triangles as usize].fill(sheet.unwrap_or(NO_SHEET));
    }
    out
}
