//! Transfer meets light: the diffuse radiance of every vertex.

use coeff_io::Transfer;
use glam::{Vec3, Vec4};
use rayon::prelude::*;

/// Vertices per parallel piece of work.
const CHUNK: usize = 1024;

/// Outgoing radiance of each vertex for albedo 1: the paper's eq. (10), one dot product per channel; not clamped.
///
/// `light` holds bands² coefficients of radiance per channel, in world space.
pub fn vertex_radiance(transfer: &Transfer, light: &[[f32; 3]]) -> Vec<Vec3> {
    // Four lanes, so that the three channels go through one instruction.
    let light: Vec<Vec4> = light.iter().map(|&l| Vec3::from(l).extend(0.0)).collect();
    let row = light.len() * transfer.channels as usize;
    let mut out = vec![Vec3::ZERO; transfer.values.len().checked_div(row).unwrap_or(0)];
    out.par_chunks_mut(CHUNK).zip(transfer.values.par_chunks(CHUNK * row.max(1))).for_each(|(out, values)| {
        for (radiance, values) in out.iter_mut().zip(values.chunks_exact(row)) {
            *radiance = if transfer.channels == 1 { dot_grey(values, &light) } else { dot_colour(values, &light) };
        }
    });
    out
}

/// Luminance of what each vertex takes, times the direction that it comes from; `heading` is that of the light. Of three channels the mean
/// is taken: they differ by what colours add to bounces.
pub(crate) fn vertex_heading(transfer: &Transfer, heading: &[[f32; 3]]) -> Vec<Vec3> {
    let channels = transfer.channels as usize;
    let share = 1.0 / channels as f32;
    let rows = transfer.values.par_chunks((heading.len() * channels).max(1));
    rows.map(|row| {
        let pairs = row.chunks_exact(channels).zip(heading);
        pairs.map(|(t, &h)| Vec3::from(h) * (share * t.iter().sum::<f32>())).sum()
    })
    .collect()
}

fn dot_grey(transfer: &[f32], light: &[Vec4]) -> Vec3 {
    transfer.iter().zip(light).map(|(&t, &l)| l * t).sum::<Vec4>().truncate()
}

fn dot_colour(transfer: &[f32], light: &[Vec4]) -> Vec3 {
    let rows = transfer.chunks_exact(3).map(|t| Vec4::new(t[0], t[1], t[2], 0.0));
    rows.zip(light).map(|(t, &l)| t * l).sum::<Vec4>().truncate()
}
