//! Milliseconds per frame on the software driver: 100,000 vertices, nothing read back.
//!
//! `cargo bench -p render-wgpu`; one frame is drawn before the clock starts, since drivers compile pipelines on first use.

#[path = "../tests/handmade/mod.rs"]
mod handmade;

use coeff_io::{Camera, MapLight};
use divan::Bencher;
use glam::Quat;
use render_wgpu::{Driver, Frame, Gpu, Renderer};
use sh_math::hemisphere::Basis;

const SIZES: [(u32, u32); 2] = [(512, 512), (1920, 1080)];
/// Rings that make the sphere 100,000 vertices.
const RINGS: u32 = 223;

fn main() {
    divan::main();
}

/// A renderer that has drawn one frame; None without an adapter.
fn renderer(shiny: bool, frame: &Frame) -> Option<Renderer> {
    let gpu = Gpu::new(Driver::Software).ok()?;
    let mut prt = handmade::sphere_on_plane(1, RINGS);
    if !shiny {
        prt.materials.iter_mut().for_each(|material| material.specular = false);
    }
    let mut renderer = Renderer::without_window(&gpu, &prt, &handmade::environment()).ok()?;
    renderer.time(frame).ok()?;
    Some(renderer)
}

fn frame((width, height): (u32, u32)) -> Frame {
    Frame { sky: false, ..Frame::plain(handmade::camera(), width, height) }
}

#[divan::bench(args = SIZES)]
fn matte(bencher: Bencher<'_, '_>, size: (u32, u32)) {
    let frame = frame(size);
    let Some(mut renderer) = renderer(false, &frame) else { return };
    bencher.bench_local(|| renderer.time(&frame));
}

#[divan::bench(args = SIZES)]
fn matte_under_a_turning_light(bencher: Bencher<'_, '_>, size: (u32, u32)) {
    let mut frame = frame(size);
    let Some(mut renderer) = renderer(false, &frame) else { return };
    bencher.bench_local(|| {
        frame.rotation *= Quat::from_rotation_y(0.01);
        renderer.time(&frame)
    });
}

/// A renderer of light maps for 3 bands of light that has drawn one frame; the picture is full of floor.
fn mapped(frame: &Frame) -> Option<Renderer> {
    let gpu = Gpu::new(Driver::Software).ok()?;
    let mut prt = handmade::mapped(Basis::ModifiedH6, &MapLight::Relightable { bands: 3 }, 24);
    prt.materials.iter_mut().for_each(|material| material.specular = false);
    prt.materials[0].normal_texture = prt.materials[2].normal_texture;
    let mut renderer = Renderer::without_window(&gpu, &prt, &handmade::environment()).ok()?;
    renderer.time(frame).ok()?;
    Some(renderer)
}

/// The floor alone, in one basis.
fn floor(basis: Basis) -> Frame {
    let camera = Camera { eye: [0.0, 1.0, 0.1], target: [0.0, -1.0, 0.0], ..handmade::camera() };
    Frame { basis: Some(basis), sky: false, ..Frame::plain(camera, 1024, 1024) }
}

#[divan::bench(args = Basis::ALL)]
fn maps(bencher: Bencher<'_, '_>, basis: Basis) {
    let frame = floor(basis);
    let Some(mut renderer) = mapped(&frame) else { return };
    bencher.bench_local(|| renderer.time(&frame));
}

#[divan::bench]
fn maps_under_a_turning_light(bencher: Bencher<'_, '_>) {
    let mut frame = floor(Basis::ModifiedH6);
    let Some(mut renderer) = mapped(&frame) else { return };
    bencher.bench_local(|| {
        frame.rotation *= Quat::from_rotation_y(0.01);
        renderer.time(&frame)
    });
}

#[divan::bench(args = SIZES)]
fn shiny_with_sky_and_bloom(bencher: Bencher<'_, '_>, size: (u32, u32)) {
    let frame = Frame { sky: true, bloom: 0.1, ..frame(size) };
    let Some(mut renderer) = renderer(true, &frame) else { return };
    bencher.bench_local(|| renderer.time(&frame));
}
