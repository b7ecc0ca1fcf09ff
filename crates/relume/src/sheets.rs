//! The sheets that light maps lie in: by the coordinates of the scene where they serve, else by those of the program.

use crate::console::Console;
use crate::usage::Usage;
use anyhow::Result;
use bake::SheetSettings;
use scene::Scene;
use scene::lightmap::{self, Density, FaultKind, ObjectOptions, Unwrap};

/// Share of a sheet that unwrapped surfaces are taken to fill, to foresee its size.
const FILLED: f64 = 0.6;
/// A sheet of which less is filled holds much of nothing.
const POORLY: f32 = 0.35;
/// Free texels around a chart where none are asked for.
pub(crate) const PADDING: u32 = 2;
/// Fewest texels along a side of a sheet.
pub(crate) const SMALLEST: u32 = 16;

/// How fine sheets are, and whose coordinates they have.
#[derive(Debug, Clone)]
pub(crate) struct SheetChoice {
    /// Texels along a side: about so many times as many in all, shared by area.
    pub(crate) texels: u32,
    /// Unwraps all surfaces, whatever coordinates the scene brings.
    pub(crate) unwrap: bool,
    /// Free texels around each chart that is unwrapped.
    pub(crate) padding: u32,
    /// Names of the meshes or materials that get light maps; empty for all surfaces that stop light.
    pub(crate) only: Vec<String>,
}

impl SheetChoice {
    /// The options of `relume bake` that make the same choice.
    pub(crate) fn options(&self) -> String {
        let unwrap = if self.unwrap { " --unwrap" } else { "" };
        format!("--texels {}{unwrap}", self.texels)
    }

    /// The sheets for a scene, whose surfaces are unwrapped where their own coordinates do not serve. What has normal maps is marked as
    /// directional.
    pub(crate) fn sheets(&self, scene: &mut Scene, console: &Console) -> Result<Vec<SheetSettings>> {
        self.check_names(scene)?;
        match self.own(scene, console) {
            Some(sheets) => Ok(sheets),
            None => self.unwrapped(scene, console),
        }
    }

    /// A sheet for each mesh, by its share of the area: by its own coordinates where they serve, else it is unwrapped alone.
    pub(crate) fn per_object(&self, scene: &mut Scene, console: &Console) -> Result<Vec<SheetSettings>> {
        self.check_names(scene)?;
        let meshes = self.meshes(scene);
        let options = ObjectOptions { texels: self.texels, padding: self.padding, unwrap: self.unwrap };
        let progress = console.progress();
        let found =
            lightmap::objects(scene, &meshes, &options, &|stage, done, total| progress.set(stage, done, total))?;
        drop(progress);
        Ok(found.into_iter().map(|object| sheet(scene, vec![object.mesh], [object.width, object.height])).collect())
    }

    fn check_names(&self, scene: &Scene) -> Result<()> {
        let missing = |name: &&String| !(0..scene.meshes.len()).any(|mesh| is_named(scene, mesh, name));
        match self.only.iter().find(missing) {
            Some(name) => {
                Err(Usage(format!("--mapped {name}: no mesh or material of {} has that name", scene.name)).into())
            }
            None => Ok(()),
        }
    }

    /// The sheets that the coordinates of the scene make: one for all meshes or one for each, whichever has no faults.
    fn own(&self, scene: &Scene, console: &Console) -> Option<Vec<SheetSettings>> {
        let meshes = self.meshes(scene);
        if self.unwrap || meshes.iter().any(|&mesh| scene.meshes[mesh].uv1.is_empty()) {
            return None;
        }
        let serves = |sheet: &[usize]| lightmap::faults(scene, sheet).iter().all(|fault| fault.kind == FaultKind::Flat);
        if serves(&meshes) {
            return Some(vec![sheet(scene, meshes, [self.texels; 2])]);
        }
        if meshes.iter().all(|&mesh| serves(&[mesh])) {
            let all: f64 = meshes.iter().map(|&mesh| area(scene, mesh)).sum();
            let side = |mesh: usize| {
                let side = f64::from(self.texels) * (area(scene, mesh) / all).sqrt();
                (side.round() as u32).clamp(SMALLEST, self.texels)
            };
            return Some(meshes.iter().map(|&mesh| sheet(scene, vec![mesh], [side(mesh); 2])).collect());
        }
        console
            .notice("the light-map coordinates of the scene do not serve (see relume uv): its surfaces are unwrapped");
        None
    }

    /// Sheets of the program's own: one for what has normal maps and one for the rest, as dense.
    fn unwrapped(&self, scene: &mut Scene, console: &Console) -> Result<Vec<SheetSettings>> {
        let (bent, plain): (Vec<usize>, Vec<usize>) =
            self.meshes(scene).into_iter().partition(|&mesh| is_bent(scene, mesh));
        let groups: Vec<Vec<usize>> = [bent, plain].into_iter().filter(|group| !group.is_empty()).collect();
        let all: f64 = groups.iter().flatten().map(|&mesh| area(scene, mesh)).sum();
        let density = f64::from(self.texels) * (FILLED / all.max(f64::MIN_POSITIVE)).sqrt();
        let one = groups.len() == 1;
        let mut sheets = Vec::new();
        for group in groups {
            let density = match one {
                true => Density::Side(self.texels),
                false => Density::PerMetre(density as f32),
            };
            let size = self.unwrap_group(scene, &group, density, console)?;
            sheets.push(sheet(scene, group, size));
        }
        Ok(sheets)
    }

    /// Unwraps meshes into one sheet; returns its sides.
    fn unwrap_group(
        &self,
        scene: &mut Scene,
        group: &[usize],
        density: Density,
        console: &Console,
    ) -> Result<[u32; 2]> {
        let progress = console.progress();
        let options = Unwrap { density, padding: self.padding };
        let atlas = lightmap::unwrap(scene, group, &options, &|stage, done, total| progress.set(stage, done, total))?;
        drop(progress);
        let text = format!("{} charts fill {:.0} % of their sheet", atlas.charts, 100.0 * atlas.filled);
        match atlas.filled < POORLY {
            true => console.notice(&format!("{text}: more --texels or less --padding would hold more light in it")),
            false => console.detail(&text),
        }
        Ok([atlas.width, atlas.height])
    }

    /// Meshes that get light maps: surfaces that stop light, or those of them that are named. Others are drawn by their vertices.
    fn meshes(&self, scene: &Scene) -> Vec<usize> {
        let wanted = |mesh: usize| self.only.is_empty() || self.only.iter().any(|name| is_named(scene, mesh, name));
        mapped(scene).into_iter().filter(|&mesh| wanted(mesh)).collect()
    }
}

fn is_named(scene: &Scene, mesh: usize, name: &str) -> bool {
    scene.meshes[mesh].name == name || scene.material(mesh).name == name
}

fn sheet(scene: &Scene, meshes: Vec<usize>, [width, height]: [u32; 2]) -> SheetSettings {
    let directional = meshes.iter().any(|&mesh| is_bent(scene, mesh));
    SheetSettings { meshes, width, height, directional }
}

/// Surfaces that stop light.
fn mapped(scene: &Scene) -> Vec<usize> {
    (0..scene.meshes.len()).filter(|&mesh| scene.material(mesh).blocks_rays()).collect()
}

/// Whether a normal map is drawn on some surface that gets light maps.
pub(crate) fn has_normal_maps(scene: &Scene) -> bool {
    mapped(scene).into_iter().any(|mesh| is_bent(scene, mesh))
}

fn is_bent(scene: &Scene, mesh: usize) -> bool {
    scene.material(mesh).normal_texture.is_some() && !scene.meshes[mesh].tangents.is_empty()
}

fn area(scene: &Scene, mesh: usize) -> f64 {
    let mesh = &scene.meshes[mesh];
    (0..mesh.triangles.len()).map(|triangle| mesh.area(triangle)).sum()
}
