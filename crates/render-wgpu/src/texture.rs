//! The pictures of the materials, each uploaded once per way in which it is read.

use crate::{Error, Gpu, picture};
use coeff_io::{Prt, Wrap};
use std::collections::HashMap;

/// How the numbers of a picture are meant.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(crate) enum Encoding {
    /// Colours: sRGB, decoded before the filter.
    Srgb,
    /// Normals, roughness: as they stand.
    Linear,
}

/// Pictures and samplers on the GPU.
#[derive(Debug)]
pub(crate) struct Textures {
    pictures: HashMap<(u32, Encoding), (wgpu::TextureView, wgpu::Sampler)>,
    white: (wgpu::TextureView, wgpu::Sampler),
}

impl Textures {
    /// No pictures yet, only the white texel for materials without.
    pub(crate) fn new(gpu: &Gpu) -> Result<Self, Error> {
        let format = wgpu::TextureFormat::Rgba8Unorm;
        let white = picture::upload(gpu, "white", [1, 1], 1, format, &[[255u8; 4]])?;
        let white = (picture::view(&white), sampler(gpu, [Wrap::Clamp; 2]));
        Ok(Self { pictures: HashMap::new(), white })
    }

    /// Uploads picture `index` unless it is there already.
    pub(crate) fn require(&mut self, gpu: &Gpu, prt: &Prt, index: u32, encoding: Encoding) -> Result<(), Error> {
        if self.pictures.contains_key(&(index, encoding)) {
            return Ok(());
        }
        let texture = &prt.textures[index as usize];
        let format = match encoding {
            Encoding::Srgb => wgpu::TextureFormat::Rgba8UnormSrgb,
            Encoding::Linear => wgpu::TextureFormat::Rgba8Unorm,
        };
        let view = if texture.rgba.is_empty() {
            self.white.0.clone()
        } else {
            let label = format!("texture {}", texture.name);
            let size = [texture.width, texture.height];
            picture::view(&picture::upload(gpu, &label, size, 1, format, &texture.rgba)?)
        };
        self.pictures.insert((index, encoding), (view, sampler(gpu, texture.wrap)));
        Ok(())
    }

    /// The picture and the sampler of a material's slot, which must have been required; white where there is none.
    pub(crate) fn get(&self, index: Option<u32>, encoding: Encoding) -> &(wgpu::TextureView, wgpu::Sampler) {
        index.map_or(&self.white, |index| &self.pictures[&(index, encoding)])
    }
}

/// Bilinear, no mip levels (docs/shading.md, Textures).
fn sampler(gpu: &Gpu, wrap: [Wrap; 2]) -> wgpu::Sampler {
    let mode = |wrap| match wrap {
        Wrap::Repeat => wgpu::AddressMode::Repeat,
        Wrap::Mirror => wgpu::AddressMode::MirrorRepeat,
        Wrap::Clamp => wgpu::AddressMode::ClampToEdge,
    };
    gpu.device.create_sampler(&wgpu::SamplerDescriptor {
        label: Some("bilinear"),
        address_mode_u: mode(wrap[0]),
        address_mode_v: mode(wrap[1]),
        mag_filter: wgpu::FilterMode::Linear,
        min_filter: wgpu::FilterMode::Linear,
        ..Default::default()
    })
}
