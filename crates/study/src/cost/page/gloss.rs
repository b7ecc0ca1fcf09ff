//! The section of the page about gloss and transfer textures.

use super::{bytes, command, escaped, seconds, share};
use crate::cost::Report;
use crate::cost::gloss::{GlossRun, GlossStudy, WayTime};

/// Storage, resolutions, clusters and ways, with what to type; nothing where they were not studied.
pub(super) fn section(report: &Report) -> String {
    let Some(gloss) = &report.gloss else { return String::new() };
    let rows: String = gloss.runs.iter().map(row).collect();
    format!(
        "<h2>Gloss and transfer textures</h2>\n<p>The plan calls for reflections by direction, which the runs above leave out. Bakes of 256 rays per receiver that differ in storage alone: at \
         vertices, at texels, and in clusters (clustered PCA). The difference is that of the picture under this light, root mean square, from that \
         of the finest texture; of clusters, from the same without them. {}. To keep the target error:</p>\n<pre><code>{}</code></pre>\n<div \
         class=\"wide\"><table>\n<thead><tr><th>options</th><th>receivers</th><th>time</th><th>bytes</th><th>clusters x vectors: transfer</th>\
         <th>visibility</th><th>bounces</th><th>difference</th></tr></thead>\n<tbody>\n{rows}</tbody>\n</table></div>\n{}",
        escaped(&gloss.storage),
        escaped(&command(&report.scene, &gloss.options)),
        ways(gloss)
    )
}

fn row(run: &GlossRun) -> String {
    let cells: String = run
        .clusters
        .iter()
        .zip(run.added)
        .map(|(clusters, added)| match clusters {
            Some([count, rank]) => {
                format!("<td>{count} x {rank}, {} lost</td>", share(f64::from(added)))
            }
            None => "<td></td>".into(),
        })
        .collect();
    format!(
        "<tr><td>{}</td><td>{}</td><td>{}</td><td>{}</td>{cells}<td>{}</td></tr>\n",
        escaped(&run.setting),
        run.receivers,
        seconds(run.seconds),
        bytes(run.bytes),
        share(run.picture)
    )
}

fn ways(gloss: &GlossStudy) -> String {
    let [still, turning] = gloss.chosen.map(|way| way.name().to_uppercase());
    let chosen = format!(
        "By itself the renderer takes {still} under a light that stays, {turning} under one that turns with every frame."
    );
    if gloss.ways.is_empty() {
        return format!("<p>{chosen} Times of the ways need a GPU.</p>\n");
    }
    let cell = |time: &WayTime| {
        format!(
            "<tr><td>{}</td><td>{}</td><td>{}</td><td>{:.2} ms</td></tr>\n",
            if time.at_vertices { "vertices" } else { "texels" },
            time.way.name(),
            if time.turns { "turns" } else { "stays" },
            time.milliseconds
        )
    };
    let rows: String = gloss.ways.iter().map(cell).collect();
    format!(
        "<p>Time of a picture by way: triple products (tp) and the matrix of the light (tpfl) where gloss is drawn, or kept per light (cache). {chosen}</p>\n\
         <div class=\"wide\"><table>\n<thead><tr><th>gloss at</th><th>way</th><th>light</th><th>picture</th></tr></thead>\n<tbody>\n{rows}</tbody>\n</table></div>\n"
    )
}
