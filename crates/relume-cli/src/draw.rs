//! The renderer as the command line uses it: names of options, and notices about who draws.

use crate::console::Console;
use crate::silence::silenced;
use anyhow::Result;
use coeff_io::Prt;
use probe_io::Environment;
use relume::{Device, Renderer, RendererOptions};
use render_cpu::{Frame, Image};
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

impl From<Backend> for relume::Backend {
    fn from(backend: Backend) -> Self {
        match backend {
            Backend::Auto => Self::Auto,
            Backend::Gpu => Self::Gpu,
            Backend::Cpu => Self::Cpu,
        }
    }
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

impl From<Window> for relume::Window {
    fn from(window: Window) -> Self {
        match window {
            Window::None => Self::None,
            Window::Auto => Self::Auto,
        }
    }
}

impl Window {
    /// The light as it is shown.
    pub(crate) fn apply(self, light: &sh_math::Rgb) -> sh_math::Rgb {
        relume::Window::from(self).apply(light)
    }
}

/// A scene under a light, ready to be drawn.
pub(crate) struct Drawer<'a>(Renderer<'a>);

impl<'a> Drawer<'a> {
    /// Makes scene and light ready; says who draws.
    pub(crate) fn open(
        backend: Backend,
        prt: &'a Prt,
        environment: &'a Environment,
        window: Window,
        console: &Console,
    ) -> Result<Self> {
        let options = RendererOptions {
            backend: backend.into(),
            window: window.into(),
            open_gpu: || silenced(|| Gpu::new(Driver::Any)),
        };
        let renderer = Renderer::with_options(prt, environment, options)?;
        console.notice(&text(renderer.device()));
        Ok(Self(renderer))
    }

    /// Draws one picture; says so where the CPU has to stand in for the GPU.
    pub(crate) fn draw(&mut self, frame: &Frame, console: &Console) -> Result<Image> {
        let before = self.0.device().clone();
        let image = self.0.draw(frame)?;
        if *self.0.device() != before {
            console.notice(&text(self.0.device()));
        }
        Ok(image)
    }

    /// Time that the GPU takes for a picture that stays there; `None` where the CPU draws.
    pub(crate) fn time(&mut self, frame: &Frame) -> Result<Option<Duration>> {
        Ok(self.0.gpu_time(frame)?)
    }
}

fn text(device: &Device) -> String {
    match device {
        Device::Gpu { description, is_software: true } => format!("drawing on a software driver: {description}"),
        Device::Gpu { description, is_software: false } => format!("drawing on the GPU: {description}"),
        Device::Cpu { gpu_error: None } => "drawing on the CPU".to_owned(),
        Device::Cpu { gpu_error: Some(render_wgpu::Error::NoAdapter { .. }) } => {
            "drawing on the CPU: no graphics driver was found".to_owned()
        }
        Device::Cpu { gpu_error: Some(error) } => format!("drawing on the CPU: {error}"),
    }
}
