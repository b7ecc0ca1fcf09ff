//! The two plots of a study: error against seconds, and error against bytes.

use super::recommend::Goal;
use super::report::{Knob, Report, Run};
use crate::plot::chart::{Chart, Label, Series, Unit};

/// The plots of a study.
#[derive(Debug, Clone, PartialEq)]
pub struct Plots {
    /// Error of the transfer against the time of the bake.
    pub seconds: Chart,
    /// Error of radiance in all bands against bytes.
    pub bytes: Chart,
}

/// Draws a study up.
#[must_use]
pub fn plots(report: &Report) -> Plots {
    Plots { seconds: seconds(report), bytes: bytes(report) }
}

fn seconds(report: &Report) -> Chart {
    let at = |run: &Run| [run.seconds, run.transfer.p95];
    let of = |knob: Knob| {
        let wanted = report.runs.iter().filter(|run| run.knob == knob && run.bands == report.bands);
        Series { name: knob.name().into(), points: wanted.map(at).collect() }
    };
    let kinds = [Knob::Error, Knob::Rays, Knob::Sampler, Knob::Bounces].map(of);
    let chosen = report.advice.iter().find(|a| matches!(a.goal, Goal::Error(_))).map(|a| a.run);
    // The ends of the front say the most after the chosen point.
    let ends = [report.fast_front.first(), report.fast_front.last()].into_iter().flatten().copied();
    let named = chosen.into_iter().chain(ends).chain(report.fast_front.iter().copied());
    let label = |i: usize| Label { at: at(&report.runs[i]), text: report.runs[i].setting.clone() };
    Chart {
        x: ("time of the bake".into(), Unit::Seconds),
        y: ("error that 95 % of receivers keep".into(), Unit::Share),
        series: kinds.into_iter().filter(|s| !s.points.is_empty()).collect(),
        front: report.fast_front.iter().map(|&i| at(&report.runs[i])).collect(),
        labels: once_each(named).into_iter().map(label).collect(),
        chosen: chosen.map(|i| at(&report.runs[i])),
    }
}

fn bytes(report: &Report) -> Chart {
    let at = |run: &Run| [run.bytes as f64, run.radiance_all_bands.unwrap_or(f64::NAN)];
    let points = |wanted: &dyn Fn(&Run) -> bool| report.runs.iter().filter(|run| wanted(run)).map(at).collect();
    let series = [
        ("bands", points(&|run| run.knob == Knob::Bands)),
        ("number format (not in files)", points(&|run| run.knob == Knob::Format)),
        ("other knobs", points(&|run| !matches!(run.knob, Knob::Bands | Knob::Format))),
    ];
    let series = series.map(|(name, points): (&str, Vec<[f64; 2]>)| Series { name: name.into(), points });
    let chosen = report.advice.iter().find(|a| matches!(a.goal, Goal::Bytes(_))).map(|a| a.run);
    let label = |i: usize| Label { at: at(&report.runs[i]), text: size_words(&report.runs[i]) };
    Chart {
        x: ("size of the coefficients".into(), Unit::Bytes),
        y: (format!("radiance: difference from {} bands", report.reference.bands), Unit::Share),
        series: series.into_iter().filter(|s| !s.points.is_empty()).collect(),
        front: report.small_front.iter().map(|&i| at(&report.runs[i])).collect(),
        labels: once_each(chosen.into_iter().chain(report.small_front.iter().copied()))
            .into_iter()
            .map(label)
            .collect(),
        chosen: chosen.map(|i| at(&report.runs[i])),
    }
}

/// What makes a run small: its bands and the bits of its numbers.
fn size_words(run: &Run) -> String {
    let bits = match run.setting.rsplit_once(" in ") {
        Some((_, format)) if format.starts_with("16") => ", 16 bit",
        Some((_, format)) if format.starts_with('8') => ", 8 bit",
        _ => "",
    };
    let grey = if run.channels == 1 { ", grey" } else { "" };
    format!("{} bands{bits}{grey}", run.bands)
}

fn once_each(indices: impl Iterator<Item = usize>) -> Vec<usize> {
    let mut seen = Vec::new();
    indices.for_each(|i| {
        if !seen.contains(&i) {
            seen.push(i);
        }
    });
    seen
}
