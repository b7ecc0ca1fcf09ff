//! What surfaces that shine need, at vertices or at texels; and transfer in textures.
//!
//! Receivers of gloss keep the visibility of their hemisphere, without a cosine, and what the surfaces that block the rest send: for every
//! coefficient of the light, or under one light as the paper has it.

mod direct;
pub(crate) mod fixed;
mod levels;
mod row;
mod settings;
mod sheets;
mod tables;

use crate::arrival::{Arrival, Arrivals};
use crate::compress::Sketch;
use crate::domain::Domain;
use crate::error::Error;
use crate::extras::{Done, Extras};
use crate::maps::{arrive_as, receiver};
use crate::mirror::{self, shining};
use crate::plan::simulates;
use crate::progress::Stage;
use crate::receivers::{NONE, Receiver};
use coeff_io::{Bounced, Effect, GlossRecord, Prt};
use direct::Direct;
use fixed::FixedBounces;
use row::{Bouncing, Layout, RowMaker};
pub use settings::{Compression, TextureSettings};
use sh_math::light_matrix::LightProduct;
use sh_math::{Bands, Rgb};
use sheets::SheetPlan;
use std::collections::BTreeMap;

/// Receivers that a sketch is learned from.
const SAMPLE: usize = 1024;
/// Numbers of a row of bounces up to which it is kept in full.
const SHORT: usize = 16;
/// Least bands over directions: what the cosine of diffuse transfer needs.
const DIFFUSE_BANDS: u32 = 3;

/// Bakes what the plan calls for of it into the file.
pub(crate) fn bake(done: &Done<'_>, extras: &Extras, prt: &mut Prt) -> Result<(), Error> {
    let glossy = simulates(done.plan, Effect::Glossy);
    if !glossy && extras.textures.is_none() {
        return Ok(());
    }
    let light = Bands::new(done.plan.bands).expect("no more than the settings ask for");
    let gloss = mirror::bands(light);
    let functions = gloss.max(Bands::new(DIFFUSE_BANDS).expect("three bands"));
    let bank = done.bank(Domain::Hemisphere, functions);
    let mut arrivals = done.relightable(&bank, functions);
    arrivals.apart = true;
    let job = Job { done, arrivals: &arrivals, extras, glossy, gloss, light };
    job.run(functions, prt)
}

/// A bake of gloss and textures.
struct Job<'a> {
    done: &'a Done<'a>,
    arrivals: &'a Arrivals<'a>,
    extras: &'a Extras,
    glossy: bool,
    gloss: Bands,
    light: Bands,
}

impl Job<'_> {
    fn run(&self, functions: Bands, prt: &mut Prt) -> Result<(), Error> {
        let channels = self.arrivals.shape().channels;
        let maker = |bouncing| RowMaker { functions, gloss: self.gloss, light: self.light, channels, bouncing };
        let whole = maker(if self.bounces() { Bouncing::Whole } else { Bouncing::None });
        let mut plans = match &self.extras.textures {
            Some(settings) => sheets::plan(self.done, settings, &|_| Layout::default()),
            None => Vec::new(),
        };
        plans.retain(|plan| !plan.texels.is_empty());
        let vertices = self.vertices(&plans);
        let mut record = GlossRecord::default();
        record.rays[0] += self.done.gatherer.mirrors.map_or(0, |mirrors| mirrors.rays);
        let (fixed, sketch);
        let mut bounced_share = 1.0;
        let bouncing = match self.extras.light.as_ref().filter(|_| self.bounces()) {
            Some(light) => {
                fixed = self.follow(&light.coefficients)?;
                Bouncing::Fixed(&fixed)
            }
            None if !self.bounces() => Bouncing::None,
            None if whole.long() <= SHORT || self.extras.compression.bounces <= 0.0 => Bouncing::Whole,
            None => {
                self.check_sample(
                    &whole,
                    vertices.ids.len() + plans.iter().map(|plan| plan.texels.len()).sum::<usize>(),
                )?;
                (sketch, bounced_share) = self.sketch(&whole, &plans, &vertices)?;
                Bouncing::Sketched(&sketch)
            }
        };
        let maker = maker(bouncing);
        let shines = shining(self.done.scene);
        for plan in &mut plans {
            let shiny = plan.settings.meshes.iter().any(|&m| shines[self.done.scene.meshes[m].material as usize]);
            plan.layout = maker.layout(true, self.glossy && shiny);
        }
        self.check_memory(&maker, &plans, vertices.ids.len())?;
        let mut lost = [0.0; 2];
        let rows = self.vertex_rows(&maker, &vertices, &mut record, &mut lost)?;
        let baked = match &self.extras.textures {
            Some(settings) => sheets::bake(self.done, self.arrivals, &maker, settings, &plans, &mut record, &mut lost)?,
            None => Vec::new(),
        };
        self.done.monitor.check()?;
        let bounced = self.bounced(&maker);
        let sketched = if lost[1] > 0.0 { (lost[0] / lost[1]).sqrt() as f32 } else { 0.0 };
        let found = tables::Found { plans, baked, vertices, rows, bounced, sketched, bounced_share };
        tables::write(self, &maker, found, record, prt);
        Ok(())
    }

    /// Whether surfaces send light to those that shine.
    fn bounces(&self) -> bool {
        self.done.gatherer.mirrors.is_some()
            && self.done.gatherer.hits
            && self.done.settings.bounces != coeff_io::Bounces::Fixed(0)
    }

    fn bounced(&self, maker: &RowMaker<'_>) -> Option<Bounced> {
        match &maker.bouncing {
            Bouncing::None => None,
            Bouncing::Whole | Bouncing::Sketched(_) => {
                Some(Bounced::Relightable { bands: self.light.count() as u32, channels: maker.channels as u32 })
            }
            Bouncing::Fixed(fixed) => {
                let light = self.extras.light.as_ref()?;
                Some(Bounced::Fixed {
                    probe: light.name.clone(),
                    light: light.coefficients[..self.light.coefficients()].to_vec(),
                    // Set once the materials of the file stand.
                    materials: 0,
                    bounces: fixed.tables() as u32,
                })
            }
        }
    }

    /// Follows fixed light over the vertices that shine.
    fn follow(&self, light: &[[f32; 3]]) -> Result<FixedBounces<'_>, Error> {
        let mirrors = self.done.gatherer.mirrors.expect("found where gloss is simulated");
        let wanted = LightProduct::light_bands(mirrors.bands);
        // A light of fewer bands is black in the others.
        let held = Bands::new((light.len() as f64).sqrt() as u32).unwrap_or(wanted);
        let rgb = Rgb { bands: held, values: light[..held.coefficients()].to_vec() };
        let bounces = match self.done.settings.bounces {
            coeff_io::Bounces::Fixed(n) => n,
            coeff_io::Bounces::Auto => u32::MAX,
        };
        FixedBounces::follow(self.done, mirrors, self.arrivals, &rgb.with_bands(wanted), bounces)
    }

    /// Receivers at vertices: of meshes that shine and lie on no sheet, and the backs of such.
    fn vertices(&self, plans: &[SheetPlan]) -> Vertices {
        let (scene, receivers) = (self.done.scene, self.done.receivers);
        let shines = shining(scene);
        let mapped = |mesh: usize| plans.iter().any(|plan| plan.settings.meshes.contains(&mesh));
        let mut all = Vertices { first_row: Vec::new(), ids: Vec::new() };
        let (mut backs, mut first) = (Vec::new(), 0u32);
        for (index, mesh) in scene.meshes.iter().enumerate() {
            let n = mesh.positions.len() as u32;
            let shines = self.glossy && shines[mesh.material as usize];
            let own = first..first + n;
            all.add(own.clone(), shines && !mapped(index));
            if scene.materials[mesh.material as usize].double_sided {
                backs.push((own.map(|v| receivers.back_of[v as usize]).collect::<Vec<u32>>(), shines));
            }
            first += n;
        }
        for (ids, shines) in backs {
            all.add(ids.into_iter(), shines);
        }
        all
    }

    fn vertex_rows(
        &self,
        maker: &RowMaker<'_>,
        vertices: &Vertices,
        record: &mut GlossRecord,
        lost: &mut [f64; 2],
    ) -> Result<Vec<f32>, Error> {
        let layout = maker.layout(false, true);
        let points = vertices.points(self.done);
        record.vertices = points.len() as u64;
        let keep = |k: usize, arrival: Arrival| {
            let rays = [arrival.visibility_rays, arrival.bounce_rays];
            let row = maker.make(layout, &arrival, points[k].normal);
            let lost = maker.lost(layout, &arrival, &row);
            (row, rays, lost)
        };
        let found = arrive_as(self.done, self.arrivals, (&points, Stage::Gloss), &|k| vertices.ids[k], &keep)?;
        for (_, rays, own) in &found {
            record.rays = [record.rays[0] + rays[0], record.rays[1] + rays[1]];
            *lost = [lost[0] + own[0], lost[1] + own[1]];
        }
        let mut rows: Vec<f32> = found.into_iter().flat_map(|(row, _, _)| row).collect();
        let row_of: BTreeMap<u32, usize> = vertices.ids.iter().enumerate().map(|(row, &id)| (id, row)).collect();
        self.done.repair.apply_rows(&mut rows, layout.len(), &|id| row_of.get(&id).copied());
        Ok(rows)
    }

    /// Learns what rows of bounces have in common from receivers spread evenly over all; and what share of all that arrives, root mean square, they are.
    fn sketch(&self, whole: &RowMaker<'_>, plans: &[SheetPlan], vertices: &Vertices) -> Result<(Sketch, f32), Error> {
        let shines = shining(self.done.scene);
        let mut points = vertices.points(self.done);
        let mut seeds: Vec<u32> = vertices.ids.clone();
        let mut first_index = 0u32;
        for plan in plans {
            let shiny = plan.settings.meshes.iter().any(|&m| shines[self.done.scene.meshes[m].material as usize]);
            if shiny {
                points.extend(plan.texels.iter().map(|texel| receiver(self.done, texel)));
                seeds.extend((0..plan.texels.len()).map(|k| sheets::seed(first_index, plan, k)));
            }
            first_index = first_index.wrapping_add(plan.settings.width * plan.settings.height);
        }
        let count = points.len().min(SAMPLE);
        let pick = |k: usize| (2 * k + 1) * points.len() / (2 * count);
        let sample: Vec<Receiver> = (0..count).map(|k| points[pick(k)]).collect();
        let direct = Direct::new(self.gloss, self.light);
        let visible = self.gloss.coefficients();
        let keep = |_: usize, arrival: Arrival| {
            (arrival.bounced[..whole.long()].to_vec(), direct.energy(&arrival.visibility[..visible]))
        };
        let found = arrive_as(self.done, self.arrivals, (&sample, Stage::Gloss), &|k| seeds[pick(k)], &keep)?;
        let straight = whole.channels as f64 * found.iter().map(|(_, energy)| energy).sum::<f64>();
        let rows: Vec<f32> = found.into_iter().flat_map(|(row, _)| row).collect();
        let bounced: f64 = rows.iter().map(|x| f64::from(*x) * f64::from(*x)).sum();
        let share = if bounced > 0.0 { (bounced / (bounced + straight)).sqrt() as f32 } else { 1.0 };
        // Of the bounces alone more may be lost, the less they are.
        Ok((Sketch::learn(&rows, whole.long(), 0.5 * self.extras.compression.bounces / share), share))
    }

    /// Refuses what does not fit into the memory allowed.
    fn check_memory(&self, maker: &RowMaker<'_>, plans: &[SheetPlan], vertices: usize) -> Result<(), Error> {
        let texels: usize = plans.iter().map(|plan| plan.texels.len()).sum();
        let numbers: usize = plans.iter().map(|plan| plan.texels.len() * plan.layout.len()).sum();
        let at_vertices = vertices * maker.layout(false, true).len();
        // While seams are stitched the rows are there twice, and levels and rings take half as many again; clusters are made of copies.
        let copies = if self.extras.compression.rows.is_some() { 6 } else { 3 };
        self.allow(4 * (copies * numbers + 2 * at_vertices) as u64, texels + vertices)
    }

    /// Refuses where the rows that a sketch is learned from do not fit, beside their copy.
    fn check_sample(&self, whole: &RowMaker<'_>, receivers: usize) -> Result<(), Error> {
        self.allow((8 * receivers.min(SAMPLE) * whole.long()) as u64, receivers)
    }

    fn allow(&self, needed: u64, texels: usize) -> Result<(), Error> {
        let allowed = self.done.settings.memory;
        if needed > allowed { Err(Error::MapMemory { texels, needed, allowed }) } else { Ok(()) }
    }
}

/// Receivers of gloss at vertices.
struct Vertices {
    /// Of each mesh of the file.
    first_row: Vec<Option<u32>>,
    ids: Vec<u32>,
}

impl Vertices {
    fn add(&mut self, ids: impl Iterator<Item = u32>, shines: bool) {
        self.first_row.push(shines.then_some(self.ids.len() as u32));
        if shines {
            self.ids.extend(ids.inspect(|&id| debug_assert!(id != NONE)));
        }
    }

    fn points(&self, done: &Done<'_>) -> Vec<Receiver> {
        self.ids.iter().map(|&id| done.receivers.list[id as usize]).collect()
    }
}
