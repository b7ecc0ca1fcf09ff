//! Exported light maps and volumes are read again: what another program changed comes back.

use crate::sidecar::{GridText, MapsText, SheetText, VolumeText};
use crate::texels::{Extent, TexelFormat, Texels};
use crate::{Container, Encoding, Error, Grid, Layers, Maps, Sheet, Volume, basis_of, block, validate};
use half::f16;
use serde::de::DeserializeOwned;
use std::path::{Component, Path};

/// Reads `maps.json` and the textures that it names.
///
/// Numbers are those of the file that was exported; eight bits come back as halves.
///
/// # Errors
/// `Unsupported` for an unknown basis, convention or texture, `Invalid` where the files contradict each other, `Io`.
pub fn maps(folder: &Path) -> Result<Maps, Error> {
    let text: MapsText = json(&folder.join("maps.json"))?;
    check_convention(&text.convention)?;
    let basis = basis_of(&text.basis);
    let basis = basis.ok_or_else(|| Error::Unsupported(format!("the basis '{}' is unknown", text.basis)))?;
    let sheets = text.sheets.into_iter().map(|sheet| Ok(Sheet { layers: layers(folder, sheet)? }));
    let sheets = sheets.collect::<Result<_, Error>>()?;
    let maps = Maps { basis, light: text.light, sheets, sheet_of_mesh: text.sheet_of_mesh };
    validate::maps_alone(&maps)?;
    Ok(maps)
}

fn layers(folder: &Path, text: SheetText) -> Result<Layers, Error> {
    let texels = texture(folder, &text.file)?;
    let (format, single) = (texels.format, text.channels == 1);
    let expected = match text.encoding {
        Encoding::F32 => [TexelFormat::Rgba32F, TexelFormat::R32F][usize::from(single)],
        Encoding::F16 => [TexelFormat::Rgba16F, TexelFormat::R16F][usize::from(single)],
        Encoding::Bc1 => TexelFormat::Bc1,
        Encoding::Bc6h => TexelFormat::Bc6h,
        Encoding::U8 => return Err(Error::Unsupported("textures of eight bits are not read".into())),
    };
    let size = (texels.width, texels.height, texels.extent);
    if format != expected || size != (text.width, text.height, Extent::Layers(text.layers)) {
        return Err(Error::invalid(0, format!("{} is not of the size or the texels that maps.json says", text.file)));
    }
    let bytes = match text.encoding {
        Encoding::Bc1 | Encoding::Bc6h => {
            let count = text.ranges.len();
            if count != text.layers as usize {
                return Err(Error::invalid(0, format!("{} has {} layers, but {count} ranges", text.file, text.layers)));
            }
            let mut bytes = block::head(text.encoding, text.channels as usize, &text.ranges);
            bytes.extend(texels.bytes);
            bytes
        }
        // The fourth channel is left out.
        _ if single => texels.bytes,
        _ => {
            let texel = format.block().1 as usize;
            texels.bytes.chunks_exact(texel).flat_map(|b| &b[..texel / 4 * 3]).copied().collect()
        }
    };
    let SheetText { width, height, layers: count, channels, encoding, .. } = text;
    Ok(Layers { width, height, count, channels, encoding, bytes })
}

/// Reads `volume.json` beside nine textures, and these.
///
/// # Errors
/// As [`maps`].
pub fn grid(folder: &Path) -> Result<Grid, Error> {
    let text: GridText = json(&folder.join("volume.json"))?;
    check_convention(&text.convention)?;
    let sound = text.origin.iter().all(|v| v.is_finite())
        && text.step.iter().all(|v| v.is_finite() && *v > 0.0)
        && text.points.iter().all(|n| *n > 0);
    if !sound {
        return Err(Error::invalid(0, "volume.json has a grid without points, or with a step that is none"));
    }
    let mut functions: [Vec<[f32; 3]>; 9] = Default::default();
    for (file, function) in text.files.iter().zip(&mut functions) {
        let texels = texture(folder, file)?;
        let size = [texels.width, texels.height, texels.extent.count()];
        if texels.format != TexelFormat::Rgba16F || size != text.points || texels.extent != Extent::Depth(size[2]) {
            return Err(Error::invalid(0, format!("{file} is not of the size or the texels that volume.json says")));
        }
        let half = |b: &[u8], c: usize| f16::from_le_bytes([b[2 * c], b[2 * c + 1]]).to_f32();
        *function = texels.bytes.chunks_exact(8).map(|b| [half(b, 0), half(b, 1), half(b, 2)]).collect();
        if !function.as_flattened().iter().all(|v| v.is_finite()) {
            return Err(Error::invalid(0, format!("{file} holds a number that is not finite")));
        }
    }
    Ok(Grid { origin: text.origin, step: text.step, points: text.points, functions })
}

/// Reads the JSON of a volume; every number is the one that was written.
///
/// # Errors
/// As [`maps`].
pub fn volume_json(path: &Path) -> Result<Volume, Error> {
    let text: VolumeText = json(path)?;
    check_convention(&text.convention)?;
    let volume = text.volume();
    let volume = volume.ok_or_else(|| Error::invalid(0, "a probe has more or fewer numbers than the first"))?;
    validate::volume_alone(&volume)?;
    Ok(volume)
}

fn check_convention(theirs: &str) -> Result<(), Error> {
    if theirs == sh_math::CONVENTION {
        return Ok(());
    }
    let ours = sh_math::CONVENTION;
    Err(Error::Unsupported(format!("the coefficients follow the convention '{theirs}', not '{ours}'")))
}

fn json<T: DeserializeOwned>(path: &Path) -> Result<T, Error> {
    let bytes = std::fs::read(path)?;
    serde_json::from_slice(&bytes).map_err(|e| Error::invalid(0, format!("{}: {e}", path.display())))
}

/// Reads a texture beside its JSON, and from nowhere else.
fn texture(folder: &Path, file: &str) -> Result<Texels, Error> {
    let plain = Path::new(file).components().all(|part| matches!(part, Component::Normal(_)));
    let container = match file.rsplit_once('.') {
        Some((_, "ktx2")) if plain => Container::Ktx2,
        Some((_, "dds")) if plain => Container::Dds,
        _ => return Err(Error::invalid(0, format!("'{file}' is no .ktx2 or .dds file beside the JSON"))),
    };
    container.read(&std::fs::read(folder.join(file))?)
}
