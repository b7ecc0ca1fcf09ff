//! Whether maps can be baked, before anything is.

use super::{MapSettings, SheetSettings, functions};
use crate::field::Field;
use crate::{Error, SettingField};
use coeff_io::{Plan, Settings};
use scene::Scene;
use scene::lightmap::texels;
use sh_math::Bands;

/// Most texels along a side of a sheet.
const MAX_SIDE: u32 = 8192;
/// Most rings around charts.
const MAX_DILATION: u32 = 64;
/// Texels of all sheets together, whose numbers are the seeds of their rays.
const MAX_TEXELS: u64 = 1 << 31;

/// Checks settings against the scene, and memory against what the texels that surfaces touch will take beside `receivers` of the vertices.
pub(crate) fn check(
    maps: &MapSettings,
    scene: &Scene,
    plan: &Plan,
    receivers: usize,
    settings: &Settings,
    has_light: bool,
) -> Result<(), Error> {
    check_sheets(&maps.sheets, maps.dilation, scene)?;
    let light = Bands::new(plan.bands).expect("no more than the settings ask for");
    let (depth, channels) = if has_light { (1, 3) } else { (light.coefficients(), plan.channels as usize) };
    let row = functions(has_light).coefficients() * depth * channels;
    let (mut touched, mut largest) = (0, 0);
    for sheet in &maps.sheets {
        let own = texels(scene, &sheet.meshes, sheet.width, sheet.height).len();
        let held = if sheet.directional { maps.basis.count() } else { 1 };
        let plane = u64::from(sheet.width) * u64::from(sheet.height);
        touched += own;
        // As found beside the plate; later as converted, beside the pictures and their encoding.
        let finished = (held * depth * channels) as u64 * (own as u64 + 2 * plane);
        largest = largest.max(finished.max((own * row) as u64));
    }
    let fields = 2 * Field::bytes(receivers, light.coefficients(), plan.channels as usize);
    // While seams are stitched the plates are there twice.
    let plates = (touched * row) as u64 * if maps.stitch { 2 } else { 1 };
    let needed = fields + 4 * (plates + largest);
    if needed > settings.memory {
        return Err(Error::MapMemory { texels: touched, needed, allowed: settings.memory });
    }
    Ok(())
}

/// Checks that sheets are no larger than can be held, and that a mesh lies on one at most.
pub(crate) fn check_sheets(sheets: &[SheetSettings], dilation: u32, scene: &Scene) -> Result<(), Error> {
    let refuse = |setting, value: String, allowed| Err(Error::Setting { setting, value, allowed });
    let sides = 1..=MAX_SIDE;
    for sheet in sheets {
        if !sides.contains(&sheet.width) || !sides.contains(&sheet.height) {
            let value = format!("{} x {}", sheet.width, sheet.height);
            return refuse(SettingField::Texels, value, "use sheets of 1 to 8192 texels along each side");
        }
    }
    let all: u64 = sheets.iter().map(|sheet| u64::from(sheet.width) * u64::from(sheet.height)).sum();
    if all > MAX_TEXELS {
        return refuse(SettingField::Texels, format!("{all} in all"), "use sheets of 2^31 texels at most together");
    }
    if dilation > MAX_DILATION {
        return refuse(SettingField::Dilation, dilation.to_string(), "use 0 to 64 rings");
    }
    let mut seen = vec![false; scene.meshes.len()];
    for &mesh in sheets.iter().flat_map(|sheet| &sheet.meshes) {
        match seen.get_mut(mesh) {
            Some(seen) if !*seen => *seen = true,
            _ => {
                return refuse(
                    SettingField::Pages,
                    format!("mesh {mesh}"),
                    "a mesh of the scene lies in one sheet at most",
                );
            }
        }
    }
    Ok(())
}
