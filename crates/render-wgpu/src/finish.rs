//! From drawn samples to the picture: mean, exposure, bloom, tone curve, encoding.

use crate::bloom::{self, Bloom, Pyramid};
use crate::fullscreen::FullscreenPass;
use crate::target::{Encoding, Target};
use crate::targets::{Size, Targets};
use crate::{Error, Frame, Gpu, Tonemap, gpu_data, picture, shaders};
use std::collections::HashMap;

/// The passes after the scene; those of bloom and of each tone curve are built when a frame first asks for them.
#[derive(Debug)]
pub(crate) struct Finish {
    post: wgpu::Buffer,
    resolve: FullscreenPass,
    bloom: Option<Bloom>,
    pyramid: Option<(Size, Pyramid)>,
    display: HashMap<(Tonemap, wgpu::TextureFormat), FullscreenPass>,
}

impl Finish {
    /// Builds what every frame needs.
    pub(crate) fn new(gpu: &Gpu) -> Self {
        let post = gpu.device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("post"),
            size: size_of::<gpu_data::Post>() as u64,
            usage: wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST,
            mapped_at_creation: false,
        });
        let resolve = FullscreenPass::new(&gpu.device, shaders::RESOLVE, "resolve", &[], gpu.linear());
        Self { post, resolve, bloom: None, pyramid: None, display: HashMap::new() }
    }

    /// Records everything from `targets.samples` to `targets.linear` and `output`.
    pub(crate) fn record(
        &mut self,
        gpu: &Gpu,
        encoder: &mut wgpu::CommandEncoder,
        targets: &Targets,
        output: &Target<'_>,
        frame: &Frame,
    ) -> Result<(), Error> {
        let numbers = gpu_data::Post {
            exposure: frame.exposure_ev.exp2(),
            supersample: frame.supersample,
            bloom: frame.bloom,
            levels: bloom::levels(targets.size.pixels()) as f32,
            largest: picture::largest(gpu.linear()),
        };
        gpu.queue.write_buffer(&self.post, 0, bytemuck::bytes_of(&numbers));
        let linear = picture::view(&targets.linear);
        if frame.bloom > 0.0 {
            self.record_bloom(gpu, encoder, targets, &linear)?;
        } else {
            self.record_resolve(gpu, encoder, targets, &linear);
        }
        self.record_display(gpu, encoder, output, &linear, frame.tonemap);
        Ok(())
    }

    fn record_resolve(
        &self,
        gpu: &Gpu,
        encoder: &mut wgpu::CommandEncoder,
        targets: &Targets,
        target: &wgpu::TextureView,
    ) {
        let samples = wgpu::BindingResource::TextureView(&targets.samples);
        let bindings = self.resolve.bind(&gpu.device, &[(0, self.post.as_entire_binding()), (1, samples)]);
        self.resolve.record(encoder, &bindings, target);
    }

    fn record_bloom(
        &mut self,
        gpu: &Gpu,
        encoder: &mut wgpu::CommandEncoder,
        targets: &Targets,
        linear: &wgpu::TextureView,
    ) -> Result<(), Error> {
        let bloom = self.bloom.take().unwrap_or_else(|| Bloom::new(gpu));
        let pyramid = match self.pyramid.take() {
            Some((size, pyramid)) if size == targets.size => pyramid,
            _ => bloom.pyramid(gpu, targets.size.pixels(), &self.post)?,
        };
        self.record_resolve(gpu, encoder, targets, &pyramid.exposed);
        bloom.record(encoder, &pyramid, linear);
        self.bloom = Some(bloom);
        self.pyramid = Some((targets.size, pyramid));
        Ok(())
    }

    fn record_display(
        &mut self,
        gpu: &Gpu,
        encoder: &mut wgpu::CommandEncoder,
        output: &Target<'_>,
        linear: &wgpu::TextureView,
        tonemap: Tonemap,
    ) {
        let format = output.format;
        let pass = self.display.entry((tonemap, format)).or_insert_with(|| {
            let encoding = f64::from(Encoding::new(format) as u32);
            let constants = [("curve", f64::from(curve(tonemap))), ("encoding", encoding)];
            FullscreenPass::new(&gpu.device, shaders::DISPLAY, "display", &constants, format)
        });
        let bindings = pass.bind(&gpu.device, &[(0, wgpu::BindingResource::TextureView(linear))]);
        pass.record(encoder, &bindings, output.view);
    }
}

/// The number of a tone curve in tone.wgsl.
pub(crate) fn curve(tonemap: Tonemap) -> u32 {
    match tonemap {
        Tonemap::None => 0,
        Tonemap::Reinhard => 1,
        Tonemap::Filmic => 2,
    }
}
