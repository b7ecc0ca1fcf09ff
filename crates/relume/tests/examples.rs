//! Runs every example, and checks what it writes.

#![allow(dead_code, reason = "the main functions of the examples are not called")]

#[path = "../examples/01_bake_and_render.rs"]
mod bake_and_render;
#[path = "../examples/05_coefficients_to_your_engine.rs"]
mod coefficients_to_your_engine;
#[path = "../examples/03_light_maps.rs"]
mod light_maps;
#[path = "../examples/02_relight_turned_probe.rs"]
mod relight_turned_probe;
#[path = "../examples/04_volume_dynamic_object.rs"]
mod volume_dynamic_object;

use relume::prelude::*;
use std::path::Path;

/// The pixels of an image that is neither black nor of one colour.
fn drawn(folder: &Path, name: &str) -> image::RgbImage {
    let image = image::open(folder.join(name)).expect("an image").to_rgb8();
    let brightest = image.pixels().map(|pixel| pixel.0).max().expect("pixels");
    let darkest = image.pixels().map(|pixel| pixel.0).min().expect("pixels");
    assert!(brightest != darkest && brightest[0] > 30, "{name}: {darkest:?} to {brightest:?}");
    image
}

#[test]
fn bake_and_render_writes_file_and_images() {
    let folder = tempfile::tempdir().expect("a folder");
    bake_and_render::run(folder.path()).expect("the example runs");
    drawn(folder.path(), "first.png");
    // Linear radiance comes back as it was written, so the sun makes it brighter than a display.
    let (_, _, linear) = relume::probe_io::read_picture(&folder.path().join("first.exr")).expect("linear radiance");
    assert_eq!(linear.len(), 320 * 180);
    assert!(Prt::read(&folder.path().join("first.prt")).is_ok());
}

#[test]
fn relight_turned_probe_moves_the_shadow() {
    let folder = tempfile::tempdir().expect("a folder");
    relight_turned_probe::run(folder.path()).expect("the example runs");
    let images: Vec<_> = (0..4).map(|number| drawn(folder.path(), &format!("turned-{number}.png"))).collect();
    assert!((1..4).all(|number| images[number] != images[0]), "every turn changes the image");
}

#[test]
fn light_maps_are_drawn_and_exported() {
    let folder = tempfile::tempdir().expect("a folder");
    light_maps::run(folder.path()).expect("the example runs");
    drawn(folder.path(), "maps.png");
    let prt = Prt::read(&folder.path().join("maps.prt")).expect("the file");
    let maps = prt.maps.expect("light maps");
    assert!(matches!(maps.light, relume::coeff_io::MapLight::Fixed { .. }));
    let textures = std::fs::read_dir(folder.path().join("textures")).expect("the folder of textures");
    assert!(textures.flatten().any(|entry| entry.path().extension().is_some_and(|ending| ending == "ktx2")));
}

#[test]
fn volume_lights_the_object_at_each_place() {
    let folder = tempfile::tempdir().expect("a folder");
    volume_dynamic_object::run(folder.path()).expect("the example runs");
    let [first, second] = ["object-0.png", "object-1.png"].map(|name| drawn(folder.path(), name));
    assert!(first != second, "the object has moved");
}

/// The dot products of the example against those of the CPU renderer, written differently.
#[test]
fn coefficients_give_the_radiance_of_the_renderer() {
    let folder = tempfile::tempdir().expect("a folder");
    let colours = coefficients_to_your_engine::run(folder.path()).expect("the example runs");
    let scene = load_scene("builtin:sphere-on-plane").expect("a builtin");
    let prt = Bake::new(&scene).settings(Preset::Draft).run().expect("the same bake");
    let radiance = |yaw: f32| {
        let sky = load_light_probe("builtin:sky").expect("a builtin");
        let bands = relume::sh_math::Bands::new(prt.transfer.bands).expect("as baked");
        let light = relume::sh_math::project(bands, sky.samples()).rotated(Quat::from_rotation_y(yaw));
        relume::render_cpu::vertex_radiance(&prt.transfer, &light.values)
    };
    let largest_difference = |yaw: f32| {
        let pairs = colours.iter().zip(radiance(yaw)).zip(&prt.transfer.albedo);
        let differences = pairs.map(|((colour, radiance), albedo)| {
            (Vec3::from(*colour) - radiance * Vec3::from(*albedo)).abs().max_element()
        });
        differences.fold(0.0, f32::max)
    };
    assert!(largest_difference(0.5) < 1e-4, "{}", largest_difference(0.5));
    assert!(largest_difference(0.6) > 1e-3, "can fail: another turn gives another radiance");
}
