//! Distant light as paths need it: radiance by direction, and directions in proportion to radiance.

mod image;
mod lamp;

use image::ImageLight;
pub(crate) use lamp::LampLight;

use glam::Vec3;
use probe_io::{Environment, Layout, Probe};

/// A light to trace with: a picture, constant over each of its pixels, and lamps.
#[derive(Debug, Clone)]
pub struct Light {
    pub(crate) image: ImageLight,
    pub(crate) lamps: Vec<LampLight>,
    /// What the camera sees where no surface is.
    sky: Environment,
}

impl Light {
    /// The light of an environment.
    #[must_use]
    pub fn new(environment: &Environment) -> Self {
        Self {
            image: ImageLight::new(&environment.image),
            lamps: environment.lamps.iter().map(LampLight::new).collect(),
            sky: environment.clone(),
        }
    }

    /// Light of an equirectangular picture of `width` columns that may be negative in places, such as a
    /// reconstruction from few bands; it has no lamps of its own. None where the rows are not full, the picture is
    /// empty or holds a value that is not finite.
    #[must_use]
    pub fn from_equirect(width: usize, pixels: Vec<[f32; 3]>) -> Option<Self> {
        let full = width > 0 && !pixels.is_empty() && pixels.len().is_multiple_of(width);
        if !full || !pixels.as_flattened().iter().all(|v| v.is_finite()) {
            return None;
        }
        let probe = Probe { layout: Layout::Equirect, width, height: pixels.len() / width, pixels };
        let image = ImageLight::new(&probe);
        Some(Self {
            image,
            lamps: Vec::new(),
            sky: Environment { name: "picture".into(), image: probe, lamps: Vec::new() },
        })
    }

    /// The same light with another view behind the scene: what lights it stays.
    #[must_use]
    pub fn with_sky(self, sky: &Environment) -> Self {
        Self { sky: sky.clone(), ..self }
    }

    /// Radiance that the camera sees where no surface is.
    pub(crate) fn sky(&self, direction: Vec3) -> Vec3 {
        Vec3::from_array(self.sky.radiance(direction))
    }
}
