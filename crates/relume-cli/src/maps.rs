//! The options of light maps.

use crate::console::Console;
use crate::gloss::{GlossOptions, SheetSet};
use crate::sheets::watched;
use anyhow::Result;
use bake::{MapSettings, TextureSettings};
use coeff_io::Encoding;
use relume::{AtlasOptions, LightMapOptions, Pages, TransferTextureOptions};
use scene::Scene;
use sh_math::hemisphere::Basis;

/// Texels along a side where none are asked for.
pub(crate) const TEXELS: u32 = 1024;

/// How light maps are baked, as typed.
#[derive(Debug, Clone, clap::Args)]
pub(crate) struct MapOptions {
    /// Texels along a side of the sheets of light maps and transfer textures: about so many times as many in all, shared by area.
    /// Where not given, 1024, and more where charts need it.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(i64::from(AtlasOptions::MIN_TEXELS)..=i64::from(AtlasOptions::MAX_TEXELS)))]
    texels: Option<u32>,
    /// The functions over normals that light maps are kept in: sh4, sh9, hl2, hsh4, hsh9, makhotkin4, makhotkin9, zernike3, zernike6, h4,
    /// h6, modified-h1 (an ordinary light map), modified-h4 or modified-h6, which is the default. Surfaces without normal maps keep an
    /// ordinary light map in any case.
    #[arg(long, value_name = "NAME", value_parser = basis)]
    basis: Option<Basis>,
    /// Gives light maps to these meshes alone, by the names of meshes or materials; the others are drawn by their vertices.
    #[arg(long, value_name = "NAME,...", value_delimiter = ',')]
    mapped: Vec<String>,
    /// How light maps are held in the file; f16 where not given.
    #[arg(long, value_enum)]
    encoding: Option<EncodingName>,
    /// Unwraps all surfaces, whatever light-map coordinates the scene brings.
    #[arg(long)]
    unwrap: bool,
    /// Leaves the light of the two sides of a seam as it is.
    #[arg(long)]
    no_stitch: bool,
    /// Free texels around each chart that is unwrapped, and rings that are filled around each chart; 2 where not given.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(0..=32))]
    padding: Option<u32>,
}

/// The encodings by the names that are typed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
enum EncodingName {
    /// Four bytes a number.
    F32,
    /// Two bytes a number.
    F16,
    /// One byte, with a range for each chart.
    U8,
    /// BC6H blocks: a byte for three numbers.
    Bc6h,
    /// BC1 blocks: half a byte for three numbers.
    Bc1,
}

impl EncodingName {
    fn encoding(self) -> Encoding {
        match self {
            Self::F32 => Encoding::F32,
            Self::F16 => Encoding::F16,
            Self::U8 => Encoding::U8,
            Self::Bc6h => Encoding::Bc6h,
            Self::Bc1 => Encoding::Bc1,
        }
    }
}

/// Settings of light maps for a plan: which sheets there will be is not known before surfaces are unwrapped, and does not matter to it.
pub(crate) fn planned(scene: &Scene) -> MapSettings {
    let meshes = (0..scene.meshes.len()).collect();
    let directional = relume::has_normal_maps(scene);
    MapSettings {
        basis: Basis::ModifiedH6,
        sheets: vec![bake::SheetSettings { meshes, width: 1, height: 1, directional }],
        stitch: false,
        dilation: 0,
        encoding: Encoding::F16,
    }
}

/// Parses the name of a basis.
pub(crate) fn basis(text: &str) -> Result<Basis, String> {
    Basis::named(text).ok_or_else(|| {
        let names = Basis::ALL.map(coeff_io::basis_id);
        format!("'{text}' is no basis: use one of {}", names.join(", "))
    })
}

impl MapOptions {
    /// The first option of light maps alone that was typed.
    pub(crate) fn typed_of_maps(&self) -> Option<&'static str> {
        let options = [("--basis", self.basis.is_some()), ("--encoding", self.encoding.is_some())];
        options.into_iter().find(|(_, is_typed)| *is_typed).map(|(name, _)| name)
    }

    /// The first option that was typed.
    pub(crate) fn typed(&self) -> Option<&'static str> {
        let options = [
            ("--texels", self.texels.is_some()),
            ("--basis", self.basis.is_some()),
            ("--mapped", !self.mapped.is_empty()),
            ("--encoding", self.encoding.is_some()),
            ("--unwrap", self.unwrap),
            ("--no-stitch", self.no_stitch),
            ("--padding", self.padding.is_some()),
        ];
        options.into_iter().find(|(_, is_typed)| *is_typed).map(|(name, _)| name)
    }

    /// The settings of transfer textures for a scene, whose surfaces are unwrapped where their own coordinates do not serve: a sheet for
    /// each mesh. `texels` along a side where none are asked for.
    pub(crate) fn textures(
        &self,
        scene: &mut Scene,
        options: &GlossOptions,
        texels: u32,
        bent: bool,
        console: &Console,
    ) -> Result<TextureSettings> {
        let options = TransferTextureOptions {
            atlas: self.atlas(texels),
            pages: match options.sheets {
                SheetSet::Object => Pages::PerMesh,
                SheetSet::Scene => Pages::Shared,
            },
            levels: !options.no_levels,
            normal_maps: bent,
            stitch: !self.no_stitch,
        };
        let settings = watched(&options.atlas, console, |observer| options.settings(scene, observer))?;
        for sheet in &settings.sheets {
            console.detail(&format!(
                "transfer texture of {} x {} texels, {} meshes",
                sheet.width,
                sheet.height,
                sheet.meshes.len()
            ));
        }
        Ok(settings)
    }

    /// The pages as they were asked for, of `texels` along a side where none are asked for.
    fn atlas(&self, texels: u32) -> AtlasOptions {
        let standard = AtlasOptions::new(self.texels.unwrap_or(texels));
        AtlasOptions {
            // Pages of a size that was asked for do not grow.
            max_texels: self.texels.unwrap_or(standard.max_texels),
            unwrap_all: self.unwrap,
            padding: self.padding.unwrap_or(standard.padding),
            only: self.mapped.clone(),
            ..standard
        }
    }

    /// The settings for a scene, whose surfaces are unwrapped where their own coordinates do not serve.
    pub(crate) fn settings(&self, scene: &mut Scene, console: &Console) -> Result<MapSettings> {
        let options = LightMapOptions {
            atlas: self.atlas(TEXELS),
            basis: self.basis.unwrap_or(Basis::ModifiedH6),
            stitch: !self.no_stitch,
            encoding: self.encoding.unwrap_or(EncodingName::F16).encoding(),
        };
        let settings = watched(&options.atlas, console, |observer| options.settings(scene, observer))?;
        let mut meshes = settings.sheets.iter().flat_map(|sheet| &sheet.meshes);
        if settings.basis == Basis::ModifiedH1 && meshes.any(|&mesh| relume::is_normal_mapped(scene, mesh)) {
            console.notice("normal maps are left out: an ordinary light map (--basis modified-h1) answers to none");
        }
        for sheet in &settings.sheets {
            let kind = if sheet.directional { settings.basis.name() } else { "an ordinary light map" };
            console.detail(&format!(
                "sheet of {} x {} texels, {} meshes, {kind}",
                sheet.width,
                sheet.height,
                sheet.meshes.len()
            ));
        }
        Ok(settings)
    }
}
