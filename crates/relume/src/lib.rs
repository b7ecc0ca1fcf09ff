//! Precomputed Radiance Transfer: bakes how a scene carries light once, and relights it under any environment.
//!
//! This crate is the front door of the workspace. It re-exports the crates that a program needs, each under its own
//! name, and the items that most programs need in [`prelude`].
//!
//! | Step | Items |
//! |---|---|
//! | Load a scene: glTF, OBJ or a builtin | [`scene::load`], [`scene::builtin`] |
//! | Load a light probe: `.hdr`, `.exr` or a builtin | [`probe_io::Environment`], [`probe_io::builtin`] |
//! | Bake the transfer | [`bake::bake`], [`bake::bake_with`] |
//! | Read and write `.prt` files | [`coeff_io::Prt`] |
//! | Draw on the CPU | [`render_cpu::render`] |
//! | Draw on the GPU | [`render_wgpu::render`] |
//!
//! ```
//! use relume::prelude::*;
//!
//! let scene = relume::scene::builtin("plane").expect("a builtin scene");
//! let settings = Settings { quality: Quality::Rays(16), ..relume::bake::settings::standard() };
//! let prt = relume::bake::bake(&scene, &settings)?;
//! assert!(!prt.transfer.values.is_empty());
//! # Ok::<(), relume::bake::Error>(())
//! ```

pub use {bake, coeff_io, probe_io, render_cpu, render_wgpu, scene, sh_math};

pub mod prelude;
