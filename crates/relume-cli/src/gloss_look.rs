//! How gloss is drawn, as typed; and what of it so many bands cannot hold.

use crate::console::Console;
use coeff_io::{Bounced, GlossView, GlossWay, Material, Prt};
use sh_math::lobe::{self, Lobe};

/// Share of a lobe's energy below which it is said that bands do not hold it.
const HELD: f64 = 0.9;
/// Materials that are named.
const NAMED: usize = 3;

/// How gloss is drawn.
#[derive(Debug, clap::Args)]
pub(crate) struct GlossOptions {
    /// The lobes of surfaces that shine: those of GGX or of Phong, as wide.
    #[arg(long, value_enum, default_value_t = LobeName::Ggx)]
    lobe: LobeName,
    /// One perceptual roughness for all that shines, 0 to 1.
    #[arg(long, value_name = "R", conflicts_with = "exponent", value_parser = crate::reference::roughness)]
    roughness: Option<f32>,
    /// The same as an exponent of Phong.
    #[arg(long, value_name = "S", value_parser = exponent)]
    exponent: Option<f32>,
    /// How light, transfer and lobe are multiplied: tp (triple products where it is drawn), tpfl (the matrix of the light where it is drawn),
    /// cache (once per light), or auto for whichever has least to do. The picture is the same.
    #[arg(long, value_enum, default_value_t = WayName::Auto)]
    way: WayName,
    /// Whether what lobes hold beyond the bands of the file comes from the prefiltered light.
    #[arg(long, value_enum, default_value_t = Tail::On)]
    tail: Tail,
    /// The finest level of transfer textures that is shown.
    #[arg(long, value_name = "N", default_value_t = 0)]
    level: u32,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
enum LobeName {
    Ggx,
    Phong,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
enum WayName {
    Auto,
    Tp,
    Tpfl,
    Cache,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
enum Tail {
    /// Added.
    On,
    /// Left out.
    Off,
}

impl GlossOptions {
    /// What the renderers are asked for.
    pub(crate) fn view(&self) -> GlossView {
        let of_exponent = self.exponent.map(|s| lobe::roughness_of_exponent(f64::from(s)) as f32);
        GlossView {
            lobe: match self.lobe {
                LobeName::Ggx => Lobe::Ggx,
                LobeName::Phong => Lobe::Phong,
            },
            roughness: self.roughness.or(of_exponent),
            way: match self.way {
                WayName::Auto => None,
                WayName::Tp => Some(GlossWay::Tp),
                WayName::Tpfl => Some(GlossWay::Tpfl),
                WayName::Cache => Some(GlossWay::Cache),
            },
            tail: self.tail == Tail::On,
            level: self.level,
        }
    }
}

/// Tells which lobes hold more than the bands of the file, and under which light bounces were baked.
pub(crate) fn tell(prt: &Prt, view: &GlossView, console: &Console) {
    let Some(gloss) = &prt.gloss else { return };
    if let Some(Bounced::Fixed { probe, .. }) = &gloss.bounced {
        console.notice(&format!("glossy bounces are of the light of {probe} alone, as it lay"));
    }
    let sharp: Vec<(&str, f64)> = prt
        .materials
        .iter()
        .filter(|material| material.specular)
        .map(|material| {
            let roughness = view.roughness.unwrap_or_else(|| least_roughness(prt, material));
            (material.name.as_str(), view.lobe.kept(f64::from(roughness), gloss.bands as usize))
        })
        .filter(|(_, kept)| *kept < HELD)
        .collect();
    if sharp.is_empty() {
        return;
    }
    let named: Vec<String> =
        sharp.iter().take(NAMED).map(|(name, kept)| format!("{name} {:.0} %", 100.0 * kept)).collect();
    let more = if sharp.len() > NAMED { format!(" and {} more", sharp.len() - NAMED) } else { String::new() };
    let rest = match view.tail {
        true => "the rest comes from the prefiltered light, unshadowed by direction",
        false => "the rest is left out",
    };
    console.notice(&format!(
        "{} bands hold a part of the sharpest lobes alone: {}{more} of their energy; {rest}",
        gloss.bands,
        named.join(", ")
    ));
}

/// The least roughness that a material shows anywhere.
fn least_roughness(prt: &Prt, material: &Material) -> f32 {
    let texels = material.metallic_roughness_texture.map(|slot| &prt.textures[slot.texture as usize].rgba);
    let least =
        texels.and_then(|texels| texels.iter().map(|texel| texel[1]).min()).map_or(1.0, |g| f32::from(g) / 255.0);
    material.roughness * least
}

fn exponent(text: &str) -> Result<f32, String> {
    match text.parse() {
        Ok(value) if (0.0..=1e5).contains(&value) => Ok(value),
        _ => Err("give an exponent from 0 to 100000".into()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exponents_become_roughness() {
        let typed = |exponent, roughness| GlossOptions {
            lobe: LobeName::Phong,
            roughness,
            exponent,
            way: WayName::Auto,
            tail: Tail::On,
            level: 0,
        };
        let roughness = typed(Some(10.0), None).view().roughness.unwrap();
        assert!((lobe::phong_exponent(f64::from(roughness)) - 10.0).abs() < 1e-3, "{roughness}");
        assert_eq!(typed(None, Some(0.3)).view().roughness, Some(0.3));
        assert_eq!(typed(None, None).view(), GlossView { lobe: Lobe::Phong, ..GlossView::default() });
        assert!(exponent("-1").is_err() && exponent("x").is_err() && exponent("nan").is_err());
    }
}
