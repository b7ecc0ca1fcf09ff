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

#[cfg(test)]
mod tests {
    use super::*;

    /// Parses and validates WGSL without a GPU.
    fn validate(text: &str) -> Result<(), String> {
        let module = naga::front::wgsl::parse_str(text).map_err(|error| error.emit_to_string(text))?;
        let flags = naga::valid::ValidationFlags::all();
        naga::valid::Validator::new(flags, naga::valid::Capabilities::default())
            .validate(&module)
            .map(drop)
            .map_err(|error| error.emit_to_string(text))
    }

    #[test]
    fn every_module_is_valid() {
        for shader in ALL {
            assert_eq!(validate(shader.text), Ok(()), "{} must be valid WGSL", shader.name);
        }
    }

    #[test]
    fn validation_can_fail() {
        for shader in ALL {
            let broken = shader.text.replace("vec2<i32>(at.clip.xy)", "vec2<i32>(at.clip.x)");
            let broken = broken.replace(": u32,", ": u32").replace("-> @location(0) vec4<f32>", "-> vec4<f32>");
            assert!(validate(&broken).is_err(), "{} with wrong types must be refused", shader.name);
        }
    }

    /// A file that no module holds would never be checked.
    #[test]
    fn every_file_is_part_of_a_module() {
        let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/shaders");
        for entry in std::fs::read_dir(folder).expect("the shaders stand beside src") {
            let path = entry.expect("a readable entry").path();
            let text = std::fs::read_to_string(&path).expect("a readable shader");
            let used = ALL.iter().any(|shader| shader.text.contains(&text));
            assert!(used, "{} belongs to a module", path.display());
        }
    }
}
