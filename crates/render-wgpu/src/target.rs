//! Where a finished picture goes: a caller's view, or a texture of ours.

use crate::{Error, Frame};

/// A view that the last pass of a frame writes.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Target<'a> {
    pub(crate) view: &'a wgpu::TextureView,
    pub(crate) format: wgpu::TextureFormat,
}

/// What a format stores; the numbers are those of display.wgsl.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Encoding {
    /// Tone mapped and sRGB encoded by the shader.
    Srgb = 0,
    /// Tone mapped; the hardware encodes.
    Display = 1,
    /// Linear radiance without tone curve.
    Radiance = 2,
}

impl Encoding {
    /// The encoding that a format calls for.
    pub(crate) fn new(format: wgpu::TextureFormat) -> Self {
        use wgpu::TextureFormat as Format;
        match format {
            Format::Rgba16Float | Format::Rgba32Float => Self::Radiance,
            format if format.is_srgb() => Self::Display,
            _ => Self::Srgb,
        }
    }
}

impl Target<'_> {
    /// Refuses a view that cannot take this frame.
    pub(crate) fn check(&self, frame: &Frame) -> Result<(), Error> {
        use wgpu::TextureFormat as Format;
        let texture = self.view.texture();
        let wrong = |problem: String| Err(Error::invalid("the target view", problem));
        match self.format {
            Format::Rgba8Unorm | Format::Rgba8UnormSrgb | Format::Bgra8Unorm | Format::Bgra8UnormSrgb => {}
            Format::Rgba16Float | Format::Rgba32Float => {}
            format => {
                return wrong(format!(
                    "{format:?} is none of Rgba8, Bgra8 (Unorm, UnormSrgb), Rgba16Float, Rgba32Float"
                ));
            }
        }
        if texture.format().remove_srgb_suffix() != self.format.remove_srgb_suffix() {
            return wrong(format!("its texture holds {:?}, not {:?}", texture.format(), self.format));
        }
        if !texture.usage().contains(wgpu::TextureUsages::RENDER_ATTACHMENT) {
            return wrong("its texture lacks the usage RENDER_ATTACHMENT".into());
        }
        if texture.dimension() != wgpu::TextureDimension::D2 || texture.sample_count() != 1 {
            return wrong("its texture must have two dimensions and one sample per texel".into());
        }
        let level = |level: u32| [texture.width(), texture.height()].map(|side| (side >> level).max(1));
        if !(0..texture.mip_level_count()).any(|number| level(number) == [frame.width, frame.height]) {
            let [width, height] = level(0);
            return wrong(format!("it has {width}x{height} texels, but the frame {}x{}", frame.width, frame.height));
        }
        Ok(())
    }
}
