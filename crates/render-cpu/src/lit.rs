//! Receivers of a file under a light: texels of transfer textures, and vertices that shine. docs/shading.md, "Transfer textures".

use crate::texture::neighbours;
use coeff_io::{Arriving, ArrivingLight, DiffuseLight, Prt, TransferLevel, Wrap};
use glam::{Quat, Vec2, Vec3, Vec4};
use rayon::prelude::*;
use sh_math::Rgb;
use sh_math::light_matrix::LightProduct;

/// Marks texels that hold nothing.
const NO_ROW: u32 = u32::MAX;
/// Receivers per parallel piece of work, at least.
const LEAST: usize = 64;

/// All that is made once per light.
#[derive(Debug)]
pub(crate) struct LitSurfaces {
    /// What they are made for.
    pub(crate) rotation: Quat,
    /// Per transfer texture.
    pub(crate) sheets: Vec<LitSheet>,
    /// `[row of gloss at vertices][n^2]`: what arrives, RGB, and visibility.
    pub(crate) rows: Vec<Vec4>,
}

/// A transfer texture, ready to be looked up.
#[derive(Debug)]
pub(crate) struct LitSheet {
    /// The finest first.
    levels: Vec<LitLevel>,
    /// Texels per metre of the finest level.
    density: f32,
    /// Functions per texel of what arrives; 0 where the sheet does not shine.
    functions: usize,
}

/// One level of detail.
#[derive(Debug)]
struct LitLevel {
    width: u32,
    height: u32,
    /// `[row][column]`: which receiver lies there.
    receivers: Vec<u32>,
    /// `[receiver]`: radiance of a white surface.
    diffuse: Vec<Vec3>,
    /// `[receiver][function]`: what arrives, RGB, and visibility.
    arriving: Vec<Vec4>,
}

/// The receivers around a place, in one or two levels, with their weights; those that hold nothing are left out.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Taps {
    items: [(usize, usize, f32); 8],
    count: usize,
}

impl LitSurfaces {
    /// Lights the receivers of a sound file by `light` (turned by `rotation` already, `2 n - 1` bands or more); `product` is that of the
    /// file's gloss.
    pub(crate) fn new(prt: &Prt, product: Option<&LightProduct>, light: &Rgb, rotation: Quat) -> Self {
        let arriving = product.and_then(|product| ArrivingLight::new(prt, product, light));
        let of_rows = |rows: &Arriving| arriving.as_ref().map_or_else(Vec::new, |light| lit_rows(prt, light, rows));
        let vertices = prt.gloss.as_ref().and_then(|gloss| gloss.vertices.as_ref());
        let rows = vertices.map_or_else(Vec::new, |vertices| of_rows(&vertices.arriving));
        let Some(textures) = &prt.transfer_textures else {
            return Self { rotation, sheets: Vec::new(), rows };
        };
        let diffuse = DiffuseLight::new(prt, textures.channels, light);
        let sheet = |(index, sheet): (usize, &coeff_io::TransferSheet)| LitSheet {
            levels: sheet.levels.iter().map(|level| LitLevel::new(prt, level, &diffuse, &of_rows)).collect(),
            density: textures.density(prt, index as u32),
            functions: sheet.levels[0].arriving.as_ref().map_or(0, |rows| rows.visibility.columns as usize),
        };
        Self { rotation, sheets: textures.sheets.iter().enumerate().map(sheet).collect(), rows }
    }
}

/// `[receiver][n^2]`: what arrives, RGB, and visibility.
fn lit_rows(prt: &Prt, light: &ArrivingLight<'_>, rows: &Arriving) -> Vec<Vec4> {
    let functions = rows.visibility.columns as usize;
    let mut out = vec![Vec4::ZERO; rows.visibility.rows as usize * functions];
    out.par_chunks_mut(functions).enumerate().with_min_len(LEAST).for_each_init(
        || vec![[0.0; 4]; functions],
        |read, (row, out)| {
            light.read(prt, rows, row as u32, read);
            out.iter_mut().zip(read).for_each(|(out, read)| *out = Vec4::from(*read));
        },
    );
    out
}

impl LitLevel {
    fn new(prt: &Prt, level: &TransferLevel, light: &DiffuseLight, of_rows: &dyn Fn(&Arriving) -> Vec<Vec4>) -> Self {
        let mut receivers = vec![NO_ROW; level.width as usize * level.height as usize];
        for (row, &place) in (0..).zip(&level.places) {
            receivers[place as usize] = row;
        }
        let read = |row| Vec3::from(light.read(prt, &level.diffuse, row));
        Self {
            width: level.width,
            height: level.height,
            receivers,
            diffuse: (0..level.places.len() as u32).into_par_iter().with_min_len(LEAST).map(read).collect(),
            arriving: level.arriving.as_ref().map_or_else(Vec::new, of_rows),
        }
    }
}

impl LitSheet {
    /// Whether its texels know what arrives.
    pub(crate) fn shines(&self) -> bool {
        self.functions > 0
    }

    /// The level, with fraction, for a sample that spans `footprint` metres: `log2(footprint * density)`, not finer than `finest`.
    pub(crate) fn detail(&self, footprint: f32, finest: u32) -> f32 {
        let last = (self.levels.len() - 1) as f32;
        // `max` turns NaN into the finest level that is shown.
        libm::log2f(footprint * self.density).max(finest as f32).min(last)
    }

    /// The receivers around `uv` at a detail within the levels.
    pub(crate) fn taps(&self, uv: Vec2, detail: f32) -> Taps {
        let mut taps = Taps { items: [(0, 0, 0.0); 8], count: 0 };
        let low = (detail as usize).min(self.levels.len() - 1);
        let blend = detail - low as f32;
        taps.add(low, &self.levels[low], uv, 1.0 - blend);
        if blend > 0.0 && low + 1 < self.levels.len() {
            taps.add(low + 1, &self.levels[low + 1], uv, blend);
        }
        taps
    }

    /// Radiance of a white surface; not clamped.
    pub(crate) fn diffuse(&self, taps: &Taps) -> Vec3 {
        taps.iter().map(|(level, row, weight)| self.levels[level].diffuse[row] * weight).sum()
    }

    /// `sum_k weights_k U_k`: RGB of what arrives, and the visibility.
    pub(crate) fn arriving(&self, taps: &Taps, weights: &[f32]) -> Vec4 {
        let of_row = |(level, row, weight): (usize, usize, f32)| {
            let start = row * self.functions;
            dot(weights, &self.levels[level].arriving[start..start + self.functions]) * weight
        };
        taps.iter().map(of_row).sum()
    }
}

/// `sum_k weights_k row_k`.
pub(crate) fn dot(weights: &[f32], row: &[Vec4]) -> Vec4 {
    weights.iter().zip(row).map(|(&weight, &u)| u * weight).sum()
}

impl Taps {
    fn add(&mut self, index: usize, level: &LitLevel, uv: Vec2, share: f32) {
        let (columns, fx) = neighbours(uv.x, level.width, Wrap::Clamp);
        let (rows, fy) = neighbours(uv.y, level.height, Wrap::Clamp);
        for (row, wy) in [(rows[0], 1.0 - fy), (rows[1], fy)] {
            for (column, wx) in [(columns[0], 1.0 - fx), (columns[1], fx)] {
                let receiver = level.receivers[row * level.width as usize + column];
                if receiver != NO_ROW {
                    self.items[self.count] = (index, receiver as usize, share * wx * wy);
                    self.count += 1;
                }
            }
        }
    }

    fn iter(&self) -> impl Iterator<Item = (usize, usize, f32)> + '_ {
        self.items[..self.count].iter().copied()
    }
}
