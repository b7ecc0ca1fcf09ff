//! Light probes from files and builtins, checked for use as a light.

use crate::Error;
use crate::builtin::builtin_name;
use probe_io::{Environment, LoadOptions};
use std::path::Path;

/// Largest radiance of a pixel: sums of more would leave the range of single precision.
const MAX_RADIANCE: f32 = 1e30;

/// Loads a light probe: a `.hdr` or `.exr` file in any layout, a folder of six faces, or `builtin:NAME`.
///
/// Negative radiance becomes 0. [`load_light_probe_with`] gives the choice and the warnings.
///
/// # Errors
/// [`Error::LightProbe`], [`Error::UnknownBuiltin`] or [`Error::TooBright`].
pub fn load_light_probe(source: impl AsRef<Path>) -> Result<Environment, Error> {
    load_light_probe_with(source, &LoadOptions::lenient()).map(|(environment, _)| environment)
}

/// [`load_light_probe`] with a choice of layout, layer and treatment of invalid pixels; the strings are warnings.
///
/// # Errors
/// As [`load_light_probe`].
pub fn load_light_probe_with(
    source: impl AsRef<Path>,
    options: &LoadOptions,
) -> Result<(Environment, Vec<String>), Error> {
    let path = source.as_ref();
    let (environment, warnings) = match builtin_name(path) {
        Some(name) => {
            let unknown = || Error::UnknownBuiltin { kind: "light probe", name: name.to_owned() };
            (probe_io::builtin(name).ok_or_else(unknown)?, Vec::new())
        }
        None => Environment::load(path, options)?,
    };
    check_radiance(&environment, &path.display().to_string())?;
    Ok((environment, warnings))
}

fn check_radiance(environment: &Environment, name: &str) -> Result<(), Error> {
    let radiance = environment.image.pixels.iter().flatten().copied().fold(0.0, f32::max);
    if radiance <= MAX_RADIANCE { Ok(()) } else { Err(Error::TooBright { name: name.to_owned(), radiance }) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn radiance_beyond_single_precision_is_refused() {
        assert!(load_light_probe("builtin:constant:1e30").is_ok(), "the limit itself");
        let refused = load_light_probe("builtin:constant:1e31");
        assert!(matches!(refused, Err(Error::TooBright { .. })), "{refused:?}");
    }
}
