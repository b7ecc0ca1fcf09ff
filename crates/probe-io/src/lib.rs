//! Light probes in every layout, analytic lights, radiance by direction.

mod angular;
mod builtin;
mod cube;
mod detect;
mod environment;
mod equirect;
mod error;
mod gauss;
mod layers;
mod layout;
mod load;
mod nonfinite;
mod openexr;
mod patch;
mod picture;
mod primaries;
mod probe;
pub mod reflection;
mod rgbe;
mod sky;
mod studio;
mod subsampled;

pub use builtin::{BUILTINS, builtin};
pub use environment::{Environment, Lamp};
pub use error::Error;
pub use layout::Layout;
pub use load::{LoadOptions, Negatives};
pub use nonfinite::NonFinite;
pub use picture::{encode_exr, read_picture, write_exr, write_hdr};
pub use probe::{Probe, Texel};
