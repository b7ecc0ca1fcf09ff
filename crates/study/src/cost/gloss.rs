//! What gloss and transfer textures cost on the scene: resolutions, clusters, and the ways to multiply.

use super::bakes::{Bakes, Timed};
use super::frames::SIZE;
use super::{Error, Request};
use bake::{Compression, Extras, SheetSettings, TextureSettings};
use coeff_io::{Codebook, Effect, GlossView, GlossWay, Prt, Quality, Settings};
use glam::Quat;
use scene::Scene;
use scene::lightmap::{ObjectOptions, objects};
use std::time::Instant;

/// Share of the time left that gloss may take.
const SHARE: f64 = 0.5;
/// Rays of each receiver: all bakes here differ in storage alone.
const RAYS: u32 = 256;
/// Texels along a side of all sheets together.
const SIDES: [u32; 4] = [64, 128, 256, 512];
/// Errors allowed to clusters.
const ERRORS: [f32; 4] = [0.1, 0.05, 0.02, 0.01];
/// Side of the sheets that clusters are tried on.
const CLUSTERED_SIDE: u32 = 128;
/// Most frames of a way.
const FRAMES: u32 = 5;

/// What was found.
#[derive(Debug, Clone, PartialEq)]
pub struct GlossStudy {
    /// Vertices, then textures from coarse to fine, then clusters.
    pub runs: Vec<GlossRun>,
    /// Milliseconds of a picture by way; none without a GPU.
    pub ways: Vec<WayTime>,
    /// The way that a light which stays takes by itself, and one that turns with every frame.
    pub chosen: [GlossWay; 2],
    /// Whether vertices or texels hold the error asked for, and why.
    pub storage: String,
    /// The options of `relume bake` that keep the target error.
    pub options: String,
}

/// One bake with gloss.
#[derive(Debug, Clone, PartialEq)]
pub struct GlossRun {
    /// The options of `relume bake` that make it, beside `--rays`.
    pub setting: String,
    /// Receivers at vertices and texels.
    pub receivers: u64,
    /// Wall-clock seconds.
    pub seconds: f64,
    /// Bytes of gloss and transfer textures in the file.
    pub bytes: u64,
    /// Clusters and vectors of transfer, visibility and bounces.
    pub clusters: [Option<[u32; 2]>; 3],
    /// Relative error that clusters added to each.
    pub added: [f32; 3],
    /// Relative difference of the picture from that of the finest texture; of clusters, from that without them.
    pub picture: f64,
}

/// Milliseconds of a picture.
#[derive(Debug, Clone, PartialEq)]
pub struct WayTime {
    /// Whether gloss is at vertices, else at texels.
    pub at_vertices: bool,
    /// How it is multiplied.
    pub way: GlossWay,
    /// Whether the light turns with every frame.
    pub turns: bool,
    /// Median.
    pub milliseconds: f64,
}

/// Bakes the scene with gloss in several ways, where its plan calls for it and the budget allows it.
pub(super) fn study(
    request: &Request<'_>,
    bakes: &mut Bakes<'_>,
    left_out: &mut Vec<String>,
) -> Result<Option<GlossStudy>, Error> {
    let settings = Settings { quality: Quality::Rays(RAYS), ..request.settings.clone() };
    let plan = bake::plan(&bakes.scene, &settings)?;
    if !plan.rows.iter().any(|row| row.effect == Effect::Glossy && row.simulate) {
        return Ok(None);
    }
    let deadline = bakes.spent() + SHARE * bakes.left().max(0.0);
    let mut tried = Tried { request, settings, deadline, done: Vec::new() };
    if tried.bake(bakes, None, Compression::default(), "--storage vertex")?.is_none() {
        left_out.push(format!("gloss: no bake of it was done within {:.1} s", SHARE * bakes.left().max(0.0)));
        return Ok(None);
    }
    for side in SIDES {
        let setting = format!("--storage transfer --texels {side}");
        if !tried.fits(bakes) || tried.bake(bakes, Some(side), Compression::default(), &setting)?.is_none() {
            left_out.push(format!("gloss, {setting} and finer: no time was left"));
            break;
        }
    }
    let textures = tried.done.len();
    let clustered = if textures > 2 { Some(CLUSTERED_SIDE) } else { None };
    for error in ERRORS {
        let place = clustered.map_or("--storage vertex".into(), |side| format!("--storage transfer --texels {side}"));
        let setting = format!("{place} --compress {error} --bounce-error {error}");
        let compression = Compression { rows: Some(error), bounces: error };
        if !tried.fits(bakes) || tried.bake(bakes, clustered, compression, &setting)?.is_none() {
            left_out.push(format!("gloss, {setting} and smaller: no time was left"));
            break;
        }
    }
    tried.report(textures, clustered.map_or(0, |_| 2), left_out).map(Some)
}

/// Bakes so far.
struct Tried<'a> {
    request: &'a Request<'a>,
    settings: Settings,
    deadline: f64,
    done: Vec<(GlossRun, Prt)>,
}

impl Tried<'_> {
    /// Whether a bake as long as the last may still be begun.
    fn fits(&self, bakes: &Bakes<'_>) -> bool {
        let last = self.done.last().map_or(0.0, |(run, _)| run.seconds);
        bakes.spent() + last < self.deadline
    }

    fn bake(
        &mut self,
        bakes: &mut Bakes<'_>,
        side: Option<u32>,
        compression: Compression,
        setting: &str,
    ) -> Result<Option<()>, Error> {
        let mut scene = bakes.scene.clone().into_owned();
        let Some(textures) = side.map_or(Some(None), |side| textures(&mut scene, side).map(Some)) else {
            return Ok(None);
        };
        let extras = Extras { textures, compression, ..Extras::default() };
        let most = (self.deadline - bakes.spent()).max(0.0);
        let Some(Timed { prt, seconds }) = bakes.bake_with(setting, &scene, &self.settings, &extras, most)? else {
            return Ok(None);
        };
        let record = prt.achieved.gloss.unwrap_or_default();
        let books = [&prt.codebooks.diffuse, &prt.codebooks.visibility, &prt.codebooks.bounce];
        let run = GlossRun {
            setting: setting.into(),
            receivers: record.vertices + record.texels,
            seconds,
            bytes: record.bytes[1],
            clusters: books.map(|book| book.as_ref().map(|book: &Codebook| [book.clusters, book.rank])),
            added: record.compression,
            picture: 0.0,
        };
        self.done.push((run, prt));
        Ok(Some(()))
    }

    /// Compares pictures, times frames and says what to type. `textures` bakes are without clusters, those after are compared with number `plain`.
    fn report(mut self, textures: usize, plain: usize, left_out: &mut Vec<String>) -> Result<GlossStudy, Error> {
        let pictures: Vec<Vec<[f32; 3]>> =
            self.done.iter().map(|(_, prt)| picture(prt, self.request)).collect::<Result<_, Error>>()?;
        for (index, (run, _)) in self.done.iter_mut().enumerate() {
            let truth = if index < textures { textures - 1 } else { plain };
            run.picture = difference(&pictures[index], &pictures[truth]);
        }
        let ways = match ways(self.request, &self.done[0].1, &self.done[textures - 1].1) {
            Ok(ways) => ways,
            Err(error) => {
                left_out.push(format!("ways of gloss on a GPU: {error}"));
                Vec::new()
            }
        };
        let choice = bake::storage(self.request.scene, &self.settings)?;
        let target = f64::from(self.request.targets.error);
        let prt = &self.done[textures - 1].1;
        let chosen = [60.0, 1.0].map(|frames| cheapest(prt, frames));
        let options = options(&self.done, textures, choice.texels.is_some(), target);
        let runs = self.done.into_iter().map(|(run, _)| run).collect();
        Ok(GlossStudy { runs, ways, chosen, storage: choice.reason, options })
    }
}

/// The cheapest bake that keeps the target error in the picture, of the storage that the scene calls for; else the nearest.
fn options(done: &[(GlossRun, Prt)], textures: usize, at_texels: bool, target: f64) -> String {
    let runs = || done.iter().map(|(run, _)| run);
    let first = if at_texels && textures > 1 { 1 } else { 0 };
    let plain = runs().take(textures).skip(first).take(if first == 0 { 1 } else { textures });
    let plain: Vec<&GlossRun> = plain.collect();
    let best = plain.iter().find(|run| run.picture <= target).or(plain.last());
    let clusters = runs().skip(textures).find(|run| run.picture <= target);
    let compress = clusters.and_then(|run| run.setting.find("--compress").map(|at| run.setting[at..].to_owned()));
    let place = best.map_or(String::new(), |run| run.setting.clone());
    compress.map_or(place.clone(), |compress| format!("{place} {compress}"))
}

/// The way with the least to do for pictures of the study.
fn cheapest(prt: &Prt, frames_per_light: f64) -> GlossWay {
    let bands = prt.gloss.as_ref().and_then(|gloss| sh_math::Bands::new(gloss.bands));
    let samples = u64::from(SIZE[0]) * u64::from(SIZE[1]);
    bands.map_or(GlossWay::Cache, |bands| {
        GlossWay::cheapest(bands, crate::paper::receivers(prt), samples, frames_per_light)
    })
}

/// A sheet for each object; none where the scene cannot be unwrapped so coarsely.
fn textures(scene: &mut Scene, side: u32) -> Option<TextureSettings> {
    let meshes: Vec<usize> = (0..scene.meshes.len()).filter(|&m| scene.material(m).blocks_rays()).collect();
    let options = ObjectOptions { texels: side, padding: 2, unwrap: false };
    let sheets = objects(scene, &meshes, &options, &|_, _, _| {}).ok()?;
    let sheets = sheets.iter().map(|sheet| SheetSettings {
        meshes: vec![sheet.mesh],
        width: sheet.width,
        height: sheet.height,
        directional: false,
    });
    Some(TextureSettings { sheets: sheets.collect(), dilation: 2, levels: true, bent: true, stitch: true })
}

/// The scene under the light, linear, without sky.
fn picture(prt: &Prt, request: &Request<'_>) -> Result<Vec<[f32; 3]>, Error> {
    let plain = render_cpu::Frame::plain(prt.cameras[0].clone(), SIZE[0] / 2, SIZE[1] / 2);
    let frame = render_cpu::Frame { sky: false, ..plain };
    Ok(render_cpu::render(prt, request.environment, &frame)?.linear)
}

/// Root mean square of the difference over that of the second.
fn difference(ours: &[[f32; 3]], truth: &[[f32; 3]]) -> f64 {
    let pairs = ours.as_flattened().iter().zip(truth.as_flattened());
    let square = |x: f32| f64::from(x) * f64::from(x);
    let (off, all) = pairs.fold((0.0, 0.0), |(off, all), (a, b)| (off + square(a - b), all + square(*b)));
    if all > 0.0 { (off / all).sqrt() } else { 0.0 }
}

/// Milliseconds of every way at vertices and at texels.
fn ways(request: &Request<'_>, at_vertices: &Prt, at_texels: &Prt) -> Result<Vec<WayTime>, render_wgpu::Error> {
    let gpu = (request.open_gpu)()?;
    let mut all = Vec::new();
    for (is_vertex, prt) in [(true, at_vertices), (false, at_texels)] {
        if !is_vertex && prt.transfer_textures.is_none() {
            break;
        }
        let mut renderer = render_wgpu::Renderer::new(&gpu, prt, request.environment)?;
        for way in GlossWay::ALL {
            for turns in [false, true] {
                let gloss = GlossView { way: Some(way), ..GlossView::default() };
                let plain = render_wgpu::Frame::plain(prt.cameras[0].clone(), SIZE[0], SIZE[1]);
                let frame = |n: u32| render_wgpu::Frame {
                    gloss,
                    rotation: if turns { Quat::from_rotation_y(0.1 * n as f32) } else { Quat::IDENTITY },
                    ..plain.clone()
                };
                renderer.time(&frame(0))?;
                let began = Instant::now();
                let mut times = Vec::new();
                for n in 1..=FRAMES {
                    times.push(1e3 * renderer.time(&frame(n))?.frame.as_secs_f64());
                    if began.elapsed().as_secs_f64() > 2.0 {
                        break;
                    }
                }
                times.sort_by(f64::total_cmp);
                let milliseconds = times[times.len() / 2];
                all.push(WayTime { at_vertices: is_vertex, way, turns, milliseconds });
            }
        }
    }
    Ok(all)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cost::{Report, Targets, csv, page, report::Machine, sample};
    use coeff_io::{Bounces, Refine};
    use std::ops::ControlFlow;

    /// The Cornell box with one mesh of metal or without, 3 bands, within so many seconds.
    fn studied(metallic: f32, budget: f64) -> (Option<GlossStudy>, Vec<String>) {
        let mut scene = scene::builtin("cornell-box").unwrap();
        let last = scene.meshes.len() - 1;
        scene.meshes[last].material = scene.materials.len() as u32;
        scene.materials.push(scene::Material { metallic, roughness: 0.7, ..scene::Material::default() });
        let settings =
            Settings { bands: 3, bounces: Bounces::Fixed(1), refine: Refine::Off, ..bake::settings::standard() };
        let request = Request {
            scene: &scene,
            environment: &probe_io::builtin("sky").unwrap(),
            settings: settings.clone(),
            targets: Targets { error: 0.2, seconds: None, bytes: None },
            budget,
            machine: Machine { threads: 1, system: "test".into(), version: "0".into() },
            light_maps: None,
            open_gpu: || render_wgpu::Gpu::new(render_wgpu::Driver::Any),
        };
        let mut bakes = Bakes::new(&scene, &settings, budget, &|_| ControlFlow::Continue(())).unwrap();
        let mut left_out = Vec::new();
        let found = study(&request, &mut bakes, &mut left_out).unwrap();
        (found, left_out)
    }

    /// An hour is enough on any machine; it is not waited for.
    #[test]
    fn gloss_is_part_of_the_report() {
        let (gloss, left_out) = studied(1.0, 3600.0);
        let gloss = gloss.unwrap();
        assert_eq!(gloss.runs.len(), 9, "{left_out:?}");
        assert_eq!(gloss.runs[4].picture, 0.0, "the finest is what others are compared with");
        assert!(gloss.runs[1].picture > gloss.runs[3].picture, "finer is nearer");
        assert!(gloss.runs[5].bytes < gloss.runs[2].bytes, "clusters are smaller");
        assert!(gloss.options.contains("--storage"), "{}", gloss.options);
        let report = Report { gloss: Some(gloss), ..sample::report() };
        let (text, table) = (page(&report).unwrap(), csv(&report));
        assert!(text.contains("<h2>Gloss and transfer textures</h2>") && text.contains("--texels 512"), "{text}");
        let columns = table.lines().next().unwrap().split(',').count();
        let rows: Vec<&str> = table.lines().filter(|line| line.starts_with("gloss,")).collect();
        assert!(rows.len() == 9 && rows.iter().all(|row| row.split(',').count() == columns), "{table}");
    }

    /// A matt scene has no such section and takes no time; without time nothing is baked, and it is said.
    #[test]
    fn gloss_is_part_of_the_report_can_fail() {
        let (gloss, left_out) = studied(0.0, 3600.0);
        assert!(gloss.is_none() && left_out.is_empty());
        let (gloss, left_out) = studied(1.0, 0.0);
        assert!(gloss.is_none() && left_out.len() == 1 && left_out[0].contains("gloss"), "{left_out:?}");
        assert!(!page(&sample::report()).unwrap().contains("Gloss and transfer"));
    }
}
