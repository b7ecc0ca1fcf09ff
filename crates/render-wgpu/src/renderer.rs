//! A baked scene under a light probe, ready to be drawn again and again.

use crate::finish::Finish;
use crate::gloss::Gloss;
use crate::readback::Readback;
use crate::relight::Relight;
use crate::relight_clusters::ClusteredRelight;
use crate::surface::{Layouts, Surfaces};
use crate::target::Target;
use crate::targets::{Size, Targets};
use crate::{Error, Frame, Gpu, Image, check, gpu_data, material, picture, reflection, sky::Sky, surface, view};
use coeff_io::{GlossWay, Prt};
use glam::Quat;
use probe_io::Environment;
use sh_math::{Bands, Rgb, hemisphere::Basis};
use std::time::{Duration, Instant};

/// A scene and its light on the GPU.
///
/// ```no_run
/// use render_wgpu::{Error, Frame, Gpu, Renderer, wgpu};
///
/// /// Draws the scene into a texture of the caller, with the caller's device.
/// fn embed(
///     device: wgpu::Device,
///     queue: wgpu::Queue,
///     texture: &wgpu::Texture,
///     prt: &coeff_io::Prt,
///     light_probe: &probe_io::Environment,
/// ) -> Result<(), Error> {
///     let gpu = Gpu::from_wgpu(device, queue)?;
///     let mut renderer = Renderer::new(&gpu, prt, light_probe)?;
///     let view = texture.create_view(&wgpu::TextureViewDescriptor::default());
///     let frame = Frame::plain(prt.cameras[0].clone(), texture.width(), texture.height());
///     renderer.draw_into(&view, texture.format(), &frame)
/// }
/// ```
#[derive(Debug)]
pub struct Renderer {
    gpu: Gpu,
    /// Coefficients of the light as it is shown, not turned, in as many bands as transfer or maps have.
    light: Rgb,
    /// Bands of the transfer.
    bands: Bands,
    /// The rotation that the vertices are lit for.
    lit_for: Option<Quat>,
    relight: Relighting,
    /// Where the light of vertices comes from; only where a normal map bends it.
    heading: Option<Relight>,
    near: f32,
    view: wgpu::Buffer,
    view_bindings: wgpu::BindGroup,
    surfaces: Surfaces,
    sky: Sky,
    finish: Finish,
    targets: Option<Targets>,
    format: wgpu::TextureFormat,
}

/// How the vertices are lit.
#[derive(Debug)]
enum Relighting {
    Exact(Relight),
    Clusters(Box<ClusteredRelight>),
}

impl Relighting {
    fn lit(&self) -> &wgpu::Buffer {
        match self {
            Self::Exact(relight) => relight.lit(),
            Self::Clusters(relight) => relight.lit(),
        }
    }

    fn record(&self, gpu: &Gpu, encoder: &mut wgpu::CommandEncoder, light: &Rgb) {
        match self {
            Self::Exact(relight) => relight.record(gpu, encoder, light),
            Self::Clusters(relight) => relight.record(gpu, encoder, light),
        }
    }
}

/// How long a frame took.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Timings {
    /// Whether the light had turned since the last frame, so that every vertex was lit anew.
    pub relit: bool,
    /// Recording and handing over, on the CPU.
    pub record: Duration,
    /// From the call until the GPU has finished; nothing is read back.
    pub frame: Duration,
}

impl Renderer {
    /// Uploads the scene and the light, under the window that keeps it from ringing (none where
    /// nothing rings), and builds
    /// the pipelines that they call for.
    ///
    /// # Errors
    /// [`Error::Invalid`] for a scene that contradicts itself, [`Error::TooLarge`] for one that the GPU cannot hold.
    pub fn new(gpu: &Gpu, prt: &Prt, environment: &Environment) -> Result<Self, Error> {
        pollster::block_on(Self::new_async(gpu, prt, environment))
    }

    /// As [`Renderer::new`], but with the light as its coefficients have it: it may be negative in places.
    ///
    /// # Errors
    /// As [`Renderer::new`].
    pub fn without_window(gpu: &Gpu, prt: &Prt, environment: &Environment) -> Result<Self, Error> {
        pollster::block_on(Self::without_window_async(gpu, prt, environment))
    }

    /// [`Renderer::new`] to be awaited, as a browser has to.
    ///
    /// # Errors
    /// As [`Renderer::new`].
    pub async fn new_async(gpu: &Gpu, prt: &Prt, environment: &Environment) -> Result<Self, Error> {
        let mut renderer = Self::without_window_async(gpu, prt, environment).await?;
        renderer.light = sh_math::window::without_ringing(&renderer.light);
        Ok(renderer)
    }

    async fn without_window_async(gpu: &Gpu, prt: &Prt, environment: &Environment) -> Result<Self, Error> {
        check::check(prt)?;
        gpu.guarded("uploading the scene", || Self::build(gpu, prt, environment)).await
    }

    fn build(gpu: &Gpu, prt: &Prt, environment: &Environment) -> Result<Self, Error> {
        let bands = Bands::new(prt.transfer.bands).ok_or_else(|| {
            let problem = format!("{} bands, not 1 to {}", prt.transfer.bands, Bands::MAX);
            Error::invalid("the transfer", problem)
        })?;
        let device = &gpu.device;
        let format = gpu.samples(surface::blends(prt));
        let relight = match &prt.compressed {
            Some(table) => Relighting::Clusters(Box::new(ClusteredRelight::new(gpu, prt, table)?)),
            None => {
                let limit = gpu.limits.max_storage_buffer_binding_size;
                Relighting::Exact(Relight::new(gpu, &prt.transfer, limit)?)
            }
        };
        let heading = prt.bends_vertices().then(|| {
            let limit = gpu.limits.max_storage_buffer_binding_size;
            Relight::new(gpu, &prt.transfer.grey(), limit)
        });
        let heading = heading.transpose()?;
        let layouts = Layouts {
            view: view_layout(device),
            material: material::layout(device),
            reflection: surface::shines(prt).then(|| reflection::layout(device)),
        };
        let reflected = layouts.reflection.as_ref().map(|layout| reflection::upload(gpu, environment, layout));
        let (view, view_bindings) = view_buffer(device, &layouts.view);
        let sky = Sky::new(gpu, environment, &layouts.view, format)?;
        let lit = (relight.lit().clone(), heading.as_ref().map(|heading| heading.lit().clone()));
        Ok(Self {
            light: sh_math::project(prt.light_bands().unwrap_or(bands), environment.samples()),
            bands,
            lit_for: None,
            near: view::near_plane(prt),
            view,
            view_bindings,
            surfaces: Surfaces::new(gpu, prt, layouts, reflected.transpose()?, lit, format)?,
            sky,
            finish: Finish::new(gpu),
            relight,
            heading,
            targets: None,
            format,
            gpu: gpu.clone(),
        })
    }

    /// Draws one picture and reads it back.
    ///
    /// # Errors
    /// [`Error::Invalid`] for a frame that makes no sense, [`Error::TooLarge`] for one beyond the GPU's limits.
    pub fn draw(&mut self, frame: &Frame) -> Result<Image, Error> {
        let readbacks = pollster::block_on(self.submit(frame))?;
        self.gpu.wait()?;
        pollster::block_on(self.read(readbacks, frame))
    }

    /// [`Renderer::draw`] to be awaited, as a browser has to.
    ///
    /// # Errors
    /// As [`Renderer::draw`].
    pub async fn draw_async(&mut self, frame: &Frame) -> Result<Image, Error> {
        let readbacks = self.submit(frame).await?;
        self.read(readbacks, frame).await
    }

    /// Submits a frame and the copies of its linear and its display picture.
    async fn submit(&mut self, frame: &Frame) -> Result<[Readback; 2], Error> {
        let basis = self.check(frame)?;
        let gpu = self.gpu.clone();
        let submitted = gpu.guarded("drawing", || {
            let mut encoder = self.record(frame, basis, None)?;
            let targets = self.targets.as_ref().ok_or_else(|| Error::invalid("the frame", "nothing was drawn"))?;
            let linear = Readback::record(&gpu, &mut encoder, &targets.linear)?;
            let display = Readback::record(&gpu, &mut encoder, &targets.display)?;
            gpu.queue.submit([encoder.finish()]);
            Ok([linear, display])
        });
        // Mapping an invalid buffer would be an error of its own, so it starts after the complaints are known.
        submitted.await
    }

    async fn read(&self, [linear, display]: [Readback; 2], frame: &Frame) -> Result<Image, Error> {
        Ok(Image {
            width: frame.width,
            height: frame.height,
            linear: linear.read_linear(&self.gpu).await?,
            display: display.read(&self.gpu, |&texel: &[u8; 4]| texel).await?,
        })
    }

    /// The device that the renderer draws on.
    #[must_use]
    pub fn gpu(&self) -> &Gpu {
        &self.gpu
    }

    /// Draws one picture, reads nothing back and says how long it took. The first frame builds what later ones reuse.
    ///
    /// # Errors
    /// As [`Renderer::draw`].
    pub fn time(&mut self, frame: &Frame) -> Result<Timings, Error> {
        let basis = self.check(frame)?;
        let gpu = self.gpu.clone();
        let timed = gpu.guarded("drawing", || {
            let start = Instant::now();
            let relit = self.lit_for != Some(frame.rotation);
            let encoder = self.record(frame, basis, None)?;
            gpu.queue.submit([encoder.finish()]);
            let record = start.elapsed();
            gpu.wait()?;
            Ok(Timings { relit, record, frame: start.elapsed() })
        });
        pollster::block_on(timed)
    }

    /// What of a frame cannot be shown; the basis that its light maps are drawn in, if it has any.
    pub(crate) fn check(&self, frame: &Frame) -> Result<Option<Basis>, Error> {
        let basis = frame.check_for(self.surfaces.maps())?;
        if let Some(gloss) = self.surfaces.gloss() {
            gloss.check(frame, &self.light)?;
        }
        Ok(basis)
    }

    /// How gloss was multiplied in the last frame; none where the file holds none.
    #[must_use]
    pub fn gloss_way(&self) -> Option<GlossWay> {
        self.surfaces.gloss().filter(|gloss| gloss.bands().is_some()).map(Gloss::way)
    }

    /// Coefficients of the light as it lies, not turned.
    #[must_use]
    pub fn light(&self) -> &Rgb {
        &self.light
    }

    /// Lights vertices and relightable maps by other coefficients, such as windowed ones; sky and reflections stay.
    pub fn set_light(&mut self, light: Rgb) {
        self.light = light;
        self.lit_for = None;
        self.surfaces.unlight();
    }

    /// Number of surface pipelines, one for each kind of material in use.
    #[must_use]
    pub fn pipelines(&self) -> usize {
        self.surfaces.pipelines()
    }

    /// Records all passes of a frame into the targets, which it creates where their size has
    /// changed; the last pass writes
    /// `output`, or a target of its own where there is none.
    pub(crate) fn record(
        &mut self,
        frame: &Frame,
        basis: Option<Basis>,
        output: Option<Target<'_>>,
    ) -> Result<wgpu::CommandEncoder, Error> {
        let gpu = self.gpu.clone();
        let size = Size::of(frame);
        let targets = match self.targets.take() {
            Some(targets) if targets.size == size => targets,
            _ => Targets::new(&gpu, size, self.format)?,
        };
        let mut encoder = gpu.device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        if self.lit_for != Some(frame.rotation) {
            let light = self.light.rotated(frame.rotation.normalize()).with_bands(self.bands);
            self.relight.record(&gpu, &mut encoder, &light);
            if let Some(heading) = &self.heading {
                heading.record(&gpu, &mut encoder, &sh_math::heading(&light));
            }
            self.lit_for = Some(frame.rotation);
        }
        self.surfaces.light_maps(&gpu, &mut encoder, &self.light, frame.rotation, basis)?;
        self.surfaces.put_on_gloss(&gpu, &mut encoder, &self.light, frame)?;
        let view = view::view(frame, self.near, picture::largest(self.format));
        gpu.queue.write_buffer(&self.view, 0, bytemuck::bytes_of(&view));
        self.record_scene(&mut encoder, &targets, &view, frame.sky);
        let display = picture::view(&targets.display);
        let output = output.unwrap_or(Target { view: &display, format: targets.display.format() });
        self.finish.record(&gpu, &mut encoder, &targets, &output, frame)?;
        self.targets = Some(targets);
        Ok(encoder)
    }

    fn record_scene(&self, encoder: &mut wgpu::CommandEncoder, targets: &Targets, view: &gpu_data::View, sky: bool) {
        let early = self.surfaces.is_early();
        if early {
            self.record_depth(encoder, targets);
        }
        let depth = if early { wgpu::LoadOp::Load } else { wgpu::LoadOp::Clear(0.0) };
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("scene"),
            color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                view: &targets.samples,
                depth_slice: None,
                resolve_target: None,
                ops: wgpu::Operations { load: wgpu::LoadOp::Clear(wgpu::Color::BLACK), store: wgpu::StoreOp::Store },
            })],
            depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
                view: &targets.depth,
                depth_ops: Some(wgpu::Operations { load: depth, store: wgpu::StoreOp::Discard }),
                stencil_ops: None,
            }),
            ..Default::default()
        });
        pass.set_bind_group(0, &self.view_bindings, &[]);
        self.surfaces.draw_opaque(&mut pass);
        if sky {
            self.sky.draw(&mut pass);
        }
        self.surfaces.draw_blended(&self.gpu, &mut pass, view);
    }

    /// The depth of opaque surfaces alone.
    fn record_depth(&self, encoder: &mut wgpu::CommandEncoder, targets: &Targets) {
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("depth"),
            depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
                view: &targets.depth,
                depth_ops: Some(wgpu::Operations { load: wgpu::LoadOp::Clear(0.0), store: wgpu::StoreOp::Store }),
                stencil_ops: None,
            }),
            ..Default::default()
        });
        pass.set_bind_group(0, &self.view_bindings, &[]);
        self.surfaces.draw_depth(&mut pass);
    }
}

/// Draws one picture of a scene: [`Renderer::new`] and [`Renderer::draw`] in one.
///
/// # Errors
/// As those two.
pub fn render(gpu: &Gpu, prt: &Prt, environment: &Environment, frame: &Frame) -> Result<Image, Error> {
    Renderer::new(gpu, prt, environment)?.draw(frame)
}

fn view_layout(device: &wgpu::Device) -> wgpu::BindGroupLayout {
    device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
        label: Some("view"),
        entries: &[wgpu::BindGroupLayoutEntry {
            binding: 0,
            visibility: wgpu::ShaderStages::VERTEX_FRAGMENT,
            ty: wgpu::BindingType::Buffer {
                ty: wgpu::BufferBindingType::Uniform,
                has_dynamic_offset: false,
                min_binding_size: wgpu::BufferSize::new(size_of::<gpu_data::View>() as u64),
            },
            count: None,
        }],
    })
}

fn view_buffer(device: &wgpu::Device, layout: &wgpu::BindGroupLayout) -> (wgpu::Buffer, wgpu::BindGroup) {
    let buffer = device.create_buffer(&wgpu::BufferDescriptor {
        label: Some("view"),
        size: size_of::<gpu_data::View>() as u64,
        usage: wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST,
        mapped_at_creation: false,
    });
    let bindings = device.create_bind_group(&wgpu::BindGroupDescriptor {
        label: Some("view"),
        layout,
        entries: &[wgpu::BindGroupEntry { binding: 0, resource: buffer.as_entire_binding() }],
    });
    (buffer, bindings)
}
