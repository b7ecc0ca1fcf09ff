//! The light probe blurred by roughness, for materials that shine.

use crate::{Error, Gpu, picture};
use probe_io::{Environment, reflection::Reflection};

/// Levels of roughness and columns of each, as docs/shading.md says.
const LEVELS: usize = 8;
const WIDTH: usize = 256;

/// The layout of group 2 of shine.wgsl.
pub(crate) fn layout(device: &wgpu::Device) -> wgpu::BindGroupLayout {
    device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
        label: Some("reflection"),
        entries: &[wgpu::BindGroupLayoutEntry {
            binding: 0,
            visibility: wgpu::ShaderStages::FRAGMENT,
            ty: wgpu::BindingType::Texture {
                sample_type: wgpu::TextureSampleType::Float { filterable: false },
                view_dimension: wgpu::TextureViewDimension::D2Array,
                multisampled: false,
            },
            count: None,
        }],
    })
}

/// Blurs the probe and uploads the levels.
pub(crate) fn upload(
    gpu: &Gpu,
    environment: &Environment,
    layout: &wgpu::BindGroupLayout,
) -> Result<wgpu::BindGroup, Error> {
    let reflection = Reflection::build(environment, LEVELS, WIDTH);
    let size = [reflection.width as u32, reflection.height as u32];
    let texels = reflection.levels.iter().flat_map(|level| picture::with_alpha(level)).collect::<Vec<_>>();
    let layers = reflection.levels.len() as u32;
    let texture = picture::upload(gpu, "the reflection", size, layers, picture::PROBE, &texels)?;
    let view = texture.create_view(&wgpu::TextureViewDescriptor {
        dimension: Some(wgpu::TextureViewDimension::D2Array),
        ..Default::default()
    });
    Ok(gpu.device.create_bind_group(&wgpu::BindGroupDescriptor {
        label: Some("reflection"),
        layout,
        entries: &[wgpu::BindGroupEntry { binding: 0, resource: wgpu::BindingResource::TextureView(&view) }],
    }))
}
