//! What `relume inspect` tells of gloss, transfer textures and clusters.

use crate::columns::{bytes, count};
use crate::inspect::elements;
use coeff_io::{ArrivingHeader, Bounced, CodebookHeader, Inspection, Kind, TableHeader};
use serde_json::{Value, json};

/// Bands, what bounces hold, sheets and clusters, on one line; none where a file holds nothing of it.
pub(crate) fn surfaces_text(seen: &Inspection) -> Option<String> {
    let surfaces = &seen.header.surfaces;
    let mut parts = Vec::new();
    if let Some(gloss) = &surfaces.gloss {
        let bounced = match &gloss.bounced {
            None => "no bounces".into(),
            Some(Bounced::Relightable { bands, .. }) => format!("bounces of any light of {bands} bands"),
            Some(Bounced::Fixed { probe, bounces, .. }) => format!("{bounces} bounces of {probe} alone"),
        };
        parts.push(format!("{} bands, {bounced}", gloss.bands));
        if let Some((_, arriving)) = &gloss.vertices {
            parts.push(format!("{} vertices", count(u64::from(arriving.visibility.rows))));
        }
    }
    if let Some(textures) = &surfaces.transfer_textures {
        let sheet = |levels: &Vec<coeff_io::TransferLevelHeader>| {
            let texels: u64 = levels.iter().map(|level| u64::from(level.diffuse.rows)).sum();
            let first = levels.first().map_or([0; 2], |level| [level.width, level.height]);
            format!("{}x{} in {} levels, {} texels", first[0], first[1], levels.len(), count(texels))
        };
        let bent = if textures.bent { ", normal maps in them" } else { "" };
        parts.push(format!(
            "transfer textures {}{bent}",
            textures.sheets.iter().map(sheet).collect::<Vec<_>>().join("; ")
        ));
    }
    for (book, what) in surfaces.codebooks.iter().zip(["transfer", "visibility", "bounces"]) {
        if let Some(CodebookHeader { clusters, rank, .. }) = book {
            parts.push(format!("{what} in {clusters} clusters of {rank} vectors"));
        }
    }
    if parts.is_empty() {
        return None;
    }
    parts.push(bytes(size(seen)));
    Some(parts.join(", "))
}

fn size(seen: &Inspection) -> u64 {
    [Kind::Codebook, Kind::Places, Kind::Table].iter().map(|kind| elements(seen, *kind, 1)).sum()
}

/// The same for scripts: tables by rows, numbers and form.
pub(crate) fn surfaces_json(seen: &Inspection) -> Value {
    let surfaces = &seen.header.surfaces;
    let table = |table: &TableHeader| json!({ "rows": table.rows, "columns": table.columns, "form": table.form });
    let arriving = |arriving: &ArrivingHeader| {
        json!({
            "visibility": table(&arriving.visibility),
            "bounces": arriving.bounces.iter().map(table).collect::<Vec<_>>(),
        })
    };
    json!({
        "gloss": surfaces.gloss.as_ref().map(|gloss| json!({
            "bands": gloss.bands,
            "bounces": gloss.bounced.as_ref().map(|bounced| match bounced {
                Bounced::Relightable { bands, channels } => json!({ "light": "relightable", "bands": bands, "channels": channels }),
                Bounced::Fixed { probe, bounces, materials, .. } => json!({ "light": "fixed", "probe": probe, "tables": bounces, "materials": materials }),
            }),
            "vertices": gloss.vertices.as_ref().map(|(_, a)| arriving(a)),
        })),
        "transfer_textures": surfaces.transfer_textures.as_ref().map(|textures| json!({
            "channels": textures.channels,
            "bent": textures.bent,
            "sheets": textures.sheets.iter().map(|levels| levels.iter().map(|level| json!({
                "width": level.width, "height": level.height, "diffuse": table(&level.diffuse),
                "arriving": level.arriving.as_ref().map(arriving),
            })).collect::<Vec<_>>()).collect::<Vec<_>>(),
        })),
        "codebooks": surfaces.codebooks.iter().map(|book| book.map(|book| json!({
            "columns": book.columns, "clusters": book.clusters, "rank": book.rank,
        }))).collect::<Vec<_>>(),
        "bytes": size(seen),
    })
}
