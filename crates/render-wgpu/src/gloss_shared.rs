//! What all receivers and surfaces with gloss share on the GPU.

use crate::gloss::FORMAT;
use crate::gloss_rows::{Factors, Kernels};
use crate::{Error, Gpu, geometry, gpu_data, picture};
use coeff_io::Prt;
use sh_math::light_matrix::LightProduct;
use sh_math::lobe;

/// What all receivers and surfaces share.
#[derive(Debug)]
pub(crate) struct Shared {
    pub(crate) kernels: Kernels,
    pub(crate) factors: Factors,
    pub(crate) frame: wgpu::Buffer,
    pub(crate) lobes: wgpu::Buffer,
    /// The turned light.
    pub(crate) light: wgpu::Buffer,
    pub(crate) triples: wgpu::Buffer,
    pub(crate) sampler: wgpu::Sampler,
    /// Stands for textures that a way does not read.
    pub(crate) nothing: wgpu::TextureView,
    /// Stands for buffers that a way does not read.
    pub(crate) empty: wgpu::Buffer,
    pub(crate) texel_layout: wgpu::BindGroupLayout,
    pub(crate) vertex_layout: wgpu::BindGroupLayout,
    /// Whether surfaces send light to those that shine.
    pub(crate) bounced: bool,
}

impl Shared {
    pub(crate) fn new(gpu: &Gpu, prt: &Prt, product: Option<&LightProduct>) -> Result<Self, Error> {
        let k = product.map_or(0, |product| product.bands().coefficients());
        let books = &prt.codebooks;
        let vectors = |book: &Option<coeff_io::Codebook>| {
            book.as_ref().map_or(0, |book| book.clusters as usize * (1 + book.rank as usize))
        };
        let fill = wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_DST;
        let wide = |label, count: usize| sized(gpu, label, 16 * count as u64, fill);
        let own = (prt.transfer.bands as usize).pow(2);
        let factors = Factors {
            matrix: wide("matrix of the light", k * k)?,
            visibility: wide("products of visibility", vectors(&books.visibility) * k)?,
            bounce: wide("products of bounces", vectors(&books.bounce) * k)?,
            light: wide("light of diffuse transfer", own)?,
            diffuse: wide("products of diffuse transfer", vectors(&books.diffuse))?,
        };
        let counted = product.map_or(0, |product| LightProduct::light_bands(product.bands()).coefficients());
        let bands = product.map_or(0, |product| product.bands().count());
        let uniform = wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST;
        let frame = bytemuck::bytes_of(&gpu_data::GlossFrame::default()).to_vec();
        let terms = product.map_or(&[][..], LightProduct::terms).iter().map(|term| gpu_data::Triple {
            lobe: term.a,
            light: term.b,
            visibility: term.c,
            value: term.value as f32,
        });
        let terms: Vec<gpu_data::Triple> = terms.collect();
        let usage = wgpu::TextureUsages::TEXTURE_BINDING;
        let nothing = picture::create(gpu, "nothing", [1, 1], 1, FORMAT, usage)?;
        let bounced = prt.gloss.as_ref().is_some_and(|gloss| gloss.bounced.is_some());
        Ok(Self {
            kernels: Kernels::new(gpu),
            factors,
            frame: geometry::buffer(gpu, "gloss of the frame", &frame, uniform)?,
            lobes: sized(gpu, "lobes", 4 * (lobe::ROWS * bands) as u64, fill)?,
            light: wide("turned light", counted)?,
            triples: geometry::buffer(
                gpu,
                "triple products",
                bytemuck::cast_slice(&terms),
                wgpu::BufferUsages::STORAGE,
            )?,
            sampler: sampler(&gpu.device),
            nothing: array_view(&nothing, 0, 1),
            empty: sized(gpu, "nothing", 16, fill)?,
            texel_layout: layout(&gpu.device, true),
            vertex_layout: layout(&gpu.device, false),
            bounced,
        })
    }
}

/// A buffer of so many bytes, 16 at least.
pub(crate) fn sized(
    gpu: &Gpu,
    label: &'static str,
    bytes: u64,
    usage: wgpu::BufferUsages,
) -> Result<wgpu::Buffer, Error> {
    let limit = gpu.limits.max_storage_buffer_binding_size.min(gpu.limits.max_buffer_size);
    Error::check_fits(
        || label.into(),
        bytes,
        limit,
        "bytes",
        "keep gloss in transfer textures, or use the CPU renderer",
    )?;
    Ok(gpu.device.create_buffer(&wgpu::BufferDescriptor {
        label: Some(label),
        size: bytes.max(16),
        usage,
        mapped_at_creation: false,
    }))
}

/// Levels of an array texture.
pub(crate) fn array_view(texture: &wgpu::Texture, first: u32, count: u32) -> wgpu::TextureView {
    texture.create_view(&wgpu::TextureViewDescriptor {
        dimension: Some(wgpu::TextureViewDimension::D2Array),
        base_mip_level: first,
        mip_level_count: Some(count),
        ..Default::default()
    })
}

/// Group 3 of surfaces with gloss or transfer textures: of texels, or of vertices.
fn layout(device: &wgpu::Device, texels: bool) -> wgpu::BindGroupLayout {
    use wgpu::{BindingType, BufferBindingType, SamplerBindingType, ShaderStages, TextureSampleType};
    let entry = |binding, ty| wgpu::BindGroupLayoutEntry {
        binding,
        visibility: ShaderStages::VERTEX_FRAGMENT,
        ty,
        count: None,
    };
    let buffer = |ty| BindingType::Buffer { ty, has_dynamic_offset: false, min_binding_size: None };
    let storage = || buffer(BufferBindingType::Storage { read_only: true });
    let picture = || BindingType::Texture {
        sample_type: TextureSampleType::Float { filterable: true },
        view_dimension: wgpu::TextureViewDimension::D2Array,
        multisampled: false,
    };
    let mut entries = vec![entry(0, buffer(BufferBindingType::Uniform))];
    entries.extend((1..5).map(|binding| entry(binding, storage())));
    if texels {
        entries.push(entry(5, BindingType::Sampler(SamplerBindingType::Filtering)));
        entries.push(entry(6, buffer(BufferBindingType::Uniform)));
        entries.extend((7..10).map(|binding| entry(binding, picture())));
    } else {
        entries.extend((5..7).map(|binding| entry(binding, storage())));
    }
    device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor { label: Some("gloss"), entries: &entries })
}

/// Bilinear in a level, linear between levels, clamped at the border (docs/shading.md, Transfer textures).
fn sampler(device: &wgpu::Device) -> wgpu::Sampler {
    device.create_sampler(&wgpu::SamplerDescriptor {
        label: Some("transfer texture"),
        mag_filter: wgpu::FilterMode::Linear,
        min_filter: wgpu::FilterMode::Linear,
        mipmap_filter: wgpu::MipmapFilterMode::Linear,
        ..Default::default()
    })
}
