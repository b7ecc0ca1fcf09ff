//! Drawing one tile: depth first, then colours, then what lets light through.

use crate::facet::Facet;
use crate::gloss::{Receivers, Source};
use crate::lit::LitSheet;
use crate::map::Sheet;
use crate::raster::{Piece, Window};
use crate::shade::{Place, Shader};
use crate::view::View;
use coeff_io::{AlphaMode, Material};
use glam::{DVec3, Vec3};

/// Marks samples that no triangle covers.
const NOTHING: u32 = u32::MAX;

/// What a tile is drawn from.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Stage<'a> {
    pub(crate) shader: Shader<'a>,
    pub(crate) view: &'a View,
    /// Vertices in projective space.
    pub(crate) projected: &'a [DVec3],
    /// Material of each triangle.
    pub(crate) materials: &'a [u32],
    /// Light map of each triangle; `None` where no mesh has one.
    pub(crate) maps: Option<(&'a [u32], &'a [Sheet])>,
    /// Texels and vertices that are more than vertices; none where the file has no such.
    pub(crate) receivers: Option<Receivers<'a>>,
}

/// The samples of a tile: depth, the nearest triangle, colour.
#[derive(Debug, Default)]
pub(crate) struct Canvas {
    depth: Vec<f32>,
    triangle: Vec<u32>,
    color: Vec<Vec3>,
}

/// A triangle in hand, so that neighbouring samples need not fetch it again.
#[derive(Debug, Clone, Copy)]
struct Held<'a> {
    triangle: u32,
    facet: Facet,
    vertices: [usize; 3],
    material: &'a Material,
    sheet: Option<&'a Sheet>,
    texels: Option<&'a LitSheet>,
    source: Option<Source<'a>>,
}

impl<'a> Stage<'a> {
    /// Draws the samples of a window: opaque pieces, sky, then blended pieces in their order, back to front.
    pub(crate) fn draw(
        &self,
        window: &Window,
        opaque: impl Iterator<Item = &'a Piece>,
        blended: impl Iterator<Item = &'a Piece>,
        canvas: &mut Canvas,
    ) {
        canvas.clear(window);
        for piece in opaque {
            self.cover(piece, window, canvas);
        }
        self.color(window, canvas);
        for piece in blended {
            self.blend(piece, window, canvas);
        }
    }

    fn cover(&self, piece: &Piece, window: &Window, canvas: &mut Canvas) {
        let held = self.hold(piece.triangle);
        let masked = matches!(held.material.alpha, AlphaMode::Mask(_));
        piece.scan(window, |column, row, depth| {
            let i = window.index(column, row);
            if depth > canvas.depth[i] && (!masked || self.shader.exists(&self.place(&held, column, row))) {
                canvas.depth[i] = depth;
                canvas.triangle[i] = piece.triangle;
            }
        });
    }

    fn color(&self, window: &Window, canvas: &mut Canvas) {
        let mut held: Option<Held<'_>> = None;
        for row in window.rows[0]..window.rows[1] {
            for column in window.columns[0]..window.columns[1] {
                let i = window.index(column, row);
                let triangle = canvas.triangle[i];
                canvas.color[i] = if triangle == NOTHING {
                    self.shader.sky(self.view.direction(self.view.centre(column, row)))
                } else {
                    let held =
                        held.insert(held.filter(|h| h.triangle == triangle).unwrap_or_else(|| self.hold(triangle)));
                    let surface = self.shader.surface(&self.place(held, column, row));
                    surface.diffuse + surface.gloss
                };
            }
        }
    }

    fn blend(&self, piece: &Piece, window: &Window, canvas: &mut Canvas) {
        let held = self.hold(piece.triangle);
        piece.scan(window, |column, row, depth| {
            let i = window.index(column, row);
            let place = self.place(&held, column, row);
            if depth > canvas.depth[i] && self.shader.exists(&place) {
                canvas.color[i] = self.shader.surface(&place).over(canvas.color[i]);
            }
        });
    }

    fn hold(&self, triangle: u32) -> Held<'a> {
        let prt = self.shader.prt;
        let vertices = prt.geometry.triangles[triangle as usize].map(|v| v as usize);
        let material = &prt.materials[self.materials[triangle as usize] as usize];
        let sheet = self.maps.and_then(|(of_triangle, sheets)| sheets.get(of_triangle[triangle as usize] as usize));
        let (texels, source) = self.receivers.map_or((None, None), |receivers| receivers.of(prt, triangle));
        let facet = Facet::new(vertices.map(|v| self.projected[v]));
        Held { triangle, facet, vertices, material, sheet, texels, source }
    }

    fn place(&self, held: &Held<'a>, column: u32, row: u32) -> Place<'a> {
        let centre = self.view.centre(column, row);
        let weights = held.facet.weights(centre);
        let depths = held.vertices.map(|v| self.projected[v].z as f32);
        let depth: f32 = depths.iter().zip(weights).map(|(depth, weight)| depth * weight).sum();
        Place {
            material: held.material,
            sheet: held.sheet,
            texels: held.texels,
            source: held.source,
            vertices: held.vertices,
            weights,
            direction: self.view.direction(centre),
            footprint: depth * self.view.spread(),
        }
    }
}

impl Canvas {
    /// Means of the samples of each pixel, row by row.
    pub(crate) fn pixels(&self, window: &Window, supersample: u32) -> Vec<[f32; 3]> {
        let s = supersample as usize;
        let (width, height) = (window.width(), window.height());
        let share = 1.0 / (s * s) as f32;
        let mut out = Vec::with_capacity(width / s * (height / s));
        for y in (0..height).step_by(s) {
            for x in (0..width).step_by(s) {
                let samples = (y..y + s).flat_map(|j| &self.color[j * width + x..][..s]);
                out.push((samples.sum::<Vec3>() * share).to_array());
            }
        }
        out
    }

    fn clear(&mut self, window: &Window) {
        let count = window.width() * window.height();
        self.depth.clear();
        self.depth.resize(count, 0.0);
        self.triangle.clear();
        self.triangle.resize(count, NOTHING);
        self.color.resize(count, Vec3::ZERO);
    }
}
