//! The options of light maps, and the sheets that they lie in.

use crate::console::Console;
use crate::usage::Usage;
use anyhow::Result;
use bake::{MapSettings, SheetSettings};
use coeff_io::Encoding;
use scene::Scene;
use scene::lightmap::{self, Density, FaultKind, Unwrap};
use sh_math::hemisphere::Basis;

/// Share of a sheet that unwrapped surfaces are taken to fill, to foresee its size.
const FILLED: f64 = 0.6;
/// Fewest texels along a side of a sheet.
const SMALLEST: u32 = 16;

/// How light maps are baked, as typed.
#[derive(Debug, Clone, clap::Args)]
pub(crate) struct MapOptions {
    /// Texels along a side of the sheets with --storage texture: about so many times as many in all, shared by area.
    #[arg(long, value_name = "N", default_value_t = 1024, value_parser = clap::value_parser!(u32).range(i64::from(SMALLEST)..=8192))]
    texels: u32,
    /// The functions over normals that light maps are kept in: sh4, sh9, hl2, hsh4, hsh9, makhotkin4, makhotkin9, zernike3, zernike6, h4,
    /// h6, modified-h1 (an ordinary light map), modified-h4 or modified-h6.
    #[arg(long, value_name = "NAME", default_value = "modified-h6", value_parser = basis)]
    basis: Basis,
    /// Gives light maps to these meshes alone, by the names of meshes or materials; the others are drawn by their vertices.
    #[arg(long, value_name = "NAME,...", value_delimiter = ',')]
    mapped: Vec<String>,
    /// How light maps are held in the file.
    #[arg(long, value_enum, default_value_t = EncodingName::F16)]
    encoding: EncodingName,
    /// Unwraps all surfaces, whatever light-map coordinates the scene brings.
    #[arg(long)]
    unwrap: bool,
    /// Leaves the light of the two sides of a seam as it is.
    #[arg(long)]
    no_stitch: bool,
    /// Free texels around each chart that is unwrapped, and rings that are filled around each chart.
    #[arg(long, value_name = "N", default_value_t = 2, value_parser = clap::value_parser!(u32).range(0..=32))]
    padding: u32,
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

/// Parses the name of a basis.
pub(crate) fn basis(text: &str) -> Result<Basis, String> {
    Basis::named(text).ok_or_else(|| {
        let names = Basis::ALL.map(|basis| basis.name().to_lowercase().replace(' ', "-"));
        format!("'{text}' is no basis: use one of {}", names.join(", "))
    })
}

impl MapOptions {
    /// The settings for a scene, whose surfaces are unwrapped where their own coordinates do not serve.
    pub(crate) fn settings(&self, scene: &mut Scene, console: &Console) -> Result<MapSettings> {
        if let Some(name) =
            self.mapped.iter().find(|name| !(0..scene.meshes.len()).any(|mesh| is_named(scene, mesh, name)))
        {
            return Err(Usage(format!("--mapped {name}: no mesh or material of {} has that name", scene.name)).into());
        }
        let sheets = match self.own(scene, console) {
            Some(sheets) => sheets,
            None => self.unwrapped(scene, console)?,
        };
        for sheet in &sheets {
            let kind = if sheet.directional { self.basis.name() } else { "plain light" };
            console.detail(&format!(
                "sheet of {} x {} texels, {} meshes, {kind}",
                sheet.width,
                sheet.height,
                sheet.meshes.len()
            ));
        }
        Ok(MapSettings {
            basis: self.basis,
            sheets,
            stitch: !self.no_stitch,
            dilation: self.padding.max(1),
            encoding: self.encoding.encoding(),
        })
    }

    /// The sheets that the coordinates of the scene make: one for all meshes or one for each, whichever has no faults.
    fn own(&self, scene: &Scene, console: &Console) -> Option<Vec<SheetSettings>> {
        let meshes = self.meshes(scene);
        if self.unwrap || meshes.iter().any(|&mesh| scene.meshes[mesh].uv1.is_empty()) {
            return None;
        }
        let serves = |sheet: &[usize]| lightmap::faults(scene, sheet).iter().all(|fault| fault.kind == FaultKind::Flat);
        if serves(&meshes) {
            return Some(vec![self.sheet(scene, meshes, [self.texels; 2])]);
        }
        if meshes.iter().all(|&mesh| serves(&[mesh])) {
            let all: f64 = meshes.iter().map(|&mesh| area(scene, mesh)).sum();
            let side = |mesh: usize| {
                let side = f64::from(self.texels) * (area(scene, mesh) / all).sqrt();
                (side.round() as u32).clamp(SMALLEST, self.texels)
            };
            return Some(meshes.iter().map(|&mesh| self.sheet(scene, vec![mesh], [side(mesh); 2])).collect());
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
            let progress = console.progress();
            let options = Unwrap { density, padding: self.padding };
            let atlas =
                lightmap::unwrap(scene, &group, &options, &|stage, done, total| progress.set(stage, done, total))?;
            drop(progress);
            console.detail(&format!("{} charts, {:.0} % of their sheet filled", atlas.charts, 100.0 * atlas.filled));
            sheets.push(self.sheet(scene, group, [atlas.width, atlas.height]));
        }
        Ok(sheets)
    }

    /// Meshes that get light maps: surfaces that stop light, or those of them that are named. Others are drawn by their vertices.
    fn meshes(&self, scene: &Scene) -> Vec<usize> {
        let wanted = |mesh: usize| self.mapped.is_empty() || self.mapped.iter().any(|name| is_named(scene, mesh, name));
        (0..scene.meshes.len()).filter(|&mesh| scene.material(mesh).blocks_rays() && wanted(mesh)).collect()
    }

    fn sheet(&self, scene: &Scene, meshes: Vec<usize>, [width, height]: [u32; 2]) -> SheetSettings {
        let directional = self.basis != Basis::ModifiedH1 && meshes.iter().any(|&mesh| is_bent(scene, mesh));
        SheetSettings { meshes, width, height, directional }
    }
}

fn is_named(scene: &Scene, mesh: usize, name: &str) -> bool {
    scene.meshes[mesh].name == name || scene.material(mesh).name == name
}

fn is_bent(scene: &Scene, mesh: usize) -> bool {
    scene.material(mesh).normal_texture.is_some() && !scene.meshes[mesh].tangents.is_empty()
}

fn area(scene: &Scene, mesh: usize) -> f64 {
    let mesh = &scene.meshes[mesh];
    (0..mesh.triangles.len()).map(|triangle| mesh.area(triangle)).sum()
}
