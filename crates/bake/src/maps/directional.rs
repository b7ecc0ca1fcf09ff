//! What arrives at texels before any basis: what bases are judged by.

use super::{Gathered, MapSettings, SheetSettings, functions, gather};
use crate::bake::bake_then;
use crate::domain::Domain;
use crate::extras::{Done, Extras, FixedLight};
use crate::refine::refined;
use crate::{Error, ProgressFn};
use coeff_io::{Encoding, Settings};
use rayon::prelude::*;
use scene::Scene;
use sh_math::hemisphere::{Basis, HARMONICS};

/// What light arrives at the texels of sheets, before any basis: 5 bands of spherical harmonics of irradiance / pi over the normals of the
/// tangent frame. What bases are judged by.
#[derive(Debug, Clone)]
pub struct Directional {
    /// The texels that see something, sheet after sheet.
    pub texels: Vec<DirectionalTexel>,
    /// Any-hit and closest-hit rays traced.
    pub rays: u64,
}

/// One texel of [`Directional`].
#[derive(Debug, Clone)]
pub struct DirectionalTexel {
    /// Index of the sheet.
    pub sheet: u32,
    /// Row and column.
    pub place: [u32; 2],
    /// `[harmonic of 25]`, RGB.
    pub coefficients: [[f32; 3]; 25],
}

/// Bakes a scene under one light and returns what arrives at the texels of sheets, for a choice of a basis; nothing is stitched or filled.
///
/// # Errors
/// As [`crate::bake_with`].
pub fn directional(
    scene: &Scene,
    settings: &Settings,
    sheets: &[SheetSettings],
    light: &FixedLight,
    progress: ProgressFn<'_>,
) -> Result<Directional, Error> {
    let maps =
        MapSettings { basis: Basis::Sh9, sheets: sheets.to_vec(), stitch: false, dilation: 0, encoding: Encoding::F32 };
    let extras = Extras { maps: Some(maps), light: Some(light.clone()), ..Extras::default() };
    let maps = extras.maps.as_ref().expect("just put there");
    let scene = &*refined(scene, settings, progress)?;
    let (_, found) = bake_then(scene, settings, &extras, progress, |done, _| all_directional(done, maps))?;
    Ok(found)
}

fn all_directional(done: &Done<'_>, maps: &MapSettings) -> Result<Directional, Error> {
    let functions = functions(done.light.is_some());
    let bank = done.bank(Domain::Hemisphere, functions);
    let arrivals = done.arrivals(&bank, functions);
    let (mut out, mut first_index) = (Directional { texels: Vec::new(), rays: 0 }, 0);
    for (number, sheet) in (0..).zip(&maps.sheets) {
        let Gathered { mut plate, frames, record, .. } = gather(done, &arrivals, sheet, first_index)?;
        out.rays += record.rays[0] + record.rays[1];
        first_index += sheet.width * sheet.height;
        plate
            .values
            .par_chunks_mut(plate.row_len.max(1))
            .zip(&frames)
            .for_each(|(row, frame)| frame.turn(functions, row, 3));
        for (row, &texel) in plate.values.chunks_exact(plate.row_len.max(1)).zip(&plate.texel_of) {
            let mut coefficients = [[0.0; 3]; HARMONICS];
            coefficients.as_flattened_mut().copy_from_slice(row);
            let place = [texel / sheet.width, texel % sheet.width];
            out.texels.push(DirectionalTexel { sheet: number, place, coefficients });
        }
    }
    Ok(out)
}
