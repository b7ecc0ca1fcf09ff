//! Bakes an irradiance volume, which lights an object that moves: `cargo run --release --example 04_volume_dynamic_object`.

use relume::bake::VolumeSteps;
use relume::glam::Affine3A;
use relume::prelude::*;
use std::path::Path;

/// Places of the object, metres: the origin, and beside it.
const PLACES: [Vec3; 2] = [Vec3::new(0.0, 1.2, 0.0), Vec3::new(1.2, 0.6, 0.0)];

/// Writes `object-0.png` and `object-1.png` into a folder.
pub(crate) fn run(folder: &Path) -> Result<(), relume::Error> {
    let scene = load_scene("builtin:half-blocked-plane")?;
    let volume = VolumeSettings { steps: VolumeSteps::Probes([4, 3, 4]), ..VolumeSettings::standard() };
    let room = Bake::new(&scene).settings(Preset::Draft).volume(volume).run()?;
    // Of the object the surfaces are used; its own transfer is replaced by that of the volume.
    let object = Bake::new(&load_scene("builtin:sphere")?).settings(Preset::Draft).run()?;

    let sky = load_light_probe("builtin:sky")?;
    for (number, place) in PLACES.into_iter().enumerate() {
        let pose = Affine3A::from_scale_rotation_translation(Vec3::splat(0.3), Quat::IDENTITY, place);
        let both = room.with_visitor(&object, &pose)?;
        let frame = Frame::plain(both.cameras[0].clone(), 320, 180);
        let image = Renderer::new(&both, &sky)?.draw(&frame)?;
        save_image(&image, folder.join(format!("object-{number}.png")))?;
    }
    Ok(())
}

fn main() -> Result<(), relume::Error> {
    run(Path::new("."))
}
