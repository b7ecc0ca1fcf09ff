//! An object that stands or moves in a baked scene, lit by its irradiance volume.

use crate::console::Console;
use crate::source;
use anyhow::{Context, Result};
use coeff_io::{Prt, VisitorError};
use glam::{Affine3A, DVec3, Quat, Vec3};
use std::path::PathBuf;

/// The object and where it stands, as typed.
#[derive(Debug, Clone, clap::Args)]
pub(crate) struct VisitorOptions {
    /// Puts the object of another baked file into the scene, lit by the scene's irradiance volume (bake --volume).
    #[arg(long, value_name = "O.prt")]
    visitor: Option<PathBuf>,
    /// Where its origin stands, metres, and, if wanted, its scale and its turn about the upward axis in degrees.
    #[arg(long, value_name = "X,Y,Z[,SCALE[,YAW]]", default_value = "0,0,0", value_parser = place, allow_hyphen_values = true, requires = "visitor")]
    at: Place,
    /// Where it has moved to in the last of --frames.
    #[arg(long, value_name = "X,Y,Z", value_parser = point, allow_hyphen_values = true, requires_all = ["visitor", "frames"])]
    to: Option<DVec3>,
}

/// Where an object stands, in world coordinates.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Place {
    at: DVec3,
    scale: f32,
    yaw: f32,
}

/// An object that was read.
pub(crate) struct Visitor {
    prt: Prt,
    file: PathBuf,
    place: Place,
    to: Option<DVec3>,
}

impl VisitorOptions {
    pub(crate) fn load(&self) -> Result<Option<Visitor>> {
        let read = |file: &PathBuf| -> Result<Visitor> {
            Ok(Visitor { prt: source::prt(file)?, file: file.clone(), place: self.at, to: self.to })
        };
        self.visitor.as_ref().map(read).transpose()
    }
}

impl Visitor {
    /// Whether it has a way to go.
    pub(crate) fn moves(&self) -> bool {
        self.to.is_some()
    }

    /// Tells where the object leaves the volume, whose border lights it there.
    pub(crate) fn tell(&self, scene: &Prt, console: &Console) {
        let Some(volume) = &scene.volume else { return };
        let low = Vec3::from(volume.origin);
        let high = low + Vec3::from(volume.spacing) * Vec3::from(volume.cells.map(|n| n as f32));
        let outside = |p: DVec3| {
            let p = local(scene, p);
            p.clamp(low, high) != p
        };
        if outside(self.place.at) || self.to.is_some_and(outside) {
            console
                .notice("the object stands outside of the irradiance volume: the light of its border is taken there");
        }
    }

    /// The scene with the object at a share of its way.
    pub(crate) fn at(&self, scene: &Prt, share: f32) -> Result<Prt> {
        let Place { at, scale, yaw } = self.place;
        let at = local(scene, self.to.map_or(at, |to| at.lerp(to, f64::from(share))));
        let place = Affine3A::from_scale_rotation_translation(Vec3::splat(scale), Quat::from_rotation_y(yaw), at);
        let placed = scene.with_visitor(&self.prt, &place).map_err(|error| match error {
            VisitorError::NoVolume => anyhow::anyhow!("{error} (--volume)"),
            VisitorError::Fixed(_) => anyhow::anyhow!("{error} (--volume without --lighting fixed)"),
            other => other.into(),
        });
        placed.with_context(|| format!("{} cannot stand in the scene", self.file.display()))
    }
}

/// A place in the coordinates of a file.
fn local(scene: &Prt, world: DVec3) -> Vec3 {
    (world - DVec3::from(scene.origin)).as_vec3()
}

fn numbers(text: &str) -> Option<Vec<f64>> {
    text.split(',').map(|part| part.trim().parse().ok().filter(|v: &f64| v.is_finite())).collect()
}

/// Parses `X,Y,Z`.
fn point(text: &str) -> Result<DVec3, String> {
    match numbers(text).as_deref() {
        Some(&[x, y, z]) => Ok(DVec3::new(x, y, z)),
        _ => Err("give three coordinates, such as 0,1,0".into()),
    }
}

/// Parses `X,Y,Z[,SCALE[,YAW]]`.
fn place(text: &str) -> Result<Place, String> {
    let wrong = || {
        "give three coordinates, and if wanted a scale above 0 and a turn in degrees, such as 0,1,0,0.5,90".to_owned()
    };
    let (at, scale, yaw) = match numbers(text).as_deref() {
        Some(&[x, y, z]) => (DVec3::new(x, y, z), 1.0, 0.0),
        Some(&[x, y, z, scale]) => (DVec3::new(x, y, z), scale as f32, 0.0),
        Some(&[x, y, z, scale, yaw]) => (DVec3::new(x, y, z), scale as f32, (yaw as f32).to_radians()),
        _ => return Err(wrong()),
    };
    if scale > 0.0 { Ok(Place { at, scale, yaw }) } else { Err(wrong()) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn places_are_parsed() {
        assert_eq!(place("1,2,-3"), Ok(Place { at: DVec3::new(1.0, 2.0, -3.0), scale: 1.0, yaw: 0.0 }));
        assert_eq!(place("0,0,0,0.5,180").map(|p| (p.scale, p.yaw)), Ok((0.5, std::f32::consts::PI)));
        assert!(place("1,2").is_err() && place("0,0,0,0").is_err() && place("0,0,nan").is_err() && point("1").is_err());
    }
}
