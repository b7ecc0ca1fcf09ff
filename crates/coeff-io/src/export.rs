//! Coefficients for other programs: `.npy`, JSON and textures.

pub use crate::export_textures::{maps, volume, volume_json};

use crate::{Error, Prt, replace};
use npyz::WriterBuilder;
use sh_math::Rgb;
use std::io::{self, Write};
use std::path::Path;

/// Writes `positions.npy` `[R, 3]`, `normals.npy` `[R, 3]`, `transfer.npy` `[R, n*n, C]` and, where C = 1,
/// `albedo.npy` `[R, 3]` into `folder`, which is made if need be; all of little-endian f32.
///
/// Positions are those of the world: of little-endian f64 where the file has an origin, which f32 could not hold.
///
/// The mesh comes with them: `triangles.npy` `[T, 3]` of little-endian u32, `uv0.npy` and `uv1.npy` `[R, 2]` where there
/// are texture coordinates, and `meshes.json` with the ranges of the meshes, their materials and the names of textures.
///
/// Where C = 3 the albedo is multiplied into the transfer, so that `transfer * light` is outgoing radiance; where
/// C = 1 outgoing radiance is `albedo * (transfer * light)`. Each file is written beside and renamed.
///
/// Where the file holds gloss or transfer textures, also their arrays: docs/format.md, Exports.
///
/// # Errors
/// `Io`.
pub fn npy(prt: &Prt, folder: &Path) -> Result<(), Error> {
    crate::make_folder(folder)?;
    let rows = prt.geometry.positions.len() as u64;
    let transfer = &prt.transfer;
    let (coefficients, channels) = (u64::from(transfer.bands).pow(2), u64::from(transfer.channels));
    positions(prt, &folder.join("positions.npy"))?;
    array(&folder.join("normals.npy"), &[rows, 3], prt.geometry.normals.as_flattened().iter().copied())?;
    mesh(prt, folder)?;
    crate::export_gloss::gloss_npy(prt, folder)?;
    let path = folder.join("transfer.npy");
    let shape = [rows, coefficients, channels];
    if channels == 1 {
        array(&path, &shape, transfer.values.iter().copied())?;
        return array(&folder.join("albedo.npy"), &[rows, 3], transfer.albedo.as_flattened().iter().copied());
    }
    // An albedo file of an earlier export would be taken for a factor that is still missing.
    remove(&folder.join("albedo.npy"))?;
    let receivers = transfer.values.chunks_exact((coefficients * channels) as usize).zip(&transfer.albedo);
    array(&path, &shape, receivers.flat_map(|(row, albedo)| row.iter().zip(albedo.iter().cycle()).map(|(t, a)| t * a)))
}

/// Writes triangles, texture coordinates, and which meshes and materials they belong to.
fn mesh(prt: &Prt, folder: &Path) -> Result<(), Error> {
    let geometry = &prt.geometry;
    let triangles = geometry.triangles.as_flattened();
    indices(&folder.join("triangles.npy"), &[geometry.triangles.len() as u64, 3], triangles)?;
    for (name, uv) in [("uv0.npy", &geometry.uv0), ("uv1.npy", &geometry.uv1)] {
        let path = folder.join(name);
        match uv.len() as u64 {
            // Those of an earlier export would be taken for this one's.
            0 => remove(&path)?,
            rows => array(&path, &[rows, 2], uv.as_flattened().iter().copied())?,
        }
    }
    let texture = |texture: &crate::Texture| {
        serde_json::json!({
            "name": texture.name, "width": texture.width, "height": texture.height, "wrap": texture.wrap,
        })
    };
    let value = serde_json::json!({
        "scene": prt.scene,
        "origin": prt.origin,
        "meshes": prt.meshes,
        "materials": prt.materials,
        "unlit": (0..prt.materials.len()).filter(|&index| prt.materials[index].unlit).collect::<Vec<_>>(),
        "textures": prt.textures.iter().map(texture).collect::<Vec<_>>(),
    });
    Ok(replace(&folder.join("meshes.json"), |file| writeln!(file, "{value:#}"))?)
}

fn remove(path: &Path) -> Result<(), Error> {
    match std::fs::remove_file(path) {
        Err(e) if e.kind() != io::ErrorKind::NotFound => Err(e.into()),
        _ => Ok(()),
    }
}

/// World positions of the receivers.
fn positions(prt: &Prt, path: &Path) -> Result<(), Error> {
    let (positions, shape) = (&prt.geometry.positions, [prt.geometry.positions.len() as u64, 3]);
    if prt.origin == [0.0; 3] {
        return array(path, &shape, positions.as_flattened().iter().copied());
    }
    let world = positions.iter().flat_map(|p| std::array::from_fn::<f64, 3, _>(|k| prt.origin[k] + f64::from(p[k])));
    let dtype = npyz::DType::Plain("<f8".parse().map_err(io::Error::other)?);
    Ok(replace(path, |file| {
        let mut writer = npyz::WriteOptions::new().dtype(dtype).shape(&shape).writer(file).begin_nd()?;
        writer.extend(world)?;
        writer.finish()
    })?)
}

/// Writes light coefficients as one array `[n*n, 3]` of little-endian f32.
///
/// # Errors
/// `Io`.
pub fn light_npy(light: &Rgb, path: &Path) -> Result<(), Error> {
    array(path, &[light.values.len() as u64, 3], light.values.as_flattened().iter().copied())
}

/// Writes light coefficients as JSON: `convention`, `bands` and `coefficients` `[n*n][3]`.
///
/// # Errors
/// `Io`.
pub fn light_json(light: &Rgb, path: &Path) -> Result<(), Error> {
    let value = serde_json::json!({
        "convention": sh_math::CONVENTION,
        "bands": light.bands.count(),
        "coefficients": light.values,
    });
    Ok(replace(path, |file| writeln!(file, "{value:#}"))?)
}

pub(crate) fn indices(path: &Path, shape: &[u64], values: &[u32]) -> Result<(), Error> {
    let dtype = npyz::DType::Plain("<u4".parse().map_err(io::Error::other)?);
    Ok(replace(path, |file| {
        let mut writer = npyz::WriteOptions::new().dtype(dtype).shape(shape).writer(file).begin_nd()?;
        writer.extend(values.iter().copied())?;
        writer.finish()
    })?)
}

pub(crate) fn array(path: &Path, shape: &[u64], values: impl Iterator<Item = f32>) -> Result<(), Error> {
    let dtype = npyz::DType::Plain("<f4".parse().map_err(io::Error::other)?);
    Ok(replace(path, |file| {
        let mut writer = npyz::WriteOptions::new().dtype(dtype).shape(shape).writer(file).begin_nd()?;
        writer.extend(values)?;
        writer.finish()
    })?)
}
