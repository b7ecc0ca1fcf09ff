//! Writes the files of `assets/`: `cargo run --release --example assets -- FOLDER`.
//!
//! The scene and the light probe are the project's own; this program is their recipe. A test compares both.

#[path = "../recipe/mod.rs"]
mod recipe;

use std::path::Path;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let folder = std::env::args().nth(1).ok_or("give a folder: assets -- FOLDER")?;
    let folder = Path::new(&folder);
    std::fs::create_dir_all(folder)?;
    std::fs::write(folder.join("pavilion.glb"), recipe::scene::glb())?;
    let rows = recipe::sky::ROWS;
    probe_io::write_hdr(&folder.join("evening.hdr"), 2 * rows, rows, &recipe::sky::pixels())?;
    Ok(())
}
