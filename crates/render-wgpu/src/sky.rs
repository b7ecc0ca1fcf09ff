//! The light probe behind the scene.

use crate::{Error, Gpu, gpu_data, picture, shaders, surface};
use probe_io::{Environment, Lamp, Layout, Probe};

/// Pipeline, picture and lamps of the sky.
#[derive(Debug)]
pub(crate) struct Sky {
    pipeline: wgpu::RenderPipeline,
    bindings: wgpu::BindGroup,
}

impl Sky {
    /// Uploads the light. A probe in another layout than the panorama becomes one, with twice its resolution.
    pub(crate) fn new(
        gpu: &Gpu,
        environment: &Environment,
        view: &wgpu::BindGroupLayout,
        format: wgpu::TextureFormat,
    ) -> Result<Self, Error> {
        let layout = bindings_layout(&gpu.device);
        let pipeline = pipeline(&gpu.device, view, &layout, format);
        let texture = match environment.image.layout {
            Layout::Equirect => upload(gpu, &environment.image)?,
            _ => upload(gpu, &environment.image.to_equirect(rows(gpu, &environment.image)))?,
        };
        let lamps = environment.lamps.iter().map(lamp).collect::<Vec<_>>();
        // A binding has at least one element; one without radiance adds nothing.
        let lamps = if lamps.is_empty() { vec![gpu_data::Lamp::default()] } else { lamps };
        let usage = wgpu::BufferUsages::STORAGE;
        let lamps = crate::geometry::buffer(gpu, "lamps", bytemuck::cast_slice(&lamps), usage)?;
        let bindings = gpu.device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("sky"),
            layout: &layout,
            entries: &[
                wgpu::BindGroupEntry {
                    binding: 0,
                    resource: wgpu::BindingResource::TextureView(&picture::view(&texture)),
                },
                wgpu::BindGroupEntry { binding: 1, resource: lamps.as_entire_binding() },
            ],
        });
        Ok(Self { pipeline, bindings })
    }

    /// Draws the sky where no surface has written depth; the view is bound as group 0.
    pub(crate) fn draw(&self, pass: &mut wgpu::RenderPass<'_>) {
        pass.set_pipeline(&self.pipeline);
        pass.set_bind_group(1, &self.bindings, &[]);
        pass.draw(0..3, 0..1);
    }
}

/// Rows of the panorama that stands for a probe of another layout.
fn rows(gpu: &Gpu, probe: &Probe) -> usize {
    (2 * probe.equivalent_rows()).min(gpu.limits.max_texture_dimension_2d as usize / 2)
}

fn upload(gpu: &Gpu, probe: &Probe) -> Result<wgpu::Texture, Error> {
    let size = [probe.width, probe.height].map(|side| u32::try_from(side).unwrap_or(u32::MAX));
    let texels = picture::with_alpha(&probe.pixels);
    picture::upload(gpu, "the light probe", size, 1, picture::PROBE, &texels)
}

fn lamp(lamp: &Lamp) -> gpu_data::Lamp {
    let sin = (0.5 * f64::from(lamp.half_angle)).sin();
    gpu_data::Lamp {
        direction: lamp.direction.into(),
        chord_squared: (4.0 * sin * sin) as f32,
        radiance: lamp.radiance(),
        pad: 0.0,
    }
}

fn bindings_layout(device: &wgpu::Device) -> wgpu::BindGroupLayout {
    let entry =
        |binding, ty| wgpu::BindGroupLayoutEntry { binding, visibility: wgpu::ShaderStages::FRAGMENT, ty, count: None };
    let picture = wgpu::BindingType::Texture {
        sample_type: wgpu::TextureSampleType::Float { filterable: false },
        view_dimension: wgpu::TextureViewDimension::D2,
        multisampled: false,
    };
    let lamps = wgpu::BindingType::Buffer {
        ty: wgpu::BufferBindingType::Storage { read_only: true },
        has_dynamic_offset: false,
        min_binding_size: None,
    };
    device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
        label: Some("sky"),
        entries: &[entry(0, picture), entry(1, lamps)],
    })
}

fn pipeline(
    device: &wgpu::Device,
    view: &wgpu::BindGroupLayout,
    sky: &wgpu::BindGroupLayout,
    format: wgpu::TextureFormat,
) -> wgpu::RenderPipeline {
    let module = shaders::SKY.module(device);
    let layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
        label: Some("sky"),
        bind_group_layouts: &[Some(view), Some(sky)],
        immediate_size: 0,
    });
    device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: Some("sky"),
        layout: Some(&layout),
        vertex: wgpu::VertexState {
            module: &module,
            entry_point: Some("cover"),
            compilation_options: wgpu::PipelineCompilationOptions::default(),
            buffers: &[],
        },
        primitive: wgpu::PrimitiveState::default(),
        // The buffer was cleared to 0, the depth of infinity; nearer things have written more.
        depth_stencil: Some(surface::depth_state(false, wgpu::CompareFunction::Equal)),
        multisample: wgpu::MultisampleState::default(),
        fragment: Some(wgpu::FragmentState {
            module: &module,
            entry_point: Some("draw_sky"),
            compilation_options: wgpu::PipelineCompilationOptions::default(),
            targets: &[Some(format.into())],
        }),
        multiview_mask: None,
        cache: None,
    })
}
