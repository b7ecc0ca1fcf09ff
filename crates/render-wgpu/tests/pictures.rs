//! Pictures of the GPU are those of the CPU renderer, and closed forms where there are any.
//!
//! Here render-cpu is a development dependency: the two renderers never see each other outside of tests.

mod compare;
mod handmade;

use coeff_io::{AlphaMode, Camera, Prt};
use compare::{cpu_frame, distance, gpu};
use handmade::{camera, environment, rotation, sphere_on_plane};
use probe_io::Environment;
use render_wgpu::{Driver, Error, Frame, Gpu, Renderer, Tonemap};
use std::process::Command;

fn cpu_picture(prt: &Prt, environment: &Environment, frame: &Frame) -> render_cpu::Image {
    render_cpu::render(prt, environment, &cpu_frame(frame)).expect("a sound scene and frame")
}

/// The whole scene without reflections, whose blur takes seconds.
fn matte() -> Prt {
    let mut prt = sphere_on_plane(1, 24);
    prt.materials.iter_mut().for_each(|material| material.specular = false);
    prt
}

/// Frames that each show something else, with names.
fn frames() -> Vec<(&'static str, Frame)> {
    let plain = Frame::plain(camera(), 192, 128);
    let from_below = Camera { eye: [-2.0, -0.6, 2.5], up: [0.3, 1.0, 0.1], ..camera() };
    let along_up = Camera { eye: [0.2, 5.0, 0.1], target: [0.2, 0.0, 0.1], ..camera() };
    vec![
        ("plain", plain.clone()),
        ("supersampled", Frame { supersample: 3, ..plain.clone() }),
        ("turned light", Frame { rotation: rotation(), tonemap: Tonemap::Reinhard, ..plain.clone() }),
        ("bloom", Frame { bloom: 0.3, exposure_ev: 1.5, tonemap: Tonemap::Filmic, ..plain.clone() }),
        ("bloom of odd sizes", Frame { bloom: 0.8, width: 131, height: 67, ..plain.clone() }),
        ("no sky", Frame { sky: false, exposure_ev: -1.0, ..plain.clone() }),
        ("from below", Frame { camera: from_below, ..plain.clone() }),
        ("along up", Frame { camera: along_up, ..plain }),
    ]
}

#[test]
fn pictures_agree_with_the_cpu() {
    let Some(gpu) = gpu() else { return };
    let (environment, prt) = (environment(), sphere_on_plane(3, 24));
    let twin = render_cpu::Renderer::without_window(&prt, &environment).expect("a sound scene");
    let mut renderer = Renderer::without_window(&gpu, &prt, &environment).expect("a sound scene");
    for (name, frame) in frames() {
        let picture = renderer.draw(&frame).expect("a sound frame");
        let expected = twin.draw(&cpu_frame(&frame)).expect("a sound frame");
        let distance = distance(&picture, &expected);
        assert!(distance.is_small(), "{name}: {distance:?}");
    }
    let mut no_bumps = prt.clone();
    no_bumps.materials[1].normal_texture = None;
    let frame = Frame::plain(camera(), 192, 128);
    let picture = render_wgpu::render(&gpu, &no_bumps, &environment, &frame).expect("a picture");
    let distance = distance(&picture, &twin.draw(&cpu_frame(&frame)).expect("a sound frame"));
    assert!(!distance.is_small(), "a normal map that is not there must be noticed: {distance:?}");
}

#[test]
fn pictures_can_fail() {
    let Some(gpu) = gpu() else { return };
    let (environment, prt, frame) = (environment(), matte(), Frame::plain(camera(), 192, 128));
    let expected = cpu_picture(&prt, &environment, &frame);
    let draw = |prt: &Prt, frame: &Frame| render_wgpu::render(&gpu, prt, &environment, frame).expect("a picture");
    let same = draw(&prt, &frame);
    let mut no_holes = prt.clone();
    no_holes.materials[2].alpha = AlphaMode::Opaque;
    let no_holes = draw(&no_holes, &frame);
    let brighter = draw(&prt, &Frame { exposure_ev: 0.05, ..frame.clone() });
    let turned = draw(&prt, &Frame { rotation: rotation(), ..frame });
    assert!(distance(&same, &expected).is_small(), "the scene itself: {:?}", distance(&same, &expected));
    for (name, picture) in [("no holes", no_holes), ("brighter", brighter), ("turned", turned)] {
        let distance = distance(&picture, &expected);
        assert!(!distance.is_small(), "{name} must be noticed: {distance:?}");
    }
}

#[test]
fn attributes_that_a_file_lacks_read_as_the_model_says() {
    let Some(gpu) = gpu() else { return };
    let (environment, frame) = (environment(), Frame::plain(camera(), 96, 64));
    let mut prt = sphere_on_plane(1, 24);
    prt.geometry.tangents.clear();
    prt.geometry.uv0.clear();
    prt.geometry.uv1.clear();
    prt.geometry.colors.clear();
    prt.transfer.openness.clear();
    let picture = render_wgpu::render(&gpu, &prt, &environment, &frame).expect("a picture");
    let distance = distance(&picture, &cpu_picture(&prt, &environment, &frame));
    assert!(distance.is_small(), "{distance:?}");
}

/// A diffuse scene with the transfer of open receivers under white light.
fn furnace() -> Prt {
    let mut prt = sphere_on_plane(1, 8);
    let material = coeff_io::Material { base_color: [0.25, 0.5, 0.75, 1.0], ..handmade::white() };
    prt.materials.iter_mut().for_each(|m| *m = material.clone());
    prt.geometry.colors.clear();
    prt.transfer.values.chunks_exact_mut(16).for_each(|row| {
        row.fill(0.0);
        // Y00 times the light's only coefficient, sqrt(4 pi), is 1.
        row[0] = 0.282_094_8;
    });
    prt
}

#[test]
fn an_open_scene_under_white_light_shows_its_albedo() {
    let Some(gpu) = gpu() else { return };
    let frame = Frame { sky: false, ..Frame::plain(camera(), 64, 64) };
    let picture = render_wgpu::render(&gpu, &furnace(), &Environment::constant([1.0; 3]), &frame).expect("a picture");
    let centre = picture.linear[32 * 64 + 32];
    for (seen, albedo) in centre.into_iter().zip([0.25f32, 0.5, 0.75]) {
        testkit::assert_close!(seen, albedo, 1e-5, 0.0);
    }
    assert!(picture.display.iter().all(|texel| texel[3] == 255), "the picture is opaque");
    assert!(picture.linear.contains(&[0.0; 3]), "black where nothing is");
}

#[test]
fn a_black_light_can_fail_the_furnace() {
    let Some(gpu) = gpu() else { return };
    let frame = Frame::plain(camera(), 16, 16);
    let picture = render_wgpu::render(&gpu, &furnace(), &Environment::constant([0.0; 3]), &frame).expect("a picture");
    assert!(picture.linear.iter().all(|pixel| *pixel == [0.0; 3]), "no light, no picture");
}

#[test]
fn a_scene_builds_only_the_pipelines_that_it_calls_for() {
    let Some(gpu) = gpu() else { return };
    let light = Environment::constant([1.0; 3]);
    let pipelines = |prt: &Prt| Renderer::without_window(&gpu, prt, &light).expect("a sound scene").pipelines();
    assert_eq!(pipelines(&furnace()), 1, "one kind of material");
    assert_eq!(pipelines(&sphere_on_plane(1, 8)), 6, "six kinds of material");
}

#[test]
fn frames_of_one_scene_are_the_same_again() {
    let Some(gpu) = gpu() else { return };
    let (environment, prt) = (environment(), matte());
    let mut renderer = Renderer::without_window(&gpu, &prt, &environment).expect("a sound scene");
    let frame = Frame { bloom: 0.2, ..Frame::plain(camera(), 80, 50) };
    let first = renderer.draw(&frame).expect("a picture");
    let other = renderer.draw(&Frame { rotation: rotation(), width: 64, ..frame.clone() }).expect("a picture");
    assert_ne!(first.linear, other.linear, "another light gives another picture");
    assert!(first == renderer.draw(&frame).expect("a picture"), "the first picture again");
    assert!(!renderer.time(&frame).expect("a frame").relit, "the light has not turned");
    assert!(renderer.time(&Frame { rotation: rotation(), ..frame }).expect("a frame").relit, "the light has turned");
}

#[test]
fn frames_that_make_no_sense_are_refused() {
    let Some(gpu) = gpu() else { return };
    let mut renderer =
        Renderer::without_window(&gpu, &furnace(), &Environment::constant([1.0; 3])).expect("a sound scene");
    let plain = Frame::plain(camera(), 8, 8);
    let broken = [
        Frame { width: 0, ..plain.clone() },
        Frame { supersample: 9, ..plain.clone() },
        Frame { bloom: f32::NAN, ..plain.clone() },
        Frame { exposure_ev: f32::INFINITY, ..plain.clone() },
        Frame { rotation: glam::Quat::from_xyzw(0.0, 0.0, 0.0, 0.0), ..plain.clone() },
        Frame { camera: Camera { target: camera().eye, ..camera() }, ..plain.clone() },
    ];
    for frame in broken {
        let refused = renderer.draw(&frame).expect_err("a broken frame");
        assert!(matches!(refused, Error::Invalid { .. }), "{refused}");
    }
    let huge = Frame { width: 16384, supersample: 8, ..plain };
    let refused = renderer.draw(&huge).expect_err("no GPU has textures of 131072 texels");
    assert!(refused.to_string().contains("131072"), "{refused}");
}

#[test]
fn scenes_that_contradict_themselves_are_refused() {
    let Some(gpu) = gpu() else { return };
    let light = Environment::constant([1.0; 3]);
    let breaks: [fn(&mut Prt); 5] = [
        |prt| prt.geometry.triangles[0][1] = u32::MAX,
        |prt| prt.transfer.values.truncate(7),
        |prt| prt.meshes[0].material = 99,
        |prt| prt.geometry.normals.clear(),
        |prt| prt.textures[0].rgba.truncate(1),
    ];
    for change in breaks {
        let mut prt = furnace();
        change(&mut prt);
        let refused = Renderer::without_window(&gpu, &prt, &light).expect_err("a broken scene");
        assert!(matches!(refused, Error::Invalid { .. }), "{refused}");
    }
}

/// Set in the process that is to find no driver.
const CHILD: &str = "RELUME_TEST_WITHOUT_DRIVER";

#[test]
fn without_a_driver_the_error_says_what_to_do() {
    if std::env::var_os(CHILD).is_some() {
        let error = Gpu::new(Driver::Any).expect_err("the driver is hidden");
        panic!("{error}");
    }
    let test = std::env::current_exe().expect("this test");
    let mut child = Command::new(test);
    child.args(["--exact", "without_a_driver_the_error_says_what_to_do"]).env(CHILD, "1");
    // Vulkan alone, and no file that names a driver.
    child.env("WGPU_BACKEND", "vulkan").env("VK_DRIVER_FILES", "/nonexistent").env("VK_ICD_FILENAMES", "/nonexistent");
    let output = child.output().expect("a child process");
    let said = String::from_utf8_lossy(&output.stdout).into_owned() + &String::from_utf8_lossy(&output.stderr);
    assert!(said.contains("no GPU adapter was found"), "{said}");
    assert!(said.contains("apt install mesa-vulkan-drivers"), "{said}");
}

/// Unlit materials, textured, masked and blended, are those of the CPU; and differ from lit ones.
#[test]
fn unlit_materials_agree_with_the_cpu() {
    let Some(gpu) = gpu() else { return };
    let (environment, lit, frame) = (environment(), sphere_on_plane(3, 24), Frame::plain(camera(), 192, 128));
    let mut unlit = lit.clone();
    unlit.materials.iter_mut().for_each(|material| material.unlit = true);
    let picture = render_wgpu::render(&gpu, &unlit, &environment, &frame).expect("a picture");
    let same = distance(&picture, &cpu_picture(&unlit, &environment, &frame));
    assert!(same.is_small(), "{same:?}");
    let other = distance(&picture, &cpu_picture(&lit, &environment, &frame));
    assert!(!other.is_small(), "can fail: a lit scene must be noticed: {other:?}");
}
