//! How light maps are drawn: in which basis, with how many functions, with or without the surfaces' colours.

use crate::console::Console;
use crate::maps;
use coeff_io::{Effect, MapLight, Prt};
use sh_math::hemisphere::Basis;

/// How what was baked is looked at.
#[derive(Debug, clap::Args)]
pub(crate) struct LookOptions {
    /// The basis that light maps are drawn in, such as modified-h6, sh9, hl2, hsh9, makhotkin9 or zernike6; their own by default.
    #[arg(long, value_name = "NAME", value_parser = maps::basis)]
    pub(crate) basis: Option<Basis>,
    /// Draws only the first N functions of the basis: modified-h6 has 6, 4 and 1, others what is a best fit.
    #[arg(long, value_name = "N")]
    pub(crate) functions: Option<u32>,
    /// The surfaces' own colours; off shows the light alone.
    #[arg(long, value_enum, default_value_t = Albedo::On)]
    albedo: Albedo,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
enum Albedo {
    /// As the materials have them.
    On,
    /// White.
    Off,
}

impl LookOptions {
    /// Whether surfaces have their own colours.
    pub(crate) fn albedo(&self) -> bool {
        self.albedo == Albedo::On
    }
}

/// Tells where normal maps that a scene has are left out, and why.
pub(crate) fn tell_left_out(prt: &Prt, console: &Console) {
    let row = prt.plan.rows.iter().find(|row| row.effect == Effect::NormalMaps && !row.simulate && row.callers > 0);
    if let Some(row) = row {
        console.notice(&format!("normal maps are left out: {}", row.reason));
    }
}

/// The end of a path, by which a probe is known again from another folder.
fn file_name(path: &str) -> &str {
    path.rsplit(['/', '\\']).next().unwrap_or(path)
}

/// Tells where the maps of a file hold the light of another probe than the one that is shown.
pub(crate) fn tell(prt: &Prt, shown: &str, look: &LookOptions, console: &Console) {
    if let Some(maps) = &prt.maps
        && (look.basis.is_some() || look.functions.is_some())
        && maps.sheets.iter().all(|sheet| maps.held(sheet).count() == 1)
    {
        console.notice("no normal map lies upon the light maps, which hold one function: they are drawn as they are");
    }
    if let Some(MapLight::Fixed { probe, .. }) = prt.maps.as_ref().map(|maps| &maps.light)
        && file_name(probe) != file_name(shown)
    {
        console.notice(&format!(
            "the light maps hold the light of {probe}; {shown} is in the sky, in reflections and where there are no maps"
        ));
    }
}
