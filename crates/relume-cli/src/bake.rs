//! `relume bake`: a scene becomes a `.prt` file.

use crate::columns::percent;
use crate::console::Console;
use crate::extras::ExtraOptions;
use crate::light_facts::LightFacts;
use crate::progress::Progress;
use crate::settings::BakeOptions;
use crate::source::{self, ProbeSource, ReadOptions, SceneOptions};
use crate::usage::bake_fault as fault;
use crate::{interpolation, interrupt, look, output, settings};
use anyhow::Result;
use coeff_io::{Bounces, Prt, Quality, Refine, Settings};
use std::ops::ControlFlow;
use std::path::PathBuf;
use std::time::{Duration, Instant};

pub(crate) const EXAMPLES: &str = "\
Examples:
  relume bake builtin:atrium -o atrium.prt
  relume bake house.glb -o house.prt --bands 6 --error 0.005
  relume bake atrium.glb -o atrium.prt --bands auto:8 --probe evening.hdr
  relume bake scan.obj -o scan.prt --rays 256 --bounces 0 --memory 2G
  relume bake city.glb -o city.prt --time 10m
  relume bake house.glb -o house.prt --storage texture --texels 1024 --basis modified-h6
  relume bake house.glb -o house.prt --storage texture --probe noon.hdr --lighting fixed --encoding bc6h
  relume bake house.glb -o house.prt --volume 0.5m --volume-levels 1
  relume bake lobby.glb -o lobby.prt --effects visibility,interreflection,color,specular,glossy,normal-maps --storage transfer --texels 1024
  relume bake lobby.glb -o lobby.prt --storage transfer --compress 0.02 --bounce-error 0.05

Ctrl-C ends a bake; the file is written when all is done, never in part. With --time the file of the finest \
result so far stays.";

#[derive(Debug, clap::Args)]
pub(crate) struct Options {
    #[command(flatten)]
    scene: SceneOptions,
    /// The file to write.
    #[arg(short, long, value_name = "F.prt", value_parser = output::prt)]
    output: PathBuf,
    #[command(flatten, next_help_heading = "Accuracy and effects")]
    bake: BakeOptions,
    /// The least error within a time: seconds, or 30s, 5m, 2h. Bakes from coarse to fine; the file is there after the first, coarse
    /// result and holds the finest one that was finished in time.
    #[arg(long, value_name = "T", conflicts_with_all = ["error", "rays"], value_parser = settings::seconds)]
    time: Option<f32>,
    /// The light that the result is meant for: with --bands auto, bands that it cannot show are left out.
    #[arg(long, value_name = "PROBE", value_parser = source::probe, help_heading = "Light probe")]
    probe: Option<ProbeSource>,
    #[command(flatten)]
    extras: ExtraOptions,
    #[command(flatten, next_help_heading = "Light probe")]
    read: ReadOptions,
}

impl Options {
    /// The light to look at the result with.
    fn probe_name(&self) -> String {
        self.probe.as_ref().map_or_else(|| "builtin:sky".into(), ProbeSource::name)
    }

    /// The files that are read.
    fn inputs(&self) -> Vec<PathBuf> {
        let probe = self.probe.as_ref().map(ProbeSource::files).unwrap_or_default();
        [self.scene.files(), probe].concat()
    }
}

pub(crate) fn run(options: &Options, console: &Console) -> Result<()> {
    let light = LightFacts::of_option(options.probe.as_ref(), &options.read, options.bake.most_bands(), console)?;
    let settings =
        Settings { time: options.time, ..options.bake.settings(light.as_ref().map_or(&[], LightFacts::norms))? };
    output::check(&options.output, &options.inputs())?;
    let mut scene = options.scene.load(console)?;
    output::check(&options.output, &scene.files)?;
    let probe = options.probe.as_ref().map(|probe| (probe, &options.read));
    let (extras, refined) = options.extras.of(&mut scene, options.bake.storage, &settings, probe, console)?;
    let texels = texels_per_receiver(refined.as_ref().unwrap_or(&scene), &extras);
    let mut stages = stages(&settings, texels, extras.volume.is_some());
    stages.retain(|(name, _)| *name != "refinement" || refined.is_none());
    console.progress().expect(&stages);
    let began = Instant::now();
    let path = &options.output;
    let write = |prt: &Prt| Ok::<(), anyhow::Error>(relume::save_prt(prt, path)?);
    let prt = match settings.time {
        Some(seconds) => {
            // The first results are of the scene as it is.
            drop(refined);
            let deadline = console.began() + Duration::from_secs_f32(seconds);
            interrupt::leave_at(deadline)?;
            let keep = |prt: &Prt| {
                write(prt)?;
                let recorder = console.recorder();
                report(prt, began.elapsed(), options, &recorder);
                interrupt::hold(recorder.recorded());
                tell_result(prt, console);
                Ok(())
            };
            let progress = console.progress();
            let prt = relume::bake_within(&scene, &settings, &extras, deadline, &keep, &watched(&progress))
                .map_err(of_setting)?;
            interrupt::over();
            prt
        }
        None => {
            let progress = console.progress();
            let watched = watched(&progress);
            let baked = match refined {
                // The scene before it was split is not needed any more.
                Some(refined) => {
                    drop(scene);
                    bake::bake_refined(&refined, &settings, &extras, &watched)
                }
                None => bake::bake_with(&scene, &settings, &extras, &watched),
            };
            let prt = baked.map_err(fault)?;
            progress.tell("writing", "writing", 0.0);
            write(&prt)?;
            prt
        }
    };
    report(&prt, began.elapsed(), options, console);
    crate::enclosure::tell_of_bake(&prt, console);
    Ok(())
}

/// Share of the bounces that are still to come that one bounce is taken for: how many there will be, nobody knows.
const BOUNCE: f64 = 0.4;

/// Shows the progress of a bake.
pub(crate) fn watched(progress: &Progress) -> impl Fn(&bake::Progress) -> ControlFlow<()> + Sync + '_ {
    move |now| {
        let share = if now.total > 0 { now.done as f64 / now.total as f64 } else { 0.0 };
        match now.stage {
            bake::Stage::Bounce(n) => {
                let bounces = f64::from(n.saturating_sub(1)) + share;
                progress.tell("bounces", &now.stage.to_string(), 1.0 - (1.0 - BOUNCE).powf(bounces));
            }
            stage => progress.tell(&stage.to_string(), &stage.to_string(), share),
        }
        // Ctrl-C and the end of the time end the program as a whole.
        ControlFlow::Continue(())
    }
}

/// Receivers that a scene of few triangles has at least once it is split.
const FEWEST_RECEIVERS: f64 = 10_000.0;
/// Share of the texels of a page that charts fill, about.
const FILLED: f64 = 0.6;

/// Texels that are baked, over the receivers; both are guesses.
fn texels_per_receiver(scene: &scene::Scene, extras: &bake::Extras) -> f64 {
    let maps = extras.maps.iter().flat_map(|maps| &maps.sheets);
    let textures = extras.textures.iter().flat_map(|textures| &textures.sheets);
    let texels: f64 = maps.chain(textures).map(|sheet| f64::from(sheet.width) * f64::from(sheet.height)).sum();
    let receivers: usize = scene.meshes.iter().map(|mesh| mesh.positions.len()).sum();
    FILLED * texels / FEWEST_RECEIVERS.max(receivers as f64)
}

/// The stages that a bake will have, with about how long each takes against the others.
pub(crate) fn stages(settings: &Settings, texels_per_receiver: f64, probes: bool) -> Vec<(&'static str, f64)> {
    let bounces = settings.bounces != Bounces::Fixed(0);
    let stages = [
        ("refinement", 2.0, settings.refine == Refine::Auto),
        ("preparation", 0.5, true),
        ("visibility", 4.0, true),
        ("backs and near surfaces", 3.0, bounces),
        ("bounces", 1.0, bounces),
        // A texel sees the sky and what blocks it, as a receiver does in two stages.
        ("texels", 7.0 * texels_per_receiver, texels_per_receiver > 0.0),
        ("probes", 3.0, probes),
        ("writing", 0.1, true),
    ];
    stages.into_iter().filter(|stage| stage.2).map(|(name, weight, _)| (name, weight)).collect()
}

/// [`fault`], where an error is one of the bake.
fn of_setting(error: anyhow::Error) -> anyhow::Error {
    match error.downcast() {
        Ok(error) => fault(error),
        Err(other) => other,
    }
}

/// Tells of one result of several.
fn tell_result(prt: &Prt, console: &Console) {
    let seconds = console.began().elapsed().as_secs_f64();
    let what = match prt.settings.quality {
        Quality::Error(_) => format!("95 % of the errors below {}", percent(relume::achieved_error(prt))),
        Quality::Rays(rays) => format!("a result of {rays} rays per receiver"),
    };
    console.notice(&format!("after {seconds:.1} s: {what}"));
}

fn report(prt: &Prt, took: Duration, options: &Options, console: &Console) {
    let (achieved, receivers) = (&prt.achieved, prt.geometry.positions.len());
    let rays = achieved.visibility_rays + achieved.bounce_rays;
    let seconds = took.as_secs_f64();
    console.notice(&format!(
        "baked {receivers} receivers in {seconds:.1} s: {rays} rays ({:.2} million/s), {} bounces",
        rays as f64 / seconds.max(1e-9) * 1e-6,
        achieved.bounces
    ));
    // With a time, or by default, nobody asked for an error.
    let asked = options.bake.asked_error().map_or(String::new(), |asked| format!("asked for {}, ", percent(asked)));
    console.notice(&format!("relative error: {asked}{}", error(prt.settings.quality, achieved.error)));
    if achieved.error[2] > 0.0 {
        console.notice(&format!("worst {}", worst_place(prt)));
    }
    if let Some(warning) = crate::bounces::warning(prt) {
        console.notice(&warning);
    }
    if let Some(text) = interpolation::text(prt) {
        console.notice(&format!("error between receivers: {text}"));
    }
    if let Some(warning) = interpolation::warning(prt) {
        console.notice(&warning);
    }
    if let Some(maps) = &achieved.maps {
        console.notice(&light_maps(maps, prt.settings.quality));
    }
    if let Some(gloss) = &achieved.gloss {
        console.notice(&gloss_text(gloss, prt.settings.quality));
        let [transfer, visibility, bounces] = gloss.compression;
        if let Some(asked) = options.extras.gloss.compress.filter(|_| transfer == 0.0 && visibility == 0.0) {
            console.notice(&format!("clusters to {} would take no less: rows are kept as they are", percent(asked)));
        }
        let asked = options.extras.gloss.bounce_error;
        if bounces > 1.5 * asked {
            console.notice(&format!(
                "clusters of bounces hold what is mirrored to {}, not to the {} asked for; --bounce-error 0 keeps bounces whole",
                percent(bounces),
                percent(asked)
            ));
        }
    }
    look::tell_left_out(prt, console);
    let repairs = achieved.repairs;
    if repairs.inside + repairs.bad_normals > 0 {
        let (inside, normals) = (repairs.inside, repairs.bad_normals);
        let left = repairs.unrepaired;
        console.notice(&format!(
            "warning: {inside} vertices inside geometry, {normals} with bad normals; moved out or repaired from neighbours but for {left}"
        ));
    }
    if let Some(volume) = &prt.volume {
        let poor = volume.validity.iter().filter(|&&validity| validity < 0.5).count();
        let probes = volume.validity.len();
        console.notice(&format!("volume: {probes} probes, {poor} of them inside of bodies"));
    }
    let file = options.output.display();
    console.notice(&format!("wrote {file}"));
    console.next(&source::render_command(&options.output, &options.probe_name()));
}

/// What light maps took and reached, in words.
pub(crate) fn light_maps(maps: &coeff_io::MapRecord, quality: Quality) -> String {
    let mut text = format!("light maps: {} texels, {}", maps.texels, error(quality, maps.error));
    for (count, what) in [
        (maps.inside, "inside of bodies, filled from their chart"),
        (maps.unfilled, "with a chart of nothing else, taken from the vertices"),
        (maps.clipped, "numbers clipped by the encoding"),
        (maps.negative, "negative numbers set to 0"),
    ] {
        if count > 0 {
            text.push_str(&format!("; {count} {what}"));
        }
    }
    text
}

/// What gloss and transfer textures took and reached, in words.
pub(crate) fn gloss_text(gloss: &coeff_io::GlossRecord, quality: Quality) -> String {
    let [exact, held] = gloss.bytes.map(crate::columns::bytes);
    let mut text = format!("gloss and transfer textures: {} vertices, {} texels", gloss.vertices, gloss.texels);
    if gloss.texels > 0 {
        text.push_str(&format!(", {}", error(quality, gloss.error)));
    }
    text.push_str(&format!("; {held} instead of {exact}"));
    for (added, what) in gloss.compression.into_iter().zip(["transfer", "visibility", "what is mirrored"]) {
        if added > 0.0 {
            text.push_str(&format!("; clusters err by {} of {what}", percent(added)));
        }
    }
    for (count, what) in [
        (gloss.inside, "texels inside of bodies"),
        (gloss.unfilled, "with a chart of nothing else, taken from the vertices"),
    ] {
        if count > 0 {
            text.push_str(&format!("; {count} {what}"));
        }
    }
    text
}

/// Where the receiver with the worst error stands.
pub(crate) fn worst_place(prt: &Prt) -> String {
    place(prt, prt.achieved.worst_receiver)
}

/// Where a receiver stands.
pub(crate) fn place(prt: &Prt, id: u32) -> String {
    let place = prt.geometry.positions.get(id as usize).copied().unwrap_or_default();
    let [x, y, z]: [f64; 3] = std::array::from_fn(|k| prt.origin[k] + f64::from(place[k]));
    format!("at receiver {id}, ({x:.4}, {y:.4}, {z:.4}) on '{}'", mesh_of(prt, id))
}

/// Name of the mesh of a receiver.
pub(crate) fn mesh_of(prt: &Prt, id: u32) -> &str {
    let of = |mesh: &&coeff_io::Mesh| (mesh.first_vertex..mesh.first_vertex + mesh.vertices).contains(&id);
    prt.meshes.iter().find(of).map_or("", |mesh| mesh.name.as_str())
}

/// The achieved error in words; a fixed number of rays is traced without an estimate.
pub(crate) fn error(quality: Quality, [median, most, worst]: [f32; 3]) -> String {
    match quality {
        Quality::Rays(rays) if worst == 0.0 => format!("not estimated at a fixed number of {rays} rays"),
        _ => format!("median {}, 95 % of receivers below {}, worst {}", percent(median), percent(most), percent(worst)),
    }
}
