//! Atlas pages for light maps and transfer textures: the scene's own coordinates where they are usable, else unwrapped.

use crate::Error;
use bake::SheetSettings;
use scene::Scene;
use scene::lightmap::{self, Atlas, Density, Layouts, ObjectOptions, Unwrap, UnwrapError};

/// Share of a page that unwrapped surfaces are expected to cover, to predict its size.
const EXPECTED_COVERAGE: f64 = 0.6;
/// Numbers of texels that are tried before an error names one.
const ATTEMPTS: usize = 8;

/// Resolution of atlas pages, and which surfaces are unwrapped.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct AtlasOptions {
    /// Texels along a side: about the square of it in all, shared by area.
    pub texels: u32,
    /// Most texels along a side that pages grow to where charts need it.
    pub max_texels: u32,
    /// Whether all surfaces are unwrapped, whatever coordinates the scene brings.
    pub unwrap_all: bool,
    /// Free texels around each chart that is unwrapped.
    pub padding: u32,
    /// Names of the meshes or materials that get a place; empty for all surfaces that block rays.
    pub only: Vec<String>,
}

/// What happens while pages are made.
#[derive(Debug, Clone, Copy)]
pub enum AtlasEvent<'a> {
    /// A stage of unwrapping: its name, how much is done, and of how much (0 where that is not known).
    Progress(&'static str, u64, u64),
    /// Which of the scene's own coordinates are usable, and why the others are not.
    Layouts(&'a Scene, &'a Layouts),
    /// A page was unwrapped.
    Unwrapped(&'a Atlas),
}

/// Receives the events; from several threads, but never at once.
pub type AtlasObserver<'a> = &'a (dyn Fn(AtlasEvent<'_>) + Sync);

type MakePages = fn(&AtlasOptions, &mut Scene, AtlasObserver<'_>) -> Result<Vec<SheetSettings>, Error>;

impl AtlasOptions {
    /// Texels between charts by default.
    pub const PADDING: u32 = 2;
    /// Fewest texels along a side of a page.
    pub const MIN_TEXELS: u32 = 16;
    /// Most texels along a side of a page.
    pub const MAX_TEXELS: u32 = 8192;
    /// Most texels along a side that pages grow to by default.
    pub const MAX_GROWTH: u32 = 4096;

    /// Pages of about `texels` along a side for all surfaces; pages grow up to 4096 texels where charts need it.
    #[must_use]
    pub fn new(texels: u32) -> Self {
        let max_texels = texels.max(Self::MAX_GROWTH);
        Self { texels, max_texels, unwrap_all: false, padding: Self::PADDING, only: Vec::new() }
    }

    /// The pages of a scene: its own coordinates where they are usable, else its charts are packed anew, and meshes without coordinates are
    /// unwrapped. Pages with normal-mapped meshes are marked as directional.
    ///
    /// # Errors
    /// [`Error::UnknownMesh`] or [`Error::Unwrap`]. Where pages may not grow and the texels are too few,
    /// [`UnwrapError::TooCoarse`] names a number that was tried and suffices.
    pub fn shared_pages(&self, scene: &mut Scene, observer: AtlasObserver<'_>) -> Result<Vec<SheetSettings>, Error> {
        self.with_sufficient_texels(scene, observer, Self::make_shared)
    }

    /// A page for each mesh, by its share of the area: its own coordinates where they are usable, else it is unwrapped alone.
    ///
    /// # Errors
    /// As [`AtlasOptions::shared_pages`].
    pub fn pages_per_mesh(&self, scene: &mut Scene, observer: AtlasObserver<'_>) -> Result<Vec<SheetSettings>, Error> {
        self.with_sufficient_texels(scene, observer, Self::make_per_mesh)
    }

    /// The pages; where the texels are too few and may not grow, the error names a number that was tried and suffices.
    fn with_sufficient_texels(
        &self,
        scene: &mut Scene,
        observer: AtlasObserver<'_>,
        make: MakePages,
    ) -> Result<Vec<SheetSettings>, Error> {
        if self.max_texels > self.texels {
            return make(self, scene, observer);
        }
        let before = scene.clone();
        let mut error = match make(self, scene, observer) {
            Err(error) => error,
            pages => return pages,
        };
        // The pages of a scene need different numbers: the first that fails names its own only.
        for _ in 0..ATTEMPTS {
            let Error::Unwrap(UnwrapError::TooCoarse { needed, .. }) = error else { break };
            let larger = Self { texels: needed, max_texels: needed, ..self.clone() };
            match make(&larger, &mut before.clone(), &|_| ()) {
                Err(next) => error = next,
                Ok(_) => break,
            }
        }
        Err(error)
    }

    fn make_shared(&self, scene: &mut Scene, observer: AtlasObserver<'_>) -> Result<Vec<SheetSettings>, Error> {
        self.check_names(scene)?;
        let meshes = self.meshes(scene);
        let layouts = match self.unwrap_all {
            true => Layouts { none: meshes.clone(), ..Layouts::default() },
            false => lightmap::layouts(scene, &meshes, self.texels, self.max_texels),
        };
        observer(AtlasEvent::Layouts(scene, &layouts));
        let own = layouts.pages.iter().map(|(meshes, side)| page(scene, meshes.clone(), [*side; 2]));
        let mut pages: Vec<SheetSettings> = own.collect();
        pages.extend(self.unwrapped(scene, &meshes, &layouts, observer)?);
        Ok(pages)
    }

    fn make_per_mesh(&self, scene: &mut Scene, observer: AtlasObserver<'_>) -> Result<Vec<SheetSettings>, Error> {
        self.check_names(scene)?;
        let meshes = self.meshes(scene);
        let progress = |stage, done, total| observer(AtlasEvent::Progress(stage, done, total));
        let mut objects = |texels| {
            let options = ObjectOptions { texels, padding: self.padding, unwrap: self.unwrap_all };
            lightmap::objects(scene, &meshes, &options, &progress)
        };
        let objects = match objects(self.texels) {
            Err(UnwrapError::TooCoarse { needed, .. }) if needed <= self.max_texels => objects(needed),
            other => other,
        }?;
        Ok(objects.into_iter().map(|object| page(scene, vec![object.mesh], [object.width, object.height])).collect())
    }

    fn check_names(&self, scene: &Scene) -> Result<(), Error> {
        let missing = |name: &&String| !(0..scene.meshes.len()).any(|mesh| is_named(scene, mesh, name));
        match self.only.iter().find(missing) {
            Some(name) => Err(Error::UnknownMesh { scene: scene.name.clone(), name: name.clone() }),
            None => Ok(()),
        }
    }

    /// Unwrapped pages for all meshes without a page: one for normal-mapped meshes and one for the others, of the same density.
    fn unwrapped(
        &self,
        scene: &mut Scene,
        meshes: &[usize],
        layouts: &Layouts,
        observer: AtlasObserver<'_>,
    ) -> Result<Vec<SheetSettings>, Error> {
        let mut left: Vec<usize> = layouts.charts.iter().chain(&layouts.none).copied().collect();
        left.sort_unstable();
        let (mapped, plain): (Vec<usize>, Vec<usize>) =
            left.into_iter().partition(|&mesh| is_normal_mapped(scene, mesh));
        let groups: Vec<Vec<usize>> = [mapped, plain].into_iter().filter(|group| !group.is_empty()).collect();
        let all: f64 = meshes.iter().map(|&mesh| area(scene, mesh)).sum();
        let per_metre = f64::from(self.texels) * (EXPECTED_COVERAGE / all.max(f64::MIN_POSITIVE)).sqrt();
        let density = match groups.len() == 1 && layouts.pages.is_empty() {
            true => Density::Side(self.texels),
            false => Density::PerMetre(per_metre as f32),
        };
        let options = Unwrap { density, padding: self.padding };
        let progress = |stage, done, total| observer(AtlasEvent::Progress(stage, done, total));
        let mut pages = Vec::new();
        for group in groups {
            let atlas =
                lightmap::unwrap_resolved(scene, &group, &layouts.charts, &options, self.max_texels, &progress)?;
            observer(AtlasEvent::Unwrapped(&atlas));
            pages.push(page(scene, group, [atlas.width, atlas.height]));
        }
        Ok(pages)
    }

    /// Meshes that get a place: surfaces that block rays, or those of them that are named.
    fn meshes(&self, scene: &Scene) -> Vec<usize> {
        let is_asked = |mesh: usize| self.only.is_empty() || self.only.iter().any(|name| is_named(scene, mesh, name));
        blocking(scene).filter(|&mesh| is_asked(mesh)).collect()
    }
}

fn is_named(scene: &Scene, mesh: usize, name: &str) -> bool {
    scene.meshes[mesh].name == name || scene.material(mesh).name == name
}

fn page(scene: &Scene, meshes: Vec<usize>, [width, height]: [u32; 2]) -> SheetSettings {
    let directional = meshes.iter().any(|&mesh| is_normal_mapped(scene, mesh));
    SheetSettings { meshes, width, height, directional }
}

/// Surfaces that block rays.
fn blocking(scene: &Scene) -> impl Iterator<Item = usize> + '_ {
    (0..scene.meshes.len()).filter(|&mesh| scene.material(mesh).blocks_rays())
}

/// Whether a normal map is drawn on some surface that gets light maps.
pub fn has_normal_maps(scene: &Scene) -> bool {
    blocking(scene).any(|mesh| is_normal_mapped(scene, mesh))
}

/// Whether a normal map is drawn on a mesh, by its index in [`Scene::meshes`].
pub fn is_normal_mapped(scene: &Scene, mesh: usize) -> bool {
    scene.material(mesh).normal_texture.is_some() && !scene.meshes[mesh].tangents.is_empty()
}

fn area(scene: &Scene, mesh: usize) -> f64 {
    let mesh = &scene.meshes[mesh];
    (0..mesh.triangles.len()).map(|triangle| mesh.area(triangle)).sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn unknown_mesh_is_refused() {
        let mut scene = crate::load_scene("builtin:teacup").expect("a builtin");
        let options = AtlasOptions { only: vec!["nothing".into()], ..AtlasOptions::new(128) };
        let refused = options.shared_pages(&mut scene, &|_| ());
        assert!(matches!(refused, Err(Error::UnknownMesh { .. })), "{refused:?}");
    }

    /// The number that the error names suffices, and half of it does not.
    #[test]
    fn error_names_sufficient_texels() {
        let scene = crate::load_scene("builtin:atrium").expect("a builtin");
        let pages = |texels| {
            let options = AtlasOptions { texels, max_texels: texels, unwrap_all: true, ..AtlasOptions::new(texels) };
            options.shared_pages(&mut scene.clone(), &|_| ())
        };
        let Err(Error::Unwrap(UnwrapError::TooCoarse { needed, .. })) = pages(16) else {
            panic!("16 texels are too few")
        };
        assert!(pages(needed).is_ok(), "{needed} texels suffice");
        assert!(pages(needed / 2).is_err(), "can fail: half of {needed} texels do not suffice");
    }
}
