//! Which view is drawn: a camera of the scene by name, or one of the user's own.

use crate::usage::Usage;
use anyhow::Result;

/// A view as typed.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Lens {
    /// A camera of the scene.
    Name(String),
    /// Eye and target in world coordinates, metres; full vertical angle of view in degrees.
    View { eye: [f64; 3], target: [f64; 3], fov: f32 },
}

/// Parses `NAME` or `ex,ey,ez,tx,ty,tz,fov`.
pub(crate) fn parse(text: &str) -> Result<Lens, String> {
    let numbers: Option<Vec<f64>> = text.split(',').map(|part| part.trim().parse().ok()).collect();
    match numbers.as_deref() {
        Some(&[ex, ey, ez, tx, ty, tz, fov]) => view([ex, ey, ez], [tx, ty, tz], fov as f32),
        Some(numbers) if numbers.len() > 1 => {
            Err("a view of your own has seven numbers: eye x,y,z, target x,y,z and the angle of view in degrees".into())
        }
        _ => Ok(Lens::Name(text.to_owned())),
    }
}

fn view(eye: [f64; 3], target: [f64; 3], fov: f32) -> Result<Lens, String> {
    if !eye.iter().chain(&target).all(|v| v.is_finite()) || eye == target {
        return Err("eye and target must be two places".into());
    }
    if !(fov > 0.0 && fov < 180.0) {
        return Err(format!("the angle of view is {fov}, but must lie between 0 and 180 degrees"));
    }
    Ok(Lens::View { eye, target, fov })
}

/// A world position relative to the origin of a scene or file.
fn relative(world: [f64; 3], origin: [f64; 3]) -> [f32; 3] {
    std::array::from_fn(|k| (world[k] - origin[k]) as f32)
}

/// The view of a baked file; its first camera where none was asked for.
pub(crate) fn of_prt(lens: Option<&Lens>, prt: &coeff_io::Prt) -> Result<coeff_io::Camera> {
    let cameras = &prt.cameras;
    let name = match lens {
        Some(&Lens::View { eye, target, fov }) => {
            let [eye, target] = [eye, target].map(|place| relative(place, prt.origin));
            let (name, up, vertical_fov) = ("view".into(), [0.0, 1.0, 0.0], fov.to_radians());
            return Ok(coeff_io::Camera { name, eye, target, up, vertical_fov });
        }
        Some(Lens::Name(name)) => Some(name.as_str()),
        None => None,
    };
    let names: Vec<&str> = cameras.iter().map(|camera| camera.name.as_str()).collect();
    Ok(cameras[find(name, &names)?].clone())
}

/// The view of a scene; its first camera, or one that sees all of it, where none was asked for.
pub(crate) fn of_scene(lens: Option<&Lens>, scene: &scene::Scene) -> Result<scene::Camera> {
    match lens {
        Some(&Lens::View { eye, target, fov }) => Ok(scene::Camera {
            name: "view".into(),
            eye: relative(eye, scene.origin).into(),
            target: relative(target, scene.origin).into(),
            up: glam::Vec3::Y,
            vertical_fov: fov.to_radians(),
        }),
        None => Ok(scene::default_camera(scene)),
        // A scene without cameras is baked with the default one, so its name is known here too.
        Some(Lens::Name(name)) if scene.cameras.is_empty() => {
            let camera = scene::default_camera(scene);
            find(Some(name), &[&camera.name])?;
            Ok(camera)
        }
        Some(Lens::Name(name)) => {
            let names: Vec<&str> = scene.cameras.iter().map(|camera| camera.name.as_str()).collect();
            Ok(scene.cameras[find(Some(name), &names)?].clone())
        }
    }
}

/// Index of the camera of that name, or of the first.
fn find(name: Option<&str>, names: &[&str]) -> Result<usize> {
    let found = match name {
        Some(name) => names.iter().position(|n| *n == name),
        None => (!names.is_empty()).then_some(0),
    };
    let fault = || Usage(format!("there is no camera '{}'; there are {}", name.unwrap_or_default(), names.join(", ")));
    Ok(found.ok_or_else(fault)?)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_become_views() {
        let far = parse("500012.25,9,-5299985.125,500000,0,-5300000,45").expect("a view");
        let scene = scene::Scene { origin: [500_000.0, 0.0, -5_300_000.0], ..scene::Scene::default() };
        let camera = of_scene(Some(&far), &scene).expect("a camera");
        assert_eq!((camera.eye, camera.target), (glam::Vec3::new(12.25, 9.0, 14.875), glam::Vec3::ZERO));
        let view = Lens::View { eye: [0.0, 1.0, 5.0], target: [0.0, 1.0, 0.0], fov: 45.0 };
        assert_eq!(parse("0,1,5,0,1,0,45"), Ok(view));
        assert_eq!(parse("front"), Ok(Lens::Name("front".into())));
        assert_eq!(parse("front, left"), Ok(Lens::Name("front, left".into())));
        for wrong in ["0,1,5", "0,1,5,0,1,5,45", "0,1,5,0,1,0,180", "0,1,5,0,1,nan,45", "inf,1,5,0,1,0,45"] {
            assert!(parse(wrong).is_err(), "{wrong}");
        }
    }
}
