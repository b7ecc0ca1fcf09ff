//! Bloom: a blur pyramid of the exposed picture, mixed in (docs/shading.md, Picture 3).

use crate::{Error, Gpu, fullscreen::FullscreenPass, picture, shaders};

/// The three steps of the pyramid.
#[derive(Debug)]
pub(crate) struct Bloom {
    down: FullscreenPass,
    up: FullscreenPass,
    mix: FullscreenPass,
}

/// The textures and bindings for pictures of one size.
#[derive(Debug)]
pub(crate) struct Pyramid {
    /// P_0: where the exposed picture is to be drawn.
    pub(crate) exposed: wgpu::TextureView,
    down: Vec<Step>,
    up: Vec<Step>,
    mix: wgpu::BindGroup,
}

/// One run of a pass.
#[derive(Debug)]
struct Step {
    bindings: wgpu::BindGroup,
    target: wgpu::TextureView,
}

/// Number of levels for a picture of this size.
pub(crate) fn levels([width, height]: [u32; 2]) -> u32 {
    width.min(height).ilog2().saturating_sub(3).clamp(1, 8)
}

impl Bloom {
    /// Builds the pipelines.
    pub(crate) fn new(gpu: &Gpu) -> Self {
        let pass = |entry| FullscreenPass::new(&gpu.device, shaders::BLOOM, entry, &[], gpu.linear());
        Self { down: pass("bloom_down"), up: pass("bloom_up"), mix: pass("bloom_mix") }
    }

    /// Creates the textures of the pyramid; `post` holds the strength.
    pub(crate) fn pyramid(&self, gpu: &Gpu, size: [u32; 2], post: &wgpu::Buffer) -> Result<Pyramid, Error> {
        let sizes = std::iter::successors(Some(size), |size| Some(size.map(|side| side.div_ceil(2))));
        let sizes = sizes.take(levels(size) as usize + 1).collect::<Vec<_>>();
        let level = |size: &[u32; 2]| {
            let usage = wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::TEXTURE_BINDING;
            let texture = picture::create(gpu, "a level of the bloom", *size, 1, gpu.linear(), usage)?;
            Ok(picture::view(&texture))
        };
        let fine = sizes.iter().map(level).collect::<Result<Vec<_>, Error>>()?;
        let inner = &sizes[1..sizes.len() - 1];
        // S_1 .. S_{n-1}; the coarsest sum is the coarsest level itself.
        let mut sums = inner.iter().map(level).collect::<Result<Vec<_>, Error>>()?;
        sums.extend(fine.last().cloned());
        let texture = wgpu::BindingResource::TextureView;
        let down = fine.windows(2).map(|pair| Step {
            bindings: self.down.bind(&gpu.device, &[(1, texture(&pair[0]))]),
            target: pair[1].clone(),
        });
        let up = sums.windows(2).zip(&fine[1..]).map(|(pair, level)| Step {
            bindings: self.up.bind(&gpu.device, &[(1, texture(level)), (2, texture(&pair[1]))]),
            target: pair[0].clone(),
        });
        let resources = [(0, post.as_entire_binding()), (1, texture(&fine[0])), (2, texture(&sums[0]))];
        let mix = self.mix.bind(&gpu.device, &resources);
        Ok(Pyramid { down: down.collect(), up: up.rev().collect(), mix, exposed: fine[0].clone() })
    }

    /// Records the blur of the exposed picture and its mixture into `target`.
    pub(crate) fn record(&self, encoder: &mut wgpu::CommandEncoder, pyramid: &Pyramid, target: &wgpu::TextureView) {
        for step in &pyramid.down {
            self.down.record(encoder, &step.bindings, &step.target);
        }
        for step in &pyramid.up {
            self.up.record(encoder, &step.bindings, &step.target);
        }
        self.mix.record(encoder, &pyramid.mix, target);
    }
}
