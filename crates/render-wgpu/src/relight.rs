//! Diffuse light of every vertex: transfer times light, computed once per light.
//!
//! The transfer stays on the GPU in chunks that each fit one storage binding (128 MiB is all that WebGPU promises and
//! all that lavapipe gives); frames then read three floats per vertex, however many bands the file has.

use crate::{Error, Gpu, geometry, gpu_data::Chunk, shaders};
use coeff_io::Transfer;
use sh_math::Rgb;

/// Vertices per workgroup, as relight.wgsl says.
const WORKGROUP: u64 = 64;
/// Bytes of a vertex' result: three floats.
const LIT_BYTES: u64 = 12;

/// The transfer on the GPU, and its product with the light of the last call.
#[derive(Debug)]
pub(crate) struct Relight {
    pipeline: wgpu::ComputePipeline,
    light: wgpu::Buffer,
    parts: Vec<Part>,
    lit: wgpu::Buffer,
}

#[derive(Debug)]
struct Part {
    bindings: wgpu::BindGroup,
    workgroups: u32,
}

impl Relight {
    /// Uploads the transfer in chunks of at most `chunk_bytes` bytes.
    pub(crate) fn new(gpu: &Gpu, transfer: &Transfer, chunk_bytes: u64) -> Result<Self, Error> {
        Self::with(gpu, &pipeline(gpu, transfer.channels), transfer, chunk_bytes)
    }

    /// [`Relight::new`] with the [`pipeline`] of the transfer's channels, which many can share.
    pub(crate) fn with(
        gpu: &Gpu,
        pipeline: &wgpu::ComputePipeline,
        transfer: &Transfer,
        chunk_bytes: u64,
    ) -> Result<Self, Error> {
        let per_vertex = (transfer.bands as usize).pow(2) * transfer.channels as usize;
        let vertices = transfer.values.len() / per_vertex;
        let storage = wgpu::BufferUsages::STORAGE;
        let light_bytes = vec![0; (transfer.bands as usize).pow(2) * size_of::<[f32; 4]>()];
        let light = geometry::buffer(gpu, "light", &light_bytes, storage | wgpu::BufferUsages::COPY_DST)?;
        let lit = lit_buffer(gpu, vertices as u64)?;
        let chunk = chunk_vertices(gpu, per_vertex as u64, chunk_bytes)?;
        let mut parts = Vec::new();
        for (index, values) in transfer.values.chunks(chunk * per_vertex).enumerate() {
            let numbers =
                Chunk { vertices: (values.len() / per_vertex) as u32, coefficients: transfer.bands * transfer.bands };
            let transfer =
                geometry::buffer(gpu, "transfer", bytemuck::cast_slice(&planar(values, per_vertex)), storage)?;
            let numbers_buffer =
                geometry::buffer(gpu, "chunk", bytemuck::bytes_of(&numbers), wgpu::BufferUsages::UNIFORM)?;
            let lit_part = wgpu::BufferBinding {
                buffer: &lit,
                offset: (index * chunk) as u64 * LIT_BYTES,
                size: wgpu::BufferSize::new(u64::from(numbers.vertices) * LIT_BYTES),
            };
            let resources = [
                numbers_buffer.as_entire_binding(),
                light.as_entire_binding(),
                transfer.as_entire_binding(),
                wgpu::BindingResource::Buffer(lit_part),
            ];
            let bindings = bind(gpu, pipeline, resources);
            parts.push(Part { bindings, workgroups: numbers.vertices.div_ceil(WORKGROUP as u32) });
        }
        Ok(Self { pipeline: pipeline.clone(), light, parts, lit })
    }

    /// Diffuse radiance without albedo, three floats per vertex: a vertex buffer.
    pub(crate) fn lit(&self) -> &wgpu::Buffer {
        &self.lit
    }

    /// Records the products with `light`, whose bands are those of the transfer.
    pub(crate) fn record(&self, gpu: &Gpu, encoder: &mut wgpu::CommandEncoder, light: &Rgb) {
        let padded = light.values.iter().map(|&[r, g, b]| [r, g, b, 0.0]).collect::<Vec<_>>();
        gpu.queue.write_buffer(&self.light, 0, bytemuck::cast_slice(&padded));
        let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor {
            label: Some(shaders::RELIGHT.name),
            timestamp_writes: None,
        });
        pass.set_pipeline(&self.pipeline);
        for part in &self.parts {
            pass.set_bind_group(0, &part.bindings, &[]);
            pass.dispatch_workgroups(part.workgroups, 1, 1);
        }
    }
}

fn lit_buffer(gpu: &Gpu, vertices: u64) -> Result<wgpu::Buffer, Error> {
    // Never empty: a buffer without bytes cannot be bound.
    let size = vertices.max(1) * LIT_BYTES;
    let advice = "simplify the scene or use the CPU renderer";
    Error::check_fits(|| "the vertices' light".into(), size, gpu.limits.max_buffer_size, "bytes", advice)?;
    Ok(gpu.device.create_buffer(&wgpu::BufferDescriptor {
        label: Some("lit"),
        size,
        usage: wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::VERTEX | wgpu::BufferUsages::COPY_SRC,
        mapped_at_creation: false,
    }))
}

/// The dot products of a transfer of 1 or 3 channels.
pub(crate) fn pipeline(gpu: &Gpu, channels: u32) -> wgpu::ComputePipeline {
    let module = shaders::RELIGHT.module(&gpu.device);
    gpu.device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
        label: Some(shaders::RELIGHT.name),
        layout: None,
        module: &module,
        entry_point: Some("relight"),
        compilation_options: wgpu::PipelineCompilationOptions {
            constants: &[("channels", f64::from(channels))],
            ..Default::default()
        },
        cache: None,
    })
}

fn bind(gpu: &Gpu, pipeline: &wgpu::ComputePipeline, resources: [wgpu::BindingResource<'_>; 4]) -> wgpu::BindGroup {
    let entries = (0..).zip(resources).map(|(binding, resource)| wgpu::BindGroupEntry { binding, resource });
    gpu.device.create_bind_group(&wgpu::BindGroupDescriptor {
        label: Some(shaders::RELIGHT.name),
        layout: &pipeline.get_bind_group_layout(0),
        entries: &entries.collect::<Vec<_>>(),
    })
}

/// How many vertices a chunk holds: whole workgroups, so that each chunk's results start at an aligned offset
/// (64 vertices of 12 bytes are three times 256 bytes, the largest alignment that WebGPU allows).
fn chunk_vertices(gpu: &Gpu, per_vertex: u64, chunk_bytes: u64) -> Result<usize, Error> {
    let limits = &gpu.limits;
    let bytes = chunk_bytes.min(limits.max_storage_buffer_binding_size).min(limits.max_buffer_size);
    let group_bytes = (per_vertex * 4).max(LIT_BYTES) * WORKGROUP;
    let what = || format!("the transfer of {WORKGROUP} vertices");
    Error::check_fits(what, group_bytes, bytes, "bytes", "bake with fewer bands or use the CPU renderer")?;
    let groups = (bytes / group_bytes).min(u64::from(limits.max_compute_workgroups_per_dimension));
    Ok((groups * WORKGROUP) as usize)
}

/// `[vertex][number]` to `[number][vertex]`.
fn planar(values: &[f32], per_vertex: usize) -> Vec<f32> {
    (0..per_vertex).flat_map(|number| values.iter().skip(number).step_by(per_vertex).copied()).collect()
}
