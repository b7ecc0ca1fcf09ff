//! A volume on an even grid, as nine 3-D textures hold it.

use crate::volume::FUNCTIONS;
use crate::{Error, Lookup, Node, Volume};
use glam::Vec3;

/// Most points of a grid: nine textures of 8 bytes per texel make 151 MB.
const MOST: u64 = 1 << 21;

/// Coefficients at the points of an even grid, lit.
///
/// Point `(i, j, k)` stands at `origin + step * (i, j, k)`, so the first and the last lie on the border. A texture that holds it is read, with
/// linear filtering, at `((position - origin) / step + 0.5) / points`.
#[derive(Debug, Clone, PartialEq)]
pub struct Grid {
    /// The first point, world space, metres.
    pub origin: [f32; 3],
    /// From point to point along each axis, metres.
    pub step: [f32; 3],
    /// Points along each axis.
    pub points: [u32; 3],
    /// `[function][z][y][x]` RGB: irradiance / pi over world normals in 3 bands.
    pub functions: [Vec<[f32; 3]>; FUNCTIONS],
}

impl Volume {
    /// The volume on the grid of its finest cells, or of coarser ones where there would be more than two million points; a light of `depth`
    /// or more coefficients in world axes (unused where the light is fixed).
    ///
    /// Points are read by [`Lookup::Visible`] without a normal: where there is a probe it is that probe. \[N\] section 2.2.5.
    ///
    /// # Errors
    /// `Unsupported` where even the coarsest level has too many points.
    pub fn grid(&self, light: &[[f32; 3]]) -> Result<Grid, Error> {
        let finest = self.levels();
        let points = |level: u32| self.cells.map(|cells| (u64::from(cells) << level) + 1);
        let fits =
            |level: &u32| points(*level).into_iter().try_fold(1_u64, u64::checked_mul).is_some_and(|n| n <= MOST);
        let level = (0..=finest).rev().find(fits).ok_or_else(|| {
            Error::Unsupported(format!("the volume has more than {MOST} points: bake a coarser one to export it"))
        })?;
        let [x, y, z] = points(level);
        let step = self.spacing.map(|edge| edge / (1_u32 << level) as f32);
        let lit = self.lit(light);
        let mut functions: [Vec<[f32; 3]>; FUNCTIONS] = Default::default();
        for index in 0..x * y * z {
            let place = [index % x, index / x % y, index / (x * y)];
            let point = Vec3::from_array(std::array::from_fn(|i| self.origin[i] + step[i] * place[i] as f32));
            let blended = self.weights(point, None, Lookup::Visible).blend(&lit);
            functions.iter_mut().zip(blended).for_each(|(function, coefficient)| function.push(coefficient));
        }
        Ok(Grid { origin: self.origin, step, points: [x, y, z].map(|n| n as u32), functions })
    }

    /// How often the coarsest cells are split at most.
    #[must_use]
    pub fn levels(&self) -> u32 {
        let coarse = self.cells.iter().map(|n| *n as usize).product::<usize>();
        // Parts lie behind their parent, so that its level is known.
        let mut levels = vec![0; (self.nodes.len() - coarse) / 8];
        let mut deepest = 0;
        for (i, node) in self.nodes.iter().enumerate() {
            if let Node::Split(first) = node {
                let level = i.checked_sub(coarse).map_or(0, |part| levels[part / 8]) + 1;
                levels[(*first as usize - coarse) / 8] = level;
                deepest = deepest.max(level);
            }
        }
        deepest
    }
}
