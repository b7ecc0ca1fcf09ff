//! Table 1 of \[T\]: frames per second of TP and TPFL at vertices and at texels, and of the kept product beside them.

use super::{Baked, Error};
use coeff_io::{GlossView, GlossWay, Prt};
use glam::Quat;
use probe_io::Environment;
use render_wgpu::{Frame, Gpu, Renderer};
use std::time::{Duration, Instant};

/// Most frames that are timed of one kind.
const MOST_FRAMES: u32 = 30;

/// Where the product is evaluated.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Stage {
    /// At vertices: the paper's baseline.
    Vertex,
    /// At fragments, from texels.
    Fragment,
}

/// Frames per second of one scene drawn in one way.
#[derive(Debug, Clone, PartialEq)]
pub struct Rate {
    /// Name of the camera.
    pub camera: String,
    /// Where the product is evaluated.
    pub stage: Stage,
    /// How.
    pub way: GlossWay,
    /// Whether the light turns with every frame.
    pub turns: bool,
    /// Frames per second, from the median.
    pub per_second: f64,
    /// Frames that were timed.
    pub frames: u32,
}

/// Draws a scene in every way through all its cameras, each for about `enough` time.
///
/// # Errors
/// [`Error::Draw`] where the GPU cannot hold or draw it.
pub fn rates(
    gpu: &Gpu,
    baked: &Baked,
    environment: &Environment,
    size: [u32; 2],
    enough: Duration,
    told: &mut dyn FnMut(&Rate),
) -> Result<Vec<Rate>, Error> {
    let mut all = Vec::new();
    for (stage, prt) in [(Stage::Vertex, &baked.at_vertices), (Stage::Fragment, &baked.at_texels)] {
        let mut renderer = Renderer::without_window(gpu, prt, environment)?;
        for camera in &prt.cameras {
            let frame = Frame::plain(camera.clone(), size[0], size[1]);
            for (way, turns) in [
                (GlossWay::Tp, false),
                (GlossWay::Tpfl, false),
                (GlossWay::Tpfl, true),
                (GlossWay::Cache, false),
                (GlossWay::Cache, true),
            ] {
                let gloss = GlossView { way: Some(way), ..GlossView::default() };
                let frame = Frame { gloss, ..frame.clone() };
                let (seconds, frames) = median(&mut renderer, &frame, turns, enough)?;
                let rate = Rate {
                    camera: camera.name.clone(),
                    stage,
                    way,
                    turns,
                    per_second: 1.0 / seconds.max(1e-9),
                    frames,
                };
                told(&rate);
                all.push(rate);
            }
        }
    }
    Ok(all)
}

/// Median seconds of a frame after a first one that warms up.
fn median(renderer: &mut Renderer, frame: &Frame, turns: bool, enough: Duration) -> Result<(f64, u32), Error> {
    let turned = |n: u32| Frame {
        rotation: if turns { Quat::from_rotation_y(0.1 * n as f32) } else { Quat::IDENTITY },
        ..frame.clone()
    };
    renderer.time(&turned(0))?;
    let began = Instant::now();
    let mut times = Vec::new();
    for n in 1..=MOST_FRAMES {
        times.push(renderer.time(&turned(n))?.frame.as_secs_f64());
        if began.elapsed() > enough {
            break;
        }
    }
    times.sort_by(f64::total_cmp);
    Ok((times[times.len() / 2], times.len() as u32))
}

/// One line of the table in Markdown for each scene and camera; `scenes` name scene, triangles, vertices and rates.
#[must_use]
pub fn rate_table(scenes: &[(&Baked, Vec<Rate>)]) -> String {
    let mut text = String::from(
        "| scene | triangles | vertices | camera | vertex: TP | TPFL | TPFL, light turns | kept | kept, light turns | fragment: TP | TPFL | TPFL, light turns | kept | kept, light turns |\n|---|---|---|---|---|---|---|---|---|---|---|---|---|---|\n",
    );
    for (baked, rates) in scenes {
        let cameras: Vec<&str> = baked.at_vertices.cameras.iter().map(|camera| camera.name.as_str()).collect();
        for camera in cameras {
            let cell = |stage, (way, turns)| {
                let found =
                    rates.iter().find(|r| r.camera == camera && (r.stage, r.way, r.turns) == (stage, way, turns));
                found.map_or("-".into(), |rate| figure(rate.per_second))
            };
            let ways = [
                (GlossWay::Tp, false),
                (GlossWay::Tpfl, false),
                (GlossWay::Tpfl, true),
                (GlossWay::Cache, false),
                (GlossWay::Cache, true),
            ];
            let cells: Vec<String> = [Stage::Vertex, Stage::Fragment]
                .into_iter()
                .flat_map(|stage| ways.map(|way| cell(stage, way)))
                .collect();
            let (name, triangles, vertices) = (&baked.name, baked.triangles, baked.vertices);
            text.push_str(&format!("| {name} | {triangles} | {vertices} | {camera} | {} |\n", cells.join(" | ")));
        }
    }
    text
}

fn figure(per_second: f64) -> String {
    match per_second {
        r if r >= 100.0 => format!("{r:.0}"),
        r if r >= 10.0 => format!("{r:.1}"),
        r if r >= 1.0 => format!("{r:.2}"),
        r => format!("{r:.3}"),
    }
}

/// Receivers that are lit for the kept product: rows at vertices or texels of all levels.
#[must_use]
pub fn receivers(prt: &Prt) -> u64 {
    let vertices = prt.gloss.iter().flat_map(|gloss| &gloss.vertices);
    let at_vertices: u64 = vertices.map(|v| u64::from(v.arriving.visibility.rows)).sum();
    at_vertices + prt.transfer_textures.as_ref().map_or(0, coeff_io::TransferTextures::texels)
}
