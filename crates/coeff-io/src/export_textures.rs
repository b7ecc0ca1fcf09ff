//! Light maps and volumes for other programs: textures, and the JSON that says what they mean.

use crate::sidecar::{GridText, MapsText, SheetText, VolumeText};
use crate::texels::{Extent, TexelFormat, Texels};
use crate::{Container, Encoding, Error, Layers, Maps, Sheet, Volume, basis_id, replace};
use half::f16;
use serde::Serialize;
use std::io::{self, Write};
use std::path::Path;

/// Writes `sheet_0.ktx2` (or `.dds`) and so on, 2-D arrays with one layer per function and coefficient of the light, and `maps.json` beside
/// them into `folder`, which is made if need be.
///
/// Blocks and floating numbers are written as they are held, three channels with a fourth that is 1; eight bits become halves. Row 0 is
/// v = 0. Ranges and curves of blocks stand in `maps.json`.
///
/// # Errors
/// `Unsupported` where a sheet is larger than graphics hardware reads, `Io`.
pub fn maps(maps: &Maps, container: Container, folder: &Path) -> Result<(), Error> {
    crate::make_folder(folder)?;
    let mut sheets = Vec::new();
    for (i, Sheet { layers }) in maps.sheets.iter().enumerate() {
        let file = format!("sheet_{i}.{}", container.extension());
        let (texels, encoding) = texels(layers);
        write(&folder.join(&file), &container.write(&texels)?)?;
        sheets.push(SheetText {
            file,
            width: layers.width,
            height: layers.height,
            layers: layers.count,
            channels: layers.channels,
            encoding,
            ranges: layers.blocks().map_or(Vec::new(), |blocks| blocks.layers),
        });
    }
    let text = MapsText {
        convention: sh_math::CONVENTION.into(),
        basis: basis_id(maps.basis).into(),
        light: maps.light.clone(),
        sheets,
        sheet_of_mesh: maps.sheet_of_mesh.clone(),
    };
    json(&folder.join("maps.json"), &text)
}

/// The texture of a sheet and the encoding of its numbers there.
fn texels(layers: &Layers) -> (Texels, Encoding) {
    let single = layers.channels == 1;
    let (format, encoding, bytes) = match (layers.encoding, layers.blocks()) {
        (Encoding::Bc1, Some(blocks)) => (TexelFormat::Bc1, Encoding::Bc1, blocks.bytes.to_vec()),
        (Encoding::Bc6h, Some(blocks)) => (TexelFormat::Bc6h, Encoding::Bc6h, blocks.bytes.to_vec()),
        (Encoding::F32, _) => {
            let bytes = with_alpha(layers.decode(), layers.channels).flat_map(f32::to_le_bytes).collect();
            (if single { TexelFormat::R32F } else { TexelFormat::Rgba32F }, Encoding::F32, bytes)
        }
        _ => {
            let bytes = with_alpha(layers.decode(), layers.channels).flat_map(half).collect();
            (if single { TexelFormat::R16F } else { TexelFormat::Rgba16F }, Encoding::F16, bytes)
        }
    };
    let extent = Extent::Layers(layers.count);
    (Texels { width: layers.width, height: layers.height, extent, format, bytes }, encoding)
}

/// Three channels get a fourth that is 1; one stays alone.
fn with_alpha(values: Vec<f32>, channels: u32) -> impl Iterator<Item = f32> {
    values.into_iter().enumerate().flat_map(move |(i, value)| {
        let last = channels == 3 && i % 3 == 2;
        std::iter::once(value).chain(last.then_some(1.0))
    })
}

fn half(value: f32) -> [u8; 2] {
    let largest = f16::MAX.to_f32();
    f16::from_f32(value.clamp(-largest, largest)).to_le_bytes()
}

/// Writes the volume on its finest even grid: `volume_0.ktx2` (or `.dds`) to `volume_8`, 3-D textures of RGBA halves with an alpha of 1, one
/// per function, and `volume.json` beside them into `folder`, which is made if need be. (3-D textures have no arrays.)
///
/// `light` has the bands of a relightable volume, in world axes; it is unused where the light is fixed.
///
/// # Errors
/// `Unsupported` where the grid is larger than graphics hardware reads, `Io`.
pub fn volume(volume: &Volume, light: &[[f32; 3]], container: Container, folder: &Path) -> Result<(), Error> {
    let grid = volume.grid(light)?;
    crate::make_folder(folder)?;
    let files = std::array::from_fn(|k| format!("volume_{k}.{}", container.extension()));
    for (file, function) in files.iter().zip(&grid.functions) {
        let bytes = function.iter().flat_map(|[r, g, b]| [*r, *g, *b, 1.0]).flat_map(half).collect();
        let [width, height, depth] = grid.points;
        let texels = Texels { width, height, extent: Extent::Depth(depth), format: TexelFormat::Rgba16F, bytes };
        write(&folder.join(file), &container.write(&texels)?)?;
    }
    let convention = sh_math::CONVENTION.into();
    let text = GridText { convention, origin: grid.origin, step: grid.step, points: grid.points, files };
    json(&folder.join("volume.json"), &text)
}

/// Writes a volume as JSON, with its cells and every number of its probes: the form to read and to change by hand. \[N\] section 2.3.
///
/// # Errors
/// `Io`.
pub fn volume_json(volume: &Volume, path: &Path) -> Result<(), Error> {
    json(path, &VolumeText::of(volume))
}

fn json(path: &Path, text: &impl Serialize) -> Result<(), Error> {
    let fill = |file: &mut io::BufWriter<&std::fs::File>| {
        serde_json::to_writer_pretty(&mut *file, text)?;
        writeln!(file)
    };
    Ok(replace(path, fill)?)
}

fn write(path: &Path, bytes: &[u8]) -> Result<(), Error> {
    Ok(replace(path, |file| file.write_all(bytes))?)
}
