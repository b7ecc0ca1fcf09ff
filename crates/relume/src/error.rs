//! Why a step failed, whichever crate it failed in.

use std::io;
use std::path::PathBuf;

/// Why a step failed; the message says what, where and what to do.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// A scene file could not be loaded.
    #[error(transparent)]
    Scene(#[from] scene::Error),
    /// A light probe could not be loaded.
    #[error(transparent)]
    LightProbe(#[from] probe_io::Error),
    /// No builtin scene or light probe has that name.
    #[error("there is no builtin {kind} '{name}'")]
    UnknownBuiltin {
        /// `scene` or `light probe`.
        kind: &'static str,
        /// The name that was asked for, without `builtin:`.
        name: String,
    },
    /// A light probe holds more radiance than sums in single precision can hold.
    #[error("{name}: a radiance of {radiance:e} is too much to be summed: give 1e30 at most")]
    TooBright {
        /// Name of the light probe.
        name: String,
        /// Its largest radiance.
        radiance: f32,
    },
    /// A number of bands that the spherical harmonics do not support.
    #[error("{bands} bands: give a number of bands from 1 to {}", sh_math::Bands::MAX)]
    Bands {
        /// The number that was asked for.
        bands: u32,
    },
    /// Light-map coordinates could not be made.
    #[error(transparent)]
    Unwrap(#[from] scene::lightmap::UnwrapError),
    /// No mesh or material has that name.
    #[error("{name}: no mesh or material of {scene} has that name")]
    UnknownMesh {
        /// Name of the scene.
        scene: String,
        /// The name that was asked for.
        name: String,
    },
    /// A bake failed or was cancelled.
    #[error(transparent)]
    Bake(#[from] bake::Error),
    /// A `.prt` file could not be read.
    #[error("cannot read {}", path.display())]
    ReadPrt {
        /// The file.
        path: PathBuf,
        /// What is wrong with it.
        source: coeff_io::Error,
    },
    /// A `.prt` file could not be written.
    #[error("cannot write {}", path.display())]
    WritePrt {
        /// The file.
        path: PathBuf,
        /// What is wrong.
        source: coeff_io::Error,
    },
    /// An export failed.
    #[error(transparent)]
    Export(#[from] coeff_io::Error),
    /// A dynamic object cannot stand in a scene.
    #[error(transparent)]
    DynamicObject(#[from] coeff_io::VisitorError),
    /// The CPU renderer refused a file or a frame.
    #[error(transparent)]
    RenderCpu(#[from] render_cpu::Error),
    /// The GPU renderer failed.
    #[error(transparent)]
    RenderGpu(#[from] render_wgpu::Error),
    /// The extension of an image file names no format that can be written.
    #[error("{}: give a file that ends in .png (for the display) or .exr (linear)", path.display())]
    ImageFormat {
        /// The file.
        path: PathBuf,
    },
    /// The operating system refused to write a file.
    #[error("cannot write {}", path.display())]
    Write {
        /// The file.
        path: PathBuf,
        /// What the operating system said.
        source: io::Error,
    },
}
