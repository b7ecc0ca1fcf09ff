//! Textures on the GPU: created within the limits, filled from memory.

use crate::{Error, Gpu};

/// The format of pictures that are only read: light probes keep every sun.
pub(crate) const PROBE: wgpu::TextureFormat = wgpu::TextureFormat::Rgba32Float;

/// Most that a texel of a linear format holds.
pub(crate) fn largest(format: wgpu::TextureFormat) -> f32 {
    if format == wgpu::TextureFormat::Rgba16Float { half::f16::MAX.to_f32() } else { f32::MAX }
}

/// A texture without content.
pub(crate) fn create(
    gpu: &Gpu,
    label: &str,
    [width, height]: [u32; 2],
    layers: u32,
    format: wgpu::TextureFormat,
    usage: wgpu::TextureUsages,
) -> Result<wgpu::Texture, Error> {
    let side = u64::from(width.max(height));
    let what = || format!("{label} of {width}x{height}");
    let limit = u64::from(gpu.limits.max_texture_dimension_2d);
    Error::check_fits(what, side, limit, "pixels along a side", "make it smaller or use the CPU renderer")?;
    let limit = u64::from(gpu.limits.max_texture_array_layers);
    Error::check_fits(|| label.into(), u64::from(layers), limit, "layers", "use the CPU renderer")?;
    Ok(gpu.device.create_texture(&wgpu::TextureDescriptor {
        label: Some(label),
        size: wgpu::Extent3d { width, height, depth_or_array_layers: layers },
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format,
        usage,
        view_formats: &[],
    }))
}

/// A texture that shaders read, filled with `texels`: all rows of all layers.
pub(crate) fn upload<T: bytemuck::NoUninit>(
    gpu: &Gpu,
    label: &str,
    size: [u32; 2],
    layers: u32,
    format: wgpu::TextureFormat,
    texels: &[T],
) -> Result<wgpu::Texture, Error> {
    let usage = wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::COPY_DST;
    let texture = create(gpu, label, size, layers, format, usage)?;
    let layout = wgpu::TexelCopyBufferLayout {
        offset: 0,
        bytes_per_row: Some(size[0] * size_of::<T>() as u32),
        rows_per_image: Some(size[1]),
    };
    gpu.queue.write_texture(texture.as_image_copy(), bytemuck::cast_slice(texels), layout, texture.size());
    Ok(texture)
}

/// Linear RGB pixels with the fourth channel that the format wants.
pub(crate) fn with_alpha(pixels: &[[f32; 3]]) -> Vec<[f32; 4]> {
    pixels.iter().map(|&[r, g, b]| [r, g, b, 1.0]).collect()
}

/// The whole of a texture.
pub(crate) fn view(texture: &wgpu::Texture) -> wgpu::TextureView {
    texture.create_view(&wgpu::TextureViewDescriptor::default())
}
