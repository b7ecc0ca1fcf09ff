//! Bakes light maps that answer to a normal map, and exports them for an engine: `cargo run --release --example 03_light_maps`.

use relume::coeff_io::{Container, export};
use relume::prelude::*;
use std::path::Path;

/// Writes `maps.prt`, `maps.png` and a folder `textures` of KTX2 files into a folder.
pub(crate) fn run(folder: &Path) -> Result<(), relume::Error> {
    let scene = load_scene("builtin:bumps")?;
    let sky = load_light_probe("builtin:sky")?;
    // Meshes without usable light-map coordinates are unwrapped. The maps hold this one light.
    let bake = Bake::new(&scene).settings(Preset::Draft).light_maps(LightMapOptions::new(64)).fixed_light(&sky);
    let prt = bake.run()?;
    save_prt(&prt, folder.join("maps.prt"))?;
    if let Some(maps) = &prt.maps {
        export::maps(maps, Container::Ktx2, &folder.join("textures"))?;
    }

    let frame = Frame::plain(prt.cameras[0].clone(), 320, 180);
    save_image(&Renderer::new(&prt, &sky)?.draw(&frame)?, folder.join("maps.png"))
}

fn main() -> Result<(), relume::Error> {
    run(Path::new("."))
}
