//! Scenes and light probes by the names that the examples take: a path, or `builtin:NAME`.
#![allow(dead_code, reason = "each example uses a part")]

use probe_io::{Environment, LoadOptions};
use scene::Scene;
use std::error::Error;
use std::path::Path;

pub(crate) fn scene(name: &str) -> Result<Scene, Box<dyn Error>> {
    Ok(match name.strip_prefix("builtin:") {
        Some(name) => scene::builtin(name).ok_or("no such scene")?,
        None => scene::load(Path::new(name))?,
    })
}

pub(crate) fn probe(name: &str) -> Result<Environment, Box<dyn Error>> {
    Ok(match name.strip_prefix("builtin:") {
        Some(name) => probe_io::builtin(name).ok_or("no such probe")?,
        None => Environment::load(Path::new(name), &LoadOptions::lenient())?.0,
    })
}
