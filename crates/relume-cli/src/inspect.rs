//! `relume inspect`: what a baked file holds, and whether it is sound.

use crate::columns::{Columns, Side, bytes, count, entry};
use crate::console::Console;
use crate::inspect_gloss::{surfaces_json, surfaces_text};
use crate::inspect_maps::{maps_json, maps_text, volume_json, volume_text};
use crate::inspect_words::{bounces, changes, effects, quality, sampler};
use anyhow::{Context, Result, bail};
use coeff_io::{Chunk, EffectCost, Inspection, Kind};
use serde_json::json;
use std::path::PathBuf;

pub(crate) const EXAMPLES: &str = "\
Examples:
  relume inspect atrium.prt
  relume inspect atrium.prt --json | jq .header.achieved

Fails when a checksum is wrong or the file contradicts itself.";

/// Characters of the column of names.
const NAMES: usize = 17;

const COLUMNS: Columns = Columns(&[
    (15, Side::Left),
    (22, Side::Left),
    (7, Side::Right),
    (7, Side::Right),
    (8, Side::Right),
    (8, Side::Right),
    (38, Side::Left),
]);

const CHUNK_COLUMNS: Columns = Columns(&[(9, Side::Left), (12, Side::Right), (12, Side::Right), (16, Side::Left)]);

#[derive(Debug, clap::Args)]
pub(crate) struct Options {
    /// The baked file.
    #[arg(value_name = "F.prt")]
    file: PathBuf,
    /// Print JSON.
    #[arg(long)]
    json: bool,
}

pub(crate) fn run(options: &Options, console: &Console) -> Result<()> {
    let path = &options.file;
    let about = || format!("{}", path.display());
    crate::source::check_baked(path)?;
    let seen = coeff_io::inspect(path).with_context(about)?;
    let sums = coeff_io::check(path, &seen.chunks).with_context(about)?;
    let text = if options.json { as_json(&seen, &sums) } else { as_text(&seen, &sums) };
    console.print(&text)?;
    let damaged = seen.chunks.iter().zip(&sums).filter(|(chunk, sum)| chunk.crc32 != **sum);
    let damaged: Vec<String> = damaged.map(|(chunk, _)| chunk.kind.to_string()).collect();
    if !damaged.is_empty() {
        bail!("{}: damaged in {}: get the file again or bake anew", path.display(), damaged.join(", "));
    }
    // Sound bytes can still contradict each other.
    let prt = coeff_io::Prt::read(path).with_context(about)?;
    if prt.achieved.error[2] > 0.0 && !options.json {
        console.print(&entry("worst error", NAMES, &crate::bake::worst_place(&prt)))?;
    }
    if let Some(text) = crate::interpolation::text(&prt).filter(|_| !options.json) {
        console.print(&entry("interpolation", NAMES, &format!("error between receivers: {text}")))?;
    }
    console.next(&crate::source::render_command(path, "builtin:sky"));
    Ok(())
}

fn as_json(seen: &Inspection, sums: &[u32]) -> String {
    let chunk = |(chunk, sum): (&Chunk, &u32)| {
        json!({
            "kind": chunk.kind.to_string(), "index": chunk.index, "offset": chunk.offset, "length": chunk.length,
            "crc32": format!("{:08x}", chunk.crc32), "sound": chunk.crc32 == *sum,
        })
    };
    let value = json!({
        "version": seen.version,
        "file_length": seen.file_length,
        "vertices": vertices(seen),
        "triangles": elements(seen, Kind::Triangles, 12),
        "chunks": seen.chunks.iter().zip(sums).map(chunk).collect::<Vec<_>>(),
        "maps": seen.header.maps.as_ref().map(|maps| maps_json(maps, seen)),
        "volume": seen.header.volume.as_ref().map(|volume| volume_json(volume, seen)),
        "gloss": surfaces_json(seen),
        "header": seen.header,
        "supplement": seen.supplement,
    });
    format!("{value:#}")
}

pub(crate) fn elements(seen: &Inspection, kind: Kind, size: u64) -> u64 {
    seen.chunks.iter().filter(|chunk| chunk.kind == kind).map(|chunk| chunk.length / size).sum()
}

fn vertices(seen: &Inspection) -> u64 {
    elements(seen, Kind::Positions, 12)
}

fn as_text(seen: &Inspection, sums: &[u32]) -> String {
    let mut text = String::new();
    write_header(&mut text, seen);
    text.push('\n');
    write_effects(&mut text, seen);
    text.push_str(&format!("\n{}", CHUNK_COLUMNS.row(&["chunks", "offset", "bytes", "crc32"])));
    for (chunk, sum) in seen.chunks.iter().zip(sums) {
        let name =
            if chunk.kind.repeats() { format!("{} {}", chunk.kind, chunk.index) } else { chunk.kind.to_string() };
        let state = if chunk.crc32 == *sum { "" } else { " DAMAGED" };
        let (offset, length) = (chunk.offset.to_string(), chunk.length.to_string());
        text.push_str(&CHUNK_COLUMNS.row(&[&name, &offset, &length, &format!("{:08x}{state}", chunk.crc32)]));
    }
    text
}

/// What was decided, and what it took and saved.
fn write_effects(text: &mut String, seen: &Inspection) {
    let (plan, achieved) = (&seen.header.plan, &seen.header.achieved);
    text.push_str(&COLUMNS.row(&["effect", "decision", "rays", "saved", "bytes", "saved", "reason"]));
    for row in &plan.rows {
        let cost = achieved.effects.iter().find(|cost| cost.effect == row.effect);
        let of = |value: fn(&EffectCost) -> u64| cost.map_or(0, value);
        let rays = [count(of(|c| c.rays)), count(of(|c| c.saved_rays))];
        let size = [bytes(of(|c| c.bytes)), bytes(of(|c| c.saved_bytes))];
        let cells = [row.effect.name(), &row.decision, &rays[0], &rays[1], &size[0], &size[1], &row.reason];
        text.push_str(&COLUMNS.row(&cells));
    }
    let survey = &plan.survey;
    let looked = format!("{} rays for {} receivers, before the bake", survey.rays, survey.receivers);
    text.push_str(&entry("survey", NAMES, &looked));
}

fn write_header(text: &mut String, seen: &Inspection) {
    let header = &seen.header;
    let (settings, achieved) = (&header.settings, &header.achieved);
    let mut row = |name: &str, value: String| text.push_str(&entry(name, NAMES, &value));
    row("format", format!("version {}, {}, written by {}", seen.version, bytes(seen.file_length), header.generator));
    row("convention", header.convention.clone());
    row("scene", header.scene.clone());
    let (meshes, materials, textures) = (header.meshes.len(), header.materials.len(), header.textures.len());
    row(
        "geometry",
        format!("{} vertices, {} triangles, {meshes} meshes", vertices(seen), elements(seen, Kind::Triangles, 12)),
    );
    if header.origin != [0.0; 3] {
        let [x, y, z] = header.origin;
        row("origin", format!("({x}, {y}, {z}) m was taken off all positions"));
    }
    row("surfaces", format!("{materials} materials, {textures} textures"));
    row("cameras", header.cameras.iter().map(|c| c.name.as_str()).collect::<Vec<_>>().join(", "));
    row("transfer", format!("{} bands, {} channel(s)", header.bands, header.channels));
    if let Some(maps) = &header.maps {
        row("light maps", maps_text(maps, seen));
    }
    if let Some(volume) = &header.volume {
        row("volume", volume_text(volume, seen));
    }
    if let Some(text) = surfaces_text(seen) {
        row("gloss", text);
    }
    row("asked for", format!("{}, {}, {}", quality(settings), bounces(settings.bounces), effects(&settings.effects)));
    row(
        "sampler",
        format!("{}, seed {}, {} of memory", sampler(settings.sampler), settings.seed, bytes(settings.memory)),
    );
    let worst = achieved.worst_receiver;
    let known = if achieved.error[2] > 0.0 { format!("; receiver {worst} is worst") } else { String::new() };
    row("error", crate::bake::error(settings.quality, achieved.error) + &known);
    row(
        "rays",
        format!("{} for visibility, {} for bounces", count(achieved.visibility_rays), count(achieved.bounce_rays)),
    );
    if let Some(maps) = &achieved.maps {
        row("maps", crate::bake::light_maps(maps, settings.quality));
    }
    if let Some(gloss) = &achieved.gloss {
        row("textures", crate::bake::gloss_text(gloss, settings.quality));
    }
    row("bounces", changes(achieved.bounces, &achieved.bounce_changes));
    if let Some(text) = crate::bounces::summed(achieved) {
        row("tail", text);
    }
    let repairs = achieved.repairs;
    let (inside, normals) = (repairs.inside, repairs.bad_normals);
    row("repairs", format!("{inside} inside geometry, {normals} bad normals, {} not repaired", repairs.unrepaired));
}
