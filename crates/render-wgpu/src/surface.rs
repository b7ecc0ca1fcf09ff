//! The surfaces of a scene: pipelines for what the file holds, and what to draw with them.

use crate::geometry::{Attribute, Geometry};
use crate::material::{self, BoundMaterial, Variant};
use crate::sheets::Sheets;
use crate::{Error, Gpu, blend::Blended, gpu_data, shaders};
use coeff_io::Prt;
use glam::Quat;
use sh_math::{Rgb, hemisphere::Basis};
use std::{collections::HashMap, ops::Range};

/// The depth buffer: reversed, near / w.
pub(crate) const DEPTH: wgpu::TextureFormat = wgpu::TextureFormat::Depth32Float;

/// A run of triangles with one material and one light map, or none.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Draw {
    pub(crate) material: u32,
    pub(crate) sheet: Option<u32>,
    pub(crate) triangles: Range<u32>,
}

/// All surfaces, ready to be drawn.
#[derive(Debug)]
pub(crate) struct Surfaces {
    geometry: Geometry,
    materials: Vec<BoundMaterial>,
    layouts: Layouts,
    format: wgpu::TextureFormat,
    /// Materials in use, with the light map above them.
    kinds: Vec<(u32, Option<u32>)>,
    pipelines: HashMap<Variant, wgpu::RenderPipeline>,
    reflection: Option<wgpu::BindGroup>,
    /// Only where a mesh shows one.
    sheets: Option<Sheets>,
    /// The basis that is asked for light maps.
    basis: Option<Basis>,
    opaque: Vec<Draw>,
    blended: Option<Blended>,
}

/// The layouts of the groups that surfaces read.
#[derive(Debug)]
pub(crate) struct Layouts {
    pub(crate) view: wgpu::BindGroupLayout,
    pub(crate) material: wgpu::BindGroupLayout,
    /// Only where something shines.
    pub(crate) reflection: Option<wgpu::BindGroupLayout>,
}

impl Surfaces {
    /// Uploads geometry, materials, textures and light maps; builds one pipeline per variant in use.
    pub(crate) fn new(
        gpu: &Gpu,
        prt: &Prt,
        layouts: Layouts,
        reflection: Option<wgpu::BindGroup>,
        lit: wgpu::Buffer,
        format: wgpu::TextureFormat,
    ) -> Result<Self, Error> {
        let geometry = Geometry::new(gpu, prt, lit, reflection.is_some())?;
        let materials = material::upload(gpu, prt, &layouts.material)?;
        let draws = draws(prt);
        let mut kinds = draws.iter().map(|draw| (draw.material, draw.sheet)).collect::<Vec<_>>();
        kinds.sort_unstable();
        kinds.dedup();
        let is_blended = |draw: &Draw| materials[draw.material as usize].is_blended();
        let (behind, opaque) = draws.into_iter().partition::<Vec<_>, _>(is_blended);
        let blended = Blended::new(gpu, prt, &behind)?;
        let sheets = Sheets::new(gpu, prt)?;
        let basis = sheets.as_ref().map(|sheets| sheets.maps().basis);
        let pipelines = HashMap::new();
        let mut surfaces =
            Self { geometry, materials, layouts, format, kinds, pipelines, reflection, sheets, basis, opaque, blended };
        surfaces.build_pipelines(gpu);
        Ok(surfaces)
    }

    /// Builds the pipelines that are not there yet.
    fn build_pipelines(&mut self, gpu: &Gpu) {
        for &(material, sheet) in &self.kinds {
            let variant = self.variant(material, sheet);
            if !self.pipelines.contains_key(&variant) {
                self.pipelines.insert(variant, self.pipeline(gpu, variant));
            }
        }
    }

    fn variant(&self, material: u32, sheet: Option<u32>) -> Variant {
        let maps = self.sheets.as_ref().zip(sheet);
        let basis = maps.zip(self.basis).map(|((sheets, sheet), asked)| sheets.basis(sheet, asked));
        self.materials[material as usize].variant(basis)
    }

    /// The light maps without their layers, if there are any.
    pub(crate) fn maps(&self) -> Option<&coeff_io::Maps> {
        self.sheets.as_ref().map(Sheets::maps)
    }

    /// Forgets the light of the light maps.
    pub(crate) fn unlight(&mut self) {
        self.sheets.iter_mut().for_each(Sheets::unlight);
    }

    /// Records the light maps in `basis`, if there are any, under `light` turned by `rotation`; builds the pipelines for them.
    pub(crate) fn light_maps(
        &mut self,
        gpu: &Gpu,
        encoder: &mut wgpu::CommandEncoder,
        light: &Rgb,
        rotation: Quat,
        basis: Option<Basis>,
    ) -> Result<(), Error> {
        if let (Some(sheets), Some(basis)) = (&mut self.sheets, basis) {
            sheets.record(gpu, encoder, light, rotation, basis)?;
            self.basis = Some(basis);
            self.build_pipelines(gpu);
        }
        Ok(())
    }

    /// Number of pipelines that were built.
    pub(crate) fn pipelines(&self) -> usize {
        self.pipelines.len()
    }

    /// Draws opaque and masked surfaces in file order: of equal depths the first stays.
    pub(crate) fn draw_opaque(&self, pass: &mut wgpu::RenderPass<'_>) {
        self.draw(pass, &self.geometry.triangles, &self.opaque);
    }

    /// Draws blended surfaces, farthest first.
    pub(crate) fn draw_blended(&self, gpu: &Gpu, pass: &mut wgpu::RenderPass<'_>, view: &gpu_data::View) {
        if let Some(blended) = &self.blended {
            self.draw(pass, &blended.indices, &blended.sort(gpu, view));
        }
    }

    fn draw(&self, pass: &mut wgpu::RenderPass<'_>, indices: &wgpu::Buffer, draws: &[Draw]) {
        pass.set_index_buffer(indices.slice(..), wgpu::IndexFormat::Uint32);
        let mut last = None;
        for draw in draws {
            let material = &self.materials[draw.material as usize];
            let variant = self.variant(draw.material, draw.sheet);
            if last != Some(variant) {
                self.set_variant(pass, variant);
                last = Some(variant);
            }
            pass.set_bind_group(1, &material.bindings, &[]);
            if let (Some(sheets), Some(sheet)) = (&self.sheets, draw.sheet) {
                pass.set_bind_group(3, sheets.bindings(sheet), &[]);
            }
            pass.draw_indexed(3 * draw.triangles.start..3 * draw.triangles.end, 0, 0..1);
        }
    }

    fn pipeline(&self, gpu: &Gpu, variant: Variant) -> wgpu::RenderPipeline {
        let shader = shaders::surface(variant.shiny, variant.basis);
        let (vertex_entry, fragment_entry) =
            if variant.shiny { ("place_shiny", "draw_shiny") } else { ("place_diffuse", "draw_diffuse") };
        let module = shader.module(&gpu.device);
        let reflection = self.layouts.reflection.as_ref().filter(|_| variant.shiny);
        let sheet = self.sheets.as_ref().filter(|_| variant.basis.is_some()).map(Sheets::layout);
        let groups = [Some(&self.layouts.view), Some(&self.layouts.material), reflection, sheet];
        let used = if sheet.is_some() { 4 } else { 2 + usize::from(variant.shiny) };
        let layout = gpu.device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
            label: Some(shader.name),
            bind_group_layouts: &groups[..used],
            immediate_size: 0,
        });
        let inputs = attributes(variant).map(|attribute| Input::new(&self.geometry, attribute)).collect::<Vec<_>>();
        let buffers = inputs.iter().map(|input| Some(input.layout())).collect::<Vec<_>>();
        let constants = variant.constants();
        gpu.device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
            label: Some(shader.name),
            layout: Some(&layout),
            vertex: wgpu::VertexState {
                module: &module,
                entry_point: Some(vertex_entry),
                compilation_options: wgpu::PipelineCompilationOptions::default(),
                buffers: &buffers,
            },
            primitive: wgpu::PrimitiveState { cull_mode: Some(wgpu::Face::Back), ..Default::default() },
            depth_stencil: Some(depth_state(!variant.blended, wgpu::CompareFunction::Greater)),
            multisample: wgpu::MultisampleState::default(),
            fragment: Some(wgpu::FragmentState {
                module: &module,
                entry_point: Some(fragment_entry),
                compilation_options: wgpu::PipelineCompilationOptions { constants: &constants, ..Default::default() },
                targets: &[Some(wgpu::ColorTargetState {
                    format: self.format,
                    blend: variant.blended.then_some(wgpu::BlendState::PREMULTIPLIED_ALPHA_BLENDING),
                    write_mask: wgpu::ColorWrites::ALL,
                })],
            }),
            multiview_mask: None,
            cache: None,
        })
    }

    fn set_variant(&self, pass: &mut wgpu::RenderPass<'_>, variant: Variant) {
        pass.set_pipeline(&self.pipelines[&variant]);
        for (slot, attribute) in (0..).zip(attributes(variant)) {
            pass.set_vertex_buffer(slot, self.geometry.stream(attribute).buffer.slice(..));
        }
        if variant.shiny {
            pass.set_bind_group(2, self.reflection.as_ref(), &[]);
        }
    }
}

/// Whether any triangle shows a material that mirrors the light probe.
pub(crate) fn shines(prt: &Prt) -> bool {
    draws(prt).iter().any(|draw| prt.materials[draw.material as usize].specular)
}

/// Whether any triangle is drawn over what lies behind.
pub(crate) fn blends(prt: &Prt) -> bool {
    draws(prt).iter().any(|draw| Variant::of(&prt.materials[draw.material as usize], false).blended)
}

/// The triangles of all meshes; neighbours of one material and light map are drawn together.
fn draws(prt: &Prt) -> Vec<Draw> {
    let mut draws: Vec<Draw> = Vec::new();
    for (index, mesh) in prt.meshes.iter().enumerate().filter(|(_, mesh)| mesh.triangles > 0) {
        let sheet = prt.maps.as_ref().and_then(|maps| maps.sheet_of_mesh[index]);
        let (material, triangles) = (mesh.material, mesh.first_triangle..mesh.first_triangle + mesh.triangles);
        match draws.last_mut() {
            Some(draw) if (draw.material, draw.sheet) == (material, sheet) && draw.triangles.end == triangles.start => {
                draw.triangles.end = triangles.end;
            }
            _ => draws.push(Draw { material, sheet, triangles }),
        }
    }
    draws
}

fn attributes(variant: Variant) -> impl Iterator<Item = Attribute> {
    let more: &[Attribute] = if variant.shiny { &Attribute::SHINY } else { &[] };
    Attribute::DIFFUSE.into_iter().chain(more.iter().copied())
}

/// A depth test against the reversed buffer.
pub(crate) fn depth_state(write: bool, compare: wgpu::CompareFunction) -> wgpu::DepthStencilState {
    wgpu::DepthStencilState {
        format: DEPTH,
        depth_write_enabled: Some(write),
        depth_compare: Some(compare),
        stencil: wgpu::StencilState::default(),
        bias: wgpu::DepthBiasState::default(),
    }
}

/// One vertex buffer with one attribute.
struct Input {
    step: wgpu::VertexStepMode,
    attribute: [wgpu::VertexAttribute; 1],
}

impl Input {
    fn new(geometry: &Geometry, attribute: Attribute) -> Self {
        let format = attribute.format();
        let attribute_description = wgpu::VertexAttribute { format, offset: 0, shader_location: attribute as u32 };
        Self { step: geometry.stream(attribute).step, attribute: [attribute_description] }
    }

    fn layout(&self) -> wgpu::VertexBufferLayout<'_> {
        wgpu::VertexBufferLayout {
            array_stride: self.attribute[0].format.size(),
            step_mode: self.step,
            attributes: &self.attribute,
        }
    }
}
