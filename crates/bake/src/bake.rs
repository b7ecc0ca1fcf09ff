//! The bake: plan, first pass, backs, repair, bounces, file.

mod bounce;

use crate::account::account;
use crate::between;
use crate::bundle::{Baked, bundle};
use crate::cells::Cells;
use crate::directions::DirectionBank;
use crate::extras::{Done, Extras, FixedLight};
use crate::field::Field;
use crate::gather::{Gathered, Gatherer};
use crate::mirror::Mirrors;
use crate::passes::{Chunk, Monitor, gather_pass};
use crate::plan::{Prepared, prepare, simulates, tolerance};
use crate::progress::{Progress, Stage};
use crate::receivers::Receivers;
use crate::refine::{check_size, refined};
use crate::repair::{Finding, Repair, emerge};
use crate::summary::summarise;
use crate::wanted::Wanted;
use crate::{Error, settings};
use coeff_io::{Achieved, Bounces, Effect, Plan, Prt, Quality, Refine, RepairCounts, Settings};
use scene::Scene;
use sh_math::Bands;
use std::borrow::Cow;
use std::ops::ControlFlow;

/// Called while a bake runs; returning `Break` cancels it.
pub type ProgressFn<'a> = &'a (dyn Fn(&Progress) -> ControlFlow<()> + Sync);

/// Tolerances that a near surface must send on to get a receiver of its own.
pub(crate) const NEAR_WORTH: f32 = 8.0;

/// Decides which effects a scene calls for; bakes nothing.
///
/// # Errors
/// As [`bake`]; no rays are traced but those of a small survey, and of the look for edges to halve.
pub fn plan(scene: &Scene, settings: &Settings) -> Result<Plan, Error> {
    plan_with(scene, settings, &Extras::default())
}

/// [`plan`] for a bake with light maps or a volume.
///
/// # Errors
/// As [`plan`].
pub fn plan_with(scene: &Scene, settings: &Settings, extras: &Extras) -> Result<Plan, Error> {
    settings::check(settings)?;
    let scene = &*refined(scene, settings, &|_| ControlFlow::Continue(()))?;
    Ok(prepare(scene, settings, extras)?.plan)
}

/// Precomputes how every vertex of a scene answers to distant light.
///
/// The result is the same for any number of threads: each receiver's is a pure function of the scene, the settings
/// and its index.
///
/// # Errors
/// [`Error`] where the scene is empty or too large, a setting is out of range, memory does not suffice, or
/// `progress` asked to stop.
pub fn bake(scene: &Scene, settings: &Settings, progress: ProgressFn<'_>) -> Result<Prt, Error> {
    bake_with(scene, settings, &Extras::default(), progress)
}

/// [`bake`], and light maps or a volume from the same light between surfaces.
///
/// # Errors
/// As [`bake`].
pub fn bake_with(scene: &Scene, settings: &Settings, extras: &Extras, progress: ProgressFn<'_>) -> Result<Prt, Error> {
    settings::check(settings)?;
    bake_refined(&*refined(scene, settings, progress)?, settings, extras, progress)
}

/// [`bake_with`] of a scene that was split before under the same settings, as by [`crate::refine`]: it is not split again.
///
/// # Errors
/// As [`bake`].
pub fn bake_refined(
    scene: &Scene,
    settings: &Settings,
    extras: &Extras,
    progress: ProgressFn<'_>,
) -> Result<Prt, Error> {
    settings::check(settings)?;
    check_size(scene)?;
    let (prt, ()) = bake_then(scene, settings, extras, progress, |done, prt| done.add(extras, prt))?;
    Ok(prt)
}

/// Bakes the vertices of a scene that is split, and hands what is known by then to `then`.
pub(crate) fn bake_then<T>(
    scene: &Scene,
    settings: &Settings,
    extras: &Extras,
    progress: ProgressFn<'_>,
    then: impl FnOnce(&Done<'_>, &mut Prt) -> Result<T, Error>,
) -> Result<(Prt, T), Error> {
    let monitor = Monitor::new(progress);
    monitor.begin(Stage::Preparation, 1);
    monitor.check()?;
    let prepared = prepare(scene, settings, extras)?;
    if let Some(volume) = &extras.volume {
        crate::volume::check(volume, scene, &prepared, settings, extras.light.is_some())?;
    }
    if let Some(maps) = &extras.maps {
        let receivers = prepared.receivers.list.len();
        crate::maps::check(maps, scene, &prepared.plan, receivers, settings, extras.light.is_some())?;
    }
    extras.check_textures(scene)?;
    extras.check_light(prepared.plan.bands)?;
    let Prepared { mut world, receivers, plan, traced } = prepared;
    if settings.refine != Refine::Auto && simulates(&plan, Effect::Interreflection) {
        world.cells = Cells::of(&world);
    }
    let bands = Bands::new(plan.bands).expect("no more than the settings ask for");
    // Where nothing is traced no directions are needed: the smallest set stands in.
    let quality = if traced.is_empty() { Quality::Rays(settings::MIN_STRATIFIED) } else { settings.quality };
    let bank = DirectionBank::new(bands, &Settings { quality, ..settings.clone() });
    let glossy = simulates(&plan, Effect::Glossy);
    // Where no light bounces none is mirrored on its way.
    let mirrors = match glossy && simulates(&plan, Effect::Interreflection) {
        true => Some(Mirrors::find(&world, &receivers, settings, bands, &monitor)?),
        false => None,
    };
    let gatherer = Gatherer {
        world: &world,
        bank: &bank,
        bands,
        quality: settings.quality,
        visibility: simulates(&plan, Effect::Visibility),
        hits: simulates(&plan, Effect::Interreflection),
        permanent: receivers.permanent as u32,
        worth: NEAR_WORTH * tolerance(settings.quality),
        mirrors: mirrors.as_ref(),
    };
    let mut run = Run::new(gatherer, receivers, settings, plan, monitor)?;
    run.light = extras.light.as_ref().filter(|_| glossy);
    let (mut prt, more) = run.finish(scene, extras, then)?;
    prt.achieved.effects = account(scene, &prt, traced.len() as u64);
    Ok((prt, more))
}

/// A bake under way.
struct Run<'a> {
    gatherer: Gatherer<'a>,
    receivers: Receivers,
    settings: &'a Settings,
    plan: Plan,
    monitor: Monitor<'a>,
    /// Transfer of the bounce before; after the first pass the direct one.
    last: Field,
    findings: Vec<Finding>,
    errors: Vec<f32>,
    achieved: Achieved,
    /// Bytes left for what receivers see; where they run out, each bounce finds it again.
    room: u64,
    /// Where surfaces shine: the direct transfer, and what they mirror of light that falls on them straight.
    direct: Option<Field>,
    glints: Option<Field>,
    /// The light that goes into gloss, where one is fixed.
    light: Option<&'a FixedLight>,
    /// Under it, per bounce from none on: the radiance of every receiver for albedo 1, RGB.
    radiance: Vec<Vec<[f32; 3]>>,
}

impl<'a> Run<'a> {
    fn new(
        gatherer: Gatherer<'a>,
        receivers: Receivers,
        settings: &'a Settings,
        plan: Plan,
        monitor: Monitor<'a>,
    ) -> Result<Self, Error> {
        let (n, coefficients, channels) = (receivers.list.len(), gatherer.bands.coefficients(), plan.channels as usize);
        let mut run = Self {
            last: Field::zeros(0, coefficients, channels),
            findings: vec![Finding::default(); n],
            errors: vec![0.0; n],
            achieved: Achieved::default(),
            room: 0,
            monitor,
            direct: None,
            glints: None,
            light: None,
            radiance: Vec::new(),
            gatherer,
            receivers,
            settings,
            plan,
        };
        run.check_memory()?;
        run.last.grow(n);
        Ok(run)
    }

    fn finish<T>(
        mut self,
        scene: &Scene,
        extras: &Extras,
        then: impl FnOnce(&Done<'_>, &mut Prt) -> Result<T, Error>,
    ) -> Result<(Prt, T), Error> {
        let all = (0..self.receivers.list.len() as u32).collect();
        self.room = self.settings.memory.saturating_sub(self.field_bytes());
        let mut chunks = self.first_pass(all, Stage::Visibility)?;
        chunks.extend(self.move_out(scene)?);
        let repair = Repair::plan(scene, &self.receivers, &self.findings);
        self.achieved.repairs = RepairCounts { inside: self.achieved.repairs.inside, ..repair.counts };
        repair.apply(&mut self.last);
        between::measure(
            &self.gatherer,
            &self.receivers,
            &self.last,
            &self.monitor,
            self.settings.seed,
            &mut self.achieved,
        )?;
        let mut transfer = self.last.clone();
        self.direct = self.gatherer.mirrors.map(|_| self.last.clone());
        if self.gatherer.hits {
            chunks.extend(self.add_helpers()?);
            // The helpers made the fields larger.
            let mut room = self.settings.memory.saturating_sub(self.field_bytes());
            chunks.iter_mut().for_each(|chunk| chunk.keep_within(&mut room));
            transfer.grow(self.receivers.list.len());
            if let Some(direct) = &mut self.direct {
                // Backs and near points joined in.
                direct.clone_from(&self.last);
            }
            self.note_radiance();
            self.bounce(&chunks, &repair, &mut transfer)?;
        }
        // What follows needs the memory.
        drop(chunks);
        let mut openness: Vec<f32> = self.findings[..self.receivers.permanent].iter().map(|f| f.openness).collect();
        repair.apply_scalar(&mut openness);
        if openness.iter().all(|&o| o >= 1.0) {
            openness.clear();
        }
        summarise(&repair, self.receivers.permanent, &self.errors, &mut self.achieved);
        let (plan, achieved) = (self.plan.clone(), std::mem::take(&mut self.achieved));
        let mut prt = bundle(
            scene,
            &self.receivers,
            self.settings,
            Baked { transfer: &transfer, openness, plan, achieved, extras },
        );
        // What is sent on reaches texels and probes one bounce later: as many bounces as were asked for, or all.
        let used = !extras.is_empty() || self.gatherer.mirrors.is_some();
        let sent = match (self.settings.bounces, !used) {
            (Bounces::Fixed(1..), false) if self.gatherer.hits => Cow::Owned(transfer.without(&self.last)),
            _ => Cow::Borrowed(&transfer),
        };
        let more = then(&self.done(scene, [&transfer, &sent], &repair, extras), &mut prt)?;
        Ok((prt, more))
    }

    fn done<'b>(
        &'b self,
        scene: &'b Scene,
        [transfer, sent]: [&'b Field; 2],
        repair: &'b Repair,
        extras: &'b Extras,
    ) -> Done<'b> {
        Done {
            scene,
            gatherer: &self.gatherer,
            receivers: &self.receivers,
            transfer,
            sent,
            settings: self.settings,
            plan: &self.plan,
            light: extras.light.as_ref(),
            direct: self.direct.as_ref(),
            radiance: &self.radiance,
            repair,
            monitor: &self.monitor,
        }
    }

    /// Receivers inside bodies or under shells look again from where their surface comes out.
    fn move_out(&mut self, scene: &Scene) -> Result<Vec<Chunk>, Error> {
        let findings = &self.findings[..self.receivers.permanent];
        self.achieved.repairs.inside = findings.iter().filter(|finding| finding.is_inside()).count() as u32;
        let moved = emerge(scene, self.gatherer.world, &self.receivers, findings);
        if moved.is_empty() {
            return Ok(Vec::new());
        }
        let ids = moved.iter().map(|&(id, _)| id).collect();
        for (id, position) in moved {
            self.receivers.list[id as usize].position = position;
        }
        self.first_pass(ids, Stage::Helpers)
    }

    /// Bytes that the fields take: where there are bounces the one before, the next, and the sum.
    fn field_bytes(&self) -> u64 {
        let gloss = if self.gatherer.mirrors.is_some() { 2 } else { 0 };
        let fields = if self.gatherer.hits { 3 } else { 1 } + gloss;
        fields * Field::bytes(self.receivers.list.len(), self.last.coefficients, self.last.channels)
    }

    fn check_memory(&self) -> Result<(), Error> {
        let (needed, allowed) = (self.field_bytes(), self.settings.memory);
        if needed > allowed {
            return Err(Error::Memory { receivers: self.receivers.list.len(), needed, allowed });
        }
        Ok(())
    }

    /// What the given receivers see directly; those that they want beside them are added to the list.
    fn first_pass(&mut self, ids: Vec<u32>, stage: Stage) -> Result<Vec<Chunk>, Error> {
        let (last, findings, errors) = (&mut self.last, &mut self.findings, &mut self.errors);
        let achieved = &mut self.achieved;
        let (glints, world) = (&mut self.glints, self.gatherer.world);
        let mut wanted = Wanted { worth: tolerance(self.settings.quality), ..Wanted::default() };
        let mut sink = |id: u32, seen: &Gathered| {
            last.set_direct(id, &seen.transfer, &seen.tinted);
            let finding = seen.finding();
            findings[id as usize] = finding;
            errors[id as usize] = seen.error;
            achieved.visibility_rays += seen.visibility_rays;
            achieved.bounce_rays += seen.bounce_rays;
            if !seen.glint.is_empty() {
                let (coefficients, channels) = (last.coefficients, last.channels);
                let glints = glints.get_or_insert_with(|| Field::zeros(0, coefficients, channels));
                glints.grow((id as usize + 1).max(glints.len()));
                glints.set(id, &seen.glint);
            } else if let Some(glints) = glints.as_mut().filter(|glints| (id as usize) < glints.len()) {
                // It looked before, from where it was moved away.
                glints.row_mut(id).fill(0.0);
            }
            if !finding.is_covered() {
                wanted.note(id, seen, world);
            }
        };
        let chunks =
            gather_pass(&self.gatherer, &self.receivers, ids, stage, &mut self.room, &self.monitor, &mut sink)?;
        wanted.add_to(&mut self.receivers, world);
        self.check_memory()?;
        let n = self.receivers.list.len();
        self.last.grow(n);
        self.findings.resize(n, Finding::default());
        self.errors.resize(n, 0.0);
        Ok(chunks)
    }

    /// What light reaches beside the receivers of the file becomes receivers for the time of the bake, until none is new:
    /// near points, and the backs of surfaces. Where backs send less than the tolerance, the fronts stand in for them.
    fn add_helpers(&mut self) -> Result<Vec<Chunk>, Error> {
        let mut chunks = Vec::new();
        let mut done = self.receivers.permanent as u32;
        while (done as usize) < self.receivers.list.len() {
            let new = (done..self.receivers.list.len() as u32).collect();
            done = self.receivers.list.len() as u32;
            chunks.extend(self.first_pass(new, Stage::Helpers)?);
        }
        self.gatherer.world.cells.complete(self.gatherer.world, &mut self.receivers);
        Ok(chunks)
    }

    /// Largest norm of a receiver's row that goes into the file, against an open receiver's.
    fn largest_norm(&self, field: &Field) -> f64 {
        (0..self.receivers.permanent as u32).map(|r| field.norm(r)).fold(0.0, f64::max) / self.gatherer.bank.open_norm
    }
}
