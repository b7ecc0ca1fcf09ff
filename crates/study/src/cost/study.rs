//! The study itself: reference, sweep, and what follows from them.

use super::bakes::{Bakes, Check, Timed};
use super::deviation::{Deviation, Spread, Truth};
use super::format::Format;
use super::gloss::GlossStudy;
use super::recommend::{Advice, Goal, Ground, advise};
use super::report::{Knob, Report, Run, View, WorstReceiver};
use super::resolution::{self, Resolution};
use super::trials::{Trial, as_asked, trials};
use super::truth::{Reference, reference};
use super::{Error, ProgressFn, Request, Targets, frames, front, gloss, light_maps, views};
use crate::bases::scene::Comparison;
use coeff_io::{Effect, Effects, Prt, Settings, Transfer};

/// Receivers in the list of the worst.
const WORST: usize = 10;
/// Maps on the page.
const MAPS: usize = 3;
/// Trials before light maps: few rays, and as asked.
const FIRST: usize = 2;
/// Parts of the time reserved for what follows the bakes, of which one goes to each of up to six timings of frames.
const FRAMES_PART: f64 = 12.0;

/// Bakes a scene again and again, one knob turned at a time, and compares what comes with a converged bake.
///
/// # Errors
/// [`Error`] where a bake or a picture fails, or `progress` asked to stop.
pub fn study(request: &Request<'_>, progress: ProgressFn<'_>) -> Result<Report, Error> {
    let whole = request;
    let request = &without_gloss(request);
    let mut bakes = Bakes::new(request.scene, &request.settings, request.budget, progress)?;
    let reference = reference(request, &mut bakes)?;
    let mut sweep =
        Sweep { request, baked: Vec::new(), asked: None, shown: None, left_out: Vec::new(), checks: Vec::new() };
    let mut wanted = trials(request);
    // What goals follow from goes before light maps, and they before the rest, which takes all the time there is.
    let rest = wanted.split_off(FIRST.min(wanted.len()));
    sweep.trials(wanted, &mut bakes)?;
    let bases = light_maps::study(request, &mut bakes, &mut sweep.left_out)?;
    let gloss = gloss::study(whole, &mut bakes, &mut sweep.left_out)?;
    sweep.trials(rest, &mut bakes)?;
    let resolution = resolution::study(request, &reference.truth, &bakes, &mut sweep.left_out)?;
    sweep.report(reference, resolution, (bases, gloss), &bakes)
}

/// The same where surfaces mirror nothing by direction: what turns the knobs of transfer leaves gloss to its own table, since it costs many times as
/// much in the bands of the reference.
fn without_gloss<'a>(request: &Request<'a>) -> Request<'a> {
    let kept = |list: &[Effect]| list.iter().copied().filter(|&effect| effect != Effect::Glossy).collect();
    let effects = match &request.settings.effects {
        Effects::Auto => Effects::Only(kept(&Effect::ALL)),
        Effects::Only(list) => Effects::Only(kept(list)),
        // Whoever wants all of it gets it.
        Effects::All => Effects::All,
    };
    Request { settings: Settings { effects, ..request.settings.clone() }, ..request.clone() }
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
    /// Index of the bake as asked, where it fitted.
    asked: Option<usize>,
    /// The bake that pictures are made of, and its index: as asked, or the first one where that did not fit.
    shown: Option<(usize, Prt)>,
    left_out: Vec<String>,
    checks: Vec<Check>,
}

impl Sweep<'_> {
    /// The first trial of all, and every further one that the budget allows.
    fn trials(&mut self, wanted: Vec<Trial>, bakes: &mut Bakes<'_>) -> Result<(), Error> {
        let asked = as_asked(self.request).setting;
        for trial in wanted {
            // Where nothing is left nothing more is predicted, but for the bake as asked: goals follow from it.
            if bakes.left() <= 0.0 && self.shown.is_some() && trial.setting != asked {
                self.left_out.push(format!("{}: no time was left", trial.setting));
                continue;
            }
            bakes.tell("predicting", 0, 1)?;
            let predicted = bakes.predict(&trial.settings)?;
            let left = bakes.left().max(0.0);
            let fits = predicted.seconds <= left || self.shown.is_none();
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
        let index = self.baked.len();
        if trial.setting == as_asked(self.request).setting {
            self.asked = Some(index);
        }
        let transfer = if self.shown.is_none() || self.asked == Some(index) {
            self.shown.insert((index, timed.prt)).1.transfer.clone()
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
        (bases, gloss): (Option<Comparison>, Option<GlossStudy>),
        bakes: &Bakes<'_>,
    ) -> Result<Report, Error> {
        bakes.tell("comparing", 0, 1)?;
        self.add_formats();
        let mut errors = Vec::with_capacity(self.baked.len());
        for baked in &mut self.baked {
            errors.push(compare(&mut baked.run, &baked.transfer, &reference.truth));
        }
        let (shown, prt) = self.shown.take().ok_or(Error::Cancelled)?;
        let runs: Vec<Run> = self.baked.into_iter().map(|baked| baked.run).collect();
        let bands = self.request.settings.bands;
        let (fast_front, small_front) = fronts(&runs, bands);
        let ground = Ground { bands, own: reference.facts.own.p95, asked: self.asked };
        let asked = asked_seconds(&runs, self.asked, &self.checks, &as_asked(self.request).setting);
        let goals = goals(self.request.targets, asked.unwrap_or(runs[shown].seconds), runs[shown].bytes);
        let advice: Vec<Advice> = goals.into_iter().filter_map(|goal| advise(&runs, ground, goal)).collect();
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
            bases,
            gloss,
            frames,
            asked: self.asked,
            shown,
            views,
            map_range: views::RANGE,
            left_out: self.left_out,
        })
    }

    /// What smaller number formats would do to the bakes that no ray separates from each other.
    fn add_formats(&mut self) {
        let wanted = |(index, baked): &(usize, &Baked)| {
            baked.run.knob == Knob::Bands || self.shown.as_ref().is_some_and(|(shown, _)| shown == index)
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
    // What no file can hold beats nothing.
    let small = |run: &Run| {
        let radiance = run.radiance_all_bands.filter(|_| run.can_be_typed);
        [run.bytes as f64, radiance.unwrap_or(f64::NAN)]
    };
    (front(&runs.iter().map(fast).collect::<Vec<_>>()), front(&runs.iter().map(small).collect::<Vec<_>>()))
}

/// Seconds of the bake as asked, or those predicted where it was left out.
fn asked_seconds(runs: &[Run], asked: Option<usize>, checks: &[Check], setting: &str) -> Option<f64> {
    let predicted = || checks.iter().find(|check| check.name == setting).map(|check| check.predicted.seconds);
    asked.map(|index| runs[index].seconds).or_else(predicted)
}

/// What the user wants; where it was not said, from the seconds and the bytes of the bake as asked.
fn goals(targets: Targets, seconds: f64, bytes: u64) -> [Goal; 3] {
    [
        Goal::Error(f64::from(targets.error)),
        Goal::Seconds(targets.seconds.unwrap_or(0.25 * seconds)),
        Goal::Bytes(targets.bytes.unwrap_or(bytes / 2)),
    ]
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
    let enough = bakes.reserved() / FRAMES_PART;
    for &n in bands.iter().filter(|&&n| n <= most) {
        bakes.tell("timing frames", u64::from(n), u64::from(most))?;
        let prt = frames::with_bands(&reference.prt, n);
        timed.push(frames::on_cpu(&prt, request.environment, enough)?);
        if gpu {
            match (request.open_gpu)().and_then(|gpu| frames::on_gpu(&gpu, &prt, request.environment, enough)) {
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cost::{Effort, sample};

    fn seconds_asked(asked: Option<usize>) -> Option<f64> {
        let runs = sample::report().runs;
        let predicted = Effort { seconds: 8.0, rays: 1e6 };
        let check = |name: &str| Check { name: name.into(), predicted, came: None };
        asked_seconds(&runs, asked, &[check("--error 0.01")], "--error 0.01")
    }

    /// The sample took 4 s as asked.
    #[test]
    fn goals_follow_from_the_bake_as_asked() {
        let targets = Targets { error: 0.01, seconds: None, bytes: None };
        let of = |asked| goals(targets, seconds_asked(asked).unwrap(), 1000);
        assert_eq!(of(Some(1)), [Goal::Error(f64::from(0.01f32)), Goal::Seconds(1.0), Goal::Bytes(500)]);
        assert_eq!(of(None)[1], Goal::Seconds(2.0), "a quarter of what was predicted");
    }

    /// What the user says stands, and without a prediction there is no number.
    #[test]
    fn goals_follow_from_the_bake_as_asked_can_fail() {
        let said = Targets { error: 0.01, seconds: Some(7.0), bytes: Some(9) };
        assert_eq!(goals(said, 4.0, 1000)[1..], [Goal::Seconds(7.0), Goal::Bytes(9)]);
        assert_eq!(asked_seconds(&[], None, &[], "--error 0.01"), None);
    }
}
