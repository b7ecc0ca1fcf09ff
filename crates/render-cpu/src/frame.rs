//! What is asked of the renderer: view, size, light rotation, exposure, tone curve.

use crate::Error;
use coeff_io::{Camera, Maps, Prt};
use glam::{Quat, Vec3};
use sh_math::hemisphere::Basis;

/// Largest width and height of a picture.
pub const MAX_SIZE: u32 = 16_384;
/// Largest number of samples along each axis of a pixel.
pub const MAX_SUPERSAMPLE: u32 = 8;
/// Largest exposure, in stops up or down.
const MAX_EXPOSURE_EV: f32 = 64.0;

/// One picture to draw; docs/shading.md says what each field does.
#[derive(Debug, Clone, PartialEq)]
pub struct Frame {
    /// The view.
    pub camera: Camera,
    /// Columns of the picture.
    pub width: u32,
    /// Rows of the picture.
    pub height: u32,
    /// world_from_light: turns the probe, without a new bake.
    pub rotation: Quat,
    /// Stops; the picture is multiplied by 2 to this power.
    pub exposure_ev: f32,
    /// Curve from scene-referred values to the display.
    pub tonemap: Tonemap,
    /// Share of glow in [0, 1]; 0 draws none.
    pub bloom: f32,
    /// Samples along each axis of a pixel, 1 to 8.
    pub supersample: u32,
    /// Whether the probe is drawn where nothing else is.
    pub sky: bool,
    /// Whether surfaces have their own colours; else they are white, and the picture is the light alone.
    pub albedo: bool,
    /// The basis that light maps are drawn in; their own where it is none.
    pub basis: Option<Basis>,
    /// How many functions of that basis are drawn; all where it is none.
    pub functions: Option<u32>,
    /// How surfaces that shine are drawn.
    pub gloss: coeff_io::GlossView,
}

/// Curve from scene-referred values to display values in [0, 1], per channel.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Tonemap {
    /// Values are cut at 1.
    None,
    /// x / (1 + x).
    Reinhard,
    /// A fit of the ACES curve.
    Filmic,
}

impl Frame {
    /// A frame through `camera` with nothing but the light: no exposure change, no curve, no bloom, one sample per pixel, sky on,
    /// light maps in their own basis.
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
        }
    }

    /// [`Frame::check`], and what of it `prt` cannot show; the basis that its light maps are drawn in, if it has any.
    ///
    /// # Errors
    /// [`Error::Frame`] as that; for a basis without light maps, for a number of functions that is no best fit, and for a turned light
    /// on maps that hold another.
    pub fn check_for(&self, prt: &Prt) -> Result<Option<Basis>, Error> {
        self.check()?;
        Maps::drawn_in(prt.maps.as_ref(), self.basis, self.functions, self.rotation).map_err(Error::Frame)
    }

    /// Says what is wrong with this frame, if anything is.
    ///
    /// # Errors
    /// [`Error::Frame`] with the field, its value and the range that it must lie in.
    pub fn check(&self) -> Result<(), Error> {
        let (width, height) = (self.width, self.height);
        let refuse = |what: String| Err(Error::Frame(what));
        if width == 0 || height == 0 || width > MAX_SIZE || height > MAX_SIZE {
            return refuse(format!("a picture of {width} x {height} pixels; each side must be from 1 to {MAX_SIZE}"));
        }
        if !(1..=MAX_SUPERSAMPLE).contains(&self.supersample) {
            return refuse(format!("supersample {}; it must be from 1 to {MAX_SUPERSAMPLE}", self.supersample));
        }
        if !(0.0..=1.0).contains(&self.bloom) {
            return refuse(format!("bloom {}; it must lie in [0, 1]", self.bloom));
        }
        if !(-MAX_EXPOSURE_EV..=MAX_EXPOSURE_EV).contains(&self.exposure_ev) {
            return refuse(format!("exposure {} EV; it must lie within {MAX_EXPOSURE_EV} stops", self.exposure_ev));
        }
        // A length that is NaN or infinite lies in no range.
        if !(0.999..=1.001).contains(&self.rotation.length()) {
            return refuse(format!("light rotation {}; it must be a quaternion of length 1", self.rotation));
        }
        check_camera(&self.camera)
    }
}

fn check_camera(camera: &Camera) -> Result<(), Error> {
    let refuse = |what: &str| Err(Error::Frame(format!("camera `{}`: {what}", camera.name)));
    let (eye, target, up) = (Vec3::from(camera.eye), Vec3::from(camera.target), Vec3::from(camera.up));
    if !(eye.is_finite() && target.is_finite() && up.is_finite()) {
        return refuse("eye, target and up must be finite");
    }
    if eye == target {
        return refuse("eye and target coincide; move one of them");
    }
    if !(camera.vertical_fov > 0.0 && camera.vertical_fov < std::f32::consts::PI) {
        return refuse("the vertical angle of view must lie between 0 and pi");
    }
    Ok(())
}
