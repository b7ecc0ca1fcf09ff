//! Rows of the effects that follow from the materials: they cost no rays of their own.

use crate::material::Facts as Material;
use crate::rows::{Table, Words, percent};
use coeff_io::{Effect, PlanRow};
use sh_math::brdf::DIELECTRIC;

/// Largest value of a fact over all materials.
fn largest(table: &Table<'_>, value: impl Fn(&Material) -> f32) -> f32 {
    table.facts.materials.iter().map(value).fold(0.0, f32::max)
}

pub(crate) fn masks(table: &Table<'_>) -> PlanRow {
    let (f, d) = (table.facts, table.decisions);
    let holes = largest(table, |m| m.holes);
    let words = Words {
        decision: if d.masks { "rays and drawing test the mask".into() } else { "opaque: no test".into() },
        reason: match (f.masked.count(), f.holed.count()) {
            (0, _) => "no material has an alpha mask".into(),
            (n, 0) => format!("{n} materials have alpha masks, but no texel of theirs is below the cutoff"),
            (n, m) => format!("of {n} materials with alpha masks {m} have texels below the cutoff"),
        },
        stake: holes,
        at_stake: match f.holed.any() {
            false => "nothing: no point of a surface is missing".into(),
            true => format!("solid sheets and their shadows where up to {} is holes", percent(holes)),
        },
    };
    table.row(Effect::Masks, d.masks, &f.holed, words)
}

pub(crate) fn specular(table: &Table<'_>) -> PlanRow {
    let (f, d) = (table.facts, table.decisions);
    let stake = if f.shiny.any() { largest(table, |m| if m.shines { m.reflectance } else { 0.0 }) } else { DIELECTRIC };
    let words = Words {
        decision: if d.specular { "reflection map".into() } else { "no reflection pipeline".into() },
        reason: match f.shiny.count() {
            0 => "every material is rough and dielectric, and so counts as matt".into(),
            n => format!("{n} materials are metallic (over 0.05) or smooth (roughness below 0.6) somewhere"),
        },
        stake,
        at_stake: match f.shiny.any() {
            true => format!("reflections missing: up to {} of the light, at normal incidence", percent(stake)),
            false => format!(
                "the blurred sheen of matt surfaces, about {} of the light, is left out of the model",
                percent(stake)
            ),
        },
    };
    let row = table.row(Effect::Specular, d.specular, &f.shiny, words);
    PlanRow { bytes: if d.specular { f.gloss_bytes } else { 0 }, ..row }
}

pub(crate) fn glossy(table: &Table<'_>) -> PlanRow {
    let (f, d) = (table.facts, table.decisions);
    let stake = if f.shiny.any() { d.gloss_stake } else { 0.0 };
    let words = Words {
        decision: match (d.glossy, f.shiny.any()) {
            (true, _) => "visibility and bounces by direction for surfaces that shine".into(),
            (false, true) => "openness dims reflections".into(),
            (false, false) => "nothing to reflect".into(),
        },
        reason: match f.shiny.count() {
            0 => "no material shines".into(),
            n => format!(
                "{n} materials reflect up to {} and up to {} of what stands around them is blocked",
                percent(f.reflectance()),
                percent(table.survey.coverage[1])
            ),
        },
        stake,
        at_stake: match stake > 0.0 {
            false => "nothing: no reflection is blocked".into(),
            true => format!(
                "reflections of what is hidden, and none of what hides it: up to {} of the light",
                percent(stake)
            ),
        },
    };
    let row = table.row(Effect::Glossy, d.glossy, &f.shiny, words);
    if !d.glossy {
        return row;
    }
    // What mirrors see is found for the light on its way and again with what blocks; half precision.
    let receivers = f.shiny_receivers() as f64;
    let rays = receivers * table.rays_of_receiver() * f64::from(2.0 + table.survey.coverage[0]);
    let bands = d.bands.min(crate::mirror::MOST_BANDS);
    PlanRow { rays: rays as u64, bytes: 2 * f.shiny_receivers() * u64::from(bands * bands), ..row }
}

pub(crate) fn normal_maps(table: &Table<'_>) -> PlanRow {
    let (f, d) = (table.facts, table.decisions);
    let stake = largest(table, |m| m.bend);
    let idle = match f.idle_bumps {
        0 => String::new(),
        n => format!("; {n} more bend too little to show"),
    };
    let decision = match f.directional {
        true => "directional light maps",
        false => "bend reflections, and the light of vertices by where it comes from",
    };
    let words = Words {
        decision: if d.normal_maps { decision.into() } else { "plain normals".into() },
        reason: match f.bumpy.count() {
            0 => format!("no material has a normal map that shows{idle}"),
            n => format!("{n} materials have normal maps that bend by up to {} on average{idle}", percent(stake)),
        },
        stake,
        at_stake: match f.bumpy.any() {
            false => "nothing: no normal is bent".into(),
            true => format!(
                "creases missing: up to {} of a light from the side, all of it where a normal turns away",
                percent(stake)
            ),
        },
    };
    let row = table.row(Effect::NormalMaps, d.normal_maps, &f.bumpy, words);
    PlanRow { bytes: if d.normal_maps { f.bump_bytes + 16 * f.receivers } else { 0 }, ..row }
}

pub(crate) fn emission(table: &Table<'_>) -> PlanRow {
    let (f, d) = (table.facts, table.decisions);
    let stake = largest(table, |m| m.emission);
    let words = Words {
        decision: if d.emission { "drawn, lights nothing".into() } else { "nothing".into() },
        reason: match f.emissive.count() {
            0 => "no surface emits light".into(),
            n => format!("{n} materials emit light"),
        },
        stake,
        at_stake: match f.emissive.any() {
            false => "nothing".into(),
            true => format!("surfaces of radiance up to {stake:.2} drawn dark"),
        },
    };
    let row = table.row(Effect::Emission, d.emission, &f.emissive, words);
    PlanRow { bytes: if d.emission { f.glow_bytes } else { 0 }, ..row }
}

pub(crate) fn transmission(table: &Table<'_>) -> PlanRow {
    let (f, d) = (table.facts, table.decisions);
    let stake = largest(table, |m| m.passes);
    let words = Words {
        decision: if d.transmission { "rays pass in part, drawn clear".into() } else { "nothing".into() },
        reason: match f.transmissive.count() {
            0 => "every surface is opaque".into(),
            n => format!("{n} materials blend or transmit, and stop the share of light that they cover"),
        },
        stake,
        at_stake: match f.transmissive.any() {
            false => "nothing".into(),
            true => format!("up to {} of the light behind them kept out", percent(stake)),
        },
    };
    table.row(Effect::Transmission, d.transmission, &f.transmissive, words)
}

pub(crate) fn motion(table: &Table<'_>) -> PlanRow {
    let moving = &table.facts.moving;
    let words = Words {
        decision: match (moving.any(), table.facts.volume) {
            (_, true) => "an irradiance volume".into(),
            (true, false) => "not simulated: baked at rest".into(),
            (false, false) => "nothing".into(),
        },
        reason: match moving.count() {
            0 => "no animation or skin moves a mesh".into(),
            n if table.facts.volume => format!("animations or skins move {n} meshes"),
            n => format!("animations or skins move {n} meshes (--volume would light them on their way)"),
        },
        stake: f32::from(u8::from(moving.any())),
        at_stake: match moving.any() {
            false => "nothing".into(),
            true => "their shadows and bounces stay where they were: up to all light near them".into(),
        },
    };
    table.row(Effect::Motion, table.facts.volume, moving, words)
}
