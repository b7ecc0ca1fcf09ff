//! Which basis light maps of the scene would take: [`crate::bases::scene`] within the study's time.

use super::bakes::Bakes;
use super::trials::as_asked;
use super::{Error, Request};
use crate::bases::scene::{Comparison, Goal, Request as Compared, compare, nanoseconds};
use bake::{FixedLight, SheetSettings};
use scene::Scene;
use scene::lightmap::texels;
use sh_math::Bands;

/// Light maps to be judged.
#[derive(Debug, Clone, Copy)]
pub struct LightMaps<'a> {
    /// The scene with the light-map coordinates of the sheets.
    pub scene: &'a Scene,
    /// The sheets.
    pub sheets: &'a [SheetSettings],
}

/// Bakes what arrives at the texels as asked and compares the bases on it, where the budget allows it.
pub(super) fn study(
    request: &Request<'_>,
    bakes: &mut Bakes<'_>,
    left_out: &mut Vec<String>,
) -> Result<Option<Comparison>, Error> {
    let Some(LightMaps { scene, sheets }) = request.light_maps else { return Ok(None) };
    let settings = as_asked(request).settings;
    let vertices: usize = bakes.scene.meshes.iter().map(|mesh| mesh.positions.len()).sum();
    let count = |sheet: &SheetSettings| texels(scene, &sheet.meshes, sheet.width, sheet.height).len();
    let texels: usize = sheets.iter().map(count).sum();
    // The vertices are baked first, since they lend light to the texels.
    let needed = bakes.predict(&settings)?.seconds * (1.0 + texels as f64 / vertices.max(1) as f64);
    let left = bakes.left().max(0.0);
    if needed > left {
        left_out.push(format!(
            "bases of light maps: {texels} texels would take about {needed:.1} s of the {left:.1} s left"
        ));
        return Ok(None);
    }
    let bands = Bands::new(settings.bands).expect("the settings were checked");
    let coefficients = sh_math::project(bands, request.environment.samples()).values;
    let light = FixedLight { name: request.environment.name.clone(), coefficients };
    let Some(found) = bakes.directional("light maps", scene, &settings, sheets, &light)? else {
        left_out.push(format!("bases of light maps: {texels} texels took longer than the {left:.1} s left"));
        return Ok(None);
    };
    bakes.tell("comparing bases", 0, 1)?;
    let goal = Goal::Error(f64::from(request.targets.error));
    let compared =
        Compared { scene, light: &request.environment.name, sheets, found: &found, goal, nanoseconds: &nanoseconds() };
    match compare(&compared) {
        Ok(comparison) => Ok(Some(comparison)),
        Err(empty) => {
            left_out.push(format!("bases of light maps: {empty}"));
            Ok(None)
        }
    }
}
