//! Evaluates a .prt file on the GPU: plain data in, pixels out.
//!
//! The shading model is that of `docs/shading.md`; `render-cpu` draws the same picture without a GPU.
//! [`Gpu::new`] opens a device, [`Renderer::new`] uploads a baked scene and a light probe,
//! [`Renderer::draw`] gives pictures.

mod error;
mod frame;
mod gpu;
mod readback;
mod renderer;

pub use error::Error;
pub use frame::{Frame, Image, Tonemap};
pub use gpu::{Driver, Gpu};
pub use renderer::{Renderer, render};
