//! Measures how far baked transfer is from the path tracer.

mod light;
mod measure;
mod subject;

pub use light::BandLight;
pub use measure::{Figures, measure};
pub use subject::Subject;
