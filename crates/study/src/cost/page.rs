//! The study as one page that needs nothing else: words, plots, pictures and tables in a single file.

mod bases;
mod gloss;
mod insight;
mod tables;

use super::plots::plots;
use super::recommend::{Advice, Goal};
use super::report::Report;
use super::views::RAMP;
use crate::plot::Error;
use crate::plot::chart::{Chart, Unit};

/// Colours, spaces and letters.
const STYLE: &str = include_str!("page/style.css");

/// The study as an HTML page. It asks for no other file and no network, and follows the reader's choice of light or dark.
///
/// # Errors
/// [`Error`] where a plot or a picture cannot be drawn.
pub fn page(report: &Report) -> Result<String, Error> {
    let plots = plots(report);
    let title = format!("What accuracy costs: {}", report.scene);
    let parts = [
        head(report, &title),
        advice(report),
        figure(&plots.seconds, &seconds_caption(report))?,
        figure(&plots.bytes, &bytes_caption(report))?,
        views(report)?,
        tables::runs(report),
        tables::resolution(report),
        bases::section(report)?,
        gloss::section(report),
        tables::frames(report),
        tables::predictions(report),
        tables::worst(report),
        method(report),
    ];
    Ok(format!(
        "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n<meta name=\"viewport\" \
         content=\"width=device-width, initial-scale=1\">\n<title>{}</title>\n<style>\n{STYLE}</style>\n</head>\n<body>\n<main>\n\
         {}</main>\n</body>\n</html>\n",
        escaped(&title),
        parts.concat()
    ))
}

/// Text between tags or in an attribute.
fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}

fn share(value: f64) -> String {
    Unit::Share.write(value)
}

fn seconds(value: f64) -> String {
    Unit::Seconds.write(value)
}

fn bytes(value: u64) -> String {
    Unit::Bytes.write(value as f64)
}

fn head(report: &Report, title: &str) -> String {
    let [all, shadowed] = report.receivers;
    let warning =
        report.warning().map_or(String::new(), |text| format!("<p class=\"warning\">{}</p>\n", escaped(&text)));
    format!(
        "<header>\n<h1>{}</h1>\n<p>Under the light {}, in {} bands. {all} receivers, {shadowed} of them with something that can \
         shadow them. Measured with {} threads on {}, relume {}, in {} of the {} allowed.</p>\n{warning}</header>\n",
        escaped(title),
        escaped(&report.light),
        report.bands,
        report.machine.threads,
        escaped(&report.machine.system),
        escaped(&report.machine.version),
        seconds(report.budget[1]),
        seconds(report.budget[0]),
    )
}

fn advice(report: &Report) -> String {
    let cards: String = report.advice.iter().map(|advice| card(report, advice)).collect();
    format!("<div class=\"advice\">\n{cards}</div>\n")
}

/// One recommendation: the goal, what to type, and what was measured.
fn card(report: &Report, advice: &Advice) -> String {
    let run = &report.runs[advice.run];
    let (goal, miss) = match advice.goal {
        Goal::Error(e) => (format!("For an error of {}", share(e)), "no run kept it"),
        Goal::Seconds(s) => (format!("For {} of baking", seconds(s)), "no run was as quick"),
        Goal::Bytes(b) => (format!("For {} of coefficients", bytes(b)), "no run was as small"),
    };
    let heading = match advice.goal {
        Goal::Error(_) => format!("{} for {}", seconds(run.seconds), share(report.kept(run))),
        Goal::Seconds(_) => format!("{} in {}", share(report.kept(run)), seconds(run.seconds)),
        Goal::Bytes(_) => format!("{} bands in {}", run.bands, bytes(run.bytes)),
    };
    let nearest = if advice.met { String::new() } else { format!(" ({miss}: this is the nearest)") };
    let radiance = match advice.goal {
        Goal::Bytes(_) => {
            let off = run.radiance_all_bands.unwrap_or(run.radiance);
            format!("Radiance under this light differs by {} from {} bands.", share(off), report.reference.bands)
        }
        _ => format!(
            "95 of 100 receivers err by less than {}; with the reference's own error, {} was measured. {} of coefficients.",
            share(report.kept(run)),
            share(run.transfer.p95),
            bytes(run.bytes)
        ),
    };
    format!(
        "<section>\n<h3>{goal}{nearest}</h3>\n<p class=\"big\">{heading}</p>\n<pre><code>{}</code></pre>\n<p>{radiance}</p>\n\
         </section>\n",
        escaped(&command(&report.scene, &run.setting))
    )
}

/// The line to type for a run.
pub(super) fn command(scene: &str, setting: &str) -> String {
    let name = scene.rsplit(['/', '\\', ':']).next().unwrap_or(scene);
    let stem = name.rsplit_once('.').map_or(name, |(stem, _)| stem);
    let plain = |text: &str| text.chars().all(|c| c.is_ascii_alphanumeric() || "-_./:+=,".contains(c));
    let word = |text: String| if plain(&text) { text } else { format!("'{}'", text.replace('\'', "'\\''")) };
    format!("relume bake {} -o {} {setting}", word(scene.to_owned()), word(format!("{stem}.prt")))
}

/// A plot within the page: the name space of the file form is not needed there.
fn figure(chart: &Chart, caption: &str) -> Result<String, Error> {
    let svg = chart.svg()?;
    let start = svg.find("<svg").unwrap_or(0);
    let svg = svg[start..].replace(" xmlns=\"http://www.w3.org/2000/svg\"", " role=\"img\"");
    Ok(format!("<figure>\n<div class=\"wide\">{svg}</div>\n<figcaption>{caption}</figcaption>\n</figure>\n"))
}

fn seconds_caption(report: &Report) -> String {
    format!(
        "Error against seconds, both logarithmic. The error is that of the transfer vector against an open receiver's, the unit of \
         <code>--error</code>; 95 of 100 receivers are below. The line joins the runs that nothing beats in both; the ring is the \
         recommendation for the error asked for. What lies below {} is within the reference's own error.",
        share(report.reference.own.p95)
    )
}

fn bytes_caption(report: &Report) -> String {
    format!(
        "Error against bytes: radiance under this light, compared with {} bands, so that what fewer bands leave out counts. Bytes are \
         those of the coefficients. Smaller number formats are reckoned from the same bakes; the file keeps 32-bit floats today.",
        report.reference.bands
    )
}

fn views(report: &Report) -> Result<String, Error> {
    let mut text = String::from(
        "<h2>Where the error is</h2>\n<p>The scene as it is baked, exposed to a fixed mean, and the error of each receiver as \
         colour.</p>\n<div class=\"views\">\n",
    );
    for (index, view) in report.views.iter().enumerate() {
        let source = if index == 0 { view.pixels.jpeg_uri()? } else { view.pixels.png_uri()? };
        let caption = escaped(&view.caption);
        let (width, height) = (view.pixels.width, view.pixels.height);
        text += &format!(
            "<figure><img src=\"{source}\" width=\"{width}\" height=\"{height}\" alt=\"{caption}\"><figcaption>{caption}</figcaption>\
             </figure>\n"
        );
    }
    let colours: Vec<String> = RAMP.iter().map(|[r, g, b]| format!("rgb({r},{g},{b})")).collect();
    let [low, high] = report.map_range.map(|e| share(f64::from(e)));
    text += &format!(
        "</div>\n<div class=\"ramp\" style=\"background:linear-gradient(90deg,{})\"></div>\n<div class=\"ends\"><span>{low} or less\
         </span><span>logarithmic</span><span>{high} or more</span></div>\n",
        colours.join(",")
    );
    Ok(text)
}

fn method(report: &Report) -> String {
    let reference = &report.reference;
    let left_out: String = report.left_out.iter().map(|what| format!("<li>{}</li>\n", escaped(what))).collect();
    let left_out = if left_out.is_empty() {
        String::new()
    } else {
        format!("<h2>What was left out</h2>\n<ul>\n{left_out}</ul>\n")
    };
    format!(
        "{left_out}<h2>How it was measured</h2>\n<ul>\n<li>Reference: the mean of two bakes of {} with seeds of their own, {} bands, \
         {} bounces: {:.0} rays per receiver together, {}. Its own error, from the difference of the two: half of the receivers below {}, \
         95 of 100 below {}, worst {}; radiance {}. The runs' errors hold it too.</li>\n<li>A run meets the error asked for where the square \
         of its 95 % error less that of the reference is no larger than the square of the error asked for.</li>\n<li>Transfer error: Euclidean norm of the \
         difference over a run's bands, largest of the channels, against the norm of a receiver with an open view.</li>\n<li>Radiance \
         error: mean of the absolute difference of outgoing radiance over receivers and channels, against the mean radiance.</li>\n\
         <li>Light beyond {} bands is in no number here.</li>\n<li>Seconds are wall-clock time of single runs: other work on the machine \
         is in them.</li>\n<li>Textures take another {} in each file.</li>\n</ul>\n",
        escaped(&reference.level),
        reference.bands,
        reference.bounces,
        reference.rays_per_receiver,
        seconds(reference.seconds),
        share(reference.own.median),
        share(reference.own.p95),
        share(reference.own.worst),
        share(reference.own_radiance),
        reference.bands,
        bytes(report.texture_bytes),
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn commands_can_be_typed() {
        assert_eq!(command("builtin:atrium", "--error 0.02"), "relume bake builtin:atrium -o atrium.prt --error 0.02");
        assert_eq!(
            command("a b/my house.glb", "--rays 64"),
            "relume bake 'a b/my house.glb' -o 'my house.prt' --rays 64"
        );
    }
}
