//! The sheets that light maps lie in: by the coordinates of the scene where they serve, else by those of the program.

use crate::console::Console;
use crate::usage::Usage;
use anyhow::{Result, anyhow};
use bake::SheetSettings;
use scene::Scene;
use scene::lightmap::{self, Atlas, Density, Fault, FaultKind, Layouts, ObjectOptions, Unwrap, UnwrapError};

/// Share of a sheet that unwrapped surfaces are taken to fill, to foresee its size.
const FILLED: f64 = 0.6;
/// A sheet of which less is filled holds much of nothing.
const POORLY: f32 = 0.35;
/// Free texels around a chart where none are asked for.
pub(crate) const PADDING: u32 = 2;
/// Fewest texels along a side of a sheet.
pub(crate) const SMALLEST: u32 = 16;
/// Most texels along a side that sheets grow to where nobody asked for a size.
const MOST_UNASKED: u32 = 4096;
/// Most texels along a side that can be asked for.
pub(crate) const MOST_TEXELS: u32 = 8192;
/// Meshes that a notice names.
const NAMED: usize = 3;
/// Numbers of texels that are tried before one is named.
const TRIES: usize = 8;

/// Makes the sheets of a scene.
type Make = fn(&SheetChoice, &mut Scene, &Console) -> Result<Vec<SheetSettings>>;

/// How fine sheets are, and whose coordinates they have.
#[derive(Debug, Clone)]
pub(crate) struct SheetChoice {
    /// Texels along a side: about so many times as many in all, shared by area.
    pub(crate) texels: u32,
    /// Whether so many were asked for; else sheets grow where charts need it.
    pub(crate) asked: bool,
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

    /// The sheets for a scene: by coordinates of its own where they serve; elsewhere its charts are packed anew, and what has none is
    /// unwrapped. What has normal maps is marked as directional.
    pub(crate) fn sheets(&self, scene: &mut Scene, console: &Console) -> Result<Vec<SheetSettings>> {
        self.or_name_texels(scene, console, Self::of_scene)
    }

    /// A sheet for each mesh, by its share of the area: by its own coordinates where they serve, else it is unwrapped alone.
    pub(crate) fn per_object(&self, scene: &mut Scene, console: &Console) -> Result<Vec<SheetSettings>> {
        self.or_name_texels(scene, console, Self::of_objects)
    }

    /// What `make` makes; where the texels asked for are too few, the error names a number that was tried and does.
    fn or_name_texels(&self, scene: &mut Scene, console: &Console, make: Make) -> Result<Vec<SheetSettings>> {
        if !self.asked {
            return make(self, scene, console).map_err(explained);
        }
        let before = scene.clone();
        let mut error = match make(self, scene, console) {
            Err(error) => error,
            sheets => return sheets,
        };
        // The sheets of a scene need different numbers: the first that fails names its own alone.
        for _ in 0..TRIES {
            let Some(&UnwrapError::TooCoarse { needed, .. }) = error.downcast_ref() else { break };
            let larger = Self { texels: needed, ..self.clone() };
            match make(&larger, &mut before.clone(), &Console::new(true, false, console.began())) {
                Err(next) => error = next,
                Ok(_) => break,
            }
        }
        Err(explained(error))
    }

    fn of_scene(&self, scene: &mut Scene, console: &Console) -> Result<Vec<SheetSettings>> {
        self.check_names(scene)?;
        let meshes = self.meshes(scene);
        let found = match self.unwrap {
            true => Layouts { none: meshes.clone(), ..Layouts::default() },
            false => lightmap::layouts(scene, &meshes, self.texels, self.most()),
        };
        tell(&found, scene, console);
        let pages = found.pages.iter().map(|(meshes, side)| sheet(scene, meshes.clone(), [*side; 2]));
        let mut sheets: Vec<SheetSettings> = pages.collect();
        sheets.extend(self.unwrapped(scene, &meshes, &found, console)?);
        Ok(sheets)
    }

    fn of_objects(&self, scene: &mut Scene, console: &Console) -> Result<Vec<SheetSettings>> {
        self.check_names(scene)?;
        let meshes = self.meshes(scene);
        let progress = console.progress();
        let mut objects = |texels| {
            let options = ObjectOptions { texels, padding: self.padding, unwrap: self.unwrap };
            lightmap::objects(scene, &meshes, &options, &|stage, done, total| progress.set(stage, done, total))
        };
        let found = match objects(self.texels) {
            Err(UnwrapError::TooCoarse { needed, .. }) if needed <= self.most() => objects(needed),
            other => other,
        };
        drop(progress);
        let found = found?;
        Ok(found.into_iter().map(|object| sheet(scene, vec![object.mesh], [object.width, object.height])).collect())
    }

    /// Most texels along a side.
    fn most(&self) -> u32 {
        if self.asked { self.texels } else { self.texels.max(MOST_UNASKED) }
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

    /// Sheets of the program's own for all that has no page: one for what has normal maps and one for the rest, as dense.
    fn unwrapped(
        &self,
        scene: &mut Scene,
        meshes: &[usize],
        found: &Layouts,
        console: &Console,
    ) -> Result<Vec<SheetSettings>> {
        let mut left: Vec<usize> = found.charts.iter().chain(&found.none).copied().collect();
        left.sort_unstable();
        let (bent, plain): (Vec<usize>, Vec<usize>) = left.into_iter().partition(|&mesh| is_bent(scene, mesh));
        let groups: Vec<Vec<usize>> = [bent, plain].into_iter().filter(|group| !group.is_empty()).collect();
        let all: f64 = meshes.iter().map(|&mesh| area(scene, mesh)).sum();
        let density = f64::from(self.texels) * (FILLED / all.max(f64::MIN_POSITIVE)).sqrt();
        let one = groups.len() == 1 && found.pages.is_empty();
        let mut sheets = Vec::new();
        for group in groups {
            let density = match one {
                true => Density::Side(self.texels),
                false => Density::PerMetre(density as f32),
            };
            let options = Unwrap { density, padding: self.padding };
            let atlas = self.unwrap_group(scene, &group, &found.charts, &options, console)?;
            sheets.push(sheet(scene, group, [atlas.width, atlas.height]));
        }
        Ok(sheets)
    }

    /// Unwraps meshes into one sheet.
    fn unwrap_group(
        &self,
        scene: &mut Scene,
        group: &[usize],
        kept: &[usize],
        options: &Unwrap,
        console: &Console,
    ) -> Result<Atlas> {
        let progress = console.progress();
        let told = |stage, done, total| progress.set(stage, done, total);
        let atlas = lightmap::unwrap_resolved(scene, group, kept, options, self.most(), &told)?;
        drop(progress);
        let (width, height) = (atlas.width, atlas.height);
        if u64::from(width) * u64::from(height) > u64::from(self.texels).pow(2) {
            console.notice(&format!("{} charts need a sheet of {width} x {height} texels", atlas.charts));
        }
        let text = format!("{} charts fill {:.0} % of their sheet", atlas.charts, 100.0 * atlas.filled);
        match atlas.filled < POORLY {
            true => console.notice(&format!("{text}: more --texels or less --padding would hold more light in it")),
            false => console.detail(&text),
        }
        Ok(atlas)
    }

    /// Meshes that get light maps: surfaces that stop light, or those of them that are named. Others are drawn by their vertices.
    fn meshes(&self, scene: &Scene) -> Vec<usize> {
        let wanted = |mesh: usize| self.only.is_empty() || self.only.iter().any(|name| is_named(scene, mesh, name));
        mapped(scene).into_iter().filter(|&mesh| wanted(mesh)).collect()
    }
}

/// Names the meshes whose own coordinates do not serve, and says what becomes of them.
fn tell(found: &Layouts, scene: &Scene, console: &Console) {
    let is_kept = |fault: &&Fault| found.charts.contains(&fault.mesh);
    let (kept, lost): (Vec<&Fault>, Vec<&Fault>) = found.faults.iter().partition(is_kept);
    for (faults, what) in [(kept, "its charts are packed, or cut, anew"), (lost, "it is unwrapped")] {
        for fault in faults.iter().take(NAMED) {
            let name = &scene.meshes[fault.mesh].name;
            let place = match fault.kind {
                FaultKind::Sparse(_) => String::new(),
                _ => format!("triangle {}: ", fault.triangle),
            };
            console
                .notice(&format!("the light-map coordinates of '{name}' do not serve ({place}{}): {what}", fault.kind));
        }
        if faults.len() > NAMED {
            console.notice(&format!("the same of {} more meshes (see relume uv)", faults.len() - NAMED));
        }
    }
}

/// With the option that gives more texels.
fn explained(error: anyhow::Error) -> anyhow::Error {
    match error.downcast_ref() {
        Some(UnwrapError::TooCoarse { needed, .. }) if *needed <= MOST_TEXELS => {
            anyhow!("{error}: use --texels {needed}")
        }
        Some(UnwrapError::TooCoarse { .. }) => anyhow!("{error}: name the meshes that get light maps with --mapped"),
        _ => error,
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
