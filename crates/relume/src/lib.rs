//! Precomputed Radiance Transfer: bakes how a scene carries light once, and relights it under any environment.
//!
//! A program that bakes a glTF scene, keeps the result, and draws it under a light probe:
//!
//! ```
//! use relume::prelude::*;
//!
//! fn main() -> Result<(), relume::Error> {
//! #   let folder = tempfile::tempdir().expect("a folder");
//! #   for name in ["pavilion.glb", "evening.hdr"] {
//! #       let asset = format!("{}/../../assets/{name}", env!("CARGO_MANIFEST_DIR"));
//! #       std::fs::copy(asset, folder.path().join(name)).expect("an asset of the project");
//! #   }
//! #   std::env::set_current_dir(&folder).expect("the folder");
//!     let scene = load_scene("pavilion.glb")?;
//!     let prt = Bake::new(&scene).settings(Preset::Draft).run()?;
//!     save_prt(&prt, "pavilion.prt")?;
//!
//!     let evening = load_light_probe("evening.hdr")?;
//!     let frame = Frame::plain(prt.cameras[0].clone(), 320, 180);
//!     let image = Renderer::new(&prt, &evening)?.draw(&frame)?;
//!     save_image(&image, "pavilion.png")
//! }
//! ```
//!
//! | Step | Items |
//! |---|---|
//! | Load a scene or a light probe | [`load_scene`], [`load_light_probe`] |
//! | Choose settings | [`Preset`], [`BakeSettings`], [`LightSpectrum`] |
//! | Bake, also within a time | [`Bake`] |
//! | Light maps, transfer textures, an irradiance volume, a fixed light | [`Bake`], [`LightMapOptions`], [`AtlasOptions`] |
//! | Keep the result in a `.prt` file | [`save_prt`], [`load_prt`] |
//! | Draw, on the GPU or the CPU | [`Renderer`], [`save_image`] |
//!
//! The folder `examples` has numbered programs, from the first image to light maps, dynamic objects and the coefficients
//! themselves. The crates behind these items are re-exported under their own names.

mod atlas;
mod bake_job;
mod bake_within;
mod builtin;
mod enclosure;
mod error;
mod image_file;
mod light_probe;
mod light_spectrum;
pub mod prelude;
mod preset;
mod prt_file;
mod renderer;
mod schedule;
mod texture_options;
mod window;

pub use atlas::{AtlasEvent, AtlasObserver, AtlasOptions, has_normal_maps, is_normal_mapped};
pub use bake_job::{Bake, fixed_bands};
pub use bake_within::{achieved_error, bake_within};
pub use builtin::load_scene;
pub use coeff_io::{Prt, Settings as BakeSettings};
pub use enclosure::{Enclosure, find_enclosure, predict_enclosure};
pub use error::Error;
pub use image_file::{ImageFormat, save_image, write_image};
pub use light_probe::{load_light_probe, load_light_probe_with};
pub use light_spectrum::LightSpectrum;
pub use preset::Preset;
pub use probe_io::Environment as LightProbe;
pub use prt_file::{load_prt, save_prt};
pub use renderer::{Backend, Device, Renderer, RendererOptions};
pub use texture_options::{LightMapOptions, Pages, TransferTextureOptions};
pub use window::{Window, fixed_light};
pub use {bake, coeff_io, glam, probe_io, render_cpu, render_wgpu, scene, sh_math};
