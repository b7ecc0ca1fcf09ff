//! The two tables of the paper on transfer textures (\[T\]), on scenes of the same kind and size.

mod memory;
mod rates;
mod setup;

pub use memory::{Memory, memory_table};
pub use rates::{Rate, Stage, rate_table, rates, receivers};
pub use setup::{Baked, Setup, baked};

/// What went wrong while measuring.
#[derive(Debug, thiserror::Error)]
pub enum Error {
    /// No scene has that name.
    #[error("there is no built-in scene '{0}'")]
    Scene(String),
    /// A mesh could not be unwrapped.
    #[error(transparent)]
    Unwrap(#[from] scene::lightmap::UnwrapError),
    /// The bake failed.
    #[error(transparent)]
    Bake(#[from] bake::Error),
    /// The GPU failed.
    #[error(transparent)]
    Draw(#[from] render_wgpu::Error),
}
