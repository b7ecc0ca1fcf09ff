//! Evaluates a .prt file on the GPU: plain data in, pixels out.
//!
//! The shading model is that of `docs/shading.md`; `render-cpu` draws the same picture without a GPU.
//! [`Gpu::new`] opens a device, [`Renderer::new`] uploads a baked scene and a light probe,
//! [`Renderer::draw`] gives pictures. In another program [`Gpu::from_wgpu`] takes the caller's device and
//! [`Renderer::draw_into`] draws into the caller's texture, without waiting.

mod blend;
mod bloom;
mod check;
mod draw;
mod draw_into;
mod error;
mod finish;
mod frame;
mod fullscreen;
mod geometry;
mod gloss;
mod gloss_rows;
mod gloss_shared;
mod gloss_sheet;
mod gloss_text;
mod gloss_vertices;
mod gloss_way;
mod gpu;
mod gpu_data;
mod material;
mod picture;
mod readback;
mod reflection;
mod relight;
mod relight_clusters;
mod renderer;
mod shaders;
mod sheets;
mod sky;
mod strip;
mod surface;
mod target;
mod targets;
mod texture;
#[cfg(test)]
mod twin;
mod view;

pub use error::Error;
pub use frame::{Frame, Image, Tonemap};
pub use gpu::{Driver, Gpu};
pub use renderer::{Renderer, Timings, render};
pub use wgpu;
