//! Pictures of the GPU beside those of the CPU.

use render_wgpu::{Driver, Frame, Gpu, Image, Tonemap};

/// A software device; None, with a line that says so, where there is none and none is required.
pub(crate) fn gpu() -> Option<Gpu> {
    match Gpu::new(Driver::Software) {
        Ok(gpu) => Some(gpu),
        Err(error) if std::env::var_os("RELUME_REQUIRE_GPU").is_some_and(|value| value == "1") => {
            panic!("RELUME_REQUIRE_GPU=1 but {error}")
        }
        Err(_) => {
            testkit::say_skipped("drawing with a software driver (no adapter)");
            None
        }
    }
}

/// A pixel is far when a display channel differs by more than this many steps of 255: texture filters of GPUs
/// weigh texels in steps of 1/256.
const FAR: u8 = 2;
/// Share of far pixels: outlines and edges of masks may fall on the other side of a sample by rounding.
const FAR_SHARE: f64 = 0.003;
/// Mean difference of linear values over the mean value, far pixels included.
const MEAN_TOLERANCE: f64 = 2e-3;

/// How far apart two pictures are.
#[derive(Debug)]
pub(crate) struct Distance {
    far_share: f64,
    mean: f64,
}

impl Distance {
    pub(crate) fn is_small(&self) -> bool {
        self.far_share <= FAR_SHARE && self.mean <= MEAN_TOLERANCE
    }
}

pub(crate) fn distance(gpu: &Image, cpu: &render_cpu::Image) -> Distance {
    let pixels = cpu.display.len();
    assert_eq!((gpu.linear.len(), gpu.display.len()), (pixels, pixels), "pictures of one size");
    let is_far = |(a, b): &(&[u8; 4], &[u8; 4])| a.iter().zip(*b).any(|(a, b)| a.abs_diff(*b) > FAR);
    let far = gpu.display.iter().zip(&cpu.display).filter(is_far).count();
    let sum = |values: &mut dyn Iterator<Item = f64>| values.sum::<f64>();
    let (ours, theirs) = (gpu.linear.as_flattened(), cpu.linear.as_flattened());
    let difference = sum(&mut ours.iter().zip(theirs).map(|(a, b)| f64::from((a - b).abs())));
    let total = sum(&mut theirs.iter().map(|&b| f64::from(b)));
    Distance { far_share: far as f64 / pixels as f64, mean: difference / total }
}

pub(crate) fn cpu_frame(frame: &Frame) -> render_cpu::Frame {
    render_cpu::Frame {
        camera: frame.camera.clone(),
        width: frame.width,
        height: frame.height,
        rotation: frame.rotation,
        exposure_ev: frame.exposure_ev,
        tonemap: match frame.tonemap {
            Tonemap::None => render_cpu::Tonemap::None,
            Tonemap::Reinhard => render_cpu::Tonemap::Reinhard,
            Tonemap::Filmic => render_cpu::Tonemap::Filmic,
        },
        bloom: frame.bloom,
        supersample: frame.supersample,
        sky: frame.sky,
        albedo: frame.albedo,
        basis: frame.basis,
        functions: frame.functions,
        gloss: frame.gloss,
    }
}
