//! One sentence on each knob, from what was measured.

use super::super::report::{Knob, Report, Run};
use super::share;
use super::tables::rays;

/// What turning a knob did, where enough was measured to tell.
pub(super) fn insight(report: &Report, knob: Knob) -> Option<String> {
    let of = |knob: Knob| report.runs.iter().filter(move |run| run.knob == knob);
    // In the bands asked for, whichever it is.
    let shown = &report.runs[report.shown];
    match knob {
        Knob::Error | Knob::Rays => {
            let first = of(knob).min_by(|a, b| a.seconds.total_cmp(&b.seconds))?;
            let last = of(knob).max_by(|a, b| a.seconds.total_cmp(&b.seconds))?;
            (first.seconds < last.seconds && last.transfer.p95 > 0.0).then(|| trade(first, last))
        }
        Knob::Sampler => {
            let said: Vec<String> = of(knob).filter_map(|run| sampler(report, run)).collect();
            (!said.is_empty()).then(|| said.join("; "))
        }
        Knob::Bounces => {
            let none = of(knob).find(|run| run.bounces == 0)?;
            Some(format!("without any bounce radiance is off by {}", share(none.radiance)))
        }
        Knob::Bands => {
            let all = shown.radiance_all_bands?;
            let bands = report.reference.bands;
            Some(format!("{} bands differ by {} from {bands} bands under this light", shown.bands, share(all)))
        }
        Knob::Format => {
            let stored = |word: &str| of(knob).find(|run| run.bands == shown.bands && run.setting.contains(word));
            let words = |run: &Run| format!("from {} to {}", share(shown.transfer.p95), share(run.transfer.p95));
            let (half, byte) = (stored("16-bit")?, stored("8 bits")?);
            Some(format!("the 95th percentile goes {} in 16 bits, {} in 8", words(half), words(byte)))
        }
        Knob::Resolution => None,
    }
}

fn trade(first: &Run, last: &Run) -> String {
    format!(
        "{:.1} times the time buys {:.1} times less error",
        last.seconds / first.seconds,
        first.transfer.p95 / last.transfer.p95
    )
}

/// A sequence against the usual one at the same `--rays`, and what both traced for it: stratified traces about half.
fn sampler(report: &Report, run: &Run) -> Option<String> {
    let (asked, name) = run.setting.split_once(" --sampler ")?;
    let usual = report.runs.iter().find(|other| other.knob == Knob::Rays && other.setting == asked)?;
    let ratio = run.transfer.p95 / usual.transfer.p95;
    let traced = [run, usual].map(|run| rays(report, run));
    ratio.is_finite().then(|| {
        format!(
            "{name} errs {ratio:.2} times as much as owen-sobol at {asked}, with {} rays traced per receiver against {}",
            traced[0], traced[1]
        )
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cost::sample;

    /// Of the 100 receivers of the sample that something shadows, stratified traces half the rays.
    #[test]
    fn the_sampler_sentence_tells_what_was_traced() {
        let said = insight(&sample::report(), Knob::Sampler).unwrap();
        assert_eq!(
            said,
            "stratified errs 3.00 times as much as owen-sobol at --rays 64, with 30 rays traced per receiver against 60"
        );
    }

    #[test]
    fn the_sampler_sentence_tells_what_was_traced_can_fail() {
        let mut report = sample::report();
        report.runs[2].rays = report.runs[0].rays;
        assert!(insight(&report, Knob::Sampler).unwrap().ends_with("with 60 rays traced per receiver against 60"));
    }
}
