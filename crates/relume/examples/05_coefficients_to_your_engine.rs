//! Uses the coefficients without a renderer of this project: `cargo run --release --example 05_coefficients_to_your_engine`.
//!
//! The radiance of a vertex is its albedo times the dot product of its transfer vector and the coefficients of the light.

use relume::prelude::*;
use relume::sh_math;
use std::io::Write;
use std::path::Path;

/// Writes `coloured.ply`, a mesh with linear radiance as vertex colours, into a folder; returns the colours.
pub(crate) fn run(folder: &Path) -> Result<Vec<[f32; 3]>, relume::Error> {
    let scene = load_scene("builtin:sphere-on-plane")?;
    let prt = Bake::new(&scene).settings(Preset::Draft).run()?;

    // The light in as many bands as the transfer; index l(l+1)+m, real orthonormal harmonics without Condon-Shortley phase.
    let bands = sh_math::Bands::new(prt.transfer.bands).ok_or(relume::Error::Bands { bands: prt.transfer.bands })?;
    let light = sh_math::project(bands, load_light_probe("builtin:sky")?.samples());
    let light = light.rotated(Quat::from_rotation_y(0.5));

    // What a vertex shader does, from two buffers: [vertex][coefficient][channel] and [coefficient][channel].
    let channels = prt.transfer.channels as usize;
    let radiance = |(row, albedo): (&[f32], &[f32; 3])| -> [f32; 3] {
        std::array::from_fn(|c| {
            let terms = row.chunks_exact(channels).zip(&light.values);
            albedo[c] * terms.map(|(transfer, light)| transfer[c.min(channels - 1)] * light[c]).sum::<f32>()
        })
    };
    let rows = prt.transfer.values.chunks_exact(bands.coefficients() * channels);
    let colours: Vec<[f32; 3]> = rows.zip(&prt.transfer.albedo).map(radiance).collect();
    let path = folder.join("coloured.ply");
    let write = |path: &Path| std::fs::File::create(path)?.write_all(ply(&prt, &colours).as_bytes());
    write(&path).map_err(|source| relume::Error::Write { path, source })?;
    Ok(colours)
}

/// The mesh with a colour for each vertex, as text.
fn ply(prt: &Prt, colours: &[[f32; 3]]) -> String {
    let (positions, triangles) = (&prt.geometry.positions, &prt.geometry.triangles);
    let mut text = format!("ply\nformat ascii 1.0\nelement vertex {}\n", positions.len());
    for name in ["x", "y", "z", "red", "green", "blue"] {
        text += &format!("property float {name}\n");
    }
    text += &format!("element face {}\nproperty list uchar int vertex_indices\nend_header\n", triangles.len());
    for ([x, y, z], [r, g, b]) in positions.iter().zip(colours) {
        text += &format!("{x} {y} {z} {r} {g} {b}\n");
    }
    for [a, b, c] in triangles {
        text += &format!("3 {a} {b} {c}\n");
    }
    text
}

fn main() -> Result<(), relume::Error> {
    run(Path::new(".")).map(drop)
}
