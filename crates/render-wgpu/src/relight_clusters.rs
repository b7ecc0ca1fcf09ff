//! Diffuse light of vertices whose transfer is in clusters: means and vectors times light once, then a short sum per vertex.

use crate::gloss_rows::{Factors, Kernels, Part, RowSet, Taken, Target, most_rows};
use crate::gloss_shared::sized;
use crate::{Error, Gpu};
use coeff_io::{DiffuseLight, Prt, Table};
use sh_math::Rgb;

/// The transfer of the vertices in clusters, and its product with the light of the last call.
#[derive(Debug)]
pub(crate) struct ClusteredRelight {
    /// Codebooks and bands.
    shell: Prt,
    channels: u32,
    factors: Factors,
    sets: Vec<RowSet>,
    lit: wgpu::Buffer,
}

impl ClusteredRelight {
    /// Uploads the table of the vertices.
    pub(crate) fn new(gpu: &Gpu, prt: &Prt, table: &Table) -> Result<Self, Error> {
        let fill = wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_DST;
        let vectors = prt.codebooks.diffuse.as_ref().map_or(0, |book| book.clusters * (1 + book.rank));
        let none = || sized(gpu, "nothing", 0, fill);
        let factors = Factors {
            matrix: none()?,
            visibility: none()?,
            bounce: none()?,
            light: none()?,
            diffuse: sized(gpu, "products of diffuse transfer", 16 * u64::from(vectors), fill)?,
        };
        let usage = wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::VERTEX | wgpu::BufferUsages::COPY_SRC;
        let lit = sized(gpu, "lit", 12 * u64::from(table.rows), usage)?;
        let (kernels, channels) = (Kernels::new(gpu), prt.transfer.channels);
        let part = Part::Diffuse { coefficients: prt.transfer.bands.pow(2), channels };
        let taken = [Taken { part, table, book: prt.codebooks.diffuse.as_ref(), number: 0 }];
        let most = most_rows(gpu, 1, prt.codebooks.diffuse.as_ref().map_or(1, |book| book.rank));
        let mut sets = Vec::new();
        for first in (0..table.rows).step_by(most as usize) {
            let run = [first, most.min(table.rows - first)];
            let mut set = RowSet::new(gpu, &kernels, &factors, 1, run, &taken)?;
            set.send_to(gpu, &kernels, &Target::Radiance(&lit), (&[], 0))?;
            sets.push(set);
        }
        Ok(Self { shell: crate::gloss::shell(prt), channels, factors, sets, lit })
    }

    /// Diffuse radiance without albedo, three floats per vertex: a vertex buffer.
    pub(crate) fn lit(&self) -> &wgpu::Buffer {
        &self.lit
    }

    /// Records the sums under `light`.
    pub(crate) fn record(&self, gpu: &Gpu, encoder: &mut wgpu::CommandEncoder, light: &Rgb) {
        let lit = DiffuseLight::new(&self.shell, self.channels, light);
        let products = lit.products().map_or(&[][..], |(_, products)| products);
        let wide: Vec<[f32; 4]> = products.iter().map(|&[r, g, b]| [r, g, b, 0.0]).collect();
        if !wide.is_empty() {
            gpu.queue.write_buffer(&self.factors.diffuse, 0, bytemuck::cast_slice(&wide));
        }
        let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor {
            label: Some("clusters under the light"),
            timestamp_writes: None,
        });
        self.sets.iter().for_each(|set| set.record(&mut pass));
    }
}
