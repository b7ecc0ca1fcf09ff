//! Pixels from a texture back to memory.

use crate::{Error, Gpu};
use std::sync::{Arc, Mutex, PoisonError};
use std::task::{Poll, Waker};

/// A texture on its way to memory.
pub(crate) struct Readback {
    buffer: wgpu::Buffer,
    format: wgpu::TextureFormat,
    row_bytes: usize,
    padded_row_bytes: usize,
}

impl Readback {
    /// Records the copy of all of `texture`.
    pub(crate) fn record(
        gpu: &Gpu,
        encoder: &mut wgpu::CommandEncoder,
        texture: &wgpu::Texture,
    ) -> Result<Self, Error> {
        let format = texture.format();
        let row_bytes = texture.width() * format.block_copy_size(None).unwrap_or(16);
        let padded = row_bytes.next_multiple_of(wgpu::COPY_BYTES_PER_ROW_ALIGNMENT);
        let size = u64::from(padded) * u64::from(texture.height());
        let what = || format!("reading back a picture of {}x{}", texture.width(), texture.height());
        Error::check_fits(what, size, gpu.limits.max_buffer_size, "bytes", "ask for a smaller picture")?;
        let buffer = gpu.device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("readback"),
            size,
            usage: wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ,
            mapped_at_creation: false,
        });
        encoder.copy_texture_to_buffer(
            texture.as_image_copy(),
            wgpu::TexelCopyBufferInfo {
                buffer: &buffer,
                layout: wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(padded), rows_per_image: None },
            },
            texture.size(),
        );
        Ok(Self { buffer, format, row_bytes: row_bytes as usize, padded_row_bytes: padded as usize })
    }

    /// The colours of a linear picture, of whichever floats it has.
    pub(crate) async fn read_linear(self, gpu: &Gpu) -> Result<Vec<[f32; 3]>, Error> {
        if self.format == wgpu::TextureFormat::Rgba16Float {
            self.read(gpu, |&[r, g, b, _]: &[half::f16; 4]| [r, g, b].map(half::f16::to_f32)).await
        } else {
            self.read(gpu, |&[r, g, b, _]: &[f32; 4]| [r, g, b]).await
        }
    }

    /// Waits for the copy, which must have been submitted, and converts each texel of type `T`.
    pub(crate) async fn read<T: bytemuck::AnyBitPattern, U>(
        self,
        gpu: &Gpu,
        convert: impl Fn(&T) -> U,
    ) -> Result<Vec<U>, Error> {
        let bytes = map(gpu, &self.buffer).await?;
        let rows = bytes.chunks_exact(self.padded_row_bytes);
        let texels = rows.flat_map(|row| bytemuck::cast_slice::<u8, T>(&row[..self.row_bytes]));
        Ok(texels.map(convert).collect())
    }
}

/// The answer to a request for the bytes of a buffer.
#[derive(Debug, Default)]
struct Answer {
    result: Option<Result<(), wgpu::BufferAsyncError>>,
    waker: Option<Waker>,
}

/// Shows the bytes of a mappable buffer once the device is done with it.
async fn map(gpu: &Gpu, buffer: &wgpu::Buffer) -> Result<wgpu::BufferView, Error> {
    let failed = |reason: String| Error::Gpu { doing: "reading back", reason };
    let answer = Arc::new(Mutex::new(Answer::default()));
    let told = Arc::clone(&answer);
    buffer.map_async(wgpu::MapMode::Read, .., move |result| {
        let mut told = told.lock().unwrap_or_else(PoisonError::into_inner);
        told.result = Some(result);
        told.waker.take().into_iter().for_each(Waker::wake);
    });
    let mapped = std::future::poll_fn(|context| {
        // A browser answers of its own accord; elsewhere a device answers when it is asked.
        let polled = gpu.device.poll(wgpu::PollType::Poll);
        let mut answer = answer.lock().unwrap_or_else(PoisonError::into_inner);
        match (answer.result.take(), polled) {
            (Some(result), _) => Poll::Ready(result.map_err(|error| failed(error.to_string()))),
            (None, Err(error)) => Poll::Ready(Err(failed(error.to_string()))),
            (None, Ok(_)) => {
                answer.waker = Some(context.waker().clone());
                if cfg!(not(target_arch = "wasm32")) {
                    context.waker().wake_by_ref();
                }
                Poll::Pending
            }
        }
    });
    mapped.await?;
    buffer.get_mapped_range(..).map_err(|error| failed(error.to_string()))
}

/// Copies a whole buffer back, for tests of what shaders write.
#[cfg(test)]
pub(crate) fn buffer<T: bytemuck::AnyBitPattern>(gpu: &Gpu, source: &wgpu::Buffer) -> Result<Vec<T>, Error> {
    let copy = gpu.device.create_buffer(&wgpu::BufferDescriptor {
        label: Some("readback"),
        size: source.size(),
        usage: wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ,
        mapped_at_creation: false,
    });
    let mut encoder = gpu.device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
    encoder.copy_buffer_to_buffer(source, 0, &copy, 0, source.size());
    gpu.queue.submit([encoder.finish()]);
    gpu.wait()?;
    Ok(bytemuck::cast_slice(&pollster::block_on(map(gpu, &copy))?).to_vec())
}
