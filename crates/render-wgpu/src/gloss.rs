//! Gloss and transfer textures on the GPU: what is kept per light, and what surfaces read.

use crate::draw::Draw;
use crate::gloss_shared::Shared;
use crate::gloss_sheet::Sheet;
use crate::gloss_vertices::Vertices;
use crate::gloss_way::History;
use crate::{Error, Frame, Gpu, gpu_data};
use coeff_io::{ArrivingLight, Bounced, DiffuseLight, Geometry, GlossWay, Prt, Transfer};
use glam::Quat;
use sh_math::light_matrix::LightProduct;
use sh_math::lobe::{self, Lobe};
use sh_math::{Bands, Rgb};

/// The format of what is kept at texels: the finest that every GPU filters.
pub(crate) const FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba16Float;

/// How the gloss of a surface is drawn.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(crate) enum GlossKind {
    /// From a transfer texture without gloss.
    Diffuse,
    /// From a transfer texture, evaluated at the fragment.
    Texels(GlossWay),
    /// At the vertices.
    Vertices(GlossWay),
}

/// All of it.
#[derive(Debug)]
pub(crate) struct Gloss {
    /// Gloss, transfer textures and codebooks of the file, and nothing else.
    shell: Prt,
    product: Option<LightProduct>,
    pub(crate) shared: Shared,
    pub(crate) sheets: Vec<Sheet>,
    pub(crate) vertices: Option<Vertices>,
    history: History,
    way: GlossWay,
    lobe: Option<Lobe>,
    /// The light that the factors are of.
    lit_for: Option<Quat>,
}

impl Gloss {
    /// Uploads what does not depend on the way; none where the file holds neither gloss nor transfer textures.
    pub(crate) fn new(gpu: &Gpu, prt: &Prt) -> Result<Option<Self>, Error> {
        if prt.gloss.is_none() && prt.transfer_textures.is_none() {
            return Ok(None);
        }
        let bands = prt.gloss.as_ref().and_then(|gloss| Bands::new(gloss.bands));
        let product = bands.map(LightProduct::new);
        let shared = Shared::new(gpu, prt, product.as_ref())?;
        let shell = shell(prt);
        let textures = prt.transfer_textures.iter();
        let count = textures.clone().map(|textures| textures.sheets.len() as u32).sum::<u32>();
        let sheets = (0..count).map(|index| Sheet::new(gpu, prt, &shared, index)).collect::<Result<_, _>>()?;
        let vertices = Vertices::new(gpu, prt)?;
        Ok(Some(Self {
            shell,
            product,
            shared,
            sheets,
            vertices,
            history: History::default(),
            way: GlossWay::Cache,
            lobe: None,
            lit_for: None,
        }))
    }

    /// How the gloss of what is drawn comes to be; none where the file holds nothing for it.
    pub(crate) fn kind(&self, draw: &Draw, shiny: bool) -> Option<GlossKind> {
        let texels = draw.texels.map(|sheet| self.sheets[sheet as usize].shines);
        match (texels, shiny && draw.rows) {
            (Some(true), _) if shiny => Some(GlossKind::Texels(self.way)),
            (Some(_), _) => Some(GlossKind::Diffuse),
            (None, true) => Some(GlossKind::Vertices(self.way)),
            (None, false) => None,
        }
    }

    /// The bindings of a kind for what is drawn.
    pub(crate) fn bindings(&self, kind: GlossKind, draw: &Draw) -> Option<&wgpu::BindGroup> {
        match kind {
            GlossKind::Vertices(_) => self.vertices.as_ref().and_then(Vertices::bindings),
            GlossKind::Diffuse | GlossKind::Texels(_) => {
                draw.texels.and_then(|sheet| self.sheets[sheet as usize].bindings())
            }
        }
    }

    /// The layout of the bindings of a kind.
    pub(crate) fn layout(&self, kind: GlossKind) -> &wgpu::BindGroupLayout {
        match kind {
            GlossKind::Vertices(_) => &self.shared.vertex_layout,
            GlossKind::Diffuse | GlossKind::Texels(_) => &self.shared.texel_layout,
        }
    }

    /// Bands of gloss.
    pub(crate) fn bands(&self) -> Option<Bands> {
        self.product.as_ref().map(LightProduct::bands)
    }

    /// Whether surfaces send light to those that shine.
    pub(crate) fn is_bounced(&self) -> bool {
        self.shared.bounced
    }

    /// The way that was drawn last.
    pub(crate) fn way(&self) -> GlossWay {
        self.way
    }

    /// Says what of a frame cannot be shown.
    pub(crate) fn check(&self, frame: &Frame, light: &Rgb) -> Result<(), Error> {
        let fault = frame.gloss.check_for(&self.shell, light, frame.rotation);
        fault.map_err(|what| Error::invalid("the frame", what))
    }

    /// Forgets the light.
    pub(crate) fn unlight(&mut self) {
        self.lit_for = None;
        self.history.changed();
    }

    /// Brings everything that a frame reads to its light and its way.
    pub(crate) fn record(
        &mut self,
        gpu: &Gpu,
        encoder: &mut wgpu::CommandEncoder,
        light: &Rgb,
        frame: &Frame,
    ) -> Result<(), Error> {
        self.history.frame(frame.rotation);
        self.way = frame.gloss.way.unwrap_or_else(|| self.cheapest(frame));
        self.write_frame(gpu, frame);
        if self.lit_for != Some(frame.rotation) {
            self.put_on(gpu, &light.rotated(frame.rotation.normalize()))?;
            self.lit_for = Some(frame.rotation);
        }
        for sheet in &mut self.sheets {
            sheet.prepare(gpu, &self.shell, &self.shared, self.way)?;
        }
        if let Some(vertices) = &mut self.vertices {
            vertices.prepare(gpu, &self.shell, &self.shared, self.way)?;
        }
        self.write_radiance(gpu, light, frame.rotation);
        let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor {
            label: Some("receivers under the light"),
            timestamp_writes: None,
        });
        self.sheets.iter_mut().for_each(|sheet| sheet.record(&mut pass, self.way));
        if let Some(vertices) = &mut self.vertices {
            vertices.record(&mut pass, self.way);
        }
        Ok(())
    }

    fn cheapest(&self, frame: &Frame) -> GlossWay {
        let Some(bands) = self.bands() else { return GlossWay::Cache };
        let texels: u64 = self.sheets.iter().map(|sheet| sheet.receivers).sum();
        let rows = self.vertices.as_ref().map_or(0, |vertices| u64::from(vertices.rows));
        let samples = u64::from(frame.width) * u64::from(frame.height) * u64::from(frame.supersample.pow(2));
        let drawn = if texels > 0 { samples } else { rows };
        self.history.cheapest(bands, texels + rows, drawn)
    }

    fn write_frame(&mut self, gpu: &Gpu, frame: &Frame) {
        let tangent = (0.5 * frame.camera.vertical_fov).tan();
        let numbers = gpu_data::GlossFrame {
            pixel: 2.0 * tangent / (frame.height * frame.supersample) as f32,
            roughness: frame.gloss.roughness.unwrap_or(-1.0),
            level: frame.gloss.level as f32,
            tail: f32::from(u8::from(frame.gloss.tail)),
        };
        gpu.queue.write_buffer(&self.shared.frame, 0, bytemuck::bytes_of(&numbers));
        if let Some(bands) = self.bands().filter(|_| self.lobe != Some(frame.gloss.lobe)) {
            let table = lobe::table(frame.gloss.lobe, bands);
            gpu.queue.write_buffer(&self.shared.lobes, 0, bytemuck::cast_slice(&table));
            self.lobe = Some(frame.gloss.lobe);
        }
    }

    /// Multiplies a light in world axes with all that receivers share.
    fn put_on(&mut self, gpu: &Gpu, light: &Rgb) -> Result<(), Error> {
        let factors = &self.shared.factors;
        let write = |buffer: &wgpu::Buffer, values: &[[f32; 4]]| {
            if !values.is_empty() {
                gpu.queue.write_buffer(buffer, 0, bytemuck::cast_slice(values));
            }
        };
        let wide = |values: &[[f32; 3]]| values.iter().map(|&[r, g, b]| [r, g, b, 0.0]).collect::<Vec<_>>();
        if let Some(product) = &self.product {
            let counted = light.with_bands(LightProduct::light_bands(product.bands()));
            write(&self.shared.light, &wide(&counted.values));
            if let Some(lit) = ArrivingLight::new(&self.shell, product, light) {
                write(&factors.matrix, &wide(lit.matrix()));
                write(&factors.visibility, lit.visibility_products().map_or(&[], |(_, products)| products));
                write(&factors.bounce, &lit.bounce_products().map_or(Vec::new(), |(_, products)| wide(products)));
            }
        }
        let own = Bands::new(self.shell.transfer.bands).unwrap_or(light.bands);
        write(&factors.light, &wide(&light.with_bands(own).values));
        if let Some(textures) = &self.shell.transfer_textures {
            let lit = DiffuseLight::new(&self.shell, textures.channels, light);
            write(&factors.diffuse, &lit.products().map_or(Vec::new(), |(_, products)| wide(products)));
        }
        self.sheets.iter_mut().for_each(Sheet::unlight);
        self.vertices.iter_mut().for_each(Vertices::unlight);
        Ok(())
    }

    /// Bounces that are in no clusters are added up here.
    fn write_radiance(&self, gpu: &Gpu, light: &Rgb, rotation: Quat) {
        let Some(product) = self.product.as_ref().filter(|_| self.shared.bounced) else { return };
        if self.shell.codebooks.bounce.is_some() {
            return;
        }
        let Some(lit) = ArrivingLight::new(&self.shell, product, &light.rotated(rotation.normalize())) else { return };
        for (sheet, index) in self.sheets.iter().zip(0..) {
            sheet.write_radiance(gpu, &self.shell, index, &lit, self.way);
        }
        if let Some(vertices) = &self.vertices {
            vertices.write_radiance(gpu, &self.shell, &lit, self.way);
        }
    }
}

/// What the rules and products of `coeff_io` need of a file, without its large arrays.
pub(crate) fn shell(prt: &Prt) -> Prt {
    let mut shell = Prt {
        generator: String::new(),
        convention: prt.convention.clone(),
        scene: String::new(),
        origin: prt.origin,
        settings: prt.settings.clone(),
        plan: coeff_io::Plan::default(),
        achieved: coeff_io::Achieved::default(),
        meshes: Vec::new(),
        materials: Vec::new(),
        cameras: Vec::new(),
        geometry: Geometry::default(),
        transfer: Transfer { bands: prt.transfer.bands, channels: prt.transfer.channels, ..Transfer::default() },
        textures: Vec::new(),
        maps: None,
        volume: None,
        gloss: prt.gloss.clone(),
        transfer_textures: prt.transfer_textures.clone(),
        codebooks: prt.codebooks.clone(),
        compressed: None,
    };
    let mark = shell.materials_mark();
    if let Some(Bounced::Fixed { materials, .. }) = shell.gloss.as_mut().and_then(|gloss| gloss.bounced.as_mut()) {
        // The shell has no materials: what matters is whether those of the file are those of the bake.
        *materials = if *materials == prt.materials_mark() { mark } else { !mark };
    }
    shell
}
