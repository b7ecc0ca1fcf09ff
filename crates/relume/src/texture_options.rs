//! Options of light maps and transfer textures that do not depend on the scene; pages are made for each scene.

use crate::{AtlasObserver, AtlasOptions, Error};
use bake::{MapSettings, TextureSettings};
use coeff_io::Encoding;
use scene::Scene;
use sh_math::hemisphere::Basis;

/// Options of light maps.
#[derive(Debug, Clone, PartialEq)]
pub struct LightMapOptions {
    /// Resolution and unwrap.
    pub atlas: AtlasOptions,
    /// The functions over normals; surfaces without normal maps keep an ordinary light map.
    pub basis: Basis,
    /// Whether the two sides of seams are made to agree.
    pub stitch: bool,
    /// How the file holds the numbers.
    pub encoding: Encoding,
}

impl LightMapOptions {
    /// Pages of about `texels` along a side, modified H-basis of 6 functions, stitched seams, half floats.
    #[must_use]
    pub fn new(texels: u32) -> Self {
        Self { atlas: AtlasOptions::new(texels), basis: Basis::ModifiedH6, stitch: true, encoding: Encoding::F16 }
    }

    /// The settings for a scene, whose surfaces are unwrapped where their own coordinates are not usable.
    ///
    /// # Errors
    /// As [`AtlasOptions::shared_pages`].
    pub fn settings(&self, scene: &mut Scene, observer: AtlasObserver<'_>) -> Result<MapSettings, Error> {
        let mut sheets = self.atlas.shared_pages(scene, observer)?;
        // An ordinary light map has one value for all normals.
        sheets.iter_mut().for_each(|sheet| sheet.directional &= self.basis != Basis::ModifiedH1);
        let dilation = self.atlas.padding.max(1);
        Ok(MapSettings { basis: self.basis, sheets, stitch: self.stitch, dilation, encoding: self.encoding })
    }
}

/// How transfer textures share atlas pages.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Pages {
    /// One for each mesh, by its share of the area.
    PerMesh,
    /// As few as the coordinates allow.
    Shared,
}

/// Options of transfer textures.
#[derive(Debug, Clone, PartialEq)]
pub struct TransferTextureOptions {
    /// Resolution and unwrap.
    pub atlas: AtlasOptions,
    /// How meshes share pages.
    pub pages: Pages,
    /// Whether levels of detail are made.
    pub levels: bool,
    /// Whether diffuse transfer is about the normals of normal maps.
    pub normal_maps: bool,
    /// Whether the two sides of seams are made to agree.
    pub stitch: bool,
}

impl TransferTextureOptions {
    /// A page for each mesh, about the square of `texels` in all, with levels of detail and normal maps.
    #[must_use]
    pub fn new(texels: u32) -> Self {
        let atlas = AtlasOptions::new(texels);
        Self { atlas, pages: Pages::PerMesh, levels: true, normal_maps: true, stitch: true }
    }

    /// The settings for a scene, whose surfaces are unwrapped where their own coordinates are not usable.
    ///
    /// # Errors
    /// As [`AtlasOptions::shared_pages`].
    pub fn settings(&self, scene: &mut Scene, observer: AtlasObserver<'_>) -> Result<TextureSettings, Error> {
        let sheets = match self.pages {
            Pages::PerMesh => self.atlas.pages_per_mesh(scene, observer)?,
            Pages::Shared => self.atlas.shared_pages(scene, observer)?,
        };
        let dilation = self.atlas.padding.max(1);
        Ok(TextureSettings { sheets, dilation, levels: self.levels, bent: self.normal_maps, stitch: self.stitch })
    }
}
