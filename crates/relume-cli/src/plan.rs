//! `relume plan`: which effects a scene calls for and why, and what each will cost; bakes nothing.

use crate::columns::{Columns, Side, bytes, count, entry, seconds, wrap};
use crate::console::Console;
use crate::light_facts::LightFacts;
use crate::settings::{BakeOptions, Storage};
use crate::source::{self, ProbeSource, ReadOptions, SceneOptions};
use anyhow::Result;
use bake::{Extras, Price};
use coeff_io::{Effect, Plan, PlanRow, Settings};
use scene::Scene;
use serde_json::json;
use std::time::Instant;

pub(crate) const EXAMPLES: &str = "\
Examples:
  relume plan house.glb
  relume plan house.glb --probe kitchen.hdr --bands auto --json
  relume plan builtin:atrium --effects all --meshes

Times are predicted from a few hundred receivers that are baked for trial on this machine; the texels of light \
maps (--storage texture) come on top.";

const COLUMNS: Columns = Columns(&[
    (15, Side::Left),
    (20, Side::Left),
    (21, Side::Left),
    (7, Side::Right),
    (7, Side::Right),
    (8, Side::Right),
    (28, Side::Left),
]);
const MESH_COLUMNS: Columns = Columns(&[(30, Side::Left), (10, Side::Right), (10, Side::Right), (62, Side::Left)]);
/// Blanks before the reason of a row.
const INDENT: usize = 17;

#[derive(Debug, clap::Args)]
pub(crate) struct Options {
    #[command(flatten)]
    scene: SceneOptions,
    /// A light: tells how many bands it can show, and how much of it they hold.
    #[arg(long, value_name = "PROBE", value_parser = source::probe)]
    probe: Option<ProbeSource>,
    #[command(flatten, next_help_heading = "Light probe")]
    read: ReadOptions,
    #[command(flatten, next_help_heading = "Accuracy and effects")]
    bake: BakeOptions,
    /// List what each mesh calls for.
    #[arg(long, help_heading = "Output")]
    meshes: bool,
    /// Print JSON.
    #[arg(long, help_heading = "Output")]
    json: bool,
}

pub(crate) fn run(options: &Options, console: &Console) -> Result<()> {
    let light = LightFacts::of_option(options.probe.as_ref(), &options.read, options.bake.most_bands(), console)?;
    let settings = options.bake.settings(light.as_ref().map_or(&[], LightFacts::norms))?;
    let scene = options.scene.load(console)?;
    let storage = options.bake.storage;
    let began = Instant::now();
    let price = bake::price(&scene, &settings, &extras(&scene, storage), &|| began.elapsed())
        .map_err(crate::usage::bake_fault)?;
    let text = if options.json {
        as_json(&scene, &settings, &price, light.as_ref())
    } else {
        let mut text = as_text(&scene.name, &price);
        if options.meshes {
            text.push('\n');
            text.push_str(&meshes(&scene, &price.plan));
        }
        if storage == Storage::Auto {
            let choice = bake::storage(&scene, &settings).map_err(crate::usage::bake_fault)?;
            let texels = choice.texels.map_or(String::new(), |n| format!(" (--texels {n} in all)"));
            let reason = format!("{}{texels}", choice.reason);
            text.push_str(&format!("\n{}", entry("storage:", INDENT, &reason)));
        }
        if let Some(light) = &light {
            text.push_str(&format!("\n{}", entry("light:", INDENT, &light.text(price.plan.bands))));
        }
        text
    };
    console.print(&text)?;
    crate::enclosure::tell(&scene, &price, settings.quality, console);
    console.next(&options.scene.bake_command());
    Ok(())
}

/// Light maps as far as a plan looks at them: whether normal maps ask for directions.
fn extras(scene: &Scene, storage: Storage) -> Extras {
    let maps = matches!(storage, Storage::Texture | Storage::Maps).then(|| crate::maps::planned(scene));
    Extras { maps, ..Extras::default() }
}

/// Seconds of one effect; those that only follow from the materials take none.
fn effect_seconds(price: &Price, effect: Effect) -> f64 {
    match effect {
        Effect::Visibility => price.visibility,
        Effect::Interreflection => price.interreflection,
        Effect::Glossy => price.gloss,
        _ => 0.0,
    }
}

fn together(price: &Price) -> f64 {
    price.preparation + price.visibility + price.interreflection + price.gloss
}

fn as_json(scene: &Scene, settings: &Settings, price: &Price, light: Option<&LightFacts>) -> String {
    let mut plan = json!(price.plan);
    for (row, value) in price.plan.rows.iter().zip(plan["rows"].as_array_mut().into_iter().flatten()) {
        value["seconds"] = json!(effect_seconds(price, row.effect));
    }
    for (mesh, value) in price.plan.meshes.iter().zip(plan["meshes"].as_array_mut().into_iter().flatten()) {
        value["name"] = json!(scene.meshes[mesh.mesh as usize].name);
    }
    let seconds = json!({
        "preparation": price.preparation, "visibility": price.visibility, "interreflection": price.interreflection,
        "gloss": price.gloss,        "together": together(price), "receivers_tried": price.tried,
    });
    let value = json!({
        "scene": scene.name, "settings": settings, "plan": plan, "seconds": seconds, "light": light.map(LightFacts::json),
    });
    format!("{value:#}")
}

fn as_text(scene: &str, price: &Price) -> String {
    let plan = &price.plan;
    let head = format!(
        "{scene}: {} receivers, {} of them with something above; {} bands, {} channel(s), about {} bounces",
        plan.receivers, plan.shadowed_receivers, plan.bands, plan.channels, plan.expected_bounces
    );
    let mut text = wrap(&head, COLUMNS.width()).join("\n") + "\n\n";
    text.push_str(&COLUMNS.row(&[
        "effect",
        "called for by",
        "decision",
        "rays",
        "time",
        "bytes",
        "if that were wrong",
    ]));
    text.push_str(&"-".repeat(COLUMNS.width()));
    text.push('\n');
    for row in &plan.rows {
        text.push_str(&row_text(row, effect_seconds(price, row.effect)));
    }
    let rays: u64 = plan.rows.iter().map(|row| row.rays).sum();
    let size: u64 = plan.rows.iter().map(|row| row.bytes).sum();
    text.push_str(&"-".repeat(COLUMNS.width()));
    text.push('\n');
    let looked = format!("time with {} to split the scene, build the tree and decide", seconds(price.preparation));
    let total = seconds(together(price));
    text.push_str(&COLUMNS.row(&["together", "", "", &count(rays), &total, &bytes(size), &looked]));
    text
}

fn row_text(row: &PlanRow, time: f64) -> String {
    let more = row.callers.saturating_sub(row.called_for_by.len() as u64);
    let mut by = row.called_for_by.join(", ");
    match (by.is_empty(), more) {
        (true, _) => by.push('-'),
        (false, 0) => {}
        (false, n) => by.push_str(&format!(" and {n} more")),
    }
    let (rays, time, size) = (count(row.rays), seconds(time), bytes(row.bytes));
    let cells = [row.effect.name(), &by, &row.decision, &rays, &time, &size, &row.at_stake];
    let mut text = COLUMNS.row(&cells);
    for line in wrap(&format!("since {}", row.reason), COLUMNS.width() - INDENT) {
        text.push_str(&format!("{}{line}\n", " ".repeat(INDENT)));
    }
    text
}

fn meshes(scene: &Scene, plan: &Plan) -> String {
    let mut text = MESH_COLUMNS.row(&["mesh", "receivers", "shadowed", "effects"]);
    for mesh in &plan.meshes {
        let effects: Vec<&str> = mesh.effects.iter().map(|effect| effect.name()).collect();
        let effects = if effects.is_empty() { "none".to_owned() } else { effects.join(", ") };
        let (receivers, shadowed) = (mesh.receivers.to_string(), mesh.shadowed.to_string());
        text.push_str(&MESH_COLUMNS.row(&[&scene.meshes[mesh.mesh as usize].name, &receivers, &shadowed, &effects]));
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    /// No line is wider than a wide console, and every effect has its row with its reason.
    #[test]
    fn the_table_fits() {
        let scene = scene::builtin("cornell-box").unwrap();
        let price =
            bake::price(&scene, &bake::settings::preview(), &Extras::default(), &|| std::time::Duration::ZERO).unwrap();
        let text = as_text(&scene.name, &price) + &meshes(&scene, &price.plan);
        for line in text.lines() {
            assert!(line.chars().count() <= 120, "{} characters: {line}", line.chars().count());
        }
        assert!(Effect::ALL.iter().all(|effect| text.contains(effect.name())), "{text}");
        assert_eq!(text.matches("since ").count(), Effect::ALL.len(), "{text}");
        assert!(COLUMNS.width() >= 100 && COLUMNS.width() <= 120, "{}", COLUMNS.width());
    }
}
