//! Directional light maps on the GPU: lit when the light changes, in the basis that is drawn.

use crate::strip::{self, Strip};
use crate::{Error, Gpu, geometry, picture, relight, shaders};
use coeff_io::{Maps, Prt};
use glam::Quat;
use sh_math::{Rgb, hemisphere::Basis};

/// The format of the coefficients that surfaces read: the finest that every GPU filters.
const FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba16Float;

/// The light maps of a scene.
#[derive(Debug)]
pub(crate) struct Sheets {
    /// As the file has them, without their layers.
    maps: Maps,
    fill: wgpu::ComputePipeline,
    layout: wgpu::BindGroupLayout,
    sampler: wgpu::Sampler,
    stored: Vec<Stored>,
    drawn: Option<Drawn>,
    /// The light that is in the textures.
    lit_for: Option<Quat>,
}

/// A sheet as the file has it.
#[derive(Debug)]
struct Stored {
    size: [u32; 2],
    /// The functions that it holds.
    held: Basis,
    strips: Vec<Strip>,
}

/// All sheets as they are drawn.
#[derive(Debug)]
struct Drawn {
    /// What was asked for.
    basis: Basis,
    sheets: Vec<DrawnSheet>,
}

#[derive(Debug)]
struct DrawnSheet {
    /// The functions of the texture.
    basis: Basis,
    /// For surfaces.
    bindings: wgpu::BindGroup,
    /// One for each strip.
    fills: Vec<wgpu::BindGroup>,
}

impl Sheets {
    /// Uploads the maps of a file; none where no mesh shows one.
    pub(crate) fn new(gpu: &Gpu, prt: &Prt) -> Result<Option<Self>, Error> {
        let Some(maps) = prt.maps.as_ref().filter(|maps| maps.are_shown()) else { return Ok(None) };
        let pipelines = [1, 3].map(|channels| relight::pipeline(gpu, channels));
        let store = |sheet: &coeff_io::Sheet| {
            let layers = &sheet.layers;
            let pipeline = &pipelines[usize::from(layers.channels == 3)];
            let strips = Strip::all(gpu, pipeline, maps, sheet)?;
            Ok(Stored { size: [layers.width, layers.height], held: maps.held(sheet), strips })
        };
        let stored = maps.sheets.iter().map(store).collect::<Result<_, Error>>()?;
        let sheet_of_mesh = maps.sheet_of_mesh.clone();
        Ok(Some(Self {
            maps: Maps { basis: maps.basis, light: maps.light.clone(), sheets: Vec::new(), sheet_of_mesh },
            fill: fill(gpu),
            layout: layout(&gpu.device),
            sampler: sampler(&gpu.device),
            stored,
            drawn: None,
            lit_for: None,
        }))
    }

    /// What frames are checked against: the maps without their layers.
    pub(crate) fn maps(&self) -> &Maps {
        &self.maps
    }

    /// The layout of group 3 of sheet.wgsl.
    pub(crate) fn layout(&self) -> &wgpu::BindGroupLayout {
        &self.layout
    }

    /// The basis that a sheet is drawn in where `asked` is asked for.
    pub(crate) fn basis(&self, sheet: u32, asked: Basis) -> Basis {
        Maps::shown(self.stored[sheet as usize].held, asked)
    }

    /// The bindings of a sheet; none before the first [`Sheets::record`].
    pub(crate) fn bindings(&self, sheet: u32) -> Option<&wgpu::BindGroup> {
        self.drawn.as_ref().map(|drawn| &drawn.sheets[sheet as usize].bindings)
    }

    /// Forgets the light.
    pub(crate) fn unlight(&mut self) {
        self.lit_for = None;
    }

    /// Records the maps in `basis` under `light` turned by `rotation`, where they are not so yet.
    pub(crate) fn record(
        &mut self,
        gpu: &Gpu,
        encoder: &mut wgpu::CommandEncoder,
        light: &Rgb,
        rotation: Quat,
        basis: Basis,
    ) -> Result<(), Error> {
        let drawn = match self.drawn.take() {
            Some(drawn) if drawn.basis == basis => drawn,
            _ => {
                self.lit_for = None;
                self.draw_in(gpu, basis)?
            }
        };
        if self.lit_for != Some(rotation) {
            let light = strip::light_of(&self.maps, &light.rotated(rotation.normalize()));
            self.stored.iter().flat_map(|sheet| &sheet.strips).for_each(|strip| strip.record(gpu, encoder, &light));
            self.record_fill(encoder, &drawn);
            self.lit_for = Some(rotation);
        }
        self.drawn = Some(drawn);
        Ok(())
    }

    fn record_fill(&self, encoder: &mut wgpu::CommandEncoder, drawn: &Drawn) {
        let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor {
            label: Some(shaders::SHEET_FILL.name),
            timestamp_writes: None,
        });
        pass.set_pipeline(&self.fill);
        for (stored, sheet) in self.stored.iter().zip(&drawn.sheets) {
            for (strip, bindings) in stored.strips.iter().zip(&sheet.fills) {
                strip.fill(&mut pass, bindings, sheet.basis.count() as u32);
            }
        }
    }

    /// Textures for the basis that is asked for, still black.
    fn draw_in(&self, gpu: &Gpu, asked: Basis) -> Result<Drawn, Error> {
        let draw = |(index, stored): (usize, &Stored)| {
            let basis = Maps::shown(stored.held, asked);
            let change = change(gpu, stored.held, basis)?;
            let usage = wgpu::TextureUsages::STORAGE_BINDING | wgpu::TextureUsages::TEXTURE_BINDING;
            let label = format!("light map {index}");
            let texture = picture::create(gpu, &label, stored.size, basis.count() as u32, FORMAT, usage)?;
            let view = texture.create_view(&wgpu::TextureViewDescriptor {
                dimension: Some(wgpu::TextureViewDimension::D2Array),
                ..Default::default()
            });
            let fills = stored.strips.iter().map(|strip| strip.bind(gpu, &self.fill, &change, &view)).collect();
            Ok(DrawnSheet { basis, bindings: self.bind(gpu, &label, &view), fills })
        };
        let sheets = self.stored.iter().enumerate().map(draw).collect::<Result<_, Error>>()?;
        Ok(Drawn { basis: asked, sheets })
    }

    fn bind(&self, gpu: &Gpu, label: &str, view: &wgpu::TextureView) -> wgpu::BindGroup {
        let resources = [wgpu::BindingResource::TextureView(view), wgpu::BindingResource::Sampler(&self.sampler)];
        let entries = (0..).zip(resources).map(|(binding, resource)| wgpu::BindGroupEntry { binding, resource });
        gpu.device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some(label),
            layout: &self.layout,
            entries: &entries.collect::<Vec<_>>(),
        })
    }
}

/// The matrix from coefficients of `held` to those of `shown`.
fn change(gpu: &Gpu, held: Basis, shown: Basis) -> Result<wgpu::Buffer, Error> {
    let rows = shown.matrix_from(held);
    let matrix = rows.iter().flat_map(|row| &row[..held.count()]).map(|&x| x as f32).collect::<Vec<_>>();
    geometry::buffer(gpu, "change of basis", bytemuck::cast_slice(&matrix), wgpu::BufferUsages::STORAGE)
}

fn layout(device: &wgpu::Device) -> wgpu::BindGroupLayout {
    let entry =
        |binding, ty| wgpu::BindGroupLayoutEntry { binding, visibility: wgpu::ShaderStages::FRAGMENT, ty, count: None };
    let sheet = wgpu::BindingType::Texture {
        sample_type: wgpu::TextureSampleType::Float { filterable: true },
        view_dimension: wgpu::TextureViewDimension::D2Array,
        multisampled: false,
    };
    device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
        label: Some("light map"),
        entries: &[entry(0, sheet), entry(1, wgpu::BindingType::Sampler(wgpu::SamplerBindingType::Filtering))],
    })
}

/// Bilinear, clamped at the border (docs/shading.md, Light maps).
fn sampler(device: &wgpu::Device) -> wgpu::Sampler {
    device.create_sampler(&wgpu::SamplerDescriptor {
        label: Some("light map"),
        mag_filter: wgpu::FilterMode::Linear,
        min_filter: wgpu::FilterMode::Linear,
        ..Default::default()
    })
}

fn fill(gpu: &Gpu) -> wgpu::ComputePipeline {
    let module = shaders::SHEET_FILL.module(&gpu.device);
    gpu.device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
        label: Some(shaders::SHEET_FILL.name),
        layout: None,
        module: &module,
        entry_point: Some("fill"),
        compilation_options: wgpu::PipelineCompilationOptions::default(),
        cache: None,
    })
}
