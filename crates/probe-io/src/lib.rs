//! Light probes in every layout, analytic lights, radiance by direction.

mod environment;
mod layout;
mod probe;

pub use environment::{Environment, Lamp};
pub use layout::Layout;
pub use probe::Probe;
