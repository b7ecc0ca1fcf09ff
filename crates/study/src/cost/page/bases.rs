//! The section of the page about bases of light maps.

use super::{bytes, command, escaped, figure, share};
use crate::bases::scene::{Comparison, PICKED, Row};
use crate::cost::Report;
use crate::plot::Error;

/// Bases of light maps compared, with a plot and what to type; nothing where they were not studied.
pub(super) fn section(report: &Report) -> Result<String, Error> {
    let Some(bases) = &report.bases else { return Ok(String::new()) };
    let normals = if bases.has_normal_maps {
        format!("at {PICKED} normals that the scene's normal maps hold")
    } else {
        "at the surface's own normal, since no normal map is in use".to_owned()
    };
    let remark = bases.remark().map_or(String::new(), |text| format!(" Note that {}.", escaped(&text)));
    let encodings: String = bases.rows[0]
        .stored
        .iter()
        .skip(1)
        .map(|stored| format!("<th>{}</th><th>error</th>", stored.encoding.id()))
        .collect();
    let rows: String = bases.rows.iter().enumerate().map(|(index, of)| row(bases, index, of)).collect();
    let plot = figure(
        &bases.chart(),
        "Error as drawn against bytes of the light maps, both logarithmic, a kind of points for each encoding. The line joins what \
         nothing beats in both; the ring is the recommendation.",
    )?;
    Ok(format!(
        "<h2>Bases of light maps</h2>\n<p>Irradiance over normals at {} texels under this light, baked once as asked in 5 bands over normals; \
         each basis is fitted to that. The error as drawn is the root of the mean square {normals}, against the mean there; over the \
         hemisphere all normals count alike. The shaded row is the recommendation: {}.{remark}</p>\n<pre><code>{}</code></pre>\n{plot}<div \
         class=\"wide\"><table>\n<thead><tr><th>basis</th><th>hemisphere</th><th>worst texel</th><th>as drawn</th><th>99 %</th>{encodings}\
         <th>ns</th></tr></thead>\n<tbody>\n{rows}</tbody>\n</table></div>\n",
        bases.texels,
        escaped(&bases.recommendation()),
        escaped(&command(&report.scene, &format!("--probe {} {}", quoted(&report.light), bases.options()))),
    ))
}

/// A word of a command line.
fn quoted(text: &str) -> String {
    if text.contains(' ') { format!("'{text}'") } else { text.to_owned() }
}

fn row(bases: &Comparison, index: usize, row: &Row) -> String {
    let class = if index == bases.choice.row { " class=\"asked\"" } else { "" };
    let exact = row.stored[0].drawn;
    let stored: String = row
        .stored
        .iter()
        .skip(1)
        .map(|stored| format!("<td>{}</td><td>{}</td>", bytes(stored.bytes), share(stored.drawn.rms)))
        .collect();
    format!(
        "<tr{class}><td>{}</td><td>{}</td><td>{}</td><td>{}</td><td>{}</td>{stored}<td>{:.2}</td></tr>\n",
        row.basis.name(),
        share(row.relative),
        share(row.worst.relative),
        share(exact.rms),
        share(exact.p99),
        row.nanoseconds
    )
}
