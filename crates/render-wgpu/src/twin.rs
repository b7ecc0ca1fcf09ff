//! Each WGSL function against its Rust twin, on a GPU: tests only.

mod gloss;
mod hemisphere;
mod sheets;

use crate::relight::Relight;
use crate::{Driver, Error, Frame, Gpu, Tonemap, finish, geometry, gpu_data, readback, view};
use coeff_io::{Camera, Transfer};
use glam::{Quat, Vec3};
use sh_math::{Bands, Rgb};

/// A software device; None, with a line that says so, where there is none and none is required.
fn gpu() -> Option<Gpu> {
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

/// The functions without bindings, and those of the view.
const FUNCTIONS: &str = concat!(
    include_str!("../shaders/view.wgsl"),
    include_str!("../shaders/equirect.wgsl"),
    include_str!("../shaders/brdf.wgsl"),
    include_str!("../shaders/tone.wgsl"),
);

/// Evaluates a WGSL expression of `x: vec4<f32>` with the functions of `library` on every input.
fn evaluate(
    gpu: &Gpu,
    library: &str,
    expression: &str,
    view: Option<&gpu_data::View>,
    inputs: &[[f32; 4]],
) -> Vec<[f32; 4]> {
    let text = format!(
        "{library}
        @group(1) @binding(0) var<storage, read> inputs: array<vec4<f32>>;
        @group(1) @binding(1) var<storage, read_write> outputs: array<vec4<f32>>;
        @compute @workgroup_size(64) fn main(@builtin(global_invocation_id) id: vec3<u32>) {{
            if id.x < arrayLength(&inputs) {{ let x = inputs[id.x]; outputs[id.x] = {expression}; }}
        }}"
    );
    let device = &gpu.device;
    let module = device.create_shader_module(wgpu::ShaderModuleDescriptor {
        label: Some("twin"),
        source: wgpu::ShaderSource::Wgsl(text.into()),
    });
    let pipeline = device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
        label: Some("twin"),
        layout: None,
        module: &module,
        entry_point: Some("main"),
        compilation_options: wgpu::PipelineCompilationOptions::default(),
        cache: None,
    });
    let bytes = bytemuck::cast_slice(inputs);
    let upload = |bytes, usage| geometry::buffer(gpu, "twin", bytes, usage).expect("a small buffer");
    let storage = wgpu::BufferUsages::STORAGE;
    let (source, result) = (upload(bytes, storage), upload(bytes, storage | wgpu::BufferUsages::COPY_SRC));
    let bind = |group, buffers: &[&wgpu::Buffer]| {
        let entries = (0..).zip(buffers);
        let entries =
            entries.map(|(binding, buffer)| wgpu::BindGroupEntry { binding, resource: buffer.as_entire_binding() });
        device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: None,
            layout: &pipeline.get_bind_group_layout(group),
            entries: &entries.collect::<Vec<_>>(),
        })
    };
    let view = view.map(|view| bind(0, &[&upload(bytemuck::bytes_of(view), wgpu::BufferUsages::UNIFORM)]));
    let mut encoder = device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
    {
        let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor::default());
        pass.set_pipeline(&pipeline);
        pass.set_bind_group(0, view.as_ref(), &[]);
        pass.set_bind_group(1, &bind(1, &[&source, &result]), &[]);
        pass.dispatch_workgroups(inputs.len().div_ceil(64) as u32, 1, 1);
    }
    gpu.queue.submit([encoder.finish()]);
    readback::buffer(gpu, &result).expect("results")
}

/// Largest error of `expression` against `exact` over the inputs, relative to `1 + |exact|`.
fn worst<const N: usize>(
    gpu: &Gpu,
    library: &str,
    expression: &str,
    view: Option<&gpu_data::View>,
    inputs: &[[f32; 4]],
    exact: impl Fn([f32; 4]) -> [f64; N],
) -> f64 {
    let results = evaluate(gpu, library, expression, view, inputs);
    let errors = inputs.iter().zip(results).flat_map(|(&input, result)| {
        let pairs = exact(input).into_iter().zip(result);
        pairs.map(|(exact, result)| (f64::from(result) - exact).abs() / (1.0 + exact.abs())).collect::<Vec<_>>()
    });
    // A NaN must not vanish in a maximum.
    errors.fold(0.0, |worst, error| if error <= worst { worst } else { error })
}

/// Directions all over the sphere, the axes and the seam among them.
fn directions() -> Vec<[f32; 4]> {
    let golden = std::f64::consts::PI * (3.0 - 5f64.sqrt());
    let spiral = (0..2000).map(|i| {
        let y = 1.0 - (2.0 * f64::from(i) + 1.0) / 2000.0;
        let (sin, cos) = (golden * f64::from(i)).sin_cos();
        let radius = (1.0 - y * y).sqrt();
        [(radius * sin) as f32, y as f32, (radius * cos) as f32, 0.0]
    });
    let axes = Vec3::AXES.into_iter().flat_map(|axis| [axis, -axis]);
    spiral.chain(axes.map(|axis| axis.extend(0.0).to_array())).collect()
}

/// Texel coordinates on a panorama of 1 by 1 (docs/conventions.md), in f64.
fn equirect([x, y, z, _]: [f32; 4]) -> [f64; 2] {
    let (x, y, z) = (f64::from(x), f64::from(y), f64::from(z));
    let longitude = f64::atan2(-x, z);
    [longitude / std::f64::consts::TAU + 0.5, x.hypot(z).atan2(y) / std::f64::consts::PI]
}

/// Drivers may be off by 4096 units in the last place in atan2 (Vulkan): 5e-4; lavapipe's polynomial is far better.
const ANGLE_TOLERANCE: f64 = 2e-5;
/// A few roundings and an exp2 or a pow.
const TOLERANCE: f64 = 3e-6;
/// Roundings of terms of up to 50 that cancel.
const FIT_TOLERANCE: f64 = 3e-5;

#[test]
fn equirect_position_is_its_twin() {
    let Some(gpu) = gpu() else { return };
    // At the seam both ends of the picture are right; the fraction of a turn is compared.
    let call = "vec4<f32>(equirect_position(x.xyz, vec2<f32>(1.0)), 0.0, 0.0)";
    let inputs = directions().into_iter().filter(|d| !(d[0] == 0.0 && d[2] <= 0.0)).collect::<Vec<_>>();
    let error = worst(&gpu, FUNCTIONS, call, None, &inputs, equirect);
    assert!(error < ANGLE_TOLERANCE, "off by {error}");
}

#[test]
fn equirect_position_can_fail() {
    let Some(gpu) = gpu() else { return };
    let mirrored = "vec4<f32>(equirect_position(x.xyz * vec3<f32>(-1.0, 1.0, 1.0), vec2<f32>(1.0)), 0.0, 0.0)";
    let error = worst(&gpu, FUNCTIONS, mirrored, None, &directions(), equirect);
    assert!(error > 0.1, "a mirrored picture must be noticed, but is off by {error} only");
}

fn roughness_and_cosine() -> Vec<[f32; 4]> {
    (0..33 * 33).map(|i| [(i % 33) as f32 / 32.0, (i / 33) as f32 / 32.0, 0.0, 0.0]).collect()
}

#[test]
fn environment_brdf_is_its_twin() {
    let Some(gpu) = gpu() else { return };
    let call = "vec4<f32>(environment_brdf(x.x, x.y), diffuse_loss(x.y), lobe_above(x.x, x.y))";
    let exact = |x: [f32; 4]| {
        let [scale, bias] = sh_math::brdf::environment_brdf(x[0], x[1]);
        [scale, bias, sh_math::brdf::diffuse_loss(x[1]), sh_math::lobe::above(x[0], x[1])].map(f64::from)
    };
    let error = worst(&gpu, FUNCTIONS, call, None, &roughness_and_cosine(), exact);
    assert!(error < FIT_TOLERANCE, "off by {error}");
}

#[test]
fn environment_brdf_can_fail() {
    let Some(gpu) = gpu() else { return };
    let swapped = "vec4<f32>(environment_brdf(x.y, x.x), 0.0, 0.0)";
    let exact = |x: [f32; 4]| render_cpu::environment_brdf(x[0], x[1]).map(f64::from);
    let error = worst(&gpu, FUNCTIONS, swapped, None, &roughness_and_cosine(), exact);
    assert!(error > 0.01, "swapped arguments must be noticed, but are off by {error} only");
}

const CURVES: [(Tonemap, render_cpu::Tonemap); 3] = [
    (Tonemap::None, render_cpu::Tonemap::None),
    (Tonemap::Reinhard, render_cpu::Tonemap::Reinhard),
    (Tonemap::Filmic, render_cpu::Tonemap::Filmic),
];

fn radiances() -> Vec<[f32; 4]> {
    let ladder = (-40..=80).map(|i| (0.5 * i as f32).exp2());
    let odd = [0.0, -1.0, -1e30, f32::MAX, f32::INFINITY, f32::NEG_INFINITY, f32::NAN];
    ladder.chain(odd).map(|x| [x, 0.0, 0.0, 0.0]).collect()
}

#[test]
fn tone_curves_are_their_twins() {
    let Some(gpu) = gpu() else { return };
    for (tonemap, twin) in CURVES {
        let call = format!("vec4<f32>(tone({}u, x.x))", finish::curve(tonemap));
        let error = worst(&gpu, FUNCTIONS, &call, None, &radiances(), |x| [f64::from(render_cpu::curve(twin, x[0]))]);
        assert!(error < TOLERANCE, "{tonemap:?} is off by {error}");
    }
}

#[test]
fn tone_curves_can_fail() {
    let Some(gpu) = gpu() else { return };
    let call = format!("vec4<f32>(tone({}u, x.x))", finish::curve(Tonemap::Reinhard));
    let twin = render_cpu::Tonemap::Filmic;
    let error = worst(&gpu, FUNCTIONS, &call, None, &radiances(), |x| [f64::from(render_cpu::curve(twin, x[0]))]);
    assert!(error > 0.05, "another curve must be noticed, but is off by {error} only");
}

#[test]
fn srgb_is_its_twin() {
    let Some(gpu) = gpu() else { return };
    let inputs = (0..=4096).map(|i| [i as f32 / 4096.0, 0.0, 0.0, 0.0]).collect::<Vec<_>>();
    let exact = |x: [f32; 4]| [render_cpu::srgb_encode(f64::from(x[0]))];
    let error = worst(&gpu, FUNCTIONS, "vec4<f32>(srgb(x.x))", None, &inputs, exact);
    assert!(error < TOLERANCE, "off by {error}");
    let gamma = worst(&gpu, FUNCTIONS, "vec4<f32>(pow(x.x, 1.0 / 2.2))", None, &inputs, exact);
    assert!(gamma > 0.01, "a plain power must be noticed, but is off by {gamma} only");
}

fn frame() -> Frame {
    let camera = Camera {
        name: "test".into(),
        eye: [1.0, 2.0, 3.0],
        target: [-0.5, 0.25, -1.0],
        up: [0.1, 1.0, 0.0],
        vertical_fov: 0.9,
    };
    let rotation = Quat::from_xyzw(0.1, 0.7, -0.3, 0.5).normalize();
    Frame { rotation, ..Frame::plain(camera, 300, 200) }
}

#[test]
fn rotation_is_its_twin() {
    let Some(gpu) = gpu() else { return };
    let frame = frame();
    let view = view::view(&frame, 0.01, f32::MAX);
    let call = "vec4<f32>(view.light_from_world * x.xyz, 0.0)";
    let turned =
        |x: [f32; 4]| frame.rotation.as_dquat().inverse() * glam::DVec3::from([x[0], x[1], x[2]].map(f64::from));
    let error = worst(&gpu, FUNCTIONS, call, Some(&view), &directions(), |x| turned(x).to_array());
    assert!(error < TOLERANCE, "off by {error}");
    let back = "vec4<f32>(x.xyz * view.light_from_world, 0.0)";
    let error = worst(&gpu, FUNCTIONS, back, Some(&view), &directions(), |x| turned(x).to_array());
    assert!(error > 0.1, "the reverse rotation must be noticed, but is off by {error} only");
}

#[test]
fn clip_coordinates_are_those_of_the_camera() {
    let Some(gpu) = gpu() else { return };
    let frame = frame();
    let view = view::view(&frame, 0.01, f32::MAX);
    // The file's own camera matrix has another depth; x, y and w must agree.
    let matrix = frame.camera.clip_from_world(1.5, 0.01, 1.0);
    let exact = |x: [f32; 4]| {
        let clip = matrix * Vec3::new(x[0], x[1], x[2]).extend(1.0);
        [clip.x, clip.y, view.near, clip.w].map(f64::from)
    };
    let error = worst(&gpu, FUNCTIONS, "clip_from_offset(x.xyz - view.eye)", Some(&view), &directions(), exact);
    assert!(error < TOLERANCE, "off by {error}");
    let error = worst(&gpu, FUNCTIONS, "clip_from_offset(x.xyz)", Some(&view), &directions(), exact);
    assert!(error > 0.1, "an eye at the origin must be noticed, but is off by {error} only");
}

/// Numbers without a pattern, in [-1, 1].
fn noise(count: usize, seed: u64) -> Vec<f32> {
    let mut state = seed;
    let next = || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 40) as f32 / (1 << 23) as f32 - 1.0
    };
    std::iter::repeat_with(next).take(count).collect()
}

/// Largest difference between the vertices' light and f64 sums, for a transfer cut into chunks of `chunk_bytes`.
fn relight_error(gpu: &Gpu, bands: u32, channels: u32, chunk_bytes: u64, shift: usize) -> f64 {
    const VERTICES: usize = 1000;
    let coefficients = (bands * bands) as usize;
    let values = noise(VERTICES * coefficients * channels as usize, 7);
    let transfer = Transfer { bands, channels, values, ..Transfer::default() };
    let mut light = Rgb::black(Bands::new(bands).expect("few bands"));
    light.values = noise(coefficients * 3, 8).chunks_exact(3).map(|rgb| [rgb[0], rgb[1], rgb[2]]).collect();
    let relight = Relight::new(gpu, &transfer, chunk_bytes).expect("a small transfer");
    let mut encoder = gpu.device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
    relight.record(gpu, &mut encoder, &light);
    gpu.queue.submit([encoder.finish()]);
    let lit = readback::buffer::<[f32; 3]>(gpu, relight.lit()).expect("results");
    let exact = |vertex: usize, channel: usize| -> f64 {
        let place = |i| (vertex * coefficients + i) * channels as usize + channel.min(channels as usize - 1);
        let term = |i: usize| f64::from(transfer.values[place(i)]) * f64::from(light.values[i][channel]);
        (0..coefficients).map(term).sum()
    };
    let pairs = (0..VERTICES).flat_map(|vertex| (0..3).map(move |channel| (vertex, channel)));
    let errors = pairs.map(|(v, c)| (f64::from(lit[v][c]) - exact((v + shift) % VERTICES, c)).abs());
    errors.fold(0.0, |worst, error| if error <= worst { worst } else { error })
}

#[test]
fn relighting_is_the_dot_product_for_any_bands_and_chunks() {
    let Some(gpu) = gpu() else { return };
    for (bands, channels) in [(1, 1), (2, 3), (5, 1), (5, 3), (9, 1), (17, 3)] {
        let row = u64::from(bands * bands * channels * 4);
        for chunk_bytes in [row.max(12) * 64, row.max(12) * 330, u64::MAX] {
            let error = relight_error(&gpu, bands, channels, chunk_bytes, 0);
            // Terms within [-1, 1] add up to about the root of their number; each sum rounds to 6e-8 of it.
            let tolerance = 6e-8 * f64::from(bands * bands) + 1e-6;
            assert!(error < tolerance, "{bands} bands, {channels} channels, chunks of {chunk_bytes}: off by {error}");
        }
    }
}

#[test]
fn relighting_can_fail() {
    let Some(gpu) = gpu() else { return };
    let error = relight_error(&gpu, 5, 3, u64::MAX, 1);
    assert!(error > 0.1, "a neighbour's light must be noticed, but is off by {error} only");
}

#[test]
fn a_transfer_beyond_the_gpu_is_refused() {
    let Some(gpu) = gpu() else { return };
    let transfer = Transfer { bands: 5, channels: 3, values: vec![0.0; 75], ..Transfer::default() };
    let refused = Relight::new(&gpu, &transfer, 1000).expect_err("64 vertices do not fit 1000 bytes");
    assert!(matches!(refused, Error::TooLarge { .. }), "{refused}");
}
