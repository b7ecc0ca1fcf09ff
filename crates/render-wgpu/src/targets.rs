//! The textures that a frame is drawn into; kept while frames have the same size.

use crate::{Error, Frame, Gpu, picture, surface::DEPTH};

/// What decides the sizes of the textures.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Size {
    pub(crate) width: u32,
    pub(crate) height: u32,
    pub(crate) supersample: u32,
}

impl Size {
    /// The size of a frame.
    pub(crate) fn of(frame: &Frame) -> Self {
        Self { width: frame.width, height: frame.height, supersample: frame.supersample }
    }

    /// Columns and rows of the picture.
    pub(crate) fn pixels(self) -> [u32; 2] {
        [self.width, self.height]
    }
}

/// Samples, depth, and the two pictures that are read back.
#[derive(Debug)]
pub(crate) struct Targets {
    pub(crate) size: Size,
    pub(crate) samples: wgpu::TextureView,
    pub(crate) depth: wgpu::TextureView,
    pub(crate) linear: wgpu::Texture,
    pub(crate) display: wgpu::Texture,
}

impl Targets {
    /// Creates the textures; `format` is that of the samples.
    pub(crate) fn new(gpu: &Gpu, size: Size, format: wgpu::TextureFormat) -> Result<Self, Error> {
        use wgpu::TextureUsages as Usage;
        let drawn = Usage::RENDER_ATTACHMENT;
        let samples = size.pixels().map(|side| side * size.supersample);
        let samples_label = "the picture with its samples";
        let linear = picture::create(
            gpu,
            "the picture",
            size.pixels(),
            1,
            gpu.linear(),
            drawn | Usage::TEXTURE_BINDING | Usage::COPY_SRC,
        )?;
        let display_format = wgpu::TextureFormat::Rgba8Unorm;
        Ok(Self {
            size,
            samples: picture::view(&picture::create(
                gpu,
                samples_label,
                samples,
                1,
                format,
                drawn | Usage::TEXTURE_BINDING,
            )?),
            depth: picture::view(&picture::create(gpu, samples_label, samples, 1, DEPTH, drawn)?),
            linear,
            display: picture::create(gpu, "the picture", size.pixels(), 1, display_format, drawn | Usage::COPY_SRC)?,
        })
    }
}
