//! What the camera sees: surfaces, their fronts, their emission, veils and the sky.

use glam::{Vec3, Vec4};
use probe_io::Environment;
use reference::{Light, Picture, Settings, World, render};
use scene::{AlphaMode, Camera, Scene, builtin};
use std::ops::ControlFlow;

const SIZE: [u32; 2] = [12, 8];
const SETTINGS: Settings = Settings { samples: 64, seed: 4, max_bounces: Some(1) };
const SKY: f32 = 2.0;

fn view(eye: Vec3) -> Camera {
    Camera { name: "test".into(), eye, target: Vec3::ZERO, up: Vec3::Z, vertical_fov: 0.3 }
}

fn draw(scene: &Scene, camera: &Camera, settings: &Settings) -> Picture {
    let light = Light::new(&Environment::constant([SKY; 3]));
    render(&World::new(scene), &light, camera, SIZE, settings, &|_| ControlFlow::Continue(())).expect("not stopped")
}

/// The open plane of albedo 0.5 with another material.
fn plane(change: impl Fn(&mut scene::Material)) -> Scene {
    let mut scene = builtin("plane").expect("a built-in scene");
    scene.materials.iter_mut().for_each(change);
    scene
}

fn mean(picture: &Picture) -> f64 {
    picture.pixels.iter().map(|p| f64::from(p[0])).sum::<f64>() / picture.pixels.len() as f64
}

/// Mean of a picture that only shows the plane from above or below.
fn seen(change: impl Fn(&mut scene::Material), height: f32) -> f64 {
    mean(&draw(&plane(change), &view(Vec3::Y * height), &SETTINGS))
}

#[test]
fn fronts_are_lit_and_backs_let_the_camera_through() {
    testkit::assert_close!(seen(|_| (), 3.0), 0.5 * SKY, 0.0, 0.01, "the front");
    testkit::assert_close!(seen(|_| (), -3.0), SKY, 0.0, 1e-6, "the back shows the sky");
    testkit::assert_close!(seen(|m| m.double_sided = true, -3.0), 0.5 * SKY, 0.0, 0.01, "both sides");
}

/// A map that bends every normal by an angle takes away the share of the sky that a tilted surface turns from, and no light comes
/// through the surface from below: `(1 + cos) / 2` of the sky are left. With light from below it would be all.
#[test]
fn normal_maps_bend_the_light() {
    let texel = [204, 128, 230, 255];
    let mut scene = plane(|m| {
        m.normal_texture = Some(scene::TextureSlot { texture: 0, uv_set: 0, transform: glam::Affine2::IDENTITY });
    });
    let wrap = [scene::Wrap::Repeat; 2];
    scene.textures = vec![scene::Texture { name: "map".into(), width: 1, height: 1, rgba: vec![texel], wrap }];
    for mesh in &mut scene.meshes {
        mesh.tangents = vec![Vec3::X.extend(1.0); mesh.positions.len()];
        mesh.uv0 = vec![glam::Vec2::ZERO; mesh.positions.len()];
    }
    let bent = Vec3::from_array([texel[0], texel[1], texel[2]].map(|x: u8| f32::from(x) / 127.5 - 1.0)).normalize();
    let light = Light::new(&Environment::constant([SKY; 3]));
    let settings = Settings { samples: 256, ..SETTINGS };
    let drawn = |on: bool| {
        let world = World::with_normal_maps(&scene, on);
        let camera = view(Vec3::Y * 3.0);
        mean(&render(&world, &light, &camera, SIZE, &settings, &|_| ControlFlow::Continue(())).expect("not stopped"))
    };
    let expected = f64::from(0.5 * SKY * 0.5 * (1.0 + bent.z));
    testkit::assert_close!(drawn(true), expected, 0.0, 0.005, "bent");
    assert!((drawn(false) - expected).abs() > 0.05, "without the map it must show");
}

#[test]
fn emission_is_added() {
    testkit::assert_close!(seen(|m| m.emissive = Vec3::splat(3.0), 3.0), 0.5 * SKY + 3.0, 0.0, 0.01);
}

#[test]
fn masks_and_veils_show_what_lies_behind() {
    let alpha = |alpha: AlphaMode, a: f32| {
        move |m: &mut scene::Material| {
            m.alpha = alpha;
            m.base_color = Vec4::new(0.5, 0.5, 0.5, a);
        }
    };
    testkit::assert_close!(seen(alpha(AlphaMode::Mask(0.5), 0.4), 3.0), SKY, 0.0, 1e-6, "masked away");
    testkit::assert_close!(seen(alpha(AlphaMode::Mask(0.5), 0.6), 3.0), 0.5 * SKY, 0.0, 0.01, "not masked");
    testkit::assert_close!(seen(alpha(AlphaMode::Blend, 0.25), 3.0), 0.875 * SKY, 0.0, 0.01, "a quarter of the plane");
    testkit::assert_close!(seen(|m| m.transmission = 1.0, 3.0), SKY, 0.0, 1e-6, "clear glass");
}

#[test]
fn wrong_views_can_fail() {
    assert!((seen(|_| (), 3.0) - f64::from(SKY)).abs() > 0.5, "the plane is not the sky");
    assert!((seen(|m| m.base_color = Vec4::ZERO, 3.0)).abs() < 1e-6, "a black plane is black");
}

#[test]
fn threads_do_not_matter_and_seeds_do() {
    let scene = builtin("cornell-box").expect("a built-in scene");
    let camera = scene.cameras[0].clone();
    let on = |threads, seed| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
        pool.install(|| draw(&scene, &camera, &Settings { seed, ..SETTINGS }))
    };
    assert_eq!(on(1, 4), on(3, 4), "the same to the bit");
    assert_ne!(on(1, 4), on(1, 5), "another seed is another picture");
}

#[test]
fn standard_errors_say_how_pictures_differ() {
    let scene = builtin("cornell-box").expect("a built-in scene");
    let camera = scene.cameras[0].clone();
    let [a, b] = [1, 2].map(|seed| draw(&scene, &camera, &Settings { seed, ..SETTINGS }));
    let (mut squares, mut n) = (0.0, 0.0);
    for i in 0..a.pixels.len() {
        let (ea, eb) = (f64::from(a.std_error[i][1]), f64::from(b.std_error[i][1]));
        if ea * eb > 0.0 {
            squares += f64::from(a.pixels[i][1] - b.pixels[i][1]).powi(2) / (ea * ea + eb * eb);
            n += 1.0;
        }
    }
    // A mean of about 90 squared standard normals, whose own spread is 0.15.
    testkit::assert_close!(squares / n, 1.0, 0.45, 0.0, "normalised squared difference of {n} pixels");
}

#[test]
fn a_break_stops_the_picture() {
    let scene = plane(|_| ());
    let light = Light::new(&Environment::constant([1.0; 3]));
    let stop = |_| ControlFlow::Break(());
    let picture = render(&World::new(&scene), &light, &view(Vec3::Y * 3.0), SIZE, &SETTINGS, &stop);
    assert!(picture.is_none(), "half a picture must not be kept");
}

/// The camera sees an unlit plane's base colour whatever the light; a veil shows it by its share.
#[test]
fn unlit_surfaces_show_their_base_colour() {
    testkit::assert_close!(seen(|m| m.unlit = true, 3.0), 0.5, 0.0, 1e-6, "under a sky of {SKY}");
    let veil = |m: &mut scene::Material| {
        m.unlit = true;
        m.alpha = AlphaMode::Blend;
        m.base_color = Vec4::new(0.5, 0.5, 0.5, 0.25);
    };
    // A quarter of 0.5, and three quarters of the sky behind.
    testkit::assert_close!(seen(veil, 3.0), 0.25 * 0.5 + 0.75 * f64::from(SKY), 0.0, 0.02, "an unlit veil");
    assert!((seen(|_| (), 3.0) - 0.5).abs() > 0.4, "can fail: the lit plane is brighter");
}
