//! Bakes a scene, writes the `.prt` file, and draws it under a sky: `cargo run --release --example 01_bake_and_render`.

use relume::prelude::*;
use std::path::Path;

/// The scene and the light probe of the project; any glTF or OBJ file and any `.hdr` or `.exr` file work as well.
const ASSETS: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../assets");

/// Writes `first.prt`, `first.png` and `first.exr` into a folder.
pub(crate) fn run(folder: &Path) -> Result<(), relume::Error> {
    let scene = load_scene(format!("{ASSETS}/pavilion.glb"))?;
    let prt = Bake::new(&scene).settings(Preset::Draft).run()?;
    save_prt(&prt, folder.join("first.prt"))?;

    // The file holds all that a renderer needs.
    let prt = load_prt(folder.join("first.prt"))?;
    let evening = load_light_probe(format!("{ASSETS}/evening.hdr"))?;
    let frame = Frame { tonemap: Tonemap::Filmic, supersample: 2, ..Frame::plain(prt.cameras[0].clone(), 320, 180) };
    let image = Renderer::new(&prt, &evening)?.draw(&frame)?;
    save_image(&image, folder.join("first.png"))?;
    save_image(&image, folder.join("first.exr"))
}

fn main() -> Result<(), relume::Error> {
    run(Path::new("."))
}
