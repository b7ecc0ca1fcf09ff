//! Rows of a light map on the GPU: their coefficients as the file has them, and what they are under a light.
//!
//! A sheet is lit as vertices are, each function at each texel a vertex of its own; strips keep the result within one storage binding.

use crate::{Error, Gpu, geometry, gpu_data, relight::Relight, shaders};
use coeff_io::{Layers, MapLight, Maps, Sheet, Transfer};
use sh_math::{Bands, Rgb};

/// Texels per workgroup along each axis, as sheet_fill.wgsl says.
const WORKGROUP: u32 = 8;
/// Bytes of a function at a texel under a light.
const LIT_BYTES: u64 = 12;

/// Some rows of a sheet.
#[derive(Debug)]
pub(crate) struct Strip {
    relight: Relight,
    numbers: wgpu::Buffer,
    workgroups: [u32; 2],
}

impl Strip {
    /// Uploads a sheet, with the functions that it holds, in as many strips as it takes.
    pub(crate) fn all(
        gpu: &Gpu,
        pipeline: &wgpu::ComputePipeline,
        maps: &Maps,
        sheet: &Sheet,
    ) -> Result<Vec<Self>, Error> {
        let (layers, stored) = (&sheet.layers, maps.held(sheet).count());
        let row_bytes = LIT_BYTES * stored as u64 * u64::from(layers.width);
        let limit = gpu.limits.max_storage_buffer_binding_size;
        let what = || format!("a row of a light map of {} texels", layers.width);
        Error::check_fits(what, row_bytes, limit, "bytes", "make it smaller or use the CPU renderer")?;
        let most = (limit / row_bytes).min(u64::from(layers.height)) as u32;
        let values = layers.decode();
        let first_rows = (0..layers.height).step_by(most as usize);
        let rows = first_rows.map(|first| first..layers.height.min(first + most));
        rows.map(|rows| Self::new(gpu, pipeline, &maps.light, (layers, stored, &values), rows)).collect()
    }

    fn new(
        gpu: &Gpu,
        pipeline: &wgpu::ComputePipeline,
        light: &MapLight,
        (layers, stored, values): (&Layers, usize, &[f32]),
        rows: std::ops::Range<u32>,
    ) -> Result<Self, Error> {
        let strip = gpu_data::Strip {
            width: layers.width,
            rows: rows.len() as u32,
            first_row: rows.start,
            stored: stored as u32,
        };
        let transfer = Transfer {
            bands: light_bands(light),
            channels: layers.channels,
            values: answers(layers, values, [stored, light.depth()], rows),
            ..Transfer::default()
        };
        let limit = gpu.limits.max_storage_buffer_binding_size;
        let usage = wgpu::BufferUsages::UNIFORM;
        Ok(Self {
            relight: Relight::with(gpu, pipeline, &transfer, limit)?,
            numbers: geometry::buffer(gpu, "strip", bytemuck::bytes_of(&strip), usage)?,
            workgroups: [strip.width, strip.rows].map(|n| n.div_ceil(WORKGROUP)),
        })
    }

    /// The bindings that bring this strip into `sheet` by the matrix `change`.
    pub(crate) fn bind(
        &self,
        gpu: &Gpu,
        fill: &wgpu::ComputePipeline,
        change: &wgpu::Buffer,
        sheet: &wgpu::TextureView,
    ) -> wgpu::BindGroup {
        let resources = [
            self.numbers.as_entire_binding(),
            change.as_entire_binding(),
            self.relight.lit().as_entire_binding(),
            wgpu::BindingResource::TextureView(sheet),
        ];
        let entries = (0..).zip(resources).map(|(binding, resource)| wgpu::BindGroupEntry { binding, resource });
        gpu.device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some(shaders::SHEET_FILL.name),
            layout: &fill.get_bind_group_layout(0),
            entries: &entries.collect::<Vec<_>>(),
        })
    }

    /// Records the strip's coefficients under a light ([`light_of`]).
    pub(crate) fn record(&self, gpu: &Gpu, encoder: &mut wgpu::CommandEncoder, light: &Rgb) {
        self.relight.record(gpu, encoder, light);
    }

    /// Records the change of basis of `drawn` functions, with the pipeline set.
    pub(crate) fn fill(&self, pass: &mut wgpu::ComputePass<'_>, bindings: &wgpu::BindGroup, drawn: u32) {
        pass.set_bind_group(0, bindings, &[]);
        pass.dispatch_workgroups(self.workgroups[0], self.workgroups[1], drawn);
    }
}

/// The light that maps are multiplied with: one white coefficient where they hold light themselves.
pub(crate) fn light_of(maps: &Maps, light: &Rgb) -> Rgb {
    match maps.light {
        MapLight::Relightable { .. } => maps.light_of(light),
        MapLight::Fixed { .. } => one(),
    }
}

/// A light whose only coefficient is 1.
fn one() -> Rgb {
    let mut light = Rgb::black(Bands::new(1).expect("one band exists"));
    light.values.fill([1.0; 3]);
    light
}

fn light_bands(light: &MapLight) -> u32 {
    match *light {
        MapLight::Relightable { bands } => bands,
        MapLight::Fixed { .. } => 1,
    }
}

/// `[function][row][column][coefficient of light][channel]` of some rows.
fn answers(layers: &Layers, values: &[f32], [stored, depth]: [usize; 2], rows: std::ops::Range<u32>) -> Vec<f32> {
    let (width, channels) = (layers.width as usize, layers.channels as usize);
    let plane = width * layers.height as usize;
    let texels = rows.start as usize * width..rows.end as usize * width;
    let mut answers = Vec::with_capacity(stored * texels.len() * depth * channels);
    for function in 0..stored {
        for texel in texels.clone() {
            for layer in function * depth..(function + 1) * depth {
                answers.extend_from_slice(&values[(layer * plane + texel) * channels..][..channels]);
            }
        }
    }
    answers
}
