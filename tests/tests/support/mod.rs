//! Measures how far baked transfer is from the path tracer.
#![allow(dead_code, reason = "each test file uses a part")]

mod light;
mod measure;
mod solids;
mod subject;

pub(crate) use light::BandLight;
pub(crate) use measure::measure;
pub(crate) use subject::Subject;
