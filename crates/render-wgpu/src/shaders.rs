//! The shader modules: WGSL files put together, without any preprocessor.

/// A named module: its name in error messages and its whole text.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Shader {
    pub(crate) name: &'static str,
    pub(crate) text: &'static str,
}

macro_rules! shader {
    ($name:literal, $($file:literal),+) => {
        Shader { name: $name, text: concat!($(include_str!(concat!("../shaders/", $file))),+) }
    };
}

/// Dot products of transfer and light.
pub(crate) const RELIGHT: Shader = shader!("relight", "relight.wgsl");
/// Surfaces without shine.
pub(crate) const DIFFUSE: Shader = shader!("diffuse", "view.wgsl", "surface.wgsl");
/// Surfaces that mirror the light probe.
pub(crate) const SHINY: Shader =
    shader!("shiny", "view.wgsl", "equirect.wgsl", "brdf.wgsl", "surface.wgsl", "shine.wgsl");
/// The light probe behind the scene.
pub(crate) const SKY: Shader = shader!("sky", "view.wgsl", "equirect.wgsl", "fullscreen.wgsl", "sky.wgsl");
/// Samples to pixels.
pub(crate) const RESOLVE: Shader = shader!("resolve", "fullscreen.wgsl", "post.wgsl", "resolve.wgsl");
/// The blur pyramid.
pub(crate) const BLOOM: Shader = shader!("bloom", "fullscreen.wgsl", "post.wgsl", "bloom.wgsl");
/// Tone curve and encoding.
pub(crate) const DISPLAY: Shader = shader!("display", "fullscreen.wgsl", "tone.wgsl", "display.wgsl");

/// Every module of the renderer, for the tests that need no GPU.
#[cfg(test)]
pub(crate) const ALL: [Shader; 7] = [RELIGHT, DIFFUSE, SHINY, SKY, RESOLVE, BLOOM, DISPLAY];

impl Shader {
    /// Compiles the module.
    pub(crate) fn module(self, device: &wgpu::Device) -> wgpu::ShaderModule {
        device.create_shader_module(wgpu::ShaderModuleDescriptor {
            label: Some(self.name),
            source: wgpu::ShaderSource::Wgsl(self.text.into()),
        })
    }
}
