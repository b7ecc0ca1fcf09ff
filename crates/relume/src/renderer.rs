//! One renderer for both backends: the GPU where there is one, the CPU anywhere.

use crate::{Error, Window};
use coeff_io::Prt;
use probe_io::Environment;
use render_cpu::{Frame, Image, Tonemap};
use render_wgpu::{Driver, Gpu};
use std::time::Duration;

/// Which backend draws.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Backend {
    /// The GPU, or the CPU where there is none or it fails.
    Auto,
    /// The GPU only.
    Gpu,
    /// The CPU only.
    Cpu,
}

/// How a renderer is opened.
#[derive(Debug, Clone, Copy)]
pub struct RendererOptions {
    /// Which backend draws.
    pub backend: Backend,
    /// The window against ringing.
    pub window: Window,
    /// Opens the GPU device.
    pub open_gpu: fn() -> Result<Gpu, render_wgpu::Error>,
}

impl RendererOptions {
    /// The GPU if possible, light without ringing, a headless device of the renderer's own.
    #[must_use]
    pub fn standard() -> Self {
        Self { backend: Backend::Auto, window: Window::Auto, open_gpu: || Gpu::new(Driver::Any) }
    }
}

/// What draws at the moment.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Device {
    /// The GPU.
    Gpu {
        /// Name of adapter and driver.
        description: String,
        /// Whether the driver computes on the CPU.
        is_software: bool,
    },
    /// The CPU.
    Cpu {
        /// Why the GPU does not draw, where it was asked first.
        gpu_error: Option<render_wgpu::Error>,
    },
}

/// A baked scene under a light probe, ready to be drawn.
///
/// ```
/// # use relume::prelude::*;
/// # let scene = load_scene("builtin:plane")?;
/// # let prt = Bake::new(&scene).settings(BakeSettings { quality: Quality::Rays(16), ..Preset::Draft.into() }).run()?;
/// let sky = load_light_probe("builtin:sky")?;
/// let mut renderer = Renderer::new(&prt, &sky)?;
/// let image = renderer.draw(&Frame::plain(prt.cameras[0].clone(), 64, 36))?;
/// assert_eq!(image.display.len(), 64 * 36);
/// # Ok::<(), relume::Error>(())
/// ```
pub struct Renderer<'a> {
    prt: &'a Prt,
    environment: &'a Environment,
    options: RendererOptions,
    inner: Inner<'a>,
    device: Device,
}

enum Inner<'a> {
    Gpu(Box<render_wgpu::Renderer>),
    Cpu(Box<render_cpu::Renderer<'a>>),
}

impl std::fmt::Debug for Renderer<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Renderer").field("options", &self.options).field("device", &self.device).finish_non_exhaustive()
    }
}

impl<'a> Renderer<'a> {
    /// Prepares scene and light with [`RendererOptions::standard`].
    ///
    /// # Errors
    /// [`Error::RenderCpu`] where the file contradicts itself.
    pub fn new(prt: &'a Prt, environment: &'a Environment) -> Result<Self, Error> {
        Self::with_options(prt, environment, RendererOptions::standard())
    }

    /// Prepares scene and light.
    ///
    /// # Errors
    /// [`Error::RenderCpu`] or [`Error::RenderGpu`]; a failure of the GPU only where [`Backend::Gpu`] is asked for.
    pub fn with_options(prt: &'a Prt, environment: &'a Environment, options: RendererOptions) -> Result<Self, Error> {
        let cpu = |gpu_error| cpu(prt, environment, options.window).map(|inner| (inner, Device::Cpu { gpu_error }));
        let (inner, device) = match options.backend {
            Backend::Cpu => cpu(None),
            Backend::Gpu => Ok(gpu(prt, environment, &options)?),
            Backend::Auto => gpu(prt, environment, &options).or_else(|error| cpu(Some(error))),
        }?;
        Ok(Self { prt, environment, options, inner, device })
    }

    /// What draws at the moment. With [`Backend::Auto`], [`Renderer::draw`] changes it where the GPU fails.
    pub fn device(&self) -> &Device {
        &self.device
    }

    /// Draws one image.
    ///
    /// # Errors
    /// [`Error::RenderCpu`] or [`Error::RenderGpu`] where the frame is out of range or the GPU fails.
    pub fn draw(&mut self, frame: &Frame) -> Result<Image, Error> {
        let error = match &mut self.inner {
            Inner::Cpu(renderer) => return Ok(renderer.draw(frame)?),
            Inner::Gpu(renderer) => match renderer.draw(&gpu_frame(frame)) {
                Ok(render_wgpu::Image { width, height, linear, display }) => {
                    return Ok(Image { width, height, linear, display });
                }
                Err(error) => error,
            },
        };
        if self.options.backend == Backend::Gpu {
            return Err(error.into());
        }
        self.inner = cpu(self.prt, self.environment, self.options.window)?;
        self.device = Device::Cpu { gpu_error: Some(error) };
        self.draw(frame)
    }

    /// Time that the GPU takes for an image that stays there; `None` where the CPU draws.
    ///
    /// # Errors
    /// [`Error::RenderGpu`] where the frame is out of range or the GPU fails.
    pub fn gpu_time(&mut self, frame: &Frame) -> Result<Option<Duration>, Error> {
        match &mut self.inner {
            Inner::Gpu(renderer) => Ok(Some(renderer.time(&gpu_frame(frame))?.frame)),
            Inner::Cpu(_) => Ok(None),
        }
    }
}

fn cpu<'a>(prt: &'a Prt, environment: &'a Environment, window: Window) -> Result<Inner<'a>, Error> {
    let renderer = match window {
        Window::Auto => render_cpu::Renderer::new(prt, environment)?,
        Window::None => render_cpu::Renderer::without_window(prt, environment)?,
    };
    Ok(Inner::Cpu(Box::new(renderer)))
}

fn gpu<'a>(
    prt: &Prt,
    environment: &Environment,
    options: &RendererOptions,
) -> Result<(Inner<'a>, Device), render_wgpu::Error> {
    let gpu = (options.open_gpu)()?;
    let renderer = match options.window {
        Window::Auto => render_wgpu::Renderer::new(&gpu, prt, environment)?,
        Window::None => render_wgpu::Renderer::without_window(&gpu, prt, environment)?,
    };
    let device = Device::Gpu { description: gpu.description().to_string(), is_software: gpu.is_software() };
    Ok((Inner::Gpu(Box::new(renderer)), device))
}

fn gpu_frame(frame: &Frame) -> render_wgpu::Frame {
    render_wgpu::Frame {
        camera: frame.camera.clone(),
        width: frame.width,
        height: frame.height,
        rotation: frame.rotation,
        exposure_ev: frame.exposure_ev,
        tonemap: match frame.tonemap {
            Tonemap::None => render_wgpu::Tonemap::None,
            Tonemap::Reinhard => render_wgpu::Tonemap::Reinhard,
            Tonemap::Filmic => render_wgpu::Tonemap::Filmic,
        },
        bloom: frame.bloom,
        supersample: frame.supersample,
        sky: frame.sky,
        albedo: frame.albedo,
        basis: frame.basis,
        functions: frame.functions,
        gloss: frame.gloss,
        early_depth: true,
    }
}
