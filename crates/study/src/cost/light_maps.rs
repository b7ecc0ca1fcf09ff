//! Which basis light maps of the scene would take: [`crate::bases::scene`] within the study's time.

use super::bakes::Bakes;
use super::trials::as_asked;
use super::{Error, Request};
use crate::bases::scene::{Comparison, Goal, Request as Compared, compare, nanoseconds};
use bake::{FixedLight, SheetSettings};
use scene::Scene;
use scene::lightmap::texels;
use sh_math::Bands;

/// Share of the time left that they may take: the knobs of the bake come after them.
const SHARE: f64 = 0.5;

/// Light maps to be judged.
#[derive(Debug, Clone, Copy)]
pub struct LightMaps<'a> {
    /// The scene with the light-map coordinates of the sheets.
    pub scene: &'a Scene,
    /// The options of `relume bake` that make the sheets.
    pub sheet_options: &'a str,
    /// The sheets.
    pub sheets: &'a [SheetSettings],
}

/// Bakes what arrives at the texels as asked and compares the bases on it, where the budget allows it.
pub(super) fn study(
    request: &Request<'_>,
    bakes: &mut Bakes<'_>,
    left_out: &mut Vec<String>,
) -> Result<Option<Comparison>, Error> {
    let Some(LightMaps { scene, sheet_options, sheets }) = request.light_maps else { return Ok(None) };
    let settings = as_asked(request).settings;
    let vertices: usize = bakes.scene.meshes.iter().map(|mesh| mesh.positions.len()).sum();
    let count = |sheet: &SheetSettings| texels(scene, &sheet.meshes, sheet.width, sheet.height).len();
    let texels: usize = sheets.iter().map(count).sum();
    // The vertices are baked first, since they lend light to the texels.
    let needed = bakes.predict(&settings)?.seconds * (1.0 + texels as f64 / vertices.max(1) as f64);
    let left = SHARE * bakes.left().max(0.0);
    if needed > left {
        left_out.push(format!(
            "bases of light maps: {texels} texels would take about {needed:.1} s of the {left:.1} s for them"
        ));
        return Ok(None);
    }
    let bands = Bands::new(settings.bands).expect("the settings were checked");
    // Ringing below 0 is what small encodings lose first, and no light.
    let light = sh_math::project(bands, request.environment.samples());
    let coefficients = light.windowed(&sh_math::window::automatic(&light)).values;
    let light = FixedLight { name: request.environment.name.clone(), coefficients };
    let Some(found) = bakes.directional("light maps", scene, &settings, sheets, &light, left)? else {
        left_out.push(format!("bases of light maps: {texels} texels took longer than the {left:.1} s for them"));
        return Ok(None);
    };
    bakes.tell("comparing bases", 0, 1)?;
    let goal = Goal::Error(f64::from(request.targets.error));
    let compared = Compared {
        scene,
        light: &request.environment.name,
        sheet_options: &format!("--window auto {sheet_options}"),
        sheets,
        found: &found,
        goal,
        nanoseconds: &nanoseconds(),
    };
    match compare(&compared) {
        Ok(comparison) => Ok(Some(comparison)),
        Err(empty) => {
            left_out.push(format!("bases of light maps: {empty}"));
            Ok(None)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cost::{Report, Targets, csv, page, report::Machine, sample};
    use coeff_io::{Bounces, Quality, Settings};
    use std::ops::ControlFlow;

    /// A ball and a square with a normal map, 64 rays per texel, within so many seconds.
    fn studied(budget: f64) -> (Option<Comparison>, Vec<String>) {
        let scene = scene::builtin("bumps").unwrap();
        let meshes = (0..scene.meshes.len()).collect();
        let sheets = [SheetSettings { meshes, width: 32, height: 32, directional: true }];
        let settings = Settings {
            bands: 3,
            quality: Quality::Rays(64),
            bounces: Bounces::Fixed(0),
            refine: coeff_io::Refine::Off,
            ..bake::settings::standard()
        };
        let request = Request {
            scene: &scene,
            environment: &probe_io::builtin("sky").unwrap(),
            settings: settings.clone(),
            targets: Targets { error: 0.2, seconds: None, bytes: None },
            budget,
            machine: Machine { threads: 1, system: "test".into(), version: "0".into() },
            light_maps: Some(LightMaps { scene: &scene, sheet_options: "--texels 32", sheets: &sheets }),
            open_gpu: || render_wgpu::Gpu::new(render_wgpu::Driver::Any),
        };
        let mut bakes = Bakes::new(&scene, &settings, budget, &|_| ControlFlow::Continue(())).unwrap();
        let mut left_out = Vec::new();
        let found = study(&request, &mut bakes, &mut left_out).unwrap();
        (found, left_out)
    }

    /// An hour is enough on any machine; it is not waited for.
    #[test]
    fn bases_are_part_of_the_report() {
        let (bases, left_out) = studied(3600.0);
        let bases = bases.unwrap();
        assert!(left_out.is_empty() && bases.has_normal_maps && bases.texels > 400, "{left_out:?}");
        let report = Report { bases: Some(bases), ..sample::report() };
        let (text, table) = (page(&report).unwrap(), csv(&report));
        let said = [
            "<h2>Bases of light maps</h2>",
            "modified H 6",
            "for an error of 20 %",
            "--window auto --texels 32",
            "--probe builtin:sky",
        ];
        assert!(said.iter().all(|part| text.contains(part)), "{text}");
        assert!(
            !text.contains("src=\"http") && !text.contains("href=") && !text.contains("xmlns"),
            "needs nothing else"
        );
        let columns = table.lines().next().unwrap().split(',').count();
        let rows: Vec<&str> = table.lines().filter(|line| line.starts_with("basis of light maps,")).collect();
        assert_eq!(rows.len(), 14 * 4);
        assert!(rows.iter().all(|row| row.split(',').count() == columns), "{table}");
    }

    /// Without time nothing is baked, the page says so, and has no such section.
    #[test]
    fn bases_are_part_of_the_report_can_fail() {
        let (bases, left_out) = studied(0.0);
        assert!(bases.is_none() && left_out.len() == 1 && left_out[0].contains("bases of light maps"), "{left_out:?}");
        let text = page(&Report { left_out, ..sample::report() }).unwrap();
        assert!(!text.contains("<h2>Bases") && text.contains("bases of light maps: "), "{text}");
    }
}
