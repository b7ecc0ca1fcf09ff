//! Decides, from the scene, which effects are simulated and why.

use crate::albedo::Albedo;
use crate::receivers::Receivers;
use crate::world::World;
use coeff_io::{Bounces, Effect, Effects, Plan, PlanRow, Quality, Settings};
use rayon::prelude::*;
use scene::{Material, Scene};

/// Perceptual roughness below which a dielectric shows a reflection that is worth drawing.
const SHINY: f32 = 0.6;
/// Metallic share above which a surface shows a reflection.
const METALLIC: f32 = 0.05;
/// Rays per receiver that the estimate assumes where an error is asked for: the median seen at 1 %.
const TYPICAL_RAYS: f64 = 700.0;

/// Facts about the scene that decisions rest on.
pub(crate) struct Facts {
    receivers: u64,
    shadowed: u64,
    /// Mean diffuse albedo over the area of surfaces that block.
    mean_albedo: f32,
    colored: Vec<String>,
    reflecting: Vec<String>,
    masked: Vec<String>,
    shiny: Vec<String>,
    normal_mapped: Vec<String>,
    emissive: Vec<String>,
    transmissive: Vec<String>,
}

impl Facts {
    /// Looks at every material once and at every receiver through the tree.
    pub(crate) fn gather(scene: &Scene, world: &World<'_>, receivers: &Receivers) -> Self {
        let fronts = &receivers.list[..receivers.permanent];
        let shadowed = fronts.par_iter().filter(|r| world.can_shadow(r)).count();
        let names = |test: &dyn Fn(&Material) -> bool| -> Vec<String> {
            scene.materials.iter().filter(|m| test(m)).map(|m| m.name.clone()).collect()
        };
        let albedos: Vec<Albedo> = (0..scene.materials.len()).map(|m| Albedo::of(scene, m)).collect();
        let with = |test: &dyn Fn(&Albedo) -> bool| -> Vec<String> {
            let pairs = scene.materials.iter().zip(&albedos);
            pairs.filter(|(m, a)| m.blocks_rays() && test(a)).map(|(m, _)| m.name.clone()).collect()
        };
        Self {
            receivers: receivers.permanent as u64,
            shadowed: shadowed as u64,
            mean_albedo: mean_albedo(scene, &albedos),
            colored: with(&|a| a.colored),
            reflecting: with(&|a| a.largest > 0.0),
            masked: names(&Material::is_masked),
            shiny: names(&shines),
            normal_mapped: names(&|m| m.normal_texture.is_some()),
            emissive: names(&|m| m.emissive.max_element() > 0.0),
            transmissive: names(&|m| !m.blocks_rays()),
        }
    }
}

/// Whether a material shows a reflection that is worth drawing.
pub(crate) fn shines(material: &Material) -> bool {
    material.metallic > METALLIC || material.roughness < SHINY
}

fn mean_albedo(scene: &Scene, albedos: &[Albedo]) -> f32 {
    let (mut area, mut sum) = (0.0f64, 0.0f64);
    for mesh in &scene.meshes {
        let material = mesh.material as usize;
        if !scene.materials[material].blocks_rays() {
            continue;
        }
        let mesh_area: f64 = (0..mesh.triangles.len()).map(|t| mesh.area(t)).sum();
        area += mesh_area;
        sum += mesh_area * f64::from(albedos[material].mean);
    }
    if area > 0.0 { (sum / area) as f32 } else { 0.0 }
}

/// Decides on every effect.
pub(crate) fn decide(facts: &Facts, settings: &Settings) -> Plan {
    let visibility = allowed(settings, Effect::Visibility) && (forced(settings) || facts.shadowed > 0);
    let bounces = match settings.bounces {
        Bounces::Fixed(n) => n,
        Bounces::Auto => bound_bounces(facts.mean_albedo, tolerance(settings.quality)),
    };
    let interreflection = visibility
        && bounces > 0
        && allowed(settings, Effect::Interreflection)
        && (forced(settings) || !facts.reflecting.is_empty());
    let color = interreflection && allowed(settings, Effect::Color) && (forced(settings) || !facts.colored.is_empty());
    let decisions =
        Decisions { visibility, interreflection, color, bounces: if interreflection { bounces } else { 0 } };
    Plan {
        rows: rows(facts, settings, &decisions),
        receivers: facts.receivers,
        shadowed_receivers: facts.shadowed,
        channels: if color { 3 } else { 1 },
        bounces: decisions.bounces,
    }
}

/// Change of the result below which a bounce is not worth simulating.
pub(crate) fn tolerance(quality: Quality) -> f32 {
    match quality {
        Quality::Error(e) => e / 4.0,
        Quality::Rays(_) => 2.5e-3,
    }
}

/// Whether rays may pass through the empty parts of alpha masks.
pub(crate) fn allows_masks(settings: &Settings) -> bool {
    allowed(settings, Effect::Masks)
}

/// Whether a plan simulates an effect.
pub(crate) fn simulates(plan: &Plan, effect: Effect) -> bool {
    plan.rows.iter().any(|row| row.effect == effect && row.simulate)
}

/// Bounces until the mean albedo to that power is below the tolerance: a bound before any ray.
fn bound_bounces(albedo: f32, tolerance: f32) -> u32 {
    if albedo <= 0.0 {
        return 0;
    }
    if albedo >= 0.999 {
        return crate::settings::MAX_BOUNCES;
    }
    let n = libm::ceil(libm::log(f64::from(tolerance)) / libm::log(f64::from(albedo)));
    (n as u32).clamp(1, crate::settings::MAX_BOUNCES)
}

struct Decisions {
    visibility: bool,
    interreflection: bool,
    color: bool,
    bounces: u32,
}

fn forced(settings: &Settings) -> bool {
    settings.effects == Effects::All
}

fn allowed(settings: &Settings, effect: Effect) -> bool {
    match &settings.effects {
        Effects::Auto | Effects::All => true,
        Effects::Only(list) => list.contains(&effect),
    }
}

fn rows(facts: &Facts, settings: &Settings, d: &Decisions) -> Vec<PlanRow> {
    let per_receiver = match settings.quality {
        Quality::Rays(n) => f64::from(n),
        Quality::Error(e) => TYPICAL_RAYS * f64::from(0.01 / e).max(0.05),
    };
    let traced = facts.shadowed;
    let visibility_rays = if d.visibility { (traced as f64 * per_receiver) as u64 } else { 0 };
    let coefficients = u64::from(settings.bands * settings.bands);
    let plane_bytes = facts.receivers * coefficients * 4;
    let table = Table { facts, settings };
    vec![
        table.row(
            Effect::Visibility,
            d.visibility,
            table.visibility_reason(),
            &[],
            visibility_rays,
            if d.visibility { facts.receivers * 4 } else { 0 },
        ),
        table.row(
            Effect::Interreflection,
            d.interreflection,
            table.interreflection_reason(d),
            &facts.reflecting,
            if d.interreflection { visibility_rays / 4 } else { 0 },
            0,
        ),
        table.row(
            Effect::Color,
            d.color,
            table.color_reason(d),
            &facts.colored,
            0,
            if d.color { 2 * plane_bytes } else { 0 },
        ),
        table.drawn(
            Effect::Masks,
            &facts.masked,
            "surfaces have alpha masks that rays may pass",
            "no surface has an alpha mask",
        ),
        table.drawn(
            Effect::Specular,
            &facts.shiny,
            "materials are metallic or smooth enough to mirror the light",
            "every material is rough and dielectric",
        ),
        table.drawn(
            Effect::NormalMaps,
            &facts.normal_mapped,
            "materials have normal maps, which bend reflections",
            "no material has a normal map",
        ),
        table.drawn(
            Effect::Emission,
            &facts.emissive,
            "surfaces emit light (drawn, not transported)",
            "no surface emits light",
        ),
        table.drawn(
            Effect::Transmission,
            &facts.transmissive,
            "surfaces blend or transmit: rays pass them",
            "every surface is opaque",
        ),
    ]
}

struct Table<'a> {
    facts: &'a Facts,
    settings: &'a Settings,
}

impl Table<'_> {
    fn row(&self, effect: Effect, simulate: bool, reason: String, by: &[String], rays: u64, bytes: u64) -> PlanRow {
        PlanRow { effect, simulate, reason, called_for_by: by.iter().take(5).cloned().collect(), rays, bytes }
    }

    /// An effect that costs no rays: it follows from the materials.
    fn drawn(&self, effect: Effect, by: &[String], yes: &str, no: &str) -> PlanRow {
        let simulate = allowed(self.settings, effect) && !by.is_empty();
        let reason = match (by.len(), allowed(self.settings, effect)) {
            (0, _) => no.to_owned(),
            (_, false) => "left out by --effects".to_owned(),
            (n, true) => format!("{n} {yes}"),
        };
        self.row(effect, simulate, reason, by, 0, 0)
    }

    fn visibility_reason(&self) -> String {
        let (shadowed, all) = (self.facts.shadowed, self.facts.receivers);
        if !allowed(self.settings, Effect::Visibility) {
            return "left out by --effects".to_owned();
        }
        match shadowed {
            0 => format!("nothing stands above any of the {all} receivers: closed form, no rays"),
            _ => format!("something stands above {shadowed} of {all} receivers; the others have a closed form"),
        }
    }

    fn interreflection_reason(&self, d: &Decisions) -> String {
        if !allowed(self.settings, Effect::Interreflection) {
            return "left out by --effects".to_owned();
        }
        if !d.visibility {
            return "no receiver sees a surface".to_owned();
        }
        if self.facts.reflecting.is_empty() {
            return "every surface is black".to_owned();
        }
        if self.settings.bounces == Bounces::Fixed(0) {
            return "--bounces 0".to_owned();
        }
        format!(
            "surfaces reflect {:.0} % on average: about {} bounces matter",
            100.0 * self.facts.mean_albedo,
            d.bounces
        )
    }

    fn color_reason(&self, d: &Decisions) -> String {
        if !allowed(self.settings, Effect::Color) {
            return "left out by --effects".to_owned();
        }
        if !d.interreflection {
            return "no bounces, so colour cannot enter: albedo is applied when drawn".to_owned();
        }
        match self.facts.colored.len() {
            0 => "every reflecting surface is grey: one channel holds all".to_owned(),
            n => format!("light bounces off {n} coloured materials: three channels"),
        }
    }
}
