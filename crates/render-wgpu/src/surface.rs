//! The surfaces of a scene: pipelines for what the file holds, and what to draw with them.

use crate::draw::{Draw, draws};
use crate::geometry::{self, Geometry};
use crate::gloss::{Gloss, GlossKind};
use crate::material::{self, BoundMaterial, Variant};
use crate::sheets::Sheets;
use crate::{Error, Frame, Gpu, blend::Blended, gpu_data, shaders};
use coeff_io::Prt;
use glam::Quat;
use sh_math::{Rgb, hemisphere::Basis};
use std::collections::HashMap;

/// The depth buffer: reversed, near / w.
pub(crate) const DEPTH: wgpu::TextureFormat = wgpu::TextureFormat::Depth32Float;

/// All surfaces, ready to be drawn.
#[derive(Debug)]
pub(crate) struct Surfaces {
    geometry: Geometry,
    materials: Vec<BoundMaterial>,
    layouts: Layouts,
    format: wgpu::TextureFormat,
    /// What there is to draw, each kind once.
    kinds: Vec<Draw>,
    pipelines: HashMap<Variant, wgpu::RenderPipeline>,
    /// Those that draw depth before.
    depth_pipelines: HashMap<Variant, wgpu::RenderPipeline>,
    reflection: Option<wgpu::BindGroup>,
    /// Only where a mesh shows one.
    sheets: Option<Sheets>,
    /// Only where the file holds any.
    gloss: Option<Gloss>,
    /// Whether depth is drawn before surfaces.
    early: bool,
    /// The basis that is asked for light maps.
    basis: Option<Basis>,
    opaque: Vec<Draw>,
    blended: Option<Blended>,
}

/// What a pipeline draws.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Pass {
    Color,
    Depth,
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
        (lit, heading): (wgpu::Buffer, Option<wgpu::Buffer>),
        format: wgpu::TextureFormat,
    ) -> Result<Self, Error> {
        let materials = material::upload(gpu, prt, &layouts.material)?;
        let draws = draws(prt);
        let mut kinds: Vec<Draw> = Vec::new();
        for kind in draws.iter().map(Draw::kind) {
            if !kinds.contains(&kind) {
                kinds.push(kind);
            }
        }
        let is_blended = |draw: &Draw| materials[draw.material as usize].is_blended();
        let (behind, opaque) = draws.into_iter().partition::<Vec<_>, _>(is_blended);
        let blended = Blended::new(gpu, prt, &behind)?;
        let sheets = Sheets::new(gpu, prt)?;
        let gloss = Gloss::new(gpu, prt)?;
        let rows = gloss.as_ref().and_then(|gloss| gloss.vertices.as_ref()).map(|vertices| vertices.row_of.clone());
        let shaped = reflection.is_some() || heading.is_some();
        let geometry = Geometry::new(gpu, prt, lit, heading, shaped, rows)?;
        let basis = sheets.as_ref().map(|sheets| sheets.maps().basis);
        let (pipelines, depth_pipelines) = (HashMap::new(), HashMap::new());
        let mut surfaces = Self {
            geometry,
            materials,
            layouts,
            format,
            kinds,
            pipelines,
            depth_pipelines,
            reflection,
            sheets,
            gloss,
            early: false,
            basis,
            opaque,
            blended,
        };
        // Which way gloss takes is known with the first frame.
        if surfaces.gloss.is_none() {
            surfaces.build_pipelines(gpu);
        }
        Ok(surfaces)
    }

    /// Builds the pipelines that are not there yet.
    fn build_pipelines(&mut self, gpu: &Gpu) {
        for kind in self.kinds.clone() {
            let variant = self.variant(&kind);
            if !self.pipelines.contains_key(&variant) {
                self.pipelines.insert(variant, self.pipeline(gpu, variant, Pass::Color));
            }
            if variant.early && !self.depth_pipelines.contains_key(&variant) {
                self.depth_pipelines.insert(variant, self.pipeline(gpu, variant, Pass::Depth));
            }
        }
    }

    fn variant(&self, draw: &Draw) -> Variant {
        let maps = self.sheets.as_ref().zip(draw.sheet);
        let basis = maps.zip(self.basis).map(|((sheets, sheet), asked)| sheets.basis(sheet, asked));
        let material = &self.materials[draw.material as usize];
        let gloss = self.gloss.as_ref().and_then(|gloss| gloss.kind(draw, material.is_shiny()));
        let texels = matches!(gloss, Some(GlossKind::Diffuse | GlossKind::Texels(_)));
        let plain = material.variant(basis, texels);
        let bounced = self.gloss.as_ref().is_some_and(Gloss::is_bounced);
        Variant { gloss, bounced, early: self.early && !plain.blended, ..plain }
    }

    /// Gloss and transfer textures, if there are any.
    pub(crate) fn gloss(&self) -> Option<&Gloss> {
        self.gloss.as_ref()
    }

    /// Brings gloss and transfer textures, if there are any, to a frame; builds the pipelines for it.
    pub(crate) fn put_on_gloss(
        &mut self,
        gpu: &Gpu,
        encoder: &mut wgpu::CommandEncoder,
        light: &Rgb,
        frame: &Frame,
    ) -> Result<(), Error> {
        if let Some(gloss) = &mut self.gloss {
            gloss.record(gpu, encoder, light, frame)?;
            self.early = frame.early_depth && gloss.sheets.iter().any(|sheet| sheet.shines);
            self.build_pipelines(gpu);
        }
        Ok(())
    }

    /// Whether depth is drawn before surfaces.
    pub(crate) fn is_early(&self) -> bool {
        self.early
    }

    /// Draws the depth of opaque and masked surfaces.
    pub(crate) fn draw_depth(&self, pass: &mut wgpu::RenderPass<'_>) {
        self.draw(pass, &self.geometry.triangles, &self.opaque, &self.depth_pipelines);
    }

    /// The light maps without their layers, if there are any.
    pub(crate) fn maps(&self) -> Option<&coeff_io::Maps> {
        self.sheets.as_ref().map(Sheets::maps)
    }

    /// Forgets the light of the light maps.
    pub(crate) fn unlight(&mut self) {
        self.sheets.iter_mut().for_each(Sheets::unlight);
        self.gloss.iter_mut().for_each(Gloss::unlight);
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
        self.draw(pass, &self.geometry.triangles, &self.opaque, &self.pipelines);
    }

    /// Draws blended surfaces, farthest first.
    pub(crate) fn draw_blended(&self, gpu: &Gpu, pass: &mut wgpu::RenderPass<'_>, view: &gpu_data::View) {
        if let Some(blended) = &self.blended {
            self.draw(pass, &blended.indices, &blended.sort(gpu, view), &self.pipelines);
        }
    }

    fn draw(
        &self,
        pass: &mut wgpu::RenderPass<'_>,
        indices: &wgpu::Buffer,
        draws: &[Draw],
        pipelines: &HashMap<Variant, wgpu::RenderPipeline>,
    ) {
        pass.set_index_buffer(indices.slice(..), wgpu::IndexFormat::Uint32);
        let mut last = None;
        for draw in draws {
            let material = &self.materials[draw.material as usize];
            let variant = self.variant(draw);
            if last != Some(variant) {
                self.set_variant(pass, variant, pipelines);
                last = Some(variant);
            }
            pass.set_bind_group(1, &material.bindings, &[]);
            if let (Some(sheets), Some(sheet)) = (&self.sheets, draw.sheet) {
                pass.set_bind_group(3, sheets.bindings(sheet), &[]);
            }
            if let (Some(gloss), Some(kind)) = (&self.gloss, variant.gloss) {
                pass.set_bind_group(3, gloss.bindings(kind, draw), &[]);
            }
            pass.draw_indexed(3 * draw.triangles.start..3 * draw.triangles.end, 0, 0..1);
        }
    }

    fn pipeline(&self, gpu: &Gpu, variant: Variant, pass: Pass) -> wgpu::RenderPipeline {
        let shader = match variant.gloss {
            Some(kind) => shaders::glossy(kind, variant.shiny, self.gloss.as_ref().and_then(Gloss::bands)),
            None if variant.bends_light && !variant.shiny => shaders::BENT,
            None => shaders::surface(variant.shiny, variant.basis),
        };
        let entries = match (variant.gloss, variant.shiny) {
            (Some(GlossKind::Vertices(_)), _) => ["place_glossy", "draw_glossy", "cut_glossy"],
            (_, true) => ["place_shiny", "draw_shiny", "cut_shiny"],
            (None, false) if variant.bends_light => ["place_shiny", "draw_bent", "cut_shiny"],
            (_, false) => ["place_diffuse", "draw_diffuse", "cut_diffuse"],
        };
        let [vertex_entry, draw_entry, cut_entry] = entries;
        let module = shader.module(&gpu.device);
        let reflection = self.layouts.reflection.as_ref().filter(|_| variant.shiny);
        let sheet = self.sheets.as_ref().filter(|_| variant.basis.is_some()).map(Sheets::layout);
        let own = self.gloss.as_ref().zip(variant.gloss).map(|(gloss, kind)| gloss.layout(kind));
        let sheet = own.or(sheet);
        let groups = [Some(&self.layouts.view), Some(&self.layouts.material), reflection, sheet];
        let used = if sheet.is_some() { 4 } else { 2 + usize::from(variant.shiny) };
        let layout = gpu.device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
            label: Some(shader.name),
            bind_group_layouts: &groups[..used],
            immediate_size: 0,
        });
        let streams = &self.geometry.streams()[..streams(variant)];
        let buffers = streams.iter().map(|stream| Some(stream.layout())).collect::<Vec<_>>();
        let constants = variant.constants();
        let color = [Some(wgpu::ColorTargetState {
            format: self.format,
            blend: variant.blended.then_some(wgpu::BlendState::PREMULTIPLIED_ALPHA_BLENDING),
            write_mask: wgpu::ColorWrites::ALL,
        })];
        let (entry, targets): (_, &[_]) = match pass {
            Pass::Color => (Some(draw_entry), &color),
            // Only a mask has to look at the surface.
            Pass::Depth => (variant.masked.then_some(cut_entry), &[]),
        };
        // Gloss at vertices reads the roughness there.
        let vertex_constants: Vec<(&str, f64)> = match variant.gloss {
            Some(GlossKind::Vertices(_)) => constants.clone(),
            _ => Vec::new(),
        };
        gpu.device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
            label: Some(shader.name),
            layout: Some(&layout),
            vertex: wgpu::VertexState {
                module: &module,
                entry_point: Some(vertex_entry),
                compilation_options: wgpu::PipelineCompilationOptions {
                    constants: &vertex_constants,
                    ..Default::default()
                },
                buffers: &buffers,
            },
            primitive: wgpu::PrimitiveState { cull_mode: Some(wgpu::Face::Back), ..Default::default() },
            depth_stencil: Some(match (pass, variant.early) {
                (Pass::Color, true) => depth_state(false, wgpu::CompareFunction::Equal),
                _ => depth_state(!variant.blended, wgpu::CompareFunction::Greater),
            }),
            multisample: wgpu::MultisampleState::default(),
            fragment: entry.map(|entry| wgpu::FragmentState {
                module: &module,
                entry_point: Some(entry),
                compilation_options: wgpu::PipelineCompilationOptions { constants: &constants, ..Default::default() },
                targets,
            }),
            multiview_mask: None,
            cache: None,
        })
    }

    fn set_variant(
        &self,
        pass: &mut wgpu::RenderPass<'_>,
        variant: Variant,
        pipelines: &HashMap<Variant, wgpu::RenderPipeline>,
    ) {
        pass.set_pipeline(&pipelines[&variant]);
        for (slot, stream) in (0..).zip(&self.geometry.streams()[..streams(variant)]) {
            pass.set_vertex_buffer(slot, stream.buffer.slice(..));
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

/// How many streams of the geometry a variant reads.
fn streams(variant: Variant) -> usize {
    match variant.gloss {
        Some(GlossKind::Vertices(_)) => geometry::ROW_STREAMS,
        _ if variant.is_shaped() => geometry::SHAPED_STREAMS,
        _ => geometry::DIFFUSE_STREAMS,
    }
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
