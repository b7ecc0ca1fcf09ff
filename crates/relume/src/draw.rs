//! Who draws: the GPU where there is one, the CPU anywhere.

use crate::console::Console;
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
    None,
    /// The mildest window under which the light is nowhere negative.
    Auto,
}

impl Window {
    /// The light as it is shown.
    pub(crate) fn apply(self, light: &sh_math::Rgb) -> sh_math::Rgb {
        match self {
            Self::None => light.clone(),
            Self::Auto => light.windowed(&sh_math::window::automatic(light)),
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
            Backend::Cpu => cpu(prt, environment)?,
            Backend::Gpu => gpu(prt, environment, console)?,
            Backend::Auto => match gpu(prt, environment, console) {
                Ok(renderer) => renderer,
                Err(error) => stand_in(prt, environment, &error, console)?,
            },
        };
        let mut drawer = Self { prt, environment, backend, renderer, window };
        drawer.apply_window();
        Ok(drawer)
    }

    fn apply_window(&mut self) {
        match &mut self.renderer {
            Renderer::Gpu(renderer) => renderer.set_light(self.window.apply(renderer.light())),
            Renderer::Cpu(renderer) => renderer.set_light(self.window.apply(renderer.light())),
        }
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
                self.renderer = stand_in(self.prt, self.environment, &error.into(), console)?;
                self.apply_window();
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

fn cpu<'a>(prt: &'a Prt, environment: &'a Environment) -> Result<Renderer<'a>> {
    Ok(Renderer::Cpu(Box::new(render_cpu::Renderer::new(prt, environment)?)))
}

fn gpu<'a>(prt: &Prt, environment: &Environment, console: &Console) -> Result<Renderer<'a>> {
    let gpu = Gpu::new(Driver::Any)?;
    console.detail(&format!("drawing on {}", gpu.description()));
    Ok(Renderer::Gpu(Box::new(render_wgpu::Renderer::new(&gpu, prt, environment)?)))
}

fn stand_in<'a>(
    prt: &'a Prt,
    environment: &'a Environment,
    error: &anyhow::Error,
    console: &Console,
) -> Result<Renderer<'a>> {
    console.notice(&format!("drawing on the CPU: {error:#}"));
    cpu(prt, environment)
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
