//! What is said while the pages of light maps are made, and the options that mend what fails.

use crate::console::Console;
use crate::usage::{Usage, fault};
use anyhow::{Result, anyhow};
use bake::SheetSettings;
use relume::{AtlasEvent, AtlasOptions, Error};
use scene::Scene;
use scene::lightmap::{Atlas, Fault, FaultKind, Layouts, UnwrapError};

/// A page of which less is filled holds much of nothing.
const POORLY: f32 = 0.35;
/// Meshes that a notice names.
const NAMED: usize = 3;

/// The options of `relume bake` that make the same pages.
pub(crate) fn options(atlas: &AtlasOptions) -> String {
    let unwrap = if atlas.unwrap_all { " --unwrap" } else { "" };
    format!("--texels {}{unwrap}", atlas.texels)
}

/// The pages of a scene, which is unwrapped where its light-map coordinates do not serve.
pub(crate) fn pages(atlas: &AtlasOptions, scene: &mut Scene, console: &Console) -> Result<Vec<SheetSettings>> {
    watched(atlas, console, |observer| atlas.shared_pages(scene, observer))
}

/// Runs `make` and says what happens.
pub(crate) fn watched<T>(
    atlas: &AtlasOptions,
    console: &Console,
    make: impl FnOnce(relume::AtlasObserver<'_>) -> Result<T, Error>,
) -> Result<T> {
    let progress = console.progress();
    let observer = |event: AtlasEvent<'_>| match event {
        AtlasEvent::Progress(stage, done, total) => progress.set(stage, done, total),
        AtlasEvent::Layouts(scene, layouts) => tell(layouts, scene, console),
        AtlasEvent::Unwrapped(page) => tell_unwrapped(page, atlas.texels, console),
    };
    make(&observer).map_err(explained)
}

/// Tells how large a page became, and how full it is.
fn tell_unwrapped(page: &Atlas, texels: u32, console: &Console) {
    let (width, height) = (page.width, page.height);
    if u64::from(width) * u64::from(height) > u64::from(texels).pow(2) {
        console.notice(&format!("{} charts need a sheet of {width} x {height} texels", page.charts));
    }
    let text = format!("{} charts fill {:.0} % of their sheet", page.charts, 100.0 * page.filled);
    match page.filled < POORLY {
        true => console.notice(&format!("{text}: more --texels or less --padding would hold more light in it")),
        false => console.detail(&text),
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

/// With the option that gives more texels, or that is wrong.
fn explained(error: Error) -> anyhow::Error {
    match error {
        Error::Unwrap(UnwrapError::TooCoarse { needed, .. }) if needed <= AtlasOptions::MAX_TEXELS => {
            anyhow!("{error}: use --texels {needed}")
        }
        Error::Unwrap(UnwrapError::TooCoarse { .. }) => {
            anyhow!("{error}: name the meshes that get light maps with --mapped")
        }
        Error::UnknownMesh { .. } => Usage(format!("--mapped {error}")).into(),
        other => fault(other),
    }
}
