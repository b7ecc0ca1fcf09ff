//! Turns the light probe around a baked scene; nothing is baked again: `cargo run --release --example 02_relight_turned_probe`.

use relume::prelude::*;
use std::f32::consts::TAU;
use std::path::Path;

/// Images of one turn.
const IMAGES: u32 = 4;

/// Writes `turned-0.png` to `turned-3.png` into a folder.
pub(crate) fn run(folder: &Path) -> Result<(), relume::Error> {
    let scene = load_scene("builtin:sphere-on-plane")?;
    let prt = Bake::new(&scene).settings(Preset::Draft).run()?;

    let sky = load_light_probe("builtin:sky")?;
    let mut renderer = Renderer::new(&prt, &sky)?;
    for number in 0..IMAGES {
        // world_from_light: a direction of the probe, turned by it, is a direction of the world.
        let rotation = Quat::from_rotation_y(TAU * number as f32 / IMAGES as f32);
        let frame = Frame { rotation, ..Frame::plain(prt.cameras[0].clone(), 320, 180) };
        save_image(&renderer.draw(&frame)?, folder.join(format!("turned-{number}.png")))?;
    }
    Ok(())
}

fn main() -> Result<(), relume::Error> {
    run(Path::new("."))
}
