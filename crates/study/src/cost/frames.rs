//! Time per picture: what a renderer asks of each frame, by number of bands.

use coeff_io::{Prt, Transfer};
use glam::Quat;
use probe_io::Environment;
use render_wgpu::Gpu;
use std::time::Instant;

/// Columns and rows of the pictures.
pub(super) const SIZE: [u32; 2] = [640, 360];
/// Most pictures that are timed after the first one.
const MOST_FRAMES: u32 = 15;

/// How long a renderer takes for a picture under a light that turns from frame to frame.
#[derive(Debug, Clone, PartialEq)]
pub struct Frames {
    /// Who draws.
    pub renderer: String,
    /// Bands of the transfer.
    pub bands: u32,
    /// Median milliseconds per picture, after one that warms up.
    pub milliseconds: f64,
    /// Pictures that were timed.
    pub count: u32,
}

/// Times the CPU renderer; after `enough` seconds no further picture is begun.
///
/// # Errors
/// As the renderer has it.
pub(super) fn on_cpu(prt: &Prt, environment: &Environment, enough: f64) -> Result<Frames, render_cpu::Error> {
    let renderer = render_cpu::Renderer::new(prt, environment)?;
    let plain = render_cpu::Frame::plain(prt.cameras[0].clone(), SIZE[0], SIZE[1]);
    let (milliseconds, count) = median(enough, |turn| {
        let began = Instant::now();
        renderer.draw(&render_cpu::Frame { rotation: turn, ..plain.clone() })?;
        Ok(began.elapsed().as_secs_f64())
    })?;
    Ok(Frames { renderer: "CPU".into(), bands: prt.transfer.bands, milliseconds, count })
}

/// Times a GPU; nothing is read back. After `enough` seconds no further picture is begun.
///
/// # Errors
/// As the renderer has it; where there is no adapter it says so.
pub(super) fn on_gpu(
    gpu: &Gpu,
    prt: &Prt,
    environment: &Environment,
    enough: f64,
) -> Result<Frames, render_wgpu::Error> {
    let mut renderer = render_wgpu::Renderer::new(gpu, prt, environment)?;
    let plain = render_wgpu::Frame::plain(prt.cameras[0].clone(), SIZE[0], SIZE[1]);
    let (milliseconds, count) = median(enough, |turn| {
        let timings = renderer.time(&render_wgpu::Frame { rotation: turn, ..plain.clone() })?;
        Ok(timings.frame.as_secs_f64())
    })?;
    Ok(Frames { renderer: format!("GPU: {}", gpu.description()), bands: prt.transfer.bands, milliseconds, count })
}

/// Median milliseconds of frames whose light turns, after a first one that is not counted.
fn median<E>(enough: f64, mut frame: impl FnMut(Quat) -> Result<f64, E>) -> Result<(f64, u32), E> {
    let turn = |n: u32| Quat::from_rotation_y(0.1 * n as f32);
    frame(turn(0))?;
    let began = Instant::now();
    let mut times = Vec::new();
    for n in 1..=MOST_FRAMES {
        times.push(1e3 * frame(turn(n))?);
        if began.elapsed().as_secs_f64() > enough {
            break;
        }
    }
    times.sort_by(f64::total_cmp);
    Ok((times[times.len() / 2], times.len() as u32))
}

/// The same file with the first so many bands of its transfer.
pub(super) fn with_bands(prt: &Prt, bands: u32) -> Prt {
    Prt { transfer: truncated(&prt.transfer, bands), ..prt.clone() }
}

/// The first so many bands of a transfer; all of them where it has fewer.
pub(super) fn truncated(transfer: &Transfer, bands: u32) -> Transfer {
    let bands = bands.min(transfer.bands);
    let row = |bands: u32| (bands * bands * transfer.channels) as usize;
    let rows = transfer.values.chunks_exact(row(transfer.bands).max(1));
    let values = rows.flat_map(|values| &values[..row(bands)]).copied().collect();
    Transfer { bands, values, ..transfer.clone() }
}
