//! What each effect took in a bake, and what the plan saved of it.

use crate::facts::texture_bytes;
use coeff_io::{Effect, EffectCost, Prt, Quality, Sampler, TextureSlot};
use scene::Scene;
use std::collections::BTreeSet;

/// Fewest rays of a receiver where an error is asked for, and fewest of its blockers that are looked up for bounces if it is
/// covered fully: three looks at 512 directions in all, of which those after the first 128 are foreseen but for a third.
const LEAST_RAYS: u64 = 250;
const LEAST_BLOCKERS: u64 = 512;

/// One entry per effect. Savings are against a bake that traces every receiver, looks up every blocker that it would for
/// bounces, and stores three channels, all bands and every texture; of rays, at least those.
pub(crate) fn account(scene: &Scene, prt: &Prt, traced: u64) -> Vec<EffectCost> {
    Effect::ALL.into_iter().map(|effect| cost(scene, prt, traced, effect)).collect()
}

fn cost(scene: &Scene, prt: &Prt, traced: u64, effect: Effect) -> EffectCost {
    let (plan, achieved, transfer) = (&prt.plan, &prt.achieved, &prt.transfer);
    let receivers = plan.receivers;
    let plane = |bands: u32| receivers * u64::from(bands * bands) * 4;
    let nothing = EffectCost { effect, rays: 0, saved_rays: 0, bytes: 0, saved_bytes: 0 };
    match effect {
        Effect::Visibility => {
            let bytes = 4 * transfer.openness.len() as u64;
            let saved_rays = (receivers - traced) * least_rays(prt);
            EffectCost {
                rays: achieved.visibility_rays,
                saved_rays,
                bytes,
                saved_bytes: 4 * receivers - bytes,
                ..nothing
            }
        }
        Effect::Interreflection => {
            let simulated = crate::plan::simulates(plan, effect);
            let saved_rays = if simulated { 0 } else { blockers(prt).saturating_sub(achieved.bounce_rays) };
            EffectCost { rays: achieved.bounce_rays, saved_rays, ..nothing }
        }
        Effect::Color => {
            let two = 2 * plane(transfer.bands);
            let (bytes, saved_bytes) = if transfer.channels == 3 { (two, 0) } else { (0, two) };
            EffectCost { bytes, saved_bytes, ..nothing }
        }
        Effect::Bands => {
            let channels = u64::from(transfer.channels);
            let saved_bytes = channels * (plane(prt.settings.bands) - plane(transfer.bands));
            EffectCost { bytes: plane(transfer.bands), saved_bytes, ..nothing }
        }
        Effect::Specular => {
            of_textures(nothing, scene, prt, |m| m.metallic_roughness_texture, |m| m.metallic_roughness_texture)
        }
        Effect::NormalMaps => {
            let maps = of_textures(nothing, scene, prt, |m| m.normal_texture, |m| m.normal_texture);
            let tangents = 16 * prt.geometry.tangents.len() as u64;
            let all = if scene.meshes.iter().any(|m| !m.tangents.is_empty()) { 16 * receivers } else { 0 };
            EffectCost {
                bytes: maps.bytes + tangents,
                saved_bytes: maps.saved_bytes + all.saturating_sub(tangents),
                ..nothing
            }
        }
        Effect::Emission => of_textures(nothing, scene, prt, |m| m.emissive_texture, |m| m.emissive_texture),
        Effect::Glossy => glossy(nothing, prt),
        Effect::Masks | Effect::Transmission | Effect::Motion => nothing,
    }
}

/// What gloss takes, and what every vertex would have taken as exact numbers.
fn glossy(nothing: EffectCost, prt: &Prt) -> EffectCost {
    let record = prt.achieved.gloss.unwrap_or_default();
    let bytes = prt.gloss.as_ref().map_or(0, |_| record.bytes[1]);
    let bands = prt.gloss.as_ref().map_or(prt.transfer.bands, |gloss| gloss.bands);
    let all = 4 * u64::from(bands * bands) * prt.geometry.positions.len() as u64;
    EffectCost { rays: record.rays[0] + record.rays[1], bytes, saved_bytes: all.saturating_sub(bytes), ..nothing }
}

/// Rays that a receiver takes at least.
fn least_rays(prt: &Prt) -> u64 {
    match prt.settings.quality {
        // Half of the samples over the whole sphere lie below the horizon.
        Quality::Rays(n) if prt.settings.sampler == Sampler::Stratified => u64::from(n) / 2,
        Quality::Rays(n) => u64::from(n),
        Quality::Error(_) => LEAST_RAYS,
    }
}

/// Blocked rays whose surfaces a bake with bounces would at least look up.
fn blockers(prt: &Prt) -> u64 {
    let most = match prt.settings.quality {
        Quality::Rays(_) => least_rays(prt) as f64,
        Quality::Error(_) => LEAST_BLOCKERS as f64,
    };
    prt.transfer.openness.iter().map(|&open| (most * f64::from(1.0 - open)) as u64).sum()
}

/// Bytes of the textures of one slot: those in the file, and those that the scene has besides.
fn of_textures(
    nothing: EffectCost,
    scene: &Scene,
    prt: &Prt,
    in_scene: fn(&scene::Material) -> Option<scene::TextureSlot>,
    in_file: fn(&coeff_io::Material) -> Option<TextureSlot>,
) -> EffectCost {
    let used: BTreeSet<u32> = prt.materials.iter().filter_map(|m| in_file(m).map(|s| s.texture)).collect();
    let bytes = used.iter().map(|&t| 4 * prt.textures[t as usize].rgba.len() as u64).sum();
    let all = texture_bytes(scene, &|m| in_scene(&scene.materials[m]));
    EffectCost { bytes, saved_bytes: all.saturating_sub(bytes), ..nothing }
}
