//! Who draws: the GPU where there is one, the CPU anywhere.

use crate::console::Console;
use crate::silence::silenced;
use anyhow::Result;
use coeff_io::Prt;
use probe_io::Environment;
use render_cpu::{Frame, Image, Tonemap};
use render_wgpu::{Driver, Gpu};
use std::time::Duration;

/// Who is asked to draw.
#[derive(Debug, Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
pub(crate) enum Backend {
    /// The GPU, or the CPU where there is none.
    Auto,
    /// The GPU or nobody.
    Gpu,
    /// The CPU.
    Cpu,
}

/// A scene under a light, ready to be drawn.
pub(crate) struct Drawer<'a> {
    prt: &'a Prt,
    environment: &'a Environment,
    backend: Backend,
    renderer: Renderer<'a>,
    window: Window,
}

/// What is done against ringing: a strong small light, cut off at few bands, is negative in places.
#[derive(Debug, Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
pub(crate) enum Window {
    /// Nothing: the light as its coefficients have it.
    #[value(alias = "off")]
    None,
    /// The mildest window under which the light is nowhere negative; none where nothing rings.
    Auto,
}

impl Window {
    /// The light as it is shown.
    pub(crate) fn apply(self, light: &sh_math::Rgb) -> sh_math::Rgb {
        match self {
            Self::None => light.clone(),
            Self::Auto => sh_math::window::without_ringing(light),
        }
    }
}

enum Renderer<'a> {
    Gpu(Box<render_wgpu::Renderer>),
    Cpu(Box<render_cpu::Renderer<'a>>),
}

impl<'a> Drawer<'a> {
    /// Makes scene and light ready; says so where the CPU has to stand in for the GPU.
    pub(crate) fn open(
        backend: Backend,
        prt: &'a Prt,
        environment: &'a Environment,
        window: Window,
        console: &Console,
    ) -> Result<Self> {
        let renderer = match backend {
            Backend::Cpu => {
                console.notice("drawing on the CPU");
                cpu(prt, environment, window)?
            }
            Backend::Gpu => gpu(prt, environment, window, console)?,
            Backend::Auto => match gpu(prt, environment, window, console) {
                Ok(renderer) => renderer,
                Err(error) => stand_in(prt, environment, window, &error, console)?,
            },
        };
        Ok(Self { prt, environment, backend, renderer, window })
    }

    /// Draws one picture.
    pub(crate) fn draw(&mut self, frame: &Frame, console: &Console) -> Result<Image> {
        let drawn = match &mut self.renderer {
            Renderer::Gpu(renderer) => renderer.draw(&for_gpu(frame)),
            Renderer::Cpu(renderer) => return Ok(renderer.draw(frame)?),
        };
        match drawn {
            Ok(render_wgpu::Image { width, height, linear, display }) => Ok(Image { width, height, linear, display }),
            Err(error) if self.backend == Backend::Auto => {
                self.renderer = stand_in(self.prt, self.environment, self.window, &error.into(), console)?;
                self.draw(frame, console)
            }
            Err(error) => Err(error.into()),
        }
    }

    /// Time that the GPU takes for a picture that stays there; `None` where the CPU draws.
    pub(crate) fn time(&mut self, frame: &Frame) -> Result<Option<Duration>> {
        match &mut self.renderer {
            Renderer::Gpu(renderer) => Ok(Some(renderer.time(&for_gpu(frame))?.frame)),
            Renderer::Cpu(_) => Ok(None),
        }
    }
}

fn cpu<'a>(prt: &'a Prt, environment: &'a Environment, window: Window) -> Result<Renderer<'a>> {
    let renderer = match window {
        Window::Auto => render_cpu::Renderer::new(prt, environment)?,
        Window::None => render_cpu::Renderer::without_window(prt, environment)?,
    };
    Ok(Renderer::Cpu(Box::new(renderer)))
}

fn gpu<'a>(prt: &Prt, environment: &Environment, window: Window, console: &Console) -> Result<Renderer<'a>> {
    let gpu = silenced(|| Gpu::new(Driver::Any))?;
    let renderer = match window {
        Window::Auto => render_wgpu::Renderer::new(&gpu, prt, environment)?,
        Window::None => render_wgpu::Renderer::without_window(&gpu, prt, environment)?,
    };
    let kind = if gpu.is_software() { "a software driver" } else { "the GPU" };
    console.notice(&format!("drawing on {kind}: {}", gpu.description()));
    Ok(Renderer::Gpu(Box::new(renderer)))
}

fn stand_in<'a>(
    prt: &'a Prt,
    environment: &'a Environment,
    window: Window,
    error: &anyhow::Error,
    console: &Console,
) -> Result<Renderer<'a>> {
    let text = match error.downcast_ref() {
        Some(render_wgpu::Error::NoAdapter { .. }) => "drawing on the CPU: no graphics driver was found".to_owned(),
        _ => format!("drawing on the CPU: {error:#}"),
    };
    console.notice(&text);
    cpu(prt, environment, window)
}

fn for_gpu(frame: &Frame) -> render_wgpu::Frame {
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
