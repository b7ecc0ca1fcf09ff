//! The study itself: reference, sweep, and what follows from them.

use super::bakes::{Bakes, Check, Timed};
use super::deviation::{Deviation, Spread, Truth};
use super::format::Format;
use super::recommend::{Advice, Goal, advise};
use super::report::{Knob, Report, Run, View, WorstReceiver};
use super::resolution::{self, Resolution};
use super::trials::{Trial, as_asked, trials};
use super::truth::{Reference, reference};
use super::{Error, ProgressFn, Request, frames, front, views};
use coeff_io::{Prt, Transfer};

/// Receivers in the list of the worst.
const WORST: usize = 10;
/// Maps on the page.
const MAPS: usize = 3;

/// Bakes a scene again and again, one knob turned at a time, and compares what comes with a converged bake.
///
/// # Errors
/// [`Error`] where a bake or a picture fails, or `progress` asked to stop.
pub fn study(request: &Request<'_>, progress: ProgressFn<'_>) -> Result<Report, Error> {
    let mut bakes = Bakes::new(request.scene, &request.settings, request.budget, progress)?;
    let reference = reference(request, &mut bakes)?;
    let mut sweep = Sweep { request, baked: Vec::new(), prt: None, left_out: Vec::new(), checks: Vec::new() };
    sweep.trials(&mut bakes)?;
    let resolution = resolution::study(request, &reference.truth, &bakes, &mut sweep.left_out)?;
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
    /// The bake as asked, or the first one where that did not fit, and its index.
    prt: Option<(usize, Prt)>,
    left_out: Vec<String>,
    checks: Vec<Check>,
}

impl Sweep<'_> {
    /// The first trial, and every further one that the budget allows.
    fn trials(&mut self, bakes: &mut Bakes<'_>) -> Result<(), Error> {
        for trial in trials(self.request) {
            // Where nothing is left nothing more is predicted.
            if bakes.left() <= 0.0 && self.prt.is_some() {
                self.left_out.push(format!("{}: no time was left", trial.setting));
                continue;
            }
            bakes.tell("predicting", 0, 1)?;
            let predicted = bakes.predict(&trial.settings)?;
            let left = bakes.left().max(0.0);
            let fits = predicted.seconds <= left || self.prt.is_none();
            let mut came = None;
            if fits {
                let timed = bakes.bake(&trial.setting, &trial.settings)?;
                came = Some(timed.effort());
                self.keep(&trial, timed);
            } else {
                let needed = predicted.seconds;
                self.left_out
                    .push(format!("{}: it would take about {needed:.1} s of the {left:.1} s left", trial.setting));
            }
            self.checks.push(Check { name: trial.setting, predicted, came });
        }
        Ok(())
    }

    fn keep(&mut self, trial: &Trial, timed: Timed) {
        let run = run_of(trial.knob, trial.setting.clone(), &timed);
        let is_shown = self.prt.is_none() || trial.setting == as_asked(self.request).setting;
        let transfer = if is_shown {
            self.prt.insert((self.baked.len(), timed.prt)).1.transfer.clone()
        } else {
            timed.prt.transfer
        };
        self.baked.push(Baked { run, transfer });
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
            checks: std::iter::once(reference.check).chain(self.checks).collect(),
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
pub(super) fn run_of(knob: Knob, setting: String, timed: &Timed) -> Run {
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
