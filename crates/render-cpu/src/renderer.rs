//! A baked scene under a probe, ready to draw frames.

use crate::bins::{Bins, Tiles};
use crate::image::Image;
use crate::light::{vertex_heading, vertex_radiance};
use crate::map::LitMaps;
use crate::raster::{Piece, Window, pieces};
use crate::shade::Shader;
use crate::surfaces::Surfaces;
use crate::texture::SrgbTable;
use crate::tile::{Canvas, Stage};
use crate::tone::Quantiser;
use crate::view::View;
use crate::{Error, Frame, bloom, check, map};
use coeff_io::{AlphaMode, Material, Prt};
use glam::{DVec3, Quat, Vec3};
use probe_io::Environment;
use probe_io::reflection::Reflection;
use rayon::prelude::*;
use sh_math::{Bands, hemisphere::Basis};
use std::sync::{Arc, Mutex};

/// Roughness levels of the prefiltered probe.
pub const REFLECTION_LEVELS: usize = 8;
/// Columns of each level of the prefiltered probe.
pub const REFLECTION_WIDTH: usize = 256;
/// Marks triangles that no mesh holds; they are not drawn.
const NO_MATERIAL: u32 = u32::MAX;
/// Triangles per parallel piece of work.
const CHUNK: usize = 4096;

/// A baked scene under a probe: what is the same for all frames is done once.
#[derive(Debug)]
pub struct Renderer<'a> {
    prt: &'a Prt,
    environment: &'a Environment,
    /// Coefficients of the light as it is shown, in as many bands as transfer or maps have.
    light: sh_math::Rgb,
    /// Bands of the transfer.
    bands: Bands,
    reflection: Option<Reflection>,
    srgb: SrgbTable,
    quantiser: Quantiser,
    /// Material of each triangle.
    materials: Vec<u32>,
    /// Light map of each triangle; empty where no mesh has one.
    sheets: Vec<u32>,
    /// The maps under the light of the last frame.
    lit_maps: Mutex<Option<Arc<LitMaps>>>,
    /// Texels and vertices that know what arrives.
    surfaces: Surfaces,
    /// Length of the diagonal of the box around all positions.
    diagonal: f64,
}

/// Draws one frame: [`Renderer::new`] and [`Renderer::draw`].
///
/// # Errors
/// As these.
pub fn render(prt: &Prt, environment: &Environment, frame: &Frame) -> Result<Image, Error> {
    frame.check()?;
    Renderer::new(prt, environment)?.draw(frame)
}

impl<'a> Renderer<'a> {
    /// Projects the probe under the window that keeps it from ringing (none where nothing rings) and, where a material
    /// calls for reflections, prefilters it.
    ///
    /// # Errors
    /// [`Error::Prt`] where the parts of `prt` do not fit each other.
    pub fn new(prt: &'a Prt, environment: &'a Environment) -> Result<Self, Error> {
        let mut renderer = Self::without_window(prt, environment)?;
        renderer.light = sh_math::window::without_ringing(&renderer.light);
        Ok(renderer)
    }

    /// As [`Renderer::new`], but with the light as its coefficients have it: it may be negative in places.
    ///
    /// # Errors
    /// As [`Renderer::new`].
    pub fn without_window(prt: &'a Prt, environment: &'a Environment) -> Result<Self, Error> {
        check::check(prt)?;
        let unsupported = || Error::Prt(format!("a transfer of {} bands, which is not supported", prt.transfer.bands));
        let bands = Bands::new(prt.transfer.bands).ok_or_else(unsupported)?;
        let shines = prt.meshes.iter().any(|mesh| prt.materials[mesh.material as usize].specular);
        Ok(Self {
            prt,
            environment,
            bands,
            light: sh_math::project(prt.light_bands().unwrap_or(bands), environment.samples()),
            reflection: shines.then(|| Reflection::build(environment, REFLECTION_LEVELS, REFLECTION_WIDTH)),
            srgb: SrgbTable::new(),
            quantiser: Quantiser::new(),
            materials: materials(prt),
            sheets: map::sheet_of_triangle(prt),
            lit_maps: Mutex::default(),
            surfaces: Surfaces::new(prt),
            diagonal: diagonal(&prt.geometry.positions),
        })
    }

    /// Coefficients of the light as it lies, not turned.
    #[must_use]
    pub fn light(&self) -> &sh_math::Rgb {
        &self.light
    }

    /// Lights vertices and relightable maps by other coefficients, such as windowed ones; sky and reflections stay.
    pub fn set_light(&mut self, light: sh_math::Rgb) {
        self.light = light;
        self.lit_maps = Mutex::default();
        self.surfaces.forget();
    }

    /// Number of levels of the probe blurred for reflections: 0 where no surface mirrors it.
    #[must_use]
    pub fn reflection_levels(&self) -> usize {
        self.reflection.as_ref().map_or(0, |reflection| reflection.levels.len())
    }

    /// Draws one frame as docs/shading.md says.
    ///
    /// # Errors
    /// [`Error::Frame`] as [`Frame::check_for`], and for gloss that the file cannot show under this light.
    pub fn draw(&self, frame: &Frame) -> Result<Image, Error> {
        let basis = frame.check_for(self.prt)?;
        frame.gloss.check_for(self.prt, &self.light, frame.rotation).map_err(Error::Frame)?;
        let view = View::new(frame, self.diagonal);
        let rotation = frame.rotation.normalize();
        let light = self.light.rotated(rotation);
        let own = light.with_bands(self.bands);
        let radiance = vertex_radiance(&self.prt.transfer, &own.values);
        let heading = match self.prt.bends_vertices() {
            true => vertex_heading(&self.prt.transfer, &sh_math::heading(&own).values),
            false => Vec::new(),
        };
        let maps = basis.map(|basis| self.maps_under(&light, rotation, basis));
        let drawn = self.surfaces.draw(self.prt, &light, rotation, frame.gloss, frame.camera.eye);
        let projected: Vec<DVec3> = self.prt.geometry.positions.par_iter().map(|&p| view.project(p)).collect();
        let shader = Shader {
            prt: self.prt,
            environment: self.environment,
            reflection: self.reflection.as_ref(),
            srgb: &self.srgb,
            radiance: &radiance,
            heading: &heading,
            gloss: drawn.gloss.as_ref(),
            finest: frame.gloss.level,
            light_from_world: rotation.inverse(),
            sky: frame.sky,
            albedo: frame.albedo,
        };
        let maps = maps.as_ref().map(|maps| (self.sheets.as_slice(), maps.sheets.as_slice()));
        let receivers = drawn.receivers();
        let stage = Stage { shader, view: &view, projected: &projected, materials: &self.materials, maps, receivers };
        let mut linear = self.tiles(&stage, frame);
        let exposure = libm::exp2f(frame.exposure_ev);
        linear.par_iter_mut().for_each(|pixel| *pixel = pixel.map(|x| x * exposure));
        if frame.bloom > 0.0 {
            bloom::apply(frame.width as usize, frame.height as usize, &mut linear, frame.bloom);
        }
        Ok(Image::new(frame.width, frame.height, linear, frame.tonemap, &self.quantiser))
    }

    /// The light maps in a basis under the turned light: those of the last frame where nothing has changed.
    fn maps_under(&self, light: &sh_math::Rgb, rotation: Quat, basis: Basis) -> Arc<LitMaps> {
        // A panic elsewhere leaves whole maps or none.
        let mut held = self.lit_maps.lock().unwrap_or_else(std::sync::PoisonError::into_inner);
        match held.take().filter(|maps| maps.rotation == rotation && maps.basis == basis) {
            Some(maps) => held.insert(maps).clone(),
            None => held.insert(Arc::new(LitMaps::new(self.prt, light, rotation, basis))).clone(),
        }
    }

    /// The linear picture before exposure, drawn tile by tile.
    fn tiles(&self, stage: &Stage<'_>, frame: &Frame) -> Vec<[f32; 3]> {
        let opaque = self.pieces(stage, |material| !lets_through(material));
        let blended = self.back_to_front(stage, self.pieces(stage, lets_through));
        let tiles = Tiles::new(stage.view.samples, frame.supersample);
        let (opaque_bins, blended_bins) = (Bins::new(&tiles, &opaque), Bins::new(&tiles, &blended));
        let drawn: Vec<Vec<[f32; 3]>> = (0..tiles.count())
            .into_par_iter()
            .map_init(Canvas::default, |canvas, tile| {
                let window = tiles.window(tile);
                let behind = opaque_bins.of(tile).iter().map(|&i| &opaque[i as usize]);
                let before = blended_bins.of(tile).iter().map(|&i| &blended[i as usize]);
                stage.draw(&window, behind, before, canvas);
                canvas.pixels(&window, frame.supersample)
            })
            .collect();
        let mut picture = vec![[0.0; 3]; frame.width as usize * frame.height as usize];
        for (tile, pixels) in drawn.iter().enumerate() {
            place(&mut picture, frame, &tiles.window(tile), pixels);
        }
        picture
    }

    /// The pieces of all triangles whose material is `wanted`, in the order of the triangles.
    fn pieces(&self, stage: &Stage<'_>, wanted: impl Fn(&Material) -> bool + Sync) -> Vec<Piece> {
        let wanted: Vec<bool> = self.prt.materials.iter().map(wanted).collect();
        let triangles = &self.prt.geometry.triangles;
        let chunks: Vec<Vec<Piece>> = (triangles.par_chunks(CHUNK).enumerate())
            .map(|(chunk, triangles)| {
                let mut out = Vec::new();
                for (i, corners) in (chunk * CHUNK..).zip(triangles) {
                    if wanted.get(self.materials[i] as usize) == Some(&true) {
                        pieces(i as u32, corners.map(|v| stage.projected[v as usize]), stage.view, &mut out);
                    }
                }
                out
            })
            .collect();
        chunks.concat()
    }

    /// Sorts pieces by the mean depth of their triangles' corners, farthest first.
    fn back_to_front(&self, stage: &Stage<'_>, mut pieces: Vec<Piece>) -> Vec<Piece> {
        let depth = |piece: &Piece| {
            let corners = self.prt.geometry.triangles[piece.triangle as usize];
            corners.iter().map(|&v| stage.projected[v as usize].z).sum::<f64>()
        };
        // The sort is stable: of equals the lower index stays first.
        pieces.sort_by(|a, b| depth(b).total_cmp(&depth(a)));
        pieces
    }
}

/// Whether a surface shows what lies behind it.
fn lets_through(material: &Material) -> bool {
    material.alpha == AlphaMode::Blend || material.transmission > 0.0
}

fn materials(prt: &Prt) -> Vec<u32> {
    let mut out = vec![NO_MATERIAL; prt.geometry.triangles.len()];
    for mesh in &prt.meshes {
        let first = mesh.first_triangle as usize;
        out[first..first + mesh.triangles as usize].fill(mesh.material);
    }
    out
}

fn diagonal(positions: &[[f32; 3]]) -> f64 {
    let first = positions.first().map_or(Vec3::ZERO, |&p| Vec3::from(p));
    let (least, most) =
        positions.iter().map(|&p| Vec3::from(p)).fold((first, first), |(least, most), p| (least.min(p), most.max(p)));
    (most.as_dvec3() - least.as_dvec3()).length()
}

/// Copies the pixels of a tile to their place in the picture.
fn place(picture: &mut [[f32; 3]], frame: &Frame, window: &Window, pixels: &[[f32; 3]]) {
    let s = frame.supersample;
    let (width, left) = (window.width() / s as usize, (window.columns[0] / s) as usize);
    for (row, pixels) in ((window.rows[0] / s) as usize..).zip(pixels.chunks_exact(width)) {
        picture[row * frame.width as usize + left..][..width].copy_from_slice(pixels);
    }
}
