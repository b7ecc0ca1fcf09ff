//! Triangles that are drawn over what lies behind them: sorted for every view, farthest first.

use crate::{Error, Gpu, draw::Draw, gpu_data};
use coeff_io::Prt;
use glam::Vec3;

/// The blended triangles of a scene.
#[derive(Debug)]
pub(crate) struct Blended {
    triangles: Vec<Triangle>,
    /// Vertex indices in the order of the last sort.
    pub(crate) indices: wgpu::Buffer,
}

#[derive(Debug)]
struct Triangle {
    corners: [Vec3; 3],
    indices: [u32; 3],
    /// How it is drawn, without triangles.
    kind: Draw,
}

impl Blended {
    /// Gathers the triangles of the given draws, in file order; None where there are none.
    pub(crate) fn new(gpu: &Gpu, prt: &Prt, draws: &[Draw]) -> Result<Option<Self>, Error> {
        let position = |index: u32| Vec3::from(prt.geometry.positions[index as usize]);
        let triangles = draws
            .iter()
            .flat_map(|draw| draw.triangles.clone().map(move |triangle| (draw, triangle)))
            .map(|(draw, triangle)| {
                let indices = prt.geometry.triangles[triangle as usize];
                let corners = indices.map(position);
                Triangle { corners, indices, kind: draw.kind() }
            })
            .collect::<Vec<_>>();
        if triangles.is_empty() {
            return Ok(None);
        }
        let size = (triangles.len() * size_of::<[u32; 3]>()) as u64;
        let advice = "simplify the scene or use the CPU renderer";
        Error::check_fits(|| "blended triangles".into(), size, gpu.limits.max_buffer_size, "bytes", advice)?;
        let indices = gpu.device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("blended triangles"),
            size,
            usage: wgpu::BufferUsages::INDEX | wgpu::BufferUsages::COPY_DST,
            mapped_at_creation: false,
        });
        Ok(Some(Self { triangles, indices }))
    }

    /// Uploads the indices farthest first and returns the runs of one material and light map in them.
    pub(crate) fn sort(&self, gpu: &Gpu, view: &gpu_data::View) -> Vec<Draw> {
        let order = self.order(view);
        let indices = order.iter().map(|&i| self.triangles[i].indices).collect::<Vec<_>>();
        gpu.queue.write_buffer(&self.indices, 0, bytemuck::cast_slice(&indices));
        let mut draws: Vec<Draw> = Vec::new();
        for (place, triangle) in (0..).zip(order.iter().map(|&i| &self.triangles[i])) {
            match draws.last_mut() {
                Some(draw) if draw.kind() == triangle.kind => draw.triangles.end = place + 1,
                _ => draws.push(Draw { triangles: place..place + 1, ..triangle.kind.clone() }),
            }
        }
        draws
    }

    /// Mean view depth decides, of equals the lower index comes first.
    fn order(&self, view: &gpu_data::View) -> Vec<usize> {
        let (eye, forward) = (Vec3::from(view.eye), Vec3::from(view.forward));
        let depth = |corner: Vec3| forward.dot(corner - eye);
        let depths = self.triangles.iter().map(|t| t.corners.map(depth)).map(|[a, b, c]| (a + b + c) / 3.0);
        let depths = depths.collect::<Vec<_>>();
        let mut order = (0..self.triangles.len()).collect::<Vec<_>>();
        order.sort_by(|&a, &b| depths[b].total_cmp(&depths[a]));
        order
    }
}
