//! Every run as a line of a CSV file.

use super::report::{Report, Run};
use std::fmt::Write;

/// The names of the columns.
const HEAD: &str = "knob,setting,can_be_typed,bands,receivers,channels,bounces,visibility_rays,bounce_rays,seconds,bytes,\
    transfer_error_median,transfer_error_p95,transfer_error_worst,radiance_error,radiance_error_all_bands,on_fast_front,\
    on_small_front,longest_edge_metres,milliseconds_per_frame\n";

/// The study as a CSV file: one line per run, per mesh, per basis of light maps in an encoding (its error as drawn stands under radiance),
/// per bake of gloss (the difference of its picture stands there), per way of gloss and per renderer; fields that do not apply are empty.
#[must_use]
pub fn csv(report: &Report) -> String {
    let mut text = HEAD.to_owned();
    for (i, run) in report.runs.iter().enumerate() {
        let fronts = [report.fast_front.contains(&i), report.small_front.contains(&i)];
        line(&mut text, run, fronts.map(|on| on.to_string()), String::new());
    }
    if let Some(resolution) = &report.resolution {
        for (run, edge) in resolution.runs.iter().zip(&resolution.edges) {
            line(&mut text, run, [String::new(), String::new()], edge.to_string());
        }
    }
    for (bases, row) in report.bases.iter().flat_map(|bases| bases.rows.iter().map(move |row| (bases, row))) {
        for stored in &row.stored {
            let _ = writeln!(
                text,
                "basis of light maps,{},true,,,3,,,,,{},,,,{},,,,,",
                bases.options_of(row.basis, stored.encoding),
                stored.bytes,
                stored.drawn.rms
            );
        }
    }
    for run in report.gloss.iter().flat_map(|gloss| &gloss.runs) {
        // The difference of the picture stands under radiance.
        let _ = writeln!(
            text,
            "gloss,{},true,,{},,,,,{},{},,,,{},,,,,",
            quoted(&run.setting),
            run.receivers,
            run.seconds,
            run.bytes,
            run.picture
        );
    }
    for time in report.gloss.iter().flat_map(|gloss| &gloss.ways) {
        let place = if time.at_vertices { "vertices" } else { "texels" };
        let light = if time.turns { "light turns" } else { "light stays" };
        let _ = writeln!(
            text,
            "way of gloss,\"{place}, {}, {light}\",,,,,,,,,,,,,,,,,,{}",
            time.way.name(),
            time.milliseconds
        );
    }
    for frames in &report.frames {
        // Writing to a string cannot fail.
        let _ = writeln!(
            text,
            "renderer,{},,{},,,,,,,,,,,,,,,,{}",
            quoted(&frames.renderer),
            frames.bands,
            frames.milliseconds
        );
    }
    text
}

fn line(text: &mut String, run: &Run, [fast, small]: [String; 2], edge: String) {
    let all_bands = run.radiance_all_bands.map_or(String::new(), |e| e.to_string());
    let Run {
        knob, can_be_typed, bands, receivers, channels, bounces, rays, seconds, bytes, transfer, radiance, ..
    } = run;
    let _ = writeln!(
        text,
        "{},{},{can_be_typed},{bands},{receivers},{channels},{bounces},{},{},{seconds},{bytes},{},{},{},{radiance},{all_bands},\
         {fast},{small},{edge},",
        quoted(knob.name()),
        quoted(&run.setting),
        rays[0],
        rays[1],
        transfer.median,
        transfer.p95,
        transfer.worst,
    );
}

/// A field with commas or quotes, as RFC 4180 has it.
fn quoted(field: &str) -> String {
    if field.contains([',', '"', '\n', '\r']) {
        format!("\"{}\"", field.replace('"', "\"\""))
    } else {
        field.to_owned()
    }
}
