//! Decides, from the scene, which effects are simulated.

use crate::bandwidth;
use crate::extras::Extras;
use crate::facts::Facts;
use crate::receivers::Receivers;
use crate::rows;
use crate::series;
use crate::survey::{open_norms, survey};
use crate::world::{Shine, World};
use crate::{Error, settings};
use coeff_io::{BandChoice, Bounces, Effect, Effects, MeshPlan, Plan, Quality, Settings, Survey};
use scene::Scene;
use sh_math::Bands;

/// The scene as rays meet it, its receivers, and what is simulated for them.
pub(crate) struct Prepared<'a> {
    pub(crate) world: World<'a>,
    pub(crate) receivers: Receivers,
    pub(crate) plan: Plan,
    /// Permanent receivers that rays are traced for.
    pub(crate) traced: Vec<u32>,
}

/// Looks at a scene that is split already, and decides. No ray is traced but those of the survey.
pub(crate) fn prepare<'a>(scene: &'a Scene, settings: &Settings, extras: &Extras) -> Result<Prepared<'a>, Error> {
    let mut receivers = Receivers::of(scene);
    let mut facts = Facts::of_materials(scene, settings, extras.is_directional());
    facts.volume = extras.volume.is_some();
    let mut world = world(scene, &facts, settings)?;
    facts.add_receivers(scene, &world, &receivers);
    world.trace_all = is_forced(settings);
    let specular = allowed(settings, Effect::Specular);
    let shows_light = |m: &crate::material::Facts| !m.is_black() || specular && m.shines;
    if !is_forced(settings) {
        facts.mark_dark(scene, &mut receivers, &shows_light);
    }
    let needs_rays = |&r: &u32| {
        let receiver = &receivers.list[r as usize];
        !receiver.dark && (world.trace_all && receiver.sound || facts.is_shadowed(r))
    };
    let traced: Vec<u32> = match allowed(settings, Effect::Visibility) {
        true => (0..receivers.permanent as u32).filter(needs_rays).collect(),
        false => Vec::new(),
    };
    let survey = survey(&world, &receivers.list, &traced, settings)?;
    let plan = decide(&facts, survey, traced.len() as u64, settings);
    world.set_shine(shine(&facts, &plan));
    Ok(Prepared { world, receivers, plan, traced })
}

/// What becomes of mirrored light of each material under a plan.
fn shine(facts: &Facts, plan: &Plan) -> Vec<Shine> {
    if !simulates(plan, Effect::Specular) {
        return Vec::new();
    }
    let shiny = if simulates(plan, Effect::Glossy) { Shine::Direction } else { Shine::Mean };
    facts.materials.iter().map(|material| if material.shines { shiny } else { Shine::Matte }).collect()
}

/// The scene as rays meet it under the settings.
pub(crate) fn world<'a>(scene: &'a Scene, facts: &Facts, settings: &Settings) -> Result<World<'a>, Error> {
    let of = &facts.materials;
    let holes = |m: usize| of[m].masked && (is_forced(settings) || of[m].holes > 0.0);
    let mut world = World::new(scene, &|m| of[m].blocks, &|m| allowed(settings, Effect::Masks) && holes(m))?;
    let tints = allowed(settings, Effect::Color) && facts.stained.any();
    world.add_translucent(&|m| of[m].translucent, tints)?;
    Ok(world)
}

/// What is simulated, before it is put into words.
pub(crate) struct Decisions {
    pub(crate) visibility: bool,
    pub(crate) interreflection: bool,
    pub(crate) color: bool,
    pub(crate) masks: bool,
    pub(crate) specular: bool,
    pub(crate) glossy: bool,
    /// Largest share of the light that a reflection blocked in the wrong places would change.
    pub(crate) gloss_stake: f32,
    pub(crate) normal_maps: bool,
    pub(crate) emission: bool,
    pub(crate) transmission: bool,
    /// Receivers that rays are traced for.
    pub(crate) traced: u64,
    pub(crate) bands: u32,
    /// Bands that would do, were fewer allowed.
    pub(crate) bands_needed: u32,
    /// What is left out with n bands, from 0 on.
    pub(crate) left_out: Vec<f64>,
    /// Bound from the largest albedo.
    pub(crate) bounces: u32,
    pub(crate) expected_bounces: u32,
    /// Mean and largest share of an open receiver's light that a bounce brings: albedo times coverage.
    pub(crate) bounced: [f32; 2],
}

/// Decides on every effect.
fn decide(facts: &Facts, survey: Survey, traced: u64, settings: &Settings) -> Plan {
    let forced = is_forced(settings);
    let wanted = |effect, called_for: bool| allowed(settings, effect) && (forced || called_for);
    let drawn = |effect, called_for: bool| allowed(settings, effect) && called_for;
    let visibility = wanted(Effect::Visibility, traced > 0);
    let gloss_stake = facts.reflectance() * survey.coverage[1].min(1.0);
    let glossy = visibility && is_gloss_worth(facts, settings, gloss_stake);
    let bounced = [facts.mean_albedo * survey.coverage[0], facts.largest_albedo * survey.coverage[1]];
    let tolerance = f64::from(tolerance(settings.quality));
    let returned = if glossy { facts.largest_albedo.max(facts.reflectance()) } else { facts.largest_albedo };
    let bounces = match settings.bounces {
        Bounces::Fixed(n) => n,
        Bounces::Auto => most_bounces(returned, tolerance).max(u32::from(forced)),
    };
    let interreflection = visibility && bounces > 0 && wanted(Effect::Interreflection, returned > 0.0);
    let gain = if interreflection { gain(bounced[0]) } else { 1.0 };
    let left_out = bandwidth::left_out(&survey, &open_norms(bands(settings)), &settings.light, gain);
    let bands_needed = bandwidth::needed(&left_out, tolerance);
    let d = Decisions {
        visibility,
        interreflection,
        color: interreflection && wanted(Effect::Color, facts.colored.any() || glossy && facts.tinted.any())
            || visibility && allowed(settings, Effect::Color) && facts.stained.any(),
        masks: drawn(Effect::Masks, facts.holed.any() || forced && facts.masked.any()),
        specular: drawn(Effect::Specular, facts.shiny.any()),
        glossy,
        gloss_stake,
        normal_maps: drawn(Effect::NormalMaps, facts.bumpy.any()),
        emission: drawn(Effect::Emission, facts.emissive.any()),
        transmission: drawn(Effect::Transmission, facts.transmissive.any()),
        traced,
        bands: match settings.band_choice {
            BandChoice::Needed if !forced => bands_needed,
            BandChoice::Needed | BandChoice::Exactly => settings.bands,
        },
        bands_needed,
        left_out,
        bounces: if interreflection { bounces } else { 0 },
        expected_bounces: if interreflection {
            expected_bounces(settings.bounces, facts.mean_albedo * survey.coverage[1], tolerance)
        } else {
            0
        },
        bounced,
    };
    Plan {
        rows: rows::rows(facts, &survey, settings, &d),
        meshes: meshes(facts, &d),
        receivers: facts.receivers,
        shadowed_receivers: facts.shadowed,
        dark_receivers: facts.dark,
        bands: d.bands,
        channels: if d.color { 3 } else { 1 },
        bounces: d.bounces,
        expected_bounces: d.expected_bounces.min(d.bounces),
        survey,
    }
}

/// What each mesh calls for.
fn meshes(facts: &Facts, d: &Decisions) -> Vec<MeshPlan> {
    let of = |(index, mesh): (usize, &crate::facts::MeshFacts)| {
        let material = &facts.materials[mesh.material];
        let lit = mesh.shadowed > 0 && !mesh.dark;
        let calls = |effect| match effect {
            Effect::Visibility => d.visibility && lit,
            Effect::Interreflection => d.interreflection && lit,
            Effect::Color => d.color && lit,
            Effect::Masks => d.masks && material.holes > 0.0,
            Effect::Specular => d.specular && material.shines,
            Effect::Glossy => d.glossy && material.shines && mesh.shadowed > 0,
            Effect::NormalMaps => d.normal_maps && material.bumpy,
            Effect::Emission => d.emission && material.emission > 0.0,
            Effect::Transmission => d.transmission && material.transmits,
            // Bands are the same for all, and motion is not simulated.
            Effect::Bands | Effect::Motion => false,
        };
        MeshPlan {
            mesh: index as u32,
            receivers: mesh.receivers,
            shadowed: mesh.shadowed,
            effects: Effect::ALL.into_iter().filter(|&effect| calls(effect)).collect(),
        }
    };
    facts.meshes.iter().enumerate().map(of).collect()
}

/// Share of the light from where reflections that are blocked in the right places are worth their rays and bytes; below it one number per
/// vertex, its openness, stands for them.
const GLOSS_WORTH: f32 = 0.1;

/// Whether reflections can be worth simulating by direction, whatever blocks the light: a bound on what [`plan`] decides that needs no ray.
pub(crate) fn may_be_glossy(scene: &Scene, settings: &Settings) -> bool {
    let facts = Facts::of_materials(scene, settings, false);
    is_gloss_worth(&facts, settings, facts.reflectance())
}

/// Whether reflections are simulated by direction where so large a share of the light is at stake.
fn is_gloss_worth(facts: &Facts, settings: &Settings, stake: f32) -> bool {
    let named = matches!(&settings.effects, Effects::Only(list) if list.contains(&Effect::Glossy));
    allowed(settings, Effect::Specular)
        && allowed(settings, Effect::Glossy)
        && facts.shiny.any()
        && (is_forced(settings) || named || stake > GLOSS_WORTH)
}

/// Change of the result below which a bounce is not worth simulating.
pub(crate) fn tolerance(quality: Quality) -> f32 {
    match quality {
        Quality::Error(e) => e / 4.0,
        Quality::Rays(_) => 2.5e-3,
    }
}

/// Whether a plan simulates an effect.
pub(crate) fn simulates(plan: &Plan, effect: Effect) -> bool {
    plan.rows.iter().any(|row| row.effect == effect && row.simulate)
}

/// Bounces after which less than the tolerance can come: `a^(n+1) / (1 - a)` bounds the rest against an open receiver, since
/// every bounce is a weighted sum of the one before with weights that sum to the largest albedo `a` at most.
fn most_bounces(albedo: f32, tolerance: f64) -> u32 {
    geometric(f64::from(albedo), tolerance)
}

/// The same for the mean albedo and the largest coverage, since the worst receiver decides: what is expected, not a bound.
fn expected_bounces(asked: Bounces, bounced: f32, tolerance: f64) -> u32 {
    match asked {
        Bounces::Fixed(n) => n,
        Bounces::Auto => geometric(f64::from(bounced), tolerance).clamp(1, series::EXPECTED),
    }
}

/// Least n for which `a^(n+1) / (1 - a)` is below the tolerance.
fn geometric(a: f64, tolerance: f64) -> u32 {
    if a <= 0.0 {
        return 0;
    }
    if a >= 0.999 {
        return settings::MAX_BOUNCES;
    }
    let n = libm::ceil(libm::log(tolerance * (1.0 - a)) / libm::log(a)) - 1.0;
    (n.max(0.0) as u32).min(settings::MAX_BOUNCES)
}

/// By how much bounces are expected to add to the direct transfer, from mean albedo and coverage.
fn gain(bounced: f32) -> f64 {
    1.0 / (1.0 - f64::from(bounced.min(0.95)))
}

/// The bands asked for.
fn bands(settings: &Settings) -> Bands {
    Bands::new(settings.bands).expect("checked with the settings")
}

/// Whether everything is simulated, called for or not.
pub(crate) fn is_forced(settings: &Settings) -> bool {
    settings.effects == Effects::All
}

/// Whether the settings leave an effect to the scene.
pub(crate) fn allowed(settings: &Settings, effect: Effect) -> bool {
    match &settings.effects {
        Effects::Auto | Effects::All => true,
        Effects::Only(list) => list.contains(&effect),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Against the sum of the series: with n bounces the rest is below the tolerance, with one fewer it is not.
    #[test]
    fn bounces_end_where_the_series_does() {
        for a in [0.001f64, 0.1, 0.5, 0.8, 0.95] {
            let rest = |n: u32| (n + 1..5000).map(|k| a.powi(k as i32)).sum::<f64>();
            let n = geometric(a, 2.5e-3);
            assert!(rest(n) <= 2.5e-3, "{a}: {n} bounces leave {}", rest(n));
            assert!(n == 0 || rest(n - 1) > 2.5e-3, "{a}: {} bounces would do (can fail)", n - 1);
        }
        assert_eq!(geometric(0.0, 1e-3), 0, "black surfaces send nothing on");
        assert_eq!(geometric(1.0, 1e-3), settings::MAX_BOUNCES, "white ones without end");
    }
}
