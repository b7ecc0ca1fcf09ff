//! Receivers on the GPU: their tables, and the passes that put a light on them.

use crate::{Error, Gpu, geometry, gpu_data, shaders};
use coeff_io::{Codebook, Form, Table};

/// Receivers per workgroup, as gloss_rows.wgsl says.
const WORKGROUP: u32 = 64;
/// Bytes of one function of a receiver under a light.
const LIT_BYTES: u64 = 16;

/// The passes of gloss_rows.wgsl.
#[derive(Debug)]
pub(crate) struct Kernels {
    clear: wgpu::ComputePipeline,
    multiply: wgpu::ComputePipeline,
    combine: wgpu::ComputePipeline,
    add: wgpu::ComputePipeline,
    diffuse: wgpu::ComputePipeline,
    store_texels: wgpu::ComputePipeline,
    store_halves: wgpu::ComputePipeline,
    store_radiance: wgpu::ComputePipeline,
}

impl Kernels {
    pub(crate) fn new(gpu: &Gpu) -> Self {
        let module = shaders::GLOSS_ROWS.module(&gpu.device);
        let pipeline = |entry: &str| {
            gpu.device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
                label: Some(entry),
                layout: None,
                module: &module,
                entry_point: Some(entry),
                compilation_options: wgpu::PipelineCompilationOptions::default(),
                cache: None,
            })
        };
        Self {
            clear: pipeline("clear"),
            multiply: pipeline("multiply"),
            combine: pipeline("combine"),
            add: pipeline("add"),
            diffuse: pipeline("diffuse"),
            store_texels: pipeline("store_texels"),
            store_halves: pipeline("store_halves"),
            store_radiance: pipeline("store_radiance"),
        }
    }
}

/// What rows are multiplied with under a light, one buffer each.
#[derive(Debug)]
pub(crate) struct Factors {
    /// `[row][column]`.
    pub(crate) matrix: wgpu::Buffer,
    /// Products of the codebook of visibility.
    pub(crate) visibility: wgpu::Buffer,
    /// Products of the codebook of bounces.
    pub(crate) bounce: wgpu::Buffer,
    /// Coefficients of the light, for diffuse transfer.
    pub(crate) light: wgpu::Buffer,
    /// Products of the codebook of diffuse transfer.
    pub(crate) diffuse: wgpu::Buffer,
}

/// What a table contributes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Part {
    Visibility,
    Bounce,
    Diffuse {
        /// Of the transfer.
        coefficients: u32,
        channels: u32,
    },
}

/// Where the result goes.
#[derive(Debug)]
pub(crate) enum Target<'a> {
    /// A level of a texture, at the texels of the rows.
    Texels(&'a wgpu::TextureView),
    /// Four halves per function.
    Halves(&'a wgpu::Buffer),
    /// Three floats per row.
    Radiance(&'a wgpu::Buffer),
}

/// Writes the radiance of a table of bounces and a row.
pub(crate) type ReadRow<'a> = dyn Fn(usize, u32, &mut [[f32; 4]]) + 'a;

/// A run of receivers, few enough for one storage binding.
#[derive(Debug)]
pub(crate) struct RowSet {
    count: u32,
    functions: u32,
    first: u32,
    lit: wgpu::Buffer,
    steps: Vec<Step>,
    store: Option<Dispatch>,
}

/// A pass over the rows.
#[derive(Debug)]
struct Step {
    dispatch: Dispatch,
    /// Rows of radiance that the CPU writes: which table of bounces.
    radiance: Option<(usize, wgpu::Buffer)>,
}

#[derive(Debug)]
struct Dispatch {
    pipeline: wgpu::ComputePipeline,
    bindings: wgpu::BindGroup,
}

/// A table of which rows are taken.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Taken<'a> {
    pub(crate) part: Part,
    pub(crate) table: &'a Table,
    pub(crate) book: Option<&'a Codebook>,
    /// Number of the table among those of bounces.
    pub(crate) number: usize,
}

/// Most rows that one set may have.
pub(crate) fn most_rows(gpu: &Gpu, functions: u32, widest: u32) -> u32 {
    let row = (LIT_BYTES * u64::from(functions)).max(4 * u64::from(widest)).max(4);
    let bytes = gpu.limits.max_storage_buffer_binding_size.min(gpu.limits.max_buffer_size);
    let groups = u64::from(gpu.limits.max_compute_workgroups_per_dimension) * u64::from(WORKGROUP);
    (bytes / row).min(groups).clamp(1, u64::from(u32::MAX)) as u32
}

impl RowSet {
    /// Uploads rows `first..first + count` of some tables, whose results add up; `places` are the texels of these rows.
    pub(crate) fn new(
        gpu: &Gpu,
        kernels: &Kernels,
        factors: &Factors,
        functions: u32,
        [first, count]: [u32; 2],
        taken: &[Taken<'_>],
    ) -> Result<Self, Error> {
        let size = u64::from(count.max(1)) * u64::from(functions) * LIT_BYTES;
        let lit = gpu.device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("rows under a light"),
            size,
            usage: wgpu::BufferUsages::STORAGE,
            mapped_at_creation: false,
        });
        let mut set = Self { count, functions, first, lit, steps: Vec::new(), store: None };
        let starts = taken.first().is_some_and(|one| set.overwrites(one));
        if !starts {
            let numbers = set.numbers(gpu, 0, 0)?;
            let bindings = bind(gpu, &kernels.clear, &[(0, numbers.as_entire_binding()), (1, set.lit_binding())]);
            set.push(&kernels.clear, bindings, None);
        }
        for one in taken {
            set.take(gpu, kernels, factors, one)?;
        }
        Ok(set)
    }

    /// Whether a table's pass writes every number rather than adding.
    fn overwrites(&self, taken: &Taken<'_>) -> bool {
        taken.table.form != Form::Clustered && !matches!(taken.part, Part::Bounce)
    }

    fn push(
        &mut self,
        pipeline: &wgpu::ComputePipeline,
        bindings: wgpu::BindGroup,
        radiance: Option<(usize, wgpu::Buffer)>,
    ) {
        let dispatch = Dispatch { pipeline: pipeline.clone(), bindings };
        self.steps.push(Step { dispatch, radiance });
    }

    fn lit_binding(&self) -> wgpu::BindingResource<'_> {
        self.lit.as_entire_binding()
    }

    fn numbers(&self, gpu: &Gpu, rank: u32, width: u32) -> Result<wgpu::Buffer, Error> {
        let numbers = gpu_data::Rows { count: self.count, functions: self.functions, rank, width, first: self.first };
        geometry::buffer(gpu, "rows", bytemuck::bytes_of(&numbers), wgpu::BufferUsages::UNIFORM)
    }

    fn take(&mut self, gpu: &Gpu, kernels: &Kernels, factors: &Factors, taken: &Taken<'_>) -> Result<(), Error> {
        let storage = wgpu::BufferUsages::STORAGE;
        let rows = self.first..self.first + self.count;
        if let (Form::Clustered, Some(book)) = (taken.table.form, taken.book) {
            let clusters: Vec<u32> = rows.clone().map(|row| u32::from(taken.table.cluster(row))).collect();
            let weights: Vec<f32> = rows.flat_map(|row| taken.table.weights(book.rank, row)).collect();
            let numbers = self.numbers(gpu, book.rank, 0)?;
            let clusters = geometry::buffer(gpu, "clusters", bytemuck::cast_slice(&clusters), storage)?;
            let weights = geometry::buffer(gpu, "weights", bytemuck::cast_slice(&weights), storage)?;
            let products = match taken.part {
                Part::Visibility => &factors.visibility,
                Part::Bounce => &factors.bounce,
                Part::Diffuse { .. } => &factors.diffuse,
            };
            let bindings = bind(
                gpu,
                &kernels.combine,
                &[
                    (0, numbers.as_entire_binding()),
                    (1, self.lit_binding()),
                    (2, weights.as_entire_binding()),
                    (3, products.as_entire_binding()),
                    (4, clusters.as_entire_binding()),
                ],
            );
            self.push(&kernels.combine, bindings, None);
            return Ok(());
        }
        match taken.part {
            Part::Bounce => {
                let size = u64::from(self.count.max(1)) * u64::from(self.functions) * LIT_BYTES;
                let radiance = gpu.device.create_buffer(&wgpu::BufferDescriptor {
                    label: Some("radiance of surfaces"),
                    size,
                    usage: storage | wgpu::BufferUsages::COPY_DST,
                    mapped_at_creation: false,
                });
                let numbers = self.numbers(gpu, 0, 0)?;
                let entries =
                    [(0, numbers.as_entire_binding()), (1, self.lit_binding()), (3, radiance.as_entire_binding())];
                let bindings = bind(gpu, &kernels.add, &entries);
                self.push(&kernels.add, bindings, Some((taken.number, radiance)));
            }
            Part::Visibility => {
                let values = self.values(gpu, taken)?;
                let numbers = self.numbers(gpu, 0, 0)?;
                let bindings = bind(
                    gpu,
                    &kernels.multiply,
                    &[
                        (0, numbers.as_entire_binding()),
                        (1, self.lit_binding()),
                        (2, values.as_entire_binding()),
                        (3, factors.matrix.as_entire_binding()),
                    ],
                );
                self.push(&kernels.multiply, bindings, None);
            }
            Part::Diffuse { coefficients, channels } => {
                let values = self.values(gpu, taken)?;
                let numbers = self.numbers(gpu, coefficients, channels)?;
                let bindings = bind(
                    gpu,
                    &kernels.diffuse,
                    &[
                        (0, numbers.as_entire_binding()),
                        (1, self.lit_binding()),
                        (2, values.as_entire_binding()),
                        (3, factors.light.as_entire_binding()),
                    ],
                );
                self.push(&kernels.diffuse, bindings, None);
            }
        }
        Ok(())
    }

    /// The exact rows of a table, as floats.
    fn values(&self, gpu: &Gpu, taken: &Taken<'_>) -> Result<wgpu::Buffer, Error> {
        let columns = taken.table.columns as usize;
        let mut values = vec![0.0f32; self.count as usize * columns];
        for (row, out) in (self.first..).zip(values.chunks_exact_mut(columns.max(1))) {
            taken.table.read(taken.book, row, out);
        }
        geometry::buffer(gpu, "rows of a table", bytemuck::cast_slice(&values), wgpu::BufferUsages::STORAGE)
    }

    /// Says where the result goes; `places` are the texels of all rows of the table.
    pub(crate) fn send_to(
        &mut self,
        gpu: &Gpu,
        kernels: &Kernels,
        target: &Target<'_>,
        (places, width): (&[u32], u32),
    ) -> Result<(), Error> {
        let (pipeline, bindings) = match target {
            Target::Texels(view) => {
                let own = &places[self.first as usize..(self.first + self.count) as usize];
                let storage = wgpu::BufferUsages::STORAGE;
                let places = geometry::buffer(gpu, "places", bytemuck::cast_slice(own), storage)?;
                let numbers = self.numbers(gpu, 0, width)?;
                let entries = [
                    (0, numbers.as_entire_binding()),
                    (1, self.lit_binding()),
                    (4, places.as_entire_binding()),
                    (5, wgpu::BindingResource::TextureView(view)),
                ];
                (&kernels.store_texels, bind(gpu, &kernels.store_texels, &entries))
            }
            Target::Halves(buffer) | Target::Radiance(buffer) => {
                let (pipeline, binding) = match target {
                    Target::Halves(..) => (&kernels.store_halves, 6),
                    _ => (&kernels.store_radiance, 7),
                };
                let numbers = self.numbers(gpu, 0, 0)?;
                let entries =
                    [(0, numbers.as_entire_binding()), (1, self.lit_binding()), (binding, buffer.as_entire_binding())];
                (pipeline, bind(gpu, pipeline, &entries))
            }
        };
        self.store = Some(Dispatch { pipeline: pipeline.clone(), bindings });
        Ok(())
    }

    /// Writes the radiance of bounces that are not in clusters; `read` writes that of a row and table, `functions` times RGB and a number.
    pub(crate) fn write_radiance(&self, gpu: &Gpu, read: &ReadRow<'_>) {
        for step in &self.steps {
            let Some((table, buffer)) = &step.radiance else { continue };
            let functions = self.functions as usize;
            let mut values = vec![[0.0f32; 4]; self.count as usize * functions];
            for (row, out) in (self.first..).zip(values.chunks_exact_mut(functions)) {
                read(*table, row, out);
            }
            gpu.queue.write_buffer(buffer, 0, bytemuck::cast_slice(&values));
        }
    }

    /// Records the passes; without visibility where only bounces are wanted.
    pub(crate) fn record(&self, pass: &mut wgpu::ComputePass<'_>) {
        let passes = self.steps.iter().map(|step| &step.dispatch).chain(&self.store);
        for dispatch in passes {
            pass.set_pipeline(&dispatch.pipeline);
            pass.set_bind_group(0, &dispatch.bindings, &[]);
            pass.dispatch_workgroups(self.count.div_ceil(WORKGROUP).max(1), self.functions, 1);
        }
    }
}

/// The bindings of one pass.
fn bind(
    gpu: &Gpu,
    pipeline: &wgpu::ComputePipeline,
    resources: &[(u32, wgpu::BindingResource<'_>)],
) -> wgpu::BindGroup {
    let entries: Vec<wgpu::BindGroupEntry<'_>> = resources
        .iter()
        .map(|(binding, resource)| wgpu::BindGroupEntry { binding: *binding, resource: resource.clone() })
        .collect();
    gpu.device.create_bind_group(&wgpu::BindGroupDescriptor {
        label: Some("rows"),
        layout: &pipeline.get_bind_group_layout(0),
        entries: &entries,
    })
}
