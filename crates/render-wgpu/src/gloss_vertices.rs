//! Gloss at vertices on the GPU.

use crate::gloss_rows::{RowSet, Taken, Target, most_rows};
use crate::gloss_shared::{Shared, sized};
use crate::gloss_sheet::{functions, radiance, tables};
use crate::{Error, Gpu, geometry};
use coeff_io::{ArrivingLight, GlossWay, Prt, VertexGloss};

/// Bytes of a function of a row: four halves.
const HALVES: u64 = 8;

/// The rows of all meshes that shine.
#[derive(Debug)]
pub(crate) struct Vertices {
    pub(crate) rows: u32,
    /// Of each vertex of the file its row; 0 where it has none.
    pub(crate) row_of: wgpu::Buffer,
    cache: Option<Kept>,
    bounces: Option<Kept>,
    visibility: Option<wgpu::Buffer>,
    bindings: Option<(GlossWay, wgpu::BindGroup)>,
}

/// Rows that are kept per light, and the passes that fill them.
#[derive(Debug)]
struct Kept {
    rows: wgpu::Buffer,
    sets: Vec<RowSet>,
    is_lit: bool,
}

impl Vertices {
    /// Uploads which vertex has which row; none where no vertex has one.
    pub(crate) fn new(gpu: &Gpu, prt: &Prt) -> Result<Option<Self>, Error> {
        let Some(vertices) = of(prt) else { return Ok(None) };
        let mut row_of = vec![0u32; prt.geometry.positions.len()];
        for (mesh, first) in prt.meshes.iter().zip(&vertices.first_row) {
            let Some(first) = first else { continue };
            let own = mesh.first_vertex as usize..(mesh.first_vertex + mesh.vertices) as usize;
            row_of[own].iter_mut().zip(*first..).for_each(|(slot, row)| *slot = row);
        }
        let row_of = geometry::buffer(gpu, "rows", bytemuck::cast_slice(&row_of), wgpu::BufferUsages::VERTEX)?;
        let rows = vertices.arriving.visibility.rows;
        Ok(Some(Self { rows, row_of, cache: None, bounces: None, visibility: None, bindings: None }))
    }

    pub(crate) fn unlight(&mut self) {
        self.cache.iter_mut().chain(&mut self.bounces).for_each(|kept| kept.is_lit = false);
    }

    /// Makes what a way reads, where it is not there yet.
    pub(crate) fn prepare(&mut self, gpu: &Gpu, prt: &Prt, shared: &Shared, way: GlossWay) -> Result<(), Error> {
        let Some(vertices) = of(prt) else { return Ok(()) };
        if way == GlossWay::Cache {
            if self.cache.is_none() {
                self.cache = Some(Kept::new(gpu, prt, shared, vertices, true)?);
            }
        } else {
            if self.bounces.is_none() && shared.bounced {
                self.bounces = Some(Kept::new(gpu, prt, shared, vertices, false)?);
            }
            if self.visibility.is_none() {
                let values = vertices.arriving.visibility.decode(prt.codebooks.visibility.as_ref());
                let usage = wgpu::BufferUsages::STORAGE;
                let limit = gpu.limits.max_storage_buffer_binding_size;
                let advice = "keep gloss in transfer textures, or use the CPU renderer";
                Error::check_fits(|| "visibility of vertices".into(), 4 * values.len() as u64, limit, "bytes", advice)?;
                let values = bytemuck::cast_slice(&values);
                self.visibility = Some(geometry::buffer(gpu, "visibility of vertices", values, usage)?);
            }
        }
        if self.bindings.as_ref().is_none_or(|(made, _)| *made != way) {
            self.bindings = Some((way, self.bind(gpu, shared, way)));
        }
        Ok(())
    }

    fn bind(&self, gpu: &Gpu, shared: &Shared, way: GlossWay) -> wgpu::BindGroup {
        let kept = if way == GlossWay::Cache { &self.cache } else { &self.bounces };
        let kept = kept.as_ref().map_or(&shared.empty, |kept| &kept.rows);
        let resources = [
            &shared.frame,
            &shared.lobes,
            &shared.light,
            &shared.factors.matrix,
            &shared.triples,
            kept,
            self.visibility.as_ref().unwrap_or(&shared.empty),
        ];
        let entries = (0..).zip(resources);
        let entries =
            entries.map(|(binding, buffer)| wgpu::BindGroupEntry { binding, resource: buffer.as_entire_binding() });
        gpu.device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("gloss of vertices"),
            layout: &shared.vertex_layout,
            entries: &entries.collect::<Vec<_>>(),
        })
    }

    /// The bindings for surfaces; none before the first frame.
    pub(crate) fn bindings(&self) -> Option<&wgpu::BindGroup> {
        self.bindings.as_ref().map(|(_, bindings)| bindings)
    }

    /// Records what the light has not been put on yet.
    pub(crate) fn record(&mut self, pass: &mut wgpu::ComputePass<'_>, way: GlossWay) {
        let kept = if way == GlossWay::Cache { &mut self.cache } else { &mut self.bounces };
        for kept in kept.iter_mut().filter(|kept| !kept.is_lit) {
            kept.sets.iter().for_each(|set| set.record(pass));
            kept.is_lit = true;
        }
    }

    pub(crate) fn write_radiance(&self, gpu: &Gpu, prt: &Prt, lit: &ArrivingLight<'_>, way: GlossWay) {
        let kept = if way == GlossWay::Cache { &self.cache } else { &self.bounces };
        if let (Some(kept), Some(vertices)) = (kept.as_ref().filter(|kept| !kept.is_lit), of(prt)) {
            kept.sets.iter().for_each(|set| set.write_radiance(gpu, &radiance(prt, lit, &vertices.arriving)));
        }
    }
}

impl Kept {
    fn new(
        gpu: &Gpu,
        prt: &Prt,
        shared: &Shared,
        vertices: &VertexGloss,
        with_visibility: bool,
    ) -> Result<Self, Error> {
        let (functions, count) = (functions(prt), vertices.arriving.visibility.rows);
        let bytes = HALVES * u64::from(functions) * u64::from(count);
        let rows = sized(gpu, "what arrives at vertices", bytes, wgpu::BufferUsages::STORAGE)?;
        let owned = tables(prt, &vertices.arriving, with_visibility);
        let parts: Vec<Taken<'_>> = owned
            .iter()
            .map(|(part, table, book, number)| Taken { part: *part, table, book: book.as_ref(), number: *number })
            .collect();
        let widest = parts.iter().map(|part| part.table.columns).max().unwrap_or(1);
        let most = most_rows(gpu, functions, widest);
        let mut sets = Vec::new();
        for first in (0..count).step_by(most as usize) {
            let run = [first, most.min(count - first)];
            let mut set = RowSet::new(gpu, &shared.kernels, &shared.factors, functions, run, &parts)?;
            set.send_to(gpu, &shared.kernels, &Target::Halves(&rows), (&[], 0))?;
            sets.push(set);
        }
        Ok(Self { rows, sets, is_lit: false })
    }
}

fn of(prt: &Prt) -> Option<&VertexGloss> {
    prt.gloss.as_ref().and_then(|gloss| gloss.vertices.as_ref())
}
