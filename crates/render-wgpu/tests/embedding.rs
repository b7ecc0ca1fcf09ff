//! Frames in a caller's texture, drawn with a caller's device, are those that the renderer reads back.

mod compare;
mod handmade;

use coeff_io::{MapLight, Prt};
use compare::{cpu_frame, distance};
use handmade::{camera, environment, mapped, rotation, sphere_on_plane};
use render_wgpu::{Driver, Error, Frame, Gpu, Image, Renderer, Tonemap, wgpu};
use sh_math::hemisphere::Basis;
use wgpu::TextureFormat as Format;

/// A device with the default limits of WebGPU, opened without this crate; none where there is no software driver.
fn open() -> Option<(wgpu::Device, wgpu::Queue)> {
    compare::gpu()?;
    let instance = wgpu::Instance::new(wgpu::InstanceDescriptor::new_without_display_handle_from_env());
    let options = wgpu::RequestAdapterOptions { force_fallback_adapter: true, ..Default::default() };
    let adapter = pollster::block_on(instance.request_adapter(&options)).expect("a software adapter");
    let features = adapter.features() & wgpu::Features::FLOAT32_BLENDABLE;
    let descriptor = wgpu::DeviceDescriptor { required_features: features, ..Default::default() };
    Some(pollster::block_on(adapter.request_device(&descriptor)).expect("a device"))
}

fn texture(device: &wgpu::Device, format: Format, [width, height]: [u32; 2]) -> wgpu::Texture {
    device.create_texture(&wgpu::TextureDescriptor {
        label: Some("the caller's"),
        size: wgpu::Extent3d { width, height, depth_or_array_layers: 1 },
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format,
        usage: wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::COPY_SRC,
        view_formats: &[],
    })
}

/// The bytes of a texture whose rows are multiples of 256 bytes.
fn bytes(device: &wgpu::Device, queue: &wgpu::Queue, texture: &wgpu::Texture) -> Vec<u8> {
    let row = texture.width() * texture.format().block_copy_size(None).expect("a plain format");
    assert_eq!(row % 256, 0, "rows that can be copied");
    let buffer = device.create_buffer(&wgpu::BufferDescriptor {
        label: None,
        size: u64::from(row * texture.height()),
        usage: wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ,
        mapped_at_creation: false,
    });
    let mut encoder = device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
    let layout = wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(row), rows_per_image: None };
    let copy = wgpu::TexelCopyBufferInfo { buffer: &buffer, layout };
    encoder.copy_texture_to_buffer(texture.as_image_copy(), copy, texture.size());
    queue.submit([encoder.finish()]);
    buffer.map_async(wgpu::MapMode::Read, .., |mapped| mapped.expect("mapped bytes"));
    device.poll(wgpu::PollType::wait_indefinitely()).expect("a device that answers");
    buffer.get_mapped_range(..).expect("mapped bytes").to_vec()
}

/// The picture that the renderer reads back, as a texture of this format holds it.
fn expected(image: &Image, format: Format) -> Vec<u8> {
    match format {
        Format::Rgba32Float => {
            image.linear.iter().flat_map(|&[r, g, b]| [r, g, b, 1.0]).flat_map(f32::to_ne_bytes).collect()
        }
        Format::Bgra8Unorm => image.display.iter().flat_map(|&[r, g, b, a]| [b, g, r, a]).collect(),
        _ => image.display.as_flattened().to_vec(),
    }
}

fn frame() -> Frame {
    Frame { tonemap: Tonemap::Filmic, exposure_ev: -0.5, ..Frame::plain(camera(), 128, 80) }
}

/// Vertices (matte, glossy, masked and blended) and light maps.
fn scenes() -> [(&'static str, Prt); 2] {
    let maps = mapped(Basis::H6, &MapLight::Relightable { bands: 3 }, 16);
    [("vertices", sphere_on_plane(3, 16)), ("light maps", maps)]
}

#[test]
fn drawn_textures_are_the_images_that_are_read_back() {
    let Some((device, queue)) = open() else { return };
    let gpu = Gpu::from_wgpu(device.clone(), queue.clone()).expect("a device of default limits");
    for (name, prt) in scenes() {
        let mut renderer = Renderer::new(&gpu, &prt, &environment()).expect("a sound scene");
        for format in [Format::Rgba8Unorm, Format::Bgra8Unorm, Format::Rgba32Float] {
            let target = texture(&device, format, [128, 80]);
            let view = target.create_view(&wgpu::TextureViewDescriptor::default());
            for frame in [frame(), Frame { rotation: rotation(), bloom: 0.2, ..frame() }] {
                renderer.draw_into(&view, format, &frame).expect("a frame");
                let drawn = bytes(&device, &queue, &target);
                let same = expected(&renderer.draw(&frame).expect("an image"), format);
                assert!(drawn == same, "{name} in {format:?}");
                let other = Frame { exposure_ev: 0.1, ..frame.clone() };
                let other = expected(&renderer.draw(&other).expect("an image"), format);
                assert!(drawn != other, "{name} in {format:?}: another exposure must be noticed");
            }
        }
    }
}

#[test]
fn images_of_a_device_with_default_limits_agree_with_the_cpu() {
    let Some((device, queue)) = open() else { return };
    let gpu = Gpu::from_wgpu(device, queue).expect("a device of default limits");
    for (name, prt) in scenes() {
        let image = Renderer::new(&gpu, &prt, &environment()).and_then(|mut renderer| renderer.draw(&frame()));
        let image = image.expect("an image");
        let agrees = |frame: &Frame| {
            let expected = render_cpu::render(&prt, &environment(), &cpu_frame(frame)).expect("an image");
            distance(&image, &expected).is_small()
        };
        assert!(agrees(&frame()), "{name}");
        assert!(!agrees(&Frame { rotation: rotation(), ..frame() }), "{name}: a turned light must be noticed");
    }
}

/// The hardware encodes by a table of its own: one step of 255 apart.
#[test]
fn srgb_textures_hold_the_same_display_values() {
    let Some((device, queue)) = open() else { return };
    let gpu = Gpu::from_wgpu(device.clone(), queue.clone()).expect("a device of default limits");
    let mut renderer = Renderer::new(&gpu, &sphere_on_plane(1, 16), &environment()).expect("a sound scene");
    let target = texture(&device, Format::Rgba8UnormSrgb, [128, 80]);
    let view = target.create_view(&wgpu::TextureViewDescriptor::default());
    let far = |frame: &Frame, drawn: &[u8], renderer: &mut Renderer| {
        let image = expected(&renderer.draw(frame).expect("an image"), Format::Rgba8Unorm);
        drawn.iter().zip(&image).map(|(a, b)| a.abs_diff(*b)).max().expect("pixels")
    };
    renderer.draw_into(&view, Format::Rgba8UnormSrgb, &frame()).expect("a frame");
    let drawn = bytes(&device, &queue, &target);
    assert!(far(&frame(), &drawn, &mut renderer) <= 1);
    let brighter = Frame { exposure_ev: 0.0, ..frame() };
    assert!(far(&brighter, &drawn, &mut renderer) > 1, "can fail: half a stop must be noticed");
}

#[test]
fn awaited_images_are_those_that_are_waited_for() {
    let Some(_) = compare::gpu() else { return };
    let (awaited, image) = pollster::block_on(async {
        let gpu = Gpu::new_async(Driver::Software).await.expect("a device");
        let mut renderer =
            Renderer::new_async(&gpu, &sphere_on_plane(1, 8), &environment()).await.expect("a sound scene");
        (renderer.draw_async(&frame()).await.expect("an image"), renderer.draw(&frame()).expect("an image"))
    });
    assert!(awaited == image);
}

#[test]
fn views_that_cannot_take_a_frame_are_refused() {
    let Some((device, queue)) = open() else { return };
    let gpu = Gpu::from_wgpu(device.clone(), queue).expect("a device of default limits");
    let mut renderer = Renderer::new(&gpu, &sphere_on_plane(1, 8), &environment()).expect("a sound scene");
    let mut refused = |format, asked, size, words: &str| {
        let view = texture(&device, format, size).create_view(&wgpu::TextureViewDescriptor::default());
        let error = renderer.draw_into(&view, asked, &frame()).expect_err("a view that does not fit");
        assert!(matches!(error, Error::Invalid { .. }) && error.to_string().contains(words), "{error}");
    };
    refused(Format::R8Unorm, Format::R8Unorm, [128, 80], "R8Unorm is none of");
    refused(Format::Rgba8Unorm, Format::Bgra8Unorm, [128, 80], "holds Rgba8Unorm, not Bgra8Unorm");
    refused(Format::Rgba8Unorm, Format::Rgba8Unorm, [64, 80], "64x80 texels, but the frame 128x80");
}

#[test]
fn a_lost_device_gives_one_error() {
    let Some((device, queue)) = open() else { return };
    let gpu = Gpu::from_wgpu(device.clone(), queue).expect("a device of default limits");
    let mut renderer = Renderer::new(&gpu, &sphere_on_plane(1, 8), &environment()).expect("a sound scene");
    let told = gpu.clone();
    device.set_device_lost_callback(move |_, reason| told.report_lost(&reason));
    let target = texture(&device, Format::Rgba8Unorm, [128, 80]);
    let view = target.create_view(&wgpu::TextureViewDescriptor::default());
    renderer.draw_into(&view, Format::Rgba8Unorm, &frame()).expect("a frame before");
    device.destroy();
    device.poll(wgpu::PollType::wait_indefinitely()).expect("a device that answers");
    let error = renderer.draw_into(&view, Format::Rgba8Unorm, &frame()).expect_err("a lost device");
    assert!(matches!(error, Error::DeviceLost { .. }), "{error}");
    assert_eq!(renderer.draw(&frame()).expect_err("a lost device"), error);
}
