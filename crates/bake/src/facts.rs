//! Facts about a scene that decisions rest on: materials, and what stands above which receiver.

use crate::material;
use crate::plan::{allowed, tolerance};
use crate::receivers::Receivers;
use crate::world::World;
use coeff_io::{Effect, Settings};
use rayon::prelude::*;
use scene::{Scene, TextureSlot};
use std::collections::BTreeSet;

/// Some objects by name.
#[derive(Debug, Default)]
pub(crate) struct Named {
    pub(crate) names: Vec<String>,
}

impl Named {
    pub(crate) fn any(&self) -> bool {
        !self.names.is_empty()
    }

    pub(crate) fn count(&self) -> usize {
        self.names.len()
    }
}

/// What a plan knows of one mesh.
#[derive(Debug)]
pub(crate) struct MeshFacts {
    pub(crate) name: String,
    pub(crate) material: usize,
    pub(crate) receivers: u64,
    pub(crate) shadowed: u64,
    /// Whether it neither scatters nor mirrors light.
    pub(crate) dark: bool,
}

/// Everything that decisions rest on but the survey.
#[derive(Debug)]
pub(crate) struct Facts {
    pub(crate) materials: Vec<material::Facts>,
    pub(crate) meshes: Vec<MeshFacts>,
    pub(crate) receivers: u64,
    pub(crate) shadowed: u64,
    pub(crate) dark: u64,
    /// Of each permanent receiver: whether something stands above it.
    above: Vec<bool>,
    /// Diffuse albedo of surfaces that block light or a part of it: mean over their area, and largest.
    pub(crate) mean_albedo: f32,
    pub(crate) largest_albedo: f32,
    /// Materials.
    pub(crate) reflecting: Named,
    pub(crate) colored: Named,
    /// Those that tint the light that passes through them.
    pub(crate) stained: Named,
    pub(crate) masked: Named,
    pub(crate) holed: Named,
    pub(crate) shiny: Named,
    /// Those that mirror light in their colour.
    pub(crate) tinted: Named,
    /// Those with normal maps that show: all that shine, with directional light maps all, and those that bend by more than the tolerance.
    pub(crate) bumpy: Named,
    /// Whether normal maps bend diffuse light.
    pub(crate) directional: bool,
    /// Whether a volume is asked for.
    pub(crate) volume: bool,
    /// Number of materials whose normal maps bend too little to show.
    pub(crate) idle_bumps: usize,
    pub(crate) emissive: Named,
    pub(crate) transmissive: Named,
    /// Meshes.
    pub(crate) moving: Named,
    /// Bytes of the textures that only one effect shows.
    pub(crate) gloss_bytes: u64,
    pub(crate) bump_bytes: u64,
    pub(crate) glow_bytes: u64,
}

impl Facts {
    /// Looks at every material; receivers are still to be added. Where the settings leave transmission out, all blocks.
    pub(crate) fn of_materials(scene: &Scene, settings: &Settings, directional: bool) -> Self {
        let mut materials: Vec<material::Facts> =
            (0..scene.materials.len()).map(|m| material::Facts::of(scene, m)).collect();
        if !allowed(settings, Effect::Transmission) {
            for m in materials.iter_mut().filter(|m| m.transmits) {
                (m.blocks, m.translucent, m.stains, m.opacity) = (true, false, false, 1.0);
            }
        }
        let named = |test: &dyn Fn(&material::Facts) -> bool| {
            let pairs = scene.materials.iter().zip(&materials).filter(|(_, facts)| test(facts));
            Named { names: pairs.map(|(m, _)| m.name.clone()).collect() }
        };
        let textures = |slot: &dyn Fn(usize) -> Option<TextureSlot>| texture_bytes(scene, slot);
        let (of, all) = (&materials, &scene.materials);
        let least = tolerance(settings.quality);
        let bends = |m: &material::Facts| m.bumpy && (m.shines || directional || m.bend > least);
        let scattering = || materials.iter().filter(|m| m.scatters());
        Self {
            meshes: Vec::new(),
            receivers: 0,
            shadowed: 0,
            dark: 0,
            above: Vec::new(),
            mean_albedo: mean_albedo(scene, &materials),
            largest_albedo: scattering().map(|m| m.albedo.largest).fold(0.0, f32::max),
            reflecting: named(&|m| m.scatters() && m.albedo.largest > 0.0),
            colored: named(&|m| m.scatters() && m.albedo.colored),
            stained: named(&|m| m.stains),
            masked: named(&|m| m.masked),
            holed: named(&|m| m.holes > 0.0),
            shiny: named(&|m| m.shines),
            tinted: named(&|m| m.tinted),
            bumpy: named(&bends),
            directional,
            volume: false,
            idle_bumps: materials.iter().filter(|m| m.bumpy && !bends(m)).count(),
            emissive: named(&|m| m.emission > 0.0),
            transmissive: named(&|m| m.transmits),
            moving: Named { names: scene.moving.clone() },
            // Metal needs this texture with or without a reflection, to know where it scatters nothing.
            gloss_bytes: textures(&|m| {
                all[m].metallic_roughness_texture.filter(|_| of[m].shines && all[m].metallic <= 0.0)
            }),
            bump_bytes: textures(&|m| all[m].normal_texture.filter(|_| of[m].bumpy)),
            glow_bytes: textures(&|m| all[m].emissive_texture.filter(|_| of[m].emission > 0.0)),
            materials,
        }
    }

    /// Receivers at vertices of surfaces that shine.
    pub(crate) fn shiny_receivers(&self) -> u64 {
        self.meshes.iter().filter(|mesh| self.materials[mesh.material].shines).map(|mesh| mesh.receivers).sum()
    }

    /// Largest reflectance at normal incidence of a material that shines.
    pub(crate) fn reflectance(&self) -> f32 {
        self.materials.iter().filter(|m| m.shines).map(|m| m.reflectance).fold(0.0, f32::max)
    }

    /// Looks at every permanent receiver through the tree.
    pub(crate) fn add_receivers(&mut self, scene: &Scene, world: &World<'_>, receivers: &Receivers) {
        let shadowed: Vec<bool> =
            receivers.list[..receivers.permanent].par_iter().map(|r| world.anything_above(r)).collect();
        let count = |range: std::ops::Range<usize>| shadowed[range].iter().filter(|&&s| s).count() as u64;
        let (mut front, mut back) = (0, receivers.vertices);
        for mesh in &scene.meshes {
            let n = mesh.positions.len();
            let two_sided = scene.materials[mesh.material as usize].double_sided;
            let backs = back..back + if two_sided { n } else { 0 };
            self.meshes.push(MeshFacts {
                name: mesh.name.clone(),
                material: mesh.material as usize,
                receivers: (n + backs.len()) as u64,
                shadowed: count(front..front + n) + count(backs.clone()),
                dark: false,
            });
            (front, back) = (front + n, backs.end);
        }
        self.receivers = receivers.permanent as u64;
        self.shadowed = count(0..receivers.permanent);
        self.above = shadowed;
    }

    /// Whether something stands above a permanent receiver.
    pub(crate) fn is_shadowed(&self, receiver: u32) -> bool {
        self.above[receiver as usize]
    }

    /// Marks the receivers of surfaces that neither scatter nor mirror light: what reaches them shows nowhere.
    pub(crate) fn mark_dark(
        &mut self,
        scene: &Scene,
        receivers: &mut Receivers,
        shows_light: &dyn Fn(&material::Facts) -> bool,
    ) {
        let mut front = 0;
        for (mesh, facts) in scene.meshes.iter().zip(&mut self.meshes) {
            let n = mesh.positions.len();
            if !shows_light(&self.materials[facts.material]) {
                facts.dark = true;
                self.dark += facts.shadowed;
                for vertex in front..front + n {
                    let back = receivers.back_of[vertex];
                    receivers.list[vertex].dark = true;
                    if let Some(back) = receivers.list.get_mut(back as usize) {
                        back.dark = true;
                    }
                }
            }
            front += n;
        }
    }
}

fn mean_albedo(scene: &Scene, materials: &[material::Facts]) -> f32 {
    let (mut area, mut sum) = (0.0f64, 0.0f64);
    for mesh in &scene.meshes {
        let facts = &materials[mesh.material as usize];
        if !facts.scatters() {
            continue;
        }
        let own: f64 = (0..mesh.triangles.len()).map(|t| mesh.area(t)).sum();
        let mesh_area = own * f64::from(facts.opacity);
        area += mesh_area;
        sum += mesh_area * f64::from(facts.albedo.mean);
    }
    if area > 0.0 { (sum / area) as f32 } else { 0.0 }
}

/// Bytes of the textures that a slot of the materials names, each counted once.
pub(crate) fn texture_bytes(scene: &Scene, slot: &dyn Fn(usize) -> Option<TextureSlot>) -> u64 {
    let used: BTreeSet<u32> = (0..scene.materials.len()).filter_map(|m| slot(m).map(|s| s.texture)).collect();
    used.iter().map(|&t| 4 * scene.textures[t as usize].rgba.len() as u64).sum()
}
