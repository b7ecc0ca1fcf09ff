//! Vertices and triangles on the GPU.

use crate::{Error, Gpu};
use coeff_io::Prt;
use wgpu::util::DeviceExt;

/// The vertex attributes, by shader location.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Attribute {
    Position,
    Lit,
    Uv0,
    Uv1,
    Color,
    Normal,
    Tangent,
    Openness,
    /// Luminance of the light times the direction that it comes from.
    Heading,
    /// Row of gloss.
    Row,
}

impl Attribute {
    const ALL: [Self; 10] = [
        Self::Position,
        Self::Lit,
        Self::Uv0,
        Self::Uv1,
        Self::Color,
        Self::Normal,
        Self::Tangent,
        Self::Openness,
        Self::Heading,
        Self::Row,
    ];

    /// Format in memory.
    fn format(self) -> wgpu::VertexFormat {
        match self {
            Self::Position | Self::Lit | Self::Normal | Self::Heading => wgpu::VertexFormat::Float32x3,
            Self::Uv0 | Self::Uv1 => wgpu::VertexFormat::Float32x2,
            Self::Color | Self::Tangent => wgpu::VertexFormat::Float32x4,
            Self::Openness => wgpu::VertexFormat::Float32,
            Self::Row => wgpu::VertexFormat::Uint32,
        }
    }

    /// Index of its stream and offset there, in bytes. WebGPU promises eight vertex buffers, so some share one.
    fn place(self) -> (usize, u64) {
        match self {
            Self::Position => (0, 0),
            Self::Lit => (1, 0),
            Self::Uv0 => (2, 0),
            Self::Uv1 => (2, size_of::<[f32; 2]>() as u64),
            Self::Color => (3, 0),
            Self::Normal => (4, 0),
            Self::Tangent => (4, size_of::<[f32; 3]>() as u64),
            Self::Openness => (5, 0),
            Self::Heading => (6, 0),
            Self::Row => (7, 0),
        }
    }
}

/// How many streams surfaces read that neither shine nor have a normal map.
pub(crate) const DIFFUSE_STREAMS: usize = 4;
/// How many streams surfaces read that shine or whose light a normal map bends.
pub(crate) const SHAPED_STREAMS: usize = 7;
/// The same with the row of gloss.
pub(crate) const ROW_STREAMS: usize = 8;

/// Floats of the value that stands for attributes which the file lacks: as many as the longest stride.
const ABSENT: usize = 7;

/// One or two attributes of all vertices, or one value for all of them.
#[derive(Debug)]
pub(crate) struct Stream {
    pub(crate) buffer: wgpu::Buffer,
    /// `Instance` where the file lacks the attributes: one value serves all vertices.
    step: wgpu::VertexStepMode,
    stride: u64,
    attributes: Vec<wgpu::VertexAttribute>,
}

impl Stream {
    fn new(index: usize, buffer: wgpu::Buffer, step: wgpu::VertexStepMode) -> Self {
        let here = Attribute::ALL.into_iter().filter(|attribute| attribute.place().0 == index);
        let attributes = here.map(|attribute| wgpu::VertexAttribute {
            format: attribute.format(),
            offset: attribute.place().1,
            shader_location: attribute as u32,
        });
        let attributes = attributes.collect::<Vec<_>>();
        let stride = attributes.iter().map(|attribute| attribute.format.size()).sum();
        Self { buffer, step, stride, attributes }
    }

    /// The layout for pipelines.
    pub(crate) fn layout(&self) -> wgpu::VertexBufferLayout<'_> {
        wgpu::VertexBufferLayout { array_stride: self.stride, step_mode: self.step, attributes: &self.attributes }
    }
}

/// All that stands still.
#[derive(Debug)]
pub(crate) struct Geometry {
    streams: Vec<Stream>,
    /// Vertex indices, file order.
    pub(crate) triangles: wgpu::Buffer,
}

impl Geometry {
    /// Uploads what the file holds; normals, tangents and openness only where `shaped`. `lit` are the vertices' colours, `heading` where they
    /// come from, if that is asked for. `rows` are those of gloss, where vertices that shine have any.
    pub(crate) fn new(
        gpu: &Gpu,
        prt: &Prt,
        lit: wgpu::Buffer,
        heading: Option<wgpu::Buffer>,
        shaped: bool,
        rows: Option<wgpu::Buffer>,
    ) -> Result<Self, Error> {
        let geometry = &prt.geometry;
        let per_vertex = wgpu::VertexStepMode::Vertex;
        let uv = interleaved(geometry.positions.len(), [flat(&geometry.uv0), flat(&geometry.uv1)], [2, 2]);
        let mut streams = vec![
            stream(gpu, 0, "positions", &geometry.positions, 0.0)?,
            Stream::new(1, lit, per_vertex),
            stream(gpu, 2, "texture coordinates", &uv, 0.0)?,
            stream(gpu, 3, "colors", &geometry.colors, 1.0)?,
        ];
        if shaped {
            let (normals, tangents) = (flat(&geometry.normals), flat(&geometry.tangents));
            let frames = interleaved(geometry.positions.len(), [normals, tangents], [3, 4]);
            streams.push(stream(gpu, 4, "tangent frames", &frames, 0.0)?);
            streams.push(stream(gpu, 5, "openness", &prt.transfer.openness, 1.0)?);
            streams.push(match heading {
                Some(buffer) => Stream::new(6, buffer, per_vertex),
                None => stream::<[f32; 3]>(gpu, 6, "headings", &[], 0.0)?,
            });
            streams.extend(rows.map(|buffer| Stream::new(7, buffer, per_vertex)));
        }
        let triangles = buffer(gpu, "triangles", bytemuck::cast_slice(&geometry.triangles), wgpu::BufferUsages::INDEX)?;
        Ok(Self { streams, triangles })
    }

    /// The streams, in the order of their slots.
    pub(crate) fn streams(&self) -> &[Stream] {
        &self.streams
    }
}

fn stream<T: bytemuck::NoUninit>(
    gpu: &Gpu,
    index: usize,
    name: &str,
    values: &[T],
    absent: f32,
) -> Result<Stream, Error> {
    let usage = wgpu::BufferUsages::VERTEX;
    let absent = [absent; ABSENT];
    let (bytes, step) = if values.is_empty() {
        (bytemuck::bytes_of(&absent), wgpu::VertexStepMode::Instance)
    } else {
        (bytemuck::cast_slice(values), wgpu::VertexStepMode::Vertex)
    };
    Ok(Stream::new(index, buffer(gpu, name, bytes, usage)?, step))
}

fn flat<const N: usize>(values: &[[f32; N]]) -> &[f32] {
    values.as_flattened()
}

/// Two attributes of `lengths` floats side by side, zero where only one is there; nothing where both lack.
fn interleaved(vertices: usize, attributes: [&[f32]; 2], lengths: [usize; 2]) -> Vec<f32> {
    if attributes.iter().all(|values| values.is_empty()) {
        return Vec::new();
    }
    let mut mixed = vec![0.0; vertices * (lengths[0] + lengths[1])];
    for (vertex, both) in mixed.chunks_exact_mut(lengths[0] + lengths[1]).enumerate() {
        let (first, second) = both.split_at_mut(lengths[0]);
        for ((values, length), target) in attributes.iter().zip(lengths).zip([first, second]) {
            if !values.is_empty() {
                target.copy_from_slice(&values[vertex * length..][..length]);
            }
        }
    }
    mixed
}

/// A buffer filled from memory; of four bytes where there are none.
pub(crate) fn buffer(gpu: &Gpu, name: &str, bytes: &[u8], usage: wgpu::BufferUsages) -> Result<wgpu::Buffer, Error> {
    let limit = gpu.limits.max_buffer_size;
    let advice = "simplify the scene or use the CPU renderer";
    Error::check_fits(|| name.into(), bytes.len() as u64, limit, "bytes", advice)?;
    let contents = if bytes.is_empty() { &[0; 4] } else { bytes };
    Ok(gpu.device.create_buffer_init(&wgpu::util::BufferInitDescriptor { label: Some(name), contents, usage }))
}
