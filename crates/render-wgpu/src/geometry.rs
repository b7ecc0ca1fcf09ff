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
    /// What surfaces without shine read.
    pub(crate) const DIFFUSE: [Self; 5] = [Self::Position, Self::Lit, Self::Uv0, Self::Uv1, Self::Color];
    /// What only surfaces that shine, or whose light a normal map bends, read besides.
    pub(crate) const SHINY: [Self; 4] = [Self::Normal, Self::Tangent, Self::Openness, Self::Heading];

    /// Format in memory.
    pub(crate) fn format(self) -> wgpu::VertexFormat {
        match self {
            Self::Position | Self::Lit | Self::Normal | Self::Heading => wgpu::VertexFormat::Float32x3,
            Self::Uv0 | Self::Uv1 => wgpu::VertexFormat::Float32x2,
            Self::Color | Self::Tangent => wgpu::VertexFormat::Float32x4,
            Self::Openness => wgpu::VertexFormat::Float32,
            Self::Row => wgpu::VertexFormat::Uint32,
        }
    }
}

/// One attribute of all vertices, or one value for all of them.
#[derive(Debug)]
pub(crate) struct Stream {
    pub(crate) buffer: wgpu::Buffer,
    /// `Instance` where the file lacks the attribute: one value of 16 bytes serves all vertices.
    pub(crate) step: wgpu::VertexStepMode,
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
        let mut streams = vec![
            stream(gpu, "positions", &geometry.positions, [0.0; 4])?,
            Stream { buffer: lit, step: wgpu::VertexStepMode::Vertex },
            stream(gpu, "uv0", &geometry.uv0, [0.0; 4])?,
            stream(gpu, "uv1", &geometry.uv1, [0.0; 4])?,
            stream(gpu, "colors", &geometry.colors, [1.0; 4])?,
        ];
        if shaped {
            streams.push(stream(gpu, "normals", &geometry.normals, [0.0; 4])?);
            streams.push(stream(gpu, "tangents", &geometry.tangents, [0.0; 4])?);
            streams.push(stream(gpu, "openness", &prt.transfer.openness, [1.0; 4])?);
            streams.push(match heading {
                Some(buffer) => Stream { buffer, step: wgpu::VertexStepMode::Vertex },
                None => stream::<[f32; 3]>(gpu, "headings", &[], [0.0; 4])?,
            });
            streams.extend(rows.map(|buffer| Stream { buffer, step: wgpu::VertexStepMode::Vertex }));
        }
        let triangles = buffer(gpu, "triangles", bytemuck::cast_slice(&geometry.triangles), wgpu::BufferUsages::INDEX)?;
        Ok(Self { streams, triangles })
    }

    /// The buffer of an attribute.
    pub(crate) fn stream(&self, attribute: Attribute) -> &Stream {
        &self.streams[attribute as usize]
    }
}

fn stream<T: bytemuck::NoUninit>(gpu: &Gpu, name: &str, values: &[T], absent: [f32; 4]) -> Result<Stream, Error> {
    let usage = wgpu::BufferUsages::VERTEX;
    let (bytes, step) = if values.is_empty() {
        (bytemuck::bytes_of(&absent), wgpu::VertexStepMode::Instance)
    } else {
        (bytemuck::cast_slice(values), wgpu::VertexStepMode::Vertex)
    };
    Ok(Stream { buffer: buffer(gpu, name, bytes, usage)?, step })
}

/// A buffer filled from memory; of four bytes where there are none.
pub(crate) fn buffer(gpu: &Gpu, name: &str, bytes: &[u8], usage: wgpu::BufferUsages) -> Result<wgpu::Buffer, Error> {
    let limit = gpu.limits.max_buffer_size;
    let advice = "simplify the scene or use the CPU renderer";
    Error::check_fits(|| name.into(), bytes.len() as u64, limit, "bytes", advice)?;
    let contents = if bytes.is_empty() { &[0; 4] } else { bytes };
    Ok(gpu.device.create_buffer_init(&wgpu::util::BufferInitDescriptor { label: Some(name), contents, usage }))
}
