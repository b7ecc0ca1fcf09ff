//! Evaluates a .prt file on the CPU: always works, no driver needed.
//!
//! [`render`] draws one picture; a [`Renderer`] draws many of one scene under one probe. The model of light, materials and
//! pictures stands in docs/shading.md; the GPU renderer follows the same one.
//!
//! Of the ways of gloss there is one here: what arrives is kept per light (`GlossWay::Cache`), which gives the same picture as the
//! others; `16 n^2` bytes per texel.

mod bend;
mod bins;
mod bloom;
mod brdf;
mod check;
mod clip;
mod error;
mod facet;
mod frame;
mod gloss;
mod image;
mod light;
mod lit;
mod map;
mod raster;
mod renderer;
mod shade;
mod surfaces;
mod texture;
mod tile;
mod tone;
mod view;

pub use brdf::environment_brdf;
pub use error::Error;
pub use frame::{Frame, MAX_SIZE, MAX_SUPERSAMPLE, Tonemap};
pub use image::Image;
pub use light::vertex_radiance;
pub use renderer::{REFLECTION_LEVELS, REFLECTION_WIDTH, Renderer, render};
pub use tone::{curve, srgb_decode, srgb_encode};
