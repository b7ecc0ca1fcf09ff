//! The study itself: short bakes, prediction, reference, sweep, and what follows from them.

use super::bakes::{Bakes, Timed};
use super::deviation::{Deviation, Spread, Truth};
use super::format::Format;
use super::predict::{Check, Pilot, Predictor};
use super::recommend::{Advice, Goal, advise};
use super::report::{Knob, Report, Run, View, WorstReceiver};
use super::resolution::{self, Resolution};
use super::trials::{self, Turn, bake_of, level};
use super::truth::{Reference, came, reference};
use super::{Error, ProgressFn, Request, frames, front, views};
use coeff_io::{Prt, Quality, Refine, Settings, Transfer};

/// Rays of the first short bake.
const FEW_RAYS: u32 = 64;
/// Receivers in the list of the worst.
const WORST: usize = 10;
/// Maps on the page.
const MAPS: usize = 3;
/// Share of the budget below which no finer mesh is begun.
const RESOLUTION_SHARE: f64 = 0.5;

/// Bakes a scene again and again, one knob turned at a time, and compares what comes with a converged bake.
///
/// # Errors
/// [`Error`] where a bake or a picture fails, or `progress` asked to stop.
pub fn study(request: &Request<'_>, progress: ProgressFn<'_>) -> Result<Report, Error> {
    let mut bakes = Bakes::new(request.scene, request.budget, progress);
    let mut sweep = Sweep { request, baked: Vec::new(), prt: None, left_out: Vec::new(), check: None };
    let predictor = sweep.pilots(&mut bakes)?;
    let reference = reference(request, &predictor, &mut bakes)?;
    sweep.trials(&predictor, &mut bakes)?;
    let resolution = sweep.resolution(&predictor, &reference.truth, &mut bakes)?;
    sweep.report(reference, resolution, &bakes)
}

/// A run before it is compared, and its coefficients.
struct Baked {
    run: Run,
    transfer: Transfer,
}

/// Everything baked so far.
struct Sweep<'a> {
    request: &'a Request<'a>,
    baked: Vec<Baked>,
    /// The bake as asked, or the last short one, and its index.
    prt: Option<(usize, Prt)>,
    left_out: Vec<String>,
    check: Option<Check>,
}

impl Sweep<'_> {
    /// Three short bakes, from which the time of others is predicted.
    fn pilots(&mut self, bakes: &mut Bakes<'_>) -> Result<Predictor, Error> {
        let fine = level(4.0 * self.request.targets.error);
        let mut pilot = |turn: Turn| {
            let (knob, setting, settings) = bake_of(self.request, turn);
            let timed = bakes.bake(&setting, &settings)?;
            let pilot = Pilot::of(&timed);
            self.keep(knob, setting, timed);
            Ok::<_, Error>(pilot)
        };
        let [few, coarse] = [pilot(Turn::Rays(FEW_RAYS))?, pilot(Turn::Error(1.0))?];
        let fine_pilot = pilot(Turn::Error(fine))?;
        Ok(Predictor::new(few, coarse, fine_pilot, f64::from(fine)))
    }

    /// Every further bake that the budget allows.
    fn trials(&mut self, predictor: &Predictor, bakes: &mut Bakes<'_>) -> Result<(), Error> {
        for (index, trial) in trials::trials(self.request, predictor).into_iter().enumerate() {
            // The first one is the bake as asked.
            let name = format!("the bake as asked: {}", trial.setting);
            if trial.estimate.seconds > bakes.left() {
                let (needed, left) = (trial.estimate.seconds, bakes.left().max(0.0));
                self.left_out
                    .push(format!("{}: it would take about {needed:.1} s of the {left:.1} s left", trial.setting));
                if index == 0 {
                    self.check = Some(Check { name, predicted: trial.estimate, came: None });
                }
                continue;
            }
            let timed = bakes.bake(&trial.setting, &trial.settings)?;
            if index == 0 {
                self.check = Some(Check { name, predicted: trial.estimate, came: Some(came(&timed)) });
            }
            self.keep(trial.knob, trial.setting, timed);
        }
        Ok(())
    }

    fn keep(&mut self, knob: Knob, setting: String, timed: Timed) {
        let as_asked = timed.prt.settings.quality == Quality::Error(self.request.targets.error) && knob == Knob::Error;
        let run = run_of(knob, setting, &timed);
        let transfer = if as_asked || self.baked.len() < 3 {
            self.prt.insert((self.baked.len(), timed.prt)).1.transfer.clone()
        } else {
            timed.prt.transfer
        };
        self.baked.push(Baked { run, transfer });
    }

    /// Bakes of coarser and finer meshes.
    fn resolution(
        &mut self,
        predictor: &Predictor,
        truth: &Truth,
        bakes: &mut Bakes<'_>,
    ) -> Result<Option<Resolution>, Error> {
        let shadowed = self.prt.as_ref().is_some_and(|(_, prt)| prt.plan.shadowed_receivers > 0);
        if !shadowed {
            self.left_out.push("resolution: nothing casts a shadow, so finer vertices would hold nothing more".into());
            return Ok(None);
        }
        let meshes = self.meshes(predictor, bakes)?;
        if meshes.len() < 2 {
            return Ok(None);
        }
        let error = self.request.targets.error;
        let mut timed = Vec::new();
        for (refine, words, _) in &meshes {
            let settings =
                Settings { refine: *refine, quality: Quality::Error(error), ..self.request.settings.clone() };
            let setting = format!("{}--error {error} {words}", trials::prefix(&settings));
            timed.push((setting.clone(), bakes.bake(&setting, &settings)?));
        }
        Ok(compare_meshes(&timed, meshes.iter().map(|m| m.2).collect(), truth))
    }

    /// Meshes from coarse to fine that the budget allows: how they are split, the option, the longest edge.
    fn meshes(&mut self, predictor: &Predictor, bakes: &Bakes<'_>) -> Result<Vec<(Refine, String, f64)>, Error> {
        let scene = self.request.scene;
        let split = |refine: Refine| bake::refine(scene, &Settings { refine, ..self.request.settings.clone() });
        let standard = split(self.request.settings.refine)?;
        let (edge, count) = (resolution::longest_edge(&standard), resolution::vertices(&standard));
        let base = predictor.level(f64::from(self.request.targets.error), self.request.settings.bands).seconds;
        let mut left = bakes.left() - base;
        let mut meshes = vec![(self.request.settings.refine, "--refine auto".to_owned(), edge)];
        if resolution::vertices(scene) < count && base < left {
            left -= base;
            meshes.insert(0, (Refine::Off, "--refine off".into(), resolution::longest_edge(scene)));
        }
        for part in [2.0, 4.0] {
            let finer = level_edge(edge / part);
            let vertices = resolution::vertices(&*split(Refine::Edge(finer as f32))?);
            let needed = base * vertices as f64 / count.max(1) as f64;
            if needed > left || bakes.left() < RESOLUTION_SHARE * needed {
                let why = format!("{vertices} receivers, about {needed:.1} s of the {:.1} s left", left.max(0.0));
                self.left_out.push(format!("--refine {finer}: {why}"));
                break;
            }
            left -= needed;
            meshes.push((Refine::Edge(finer as f32), format!("--refine {finer}"), finer));
        }
        Ok(meshes)
    }

    /// Compares, times frames, draws, and writes the report.
    fn report(
        mut self,
        reference: Reference,
        resolution: Option<Resolution>,
        bakes: &Bakes<'_>,
    ) -> Result<Report, Error> {
        bakes.tell("comparing", 0, 1)?;
        self.add_formats();
        let mut errors = Vec::with_capacity(self.baked.len());
        for baked in &mut self.baked {
            errors.push(compare(&mut baked.run, &baked.transfer, &reference.truth));
        }
        let (shown, prt) = self.prt.take().ok_or(Error::Cancelled)?;
        let runs: Vec<Run> = self.baked.into_iter().map(|baked| baked.run).collect();
        let bands = self.request.settings.bands;
        let (fast_front, small_front) = fronts(&runs, bands);
        let advice = advice(&runs, self.request, shown);
        bakes.tell("drawing", 0, 1)?;
        let frames = time_frames(self.request, &reference, bakes, &mut self.left_out)?;
        let views = draw(self.request, (shown, &prt), &runs, &advice, &errors)?;
        Ok(Report {
            scene: self.request.scene.name.clone(),
            light: self.request.environment.name.clone(),
            bands,
            machine: self.request.machine.clone(),
            budget: [self.request.budget, bakes.spent()],
            receivers: [prt.plan.receivers, prt.plan.shadowed_receivers],
            texture_bytes: prt.textures.iter().map(|t| 4 * t.rgba.len() as u64).sum(),
            worst: worst(&prt, &errors[shown]),
            checks: [self.check, Some(reference.check)].into_iter().flatten().collect(),
            reference: reference.facts,
            runs,
            fast_front,
            small_front,
            advice,
            resolution,
            frames,
            shown,
            views,
            map_range: views::RANGE,
            left_out: self.left_out,
        })
    }

    /// What smaller number formats would do to the bakes that no ray separates from each other.
    fn add_formats(&mut self) {
        let wanted = |(index, baked): &(usize, &Baked)| {
            baked.run.knob == Knob::Bands || self.prt.as_ref().is_some_and(|(shown, _)| shown == index)
        };
        let stored = |(_, baked): (usize, &Baked)| {
            [Format::F16, Format::U8].map(|format| {
                let setting = format!("{} in {}", baked.run.setting, format.name());
                let bytes = format.bytes(&baked.transfer);
                let run = Run { knob: Knob::Format, setting, can_be_typed: false, bytes, ..baked.run.clone() };
                Baked { run, transfer: format.round_trip(&baked.transfer) }
            })
        };
        let added: Vec<Baked> = self.baked.iter().enumerate().filter(wanted).flat_map(stored).collect();
        self.baked.extend(added);
    }
}

/// A run of a bake, not compared yet.
fn run_of(knob: Knob, setting: String, timed: &Timed) -> Run {
    let (transfer, achieved) = (&timed.prt.transfer, &timed.prt.achieved);
    Run {
        knob,
        setting,
        can_be_typed: true,
        bands: transfer.bands,
        receivers: timed.prt.geometry.positions.len(),
        channels: transfer.channels,
        bounces: achieved.bounces,
        rays: [achieved.visibility_rays, achieved.bounce_rays],
        seconds: timed.seconds,
        bytes: 4 * transfer.values.len() as u64,
        transfer: Spread::default(),
        radiance: 0.0,
        radiance_all_bands: None,
    }
}

/// Writes the errors of a run into it; returns those of its receivers.
fn compare(run: &mut Run, transfer: &Transfer, truth: &Truth) -> Vec<f32> {
    let Deviation { receivers, radiance, radiance_all_bands } = truth.deviation(transfer);
    run.transfer = Spread::of(&receivers);
    run.radiance = radiance;
    run.radiance_all_bands = Some(radiance_all_bands);
    receivers
}

/// Compares bakes of several meshes with the last, which is the finest.
fn compare_meshes(timed: &[(String, Timed)], edges: Vec<f64>, truth: &Truth) -> Option<Resolution> {
    let (_, finest) = timed.last()?;
    let truth = Truth { transfer: finest.prt.transfer.clone(), light: truth.light.clone() };
    let compared = |(setting, timed): &(String, Timed)| {
        let deviation = resolution::deviation(&timed.prt, &truth, &finest.prt);
        resolution::as_run(setting.clone(), run_of(Knob::Resolution, setting.clone(), timed), deviation.as_ref())
    };
    Some(Resolution { runs: timed.iter().map(compared).collect(), edges })
}

/// A length with two digits.
fn level_edge(edge: f64) -> f64 {
    format!("{edge:.1e}").parse().unwrap_or(edge)
}

/// The fronts of time and of bytes.
fn fronts(runs: &[Run], bands: u32) -> (Vec<usize>, Vec<usize>) {
    let fast = |run: &Run| {
        let counts = run.can_be_typed && run.bands == bands;
        if counts { [run.seconds, run.transfer.p95] } else { [f64::NAN; 2] }
    };
    let small = |run: &Run| [run.bytes as f64, run.radiance_all_bands.unwrap_or(f64::NAN)];
    (front(&runs.iter().map(fast).collect::<Vec<_>>()), front(&runs.iter().map(small).collect::<Vec<_>>()))
}

/// The advice for each target.
fn advice(runs: &[Run], request: &Request<'_>, shown: usize) -> Vec<Advice> {
    let targets = request.targets;
    let goals = [
        Goal::Error(f64::from(targets.error)),
        Goal::Seconds(targets.seconds.unwrap_or(0.25 * runs[shown].seconds)),
        Goal::Bytes(targets.bytes.unwrap_or(runs[shown].bytes / 2)),
    ];
    goals.into_iter().filter_map(|goal| advise(runs, request.settings.bands, goal)).collect()
}

/// Times pictures of some numbers of bands; where there is no GPU it is noted.
fn time_frames(
    request: &Request<'_>,
    reference: &Reference,
    bakes: &Bakes<'_>,
    left_out: &mut Vec<String>,
) -> Result<Vec<frames::Frames>, Error> {
    let most = reference.facts.bands;
    let mut bands = vec![3, request.settings.bands, most];
    bands.sort_unstable();
    bands.dedup();
    let mut timed = Vec::new();
    let mut gpu = true;
    for &n in bands.iter().filter(|&&n| n <= most) {
        bakes.tell("timing frames", u64::from(n), u64::from(most))?;
        let prt = frames::with_bands(&reference.prt, n);
        timed.push(frames::on_cpu(&prt, request.environment)?);
        if gpu {
            match frames::on_gpu(&prt, request.environment) {
                Ok(frames) => timed.push(frames),
                Err(error) => {
                    left_out.push(format!("frames on a GPU: {error}"));
                    gpu = false;
                }
            }
        }
    }
    Ok(timed)
}

/// The receivers with the largest errors.
fn worst(prt: &Prt, errors: &[f32]) -> Vec<WorstReceiver> {
    let mut order: Vec<usize> = (0..errors.len()).collect();
    order.sort_by(|&a, &b| errors[b].total_cmp(&errors[a]).then(a.cmp(&b)));
    let object = |index: usize| {
        let holds =
            |mesh: &&coeff_io::Mesh| (mesh.first_vertex..mesh.first_vertex + mesh.vertices).contains(&(index as u32));
        prt.meshes.iter().find(holds).map_or(String::new(), |mesh| mesh.name.clone())
    };
    let receiver = |index: usize| WorstReceiver {
        index,
        position: prt.geometry.positions[index],
        error: errors[index],
        object: object(index),
    };
    order.into_iter().take(WORST).filter(|&i| errors[i] > 0.0).map(receiver).collect()
}

/// The baked picture, and the errors of the bakes recommended and of the coarsest one.
fn draw(
    request: &Request<'_>,
    (shown, prt): (usize, &Prt),
    runs: &[Run],
    advice: &[Advice],
    errors: &[Vec<f32>],
) -> Result<Vec<View>, Error> {
    let caption = format!("baked: {}", runs[shown].setting);
    let mut views = vec![View { caption, pixels: views::baked(prt, request.environment)? }];
    let mut wanted = Vec::new();
    for index in advice.iter().filter(|a| !matches!(a.goal, Goal::Bytes(_))).map(|a| a.run).chain([shown, 0]) {
        if !wanted.contains(&index) {
            wanted.push(index);
        }
    }
    for index in wanted.into_iter().take(MAPS) {
        views.push(View {
            caption: format!("error: {}", runs[index].setting),
            pixels: views::map(prt, &errors[index])?,
        });
    }
    Ok(views)
}
