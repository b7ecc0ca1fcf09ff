//! The tables of the page.

use super::super::bakes::Check;
use super::super::report::{Knob, Report, Run};
use super::insight::insight;
use super::{bytes, escaped, seconds, share};

/// Width of the longest bar, in em.
const LONGEST_BAR: f64 = 5.0;

/// All runs, knob by knob.
pub(super) fn runs(report: &Report) -> String {
    let worst = report.runs.iter().map(|run| run.transfer.p95).fold(0.0, f64::max);
    let least = report.runs.iter().map(|run| run.transfer.p95).filter(|e| *e > 0.0).fold(worst, f64::min);
    let groups: String = Knob::ALL.iter().map(|&knob| group(report, knob, [least, worst])).collect();
    let asked = match report.asked {
        Some(_) => "The shaded row is the bake as asked",
        None => "The bake as asked was left out",
    };
    format!(
        "<h2>Knob by knob</h2>\n<p>One knob is turned at a time. {asked}; &#9670; marks runs on the front \
         of time. Bars are logarithmic.</p>\n<div class=\"wide\"><table>\n<thead><tr><th>options</th><th>error, 95 %</th>\
         <th>median</th><th>worst</th><th>radiance</th><th>against {} bands</th><th>time</th><th>rays / receiver</th><th>bounces</th>\
         <th>bytes</th></tr></thead>\n{groups}</table></div>\n",
        report.reference.bands
    )
}

fn group(report: &Report, knob: Knob, range: [f64; 2]) -> String {
    let rows: String = report
        .runs
        .iter()
        .enumerate()
        .filter(|(_, run)| run.knob == knob)
        .map(|(i, _)| row(report, i, range))
        .collect();
    if rows.is_empty() {
        return rows;
    }
    let said = insight(report, knob).map_or(String::new(), |said| format!(" <span>{}</span>", escaped(&said)));
    format!("<tbody>\n<tr><th colspan=\"10\">{knob}{said}</th></tr>\n{rows}</tbody>\n")
}

fn row(report: &Report, index: usize, [least, worst]: [f64; 2]) -> String {
    let run = &report.runs[index];
    let p95 = run.transfer.p95;
    let part = if p95 > 0.0 && worst > least { (p95 / least).ln() / (worst / least).ln() } else { 0.0 };
    let width = 0.3 + part.clamp(0.0, 1.0) * (LONGEST_BAR - 0.3);
    let class = match (report.asked == Some(index), report.fast_front.contains(&index)) {
        (true, true) => " class=\"asked front\"",
        (true, false) => " class=\"asked\"",
        (false, true) => " class=\"front\"",
        (false, false) => "",
    };
    format!(
        "<tr{class}><td>{}</td><td><span class=\"bar\" style=\"width:{width:.2}em\"></span>{}</td><td>{}</td><td>{}</td><td>{}</td>\
         <td>{}</td><td>{}</td><td>{}</td><td>{}</td><td>{}</td></tr>\n",
        options(run),
        share(p95),
        share(run.transfer.median),
        share(run.transfer.worst),
        share(run.radiance),
        run.radiance_all_bands.map_or(String::new(), share),
        seconds(run.seconds),
        rays(report, run),
        run.bounces,
        bytes(run.bytes),
    )
}

fn options(run: &Run) -> String {
    if run.can_be_typed { format!("<code>{}</code>", escaped(&run.setting)) } else { escaped(&run.setting) }
}

/// Visibility rays per receiver that something can shadow.
pub(super) fn rays(report: &Report, run: &Run) -> String {
    format!("{:.0}", run.rays[0] as f64 / report.receivers[1].max(1) as f64)
}

/// Meshes against the finest one.
pub(super) fn resolution(report: &Report) -> String {
    let Some(resolution) = &report.resolution else { return String::new() };
    let last = resolution.runs.len() - 1;
    let row = |(index, (run, edge)): (usize, (&Run, &f64))| {
        let errors = if index == last {
            "<td>compared with</td><td></td>".to_owned()
        } else {
            format!("<td>{}</td><td>{}</td>", share(run.radiance), share(run.transfer.p95))
        };
        format!(
            "<tr><td>{}</td><td>{edge:.3} m</td><td>{}</td>{errors}<td>{}</td><td>{}</td></tr>\n",
            options(run),
            run.receivers,
            seconds(run.seconds),
            bytes(run.bytes)
        )
    };
    let rows: String = resolution.runs.iter().zip(&resolution.edges).enumerate().map(row).collect();
    format!(
        "<h2>Storage resolution</h2>\n<p>Vertices carry the transfer. Each mesh is read, by interpolation, at the vertices of the finest, which \
         has those of the mesh as asked and no long edges; the noise of both bakes is in the numbers.</p>\n<div class=\"wide\"><table>\n<thead><tr><th>options</th><th>longest edge</th>\
         <th>receivers</th><th>radiance</th><th>error, 95 %</th><th>time</th><th>bytes</th></tr></thead>\n<tbody>\n{rows}</tbody>\n\
         </table></div>\n"
    )
}

/// Time per picture.
pub(super) fn frames(report: &Report) -> String {
    let row = |frames: &super::super::Frames| {
        format!(
            "<tr><td>{}</td><td>{}</td><td>{:.2} ms</td><td>{}</td></tr>\n",
            escaped(&frames.renderer),
            frames.bands,
            frames.milliseconds,
            frames.count
        )
    };
    let rows: String = report.frames.iter().map(row).collect();
    let [width, height] = super::super::frames::SIZE;
    format!(
        "<h2>Each picture</h2>\n<p>Median time of a picture of {width} by {height} pixels whose light turns, so that every vertex is lit \
         anew; one picture before is not counted, and nothing is read back from a GPU.</p>\n<div class=\"wide\"><table>\n<thead><tr>\
         <th>renderer</th><th>bands</th><th>per picture</th><th>pictures</th></tr></thead>\n<tbody>\n{rows}</tbody>\n</table></div>\n"
    )
}

/// What was predicted, and what came.
pub(super) fn predictions(report: &Report) -> String {
    let rows: String = report.checks.iter().map(|check| prediction(report, check)).collect();
    format!(
        "<h2>Predicted and measured</h2>\n<p>Before a bake starts, a few hundred receivers in runs of neighbours, evenly drawn over the \
         surfaces, are baked for trial on this machine; their time and rays are scaled to all receivers. {} Half of a \
         reference of so many rays is reckoned from a trial at fewer.</p>\n<div class=\"wide\"><table>\n<thead><tr><th>bake</th><th>predicted</th><th>came</th>\
         <th>predicted / came</th><th>rays predicted</th><th>rays traced</th></tr></thead>\n<tbody>\n{rows}</tbody>\n</table></div>\n",
        honesty(report)
    )
}

/// How far the predictions of time were from what came.
fn honesty(report: &Report) -> String {
    let came = report.checks.iter().filter_map(|check| Some(check.predicted.seconds / check.came?.seconds));
    let mut ratios: Vec<f64> = came.filter(|r| r.is_finite()).collect();
    ratios.sort_by(f64::total_cmp);
    match ratios[..] {
        [] => String::new(),
        [least, .., most] => {
            let middle = median(&ratios);
            format!("Here the predictions were {middle:.2} times what came (median; {least:.2} to {most:.2}).")
        }
        [only] => format!("Here the prediction was {only:.2} times what came."),
    }
}

/// The median of sorted values, of which there are some: the mean of the two in the middle where their number is even.
fn median(sorted: &[f64]) -> f64 {
    0.5 * (sorted[(sorted.len() - 1) / 2] + sorted[sorted.len() / 2])
}

fn prediction(report: &Report, check: &Check) -> String {
    let asked = report.asked.is_some_and(|index| check.name == report.runs[index].setting);
    let class = if asked { " class=\"asked\"" } else { "" };
    let [came, ratio, rays] = match &check.came {
        Some(came) => {
            let ratio = check.predicted.seconds / came.seconds;
            [seconds(came.seconds), format!("{ratio:.2}"), count(came.rays)]
        }
        None => ["left out".to_owned(), String::new(), String::new()],
    };
    format!(
        "<tr{class}><td>{}</td><td>{}</td><td>{came}</td><td>{ratio}</td><td>{}</td><td>{rays}</td></tr>\n",
        escaped(&check.name),
        seconds(check.predicted.seconds),
        count(check.predicted.rays),
    )
}

/// A count of rays for people.
fn count(rays: f64) -> String {
    match rays {
        r if r >= 1e6 => format!("{:.1} million", r * 1e-6),
        r => format!("{r:.0}"),
    }
}

/// The receivers that err most.
pub(super) fn worst(report: &Report) -> String {
    let row = |receiver: &super::super::report::WorstReceiver| {
        let [x, y, z] = receiver.position;
        format!(
            "<tr><td>{}</td><td>{}</td><td>{x:.3}, {y:.3}, {z:.3}</td><td>{}</td></tr>\n",
            receiver.index,
            escaped(&receiver.object),
            share(f64::from(receiver.error))
        )
    };
    let rows: String = report.worst.iter().map(row).collect();
    if rows.is_empty() {
        return rows;
    }
    format!(
        "<h2>Worst receivers</h2>\n<p>Of <code>{}</code>.</p>\n<div class=\"wide\"><table>\n<thead><tr><th>vertex</th><th>object</th>\
         <th>position, m</th><th>error</th></tr></thead>\n<tbody>\n{rows}</tbody>\n</table></div>\n",
        escaped(&report.runs[report.shown].setting)
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cost::sample;

    #[test]
    fn the_median_is_in_the_middle() {
        assert_eq!([median(&[1.0]), median(&[1.0, 2.0]), median(&[1.0, 2.0, 4.0, 9.0])], [1.0, 1.5, 3.0]);
        assert_eq!(median(&[1.0, 2.0, 9.0]), 2.0);
    }

    /// Run 1 of the sample is as asked.
    #[test]
    fn the_bake_as_asked_is_shaded() {
        let text = runs(&sample::report());
        assert!(text.contains("<tr class=\"asked\"><td><code>--error 0.01<"), "{text}");
        assert!(text.contains("shaded row is"), "{text}");
    }

    /// Another bake takes its place in the pictures, not in the table.
    #[test]
    fn the_bake_as_asked_is_shaded_can_fail() {
        let text = runs(&Report { asked: None, shown: 0, ..sample::report() });
        assert!(!text.contains("asked\""), "{text}");
        assert!(text.contains("was left out"), "{text}");
    }
}
