//! A sheet for each object, by its share of the area: so none takes texels from another (\[T\] section 4.3, texture sets).

use super::{Atlas, Density, Layouts, Unwrap, UnwrapError, layouts, unwrap_resolved};
use crate::Scene;

/// Fewest texels along a side of a sheet.
const SMALLEST: u32 = 16;
/// Times as many texels along a side as all sheets are to have together that the charts of one may need.
const MOST_GROWTH: u32 = 2;
/// Sides are whole multiples of it: levels of detail halve them without a rest.
const STEP: u32 = 16;

/// The sheet of one object.
#[derive(Debug, Clone)]
pub struct ObjectSheet {
    /// Index into [`Scene::meshes`].
    pub mesh: usize,
    /// Texels along u.
    pub width: u32,
    /// Texels along v.
    pub height: u32,
    /// How it was unwrapped; none where its own coordinates serve.
    pub atlas: Option<Atlas>,
}

/// How objects get their sheets.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct ObjectOptions {
    /// Texels along a side of all sheets together: about so many times as many are shared by area.
    pub texels: u32,
    /// Free texels around a chart that is unwrapped.
    pub padding: u32,
    /// Unwraps all, whatever coordinates a mesh brings.
    pub unwrap: bool,
}

/// Gives each of the meshes a sheet: by its own second texture coordinates where they serve, else it is unwrapped alone. Sheets grow until
/// their charts fit and have enough texels.
///
/// # Errors
/// [`UnwrapError`] where even a sheet of twice all texels along a side is too small, or a mesh cannot be unwrapped.
pub fn objects(
    scene: &mut Scene,
    meshes: &[usize],
    options: &ObjectOptions,
    progress: &(dyn Fn(&'static str, u64, u64) + Sync),
) -> Result<Vec<ObjectSheet>, UnwrapError> {
    let all: f64 = meshes.iter().map(|&mesh| area(scene, mesh)).sum();
    let most = MOST_GROWTH * options.texels;
    let mut sheets = Vec::new();
    for &mesh in meshes {
        let share = (area(scene, mesh) / all.max(f64::MIN_POSITIVE)).sqrt();
        let side = (f64::from(options.texels) * share).round() as u32;
        let side = side.clamp(SMALLEST.min(options.texels), options.texels);
        let own = if options.unwrap { Layouts::default() } else { layouts(scene, &[mesh], side, most) };
        let sheet = match own.pages.first() {
            Some((_, side)) => {
                let side = side.next_multiple_of(STEP);
                ObjectSheet { mesh, width: side, height: side, atlas: None }
            }
            None => {
                let asked = Unwrap { density: Density::Side(side), padding: options.padding };
                let atlas = unwrap_resolved(scene, &[mesh], &own.charts, &asked, most, progress)?;
                let [width, height] = padded(scene, mesh, [atlas.width, atlas.height]);
                ObjectSheet { mesh, width, height, atlas: Some(atlas) }
            }
        };
        sheets.push(sheet);
    }
    Ok(sheets)
}

/// Makes room at the far sides of a sheet; texels stay where they are.
fn padded(scene: &mut Scene, mesh: usize, sides: [u32; 2]) -> [u32; 2] {
    let wider = sides.map(|side| side.next_multiple_of(STEP));
    let scale = glam::Vec2::new(sides[0] as f32 / wider[0] as f32, sides[1] as f32 / wider[1] as f32);
    scene.meshes[mesh].uv1.iter_mut().for_each(|uv| *uv *= scale);
    wider
}

fn area(scene: &Scene, mesh: usize) -> f64 {
    let mesh = &scene.meshes[mesh];
    (0..mesh.triangles.len()).map(|triangle| mesh.area(triangle)).sum()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lightmap::{FaultKind, faults};

    const OPTIONS: ObjectOptions = ObjectOptions { texels: 256, padding: 2, unwrap: true };

    /// Texels go by area, each object has coordinates without overlap, and a small object's sheet grows until it fits.
    #[test]
    fn objects_share_the_texels_by_area() {
        let mut scene = crate::builtin("teacup").unwrap();
        let meshes: Vec<usize> = (0..scene.meshes.len()).collect();
        let areas: Vec<f64> = meshes.iter().map(|&mesh| area(&scene, mesh)).collect();
        let sheets = objects(&mut scene, &meshes, &OPTIONS, &|_, _, _| {}).unwrap();
        let largest = (0..meshes.len()).max_by(|&a, &b| areas[a].total_cmp(&areas[b])).unwrap();
        assert!(sheets.iter().all(|sheet| sheet.width <= sheets[largest].width));
        for sheet in &sheets {
            let flaws = faults(&scene, &[sheet.mesh]);
            assert!(flaws.iter().all(|fault| fault.kind == FaultKind::Flat), "{flaws:?}");
        }
        // One sheet for all, by the coordinates that each has alone, would overlap.
        assert!(faults(&scene, &meshes).iter().any(|fault| fault.kind != FaultKind::Flat), "can fail");
    }

    #[test]
    fn own_coordinates_are_kept_where_they_serve() {
        let mut scene = crate::builtin("bumps").unwrap();
        let before = scene.meshes[0].uv1.clone();
        let options = ObjectOptions { unwrap: false, ..OPTIONS };
        let sheets = objects(&mut scene, &[0], &options, &|_, _, _| {}).unwrap();
        assert!(sheets[0].atlas.is_none() && scene.meshes[0].uv1 == before);
        let again = objects(&mut scene, &[0], &OPTIONS, &|_, _, _| {}).unwrap();
        assert!(again[0].atlas.is_some(), "can fail");
    }
}
