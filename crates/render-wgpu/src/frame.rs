//! One picture: what is asked for and what comes back.

use crate::Error;
use coeff_io::{Camera, Maps};
use glam::Quat;
use sh_math::hemisphere::Basis;

/// Most columns or rows of a picture.
const MAX_SIZE: u32 = 16384;

/// All that may change from picture to picture without a new bake.
#[derive(Debug, Clone, PartialEq)]
pub struct Frame {
    /// The view.
    pub camera: Camera,
    /// Columns of the picture.
    pub width: u32,
    /// Rows of the picture.
    pub height: u32,
    /// Turns directions of the light probe into directions of the world (world from light).
    pub rotation: Quat,
    /// Exposure in stops: linear radiance is multiplied by `2^exposure_ev`.
    pub exposure_ev: f32,
    /// How radiance becomes a display value.
    pub tonemap: Tonemap,
    /// Share of the blurred picture that is mixed in, in [0, 1]; 0 builds no blur at all.
    pub bloom: f32,
    /// Each pixel is the mean of `supersample * supersample` samples; at least 1.
    pub supersample: u32,
    /// Whether the light probe is drawn behind the scene (else black).
    pub sky: bool,
    /// Whether surfaces have their own colours; else they are white, and the picture is the light alone.
    pub albedo: bool,
    /// The basis that light maps are drawn in; their own where it is none.
    pub basis: Option<Basis>,
    /// How many functions of that basis are drawn; all where it is none.
    pub functions: Option<u32>,
    /// How surfaces that shine are drawn.
    pub gloss: coeff_io::GlossView,
    /// Whether the depth of surfaces is drawn before them where gloss is evaluated at fragments, so that none is evaluated in vain.
    pub early_depth: bool,
}

impl Frame {
    /// A frame with nothing but the light: not turned, exposure 0, no tone curve, no bloom, one sample per pixel, with sky,
    /// light maps in their own basis.
    #[must_use]
    pub fn plain(camera: Camera, width: u32, height: u32) -> Self {
        Self {
            camera,
            width,
            height,
            rotation: Quat::IDENTITY,
            exposure_ev: 0.0,
            tonemap: Tonemap::None,
            bloom: 0.0,
            supersample: 1,
            sky: true,
            albedo: true,
            basis: None,
            functions: None,
            gloss: coeff_io::GlossView::default(),
            early_depth: true,
        }
    }

    /// [`Frame::check`], and whether the file's light maps can be shown so; the basis that they are drawn in, if there are any.
    pub(crate) fn check_for(&self, maps: Option<&Maps>) -> Result<Option<Basis>, Error> {
        self.check()?;
        Maps::drawn_in(maps, self.basis, self.functions, self.rotation)
            .map_err(|problem| Error::invalid("the frame", problem))
    }

    /// Checks every value on its own; whether the sizes fit a GPU is the renderer's affair.
    fn check(&self) -> Result<(), Error> {
        let wrong = |problem: &str| Err(Error::invalid("the frame", problem));
        let camera = &self.camera;
        let numbers = [camera.eye, camera.target, camera.up];
        if !(1..=MAX_SIZE).contains(&self.width) || !(1..=MAX_SIZE).contains(&self.height) {
            return wrong("its width and height must lie within 1 and 16384 pixels");
        }
        if !(1..=8).contains(&self.supersample) {
            return wrong("supersample must lie within 1 and 8 samples along each side of a pixel");
        }
        if !(self.rotation.is_finite() && (self.rotation.length() - 1.0).abs() <= 1e-3) {
            return wrong("the rotation of the light must be a quaternion of length 1");
        }
        if !self.exposure_ev.is_finite() || self.exposure_ev.abs() > 64.0 {
            return wrong("the exposure must lie within -64 and 64 stops");
        }
        if !(0.0..=1.0).contains(&self.bloom) {
            return wrong("the bloom strength must lie within 0 and 1");
        }
        if !numbers.as_flattened().iter().all(|x| x.is_finite()) || camera.eye == camera.target {
            return wrong("the camera must stand at a finite place and look at another one");
        }
        if !(camera.vertical_fov > 0.0 && camera.vertical_fov < std::f32::consts::PI) {
            return wrong("the camera's vertical angle of view must lie within 0 and pi radians");
        }
        Ok(())
    }
}

/// How radiance becomes a display value in [0, 1], per channel, before the sRGB curve.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum Tonemap {
    /// Clipped at 1.
    #[default]
    None,
    /// `x / (1 + x)`.
    Reinhard,
    /// A curve with toe and shoulder.
    Filmic,
}

/// A finished picture, row by row from the top.
#[derive(Debug, Clone, PartialEq)]
pub struct Image {
    /// Columns.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// Scene-referred linear radiance after exposure and bloom, before the tone curve.
    pub linear: Vec<[f32; 3]>,
    /// Tone mapped and sRGB encoded; alpha is 255.
    pub display: Vec<[u8; 4]>,
}
