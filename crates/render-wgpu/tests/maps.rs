//! Pictures of scenes with light maps, on the GPU and on the CPU.

mod compare;
mod handmade;

use coeff_io::{Layers, MapLight, Prt};
use compare::{Distance, cpu_frame, distance, gpu};
use handmade::{camera, environment, mapped, rotation, sphere_on_plane};
use probe_io::Environment;
use render_wgpu::{Error, Frame, Gpu, Renderer};
use sh_math::hemisphere::Basis;

const RELIGHTABLE: MapLight = MapLight::Relightable { bands: 3 };

fn fixed() -> MapLight {
    MapLight::Fixed { probe: "test".into(), bands: 4 }
}

fn frame() -> Frame {
    Frame::plain(camera(), 192, 128)
}

/// Without reflections, whose blur takes seconds.
fn matte(basis: Basis, light: &MapLight) -> Prt {
    let mut prt = mapped(basis, light, 24);
    prt.materials.iter_mut().for_each(|material| material.specular = false);
    prt
}

/// How far the two renderers are apart in each frame.
fn compare(gpu: &Gpu, prt: &Prt, environment: &Environment, frames: &[Frame]) -> Vec<Distance> {
    let twin = render_cpu::Renderer::without_window(prt, environment).expect("a sound scene");
    let mut renderer = Renderer::without_window(gpu, prt, environment).expect("a sound scene");
    let pair = |frame| {
        let picture = renderer.draw(frame).expect("a sound frame");
        distance(&picture, &twin.draw(&cpu_frame(frame)).expect("a sound frame"))
    };
    frames.iter().map(pair).collect()
}

#[test]
fn pictures_of_every_basis_agree_with_the_cpu() {
    let Some(gpu) = gpu() else { return };
    let environment = environment();
    for basis in Basis::ALL {
        for distance in compare(&gpu, &matte(basis, &fixed()), &environment, &[frame()]) {
            assert!(distance.is_small(), "{}: {distance:?}", basis.name());
        }
    }
}

#[test]
fn one_file_in_every_basis_under_a_turning_light_agrees_with_the_cpu() {
    let Some(gpu) = gpu() else { return };
    let own = Frame { rotation: rotation(), ..frame() };
    let others = Basis::ALL.map(|basis| Frame { basis: Some(basis), ..own.clone() });
    let cut = Frame { functions: Some(4), ..own.clone() };
    let frames = [vec![frame(), own, cut], others.into()].concat();
    let prt = matte(Basis::H6, &RELIGHTABLE);
    for (frame, distance) in frames.iter().zip(compare(&gpu, &prt, &environment(), &frames)) {
        assert!(distance.is_small(), "{:?}, {:?}: {distance:?}", frame.basis, frame.functions);
    }
}

#[test]
fn maps_that_shine_and_white_surfaces_agree_with_the_cpu() {
    let Some(gpu) = gpu() else { return };
    let prt = mapped(Basis::ModifiedH6, &RELIGHTABLE, 24);
    let white = Frame { albedo: false, ..frame() };
    for distance in compare(&gpu, &prt, &environment(), &[frame(), white]) {
        assert!(distance.is_small(), "{distance:?}");
    }
}

/// The floor's sheet holds one function of six: an ordinary light map in every basis.
#[test]
fn ordinary_light_maps_beside_directional_ones_agree_with_the_cpu() {
    let Some(gpu) = gpu() else { return };
    let mut prt = matte(Basis::ModifiedH6, &RELIGHTABLE);
    let layers = &mut prt.maps.as_mut().expect("maps").sheets[0].layers;
    let values = layers.decode();
    let held = 9 * (layers.width * layers.height * layers.channels) as usize;
    *layers = Layers::exact([layers.width, layers.height, 9, layers.channels], &values[..held]);
    let frames = [None, Some(Basis::Hl2)].map(|basis| Frame { basis, rotation: rotation(), ..frame() });
    for (frame, distance) in frames.iter().zip(compare(&gpu, &prt, &environment(), &frames)) {
        assert!(distance.is_small(), "{:?}: {distance:?}", frame.basis);
    }
}

#[test]
fn pictures_with_maps_can_fail() {
    let Some(gpu) = gpu() else { return };
    let (environment, prt) = (environment(), matte(Basis::H6, &RELIGHTABLE));
    let twin = render_cpu::Renderer::without_window(&prt, &environment).expect("a sound scene");
    let expected = twin.draw(&cpu_frame(&frame())).expect("a sound frame");
    let mut no_bumps = prt.clone();
    no_bumps.materials[2].normal_texture = None;
    let mut no_maps = prt.clone();
    no_maps.maps = None;
    let mut other_sheet = prt.clone();
    other_sheet.maps.as_mut().expect("maps").sheet_of_mesh[0] = Some(1);
    let mut shifted = prt.clone();
    shifted.geometry.uv1.iter_mut().for_each(|uv| uv[0] += 0.5 / 13.0);
    let draw = |prt: &Prt, frame: &Frame| render_wgpu::render(&gpu, prt, &environment, frame).expect("a picture");
    let wrong = [
        ("no normal map on the leaf", draw(&no_bumps, &frame())),
        ("no maps", draw(&no_maps, &frame())),
        ("another sheet", draw(&other_sheet, &frame())),
        ("half a texel", draw(&shifted, &frame())),
        ("a turned light", draw(&prt, &Frame { rotation: rotation(), ..frame() })),
        ("another basis", draw(&prt, &Frame { basis: Some(Basis::Hl2), ..frame() })),
        ("fewer functions", draw(&prt, &Frame { functions: Some(4), ..frame() })),
        ("no albedo", draw(&prt, &Frame { albedo: false, ..frame() })),
    ];
    for (name, picture) in wrong {
        let distance = distance(&picture, &expected);
        assert!(!distance.is_small(), "{name} must be noticed: {distance:?}");
    }
}

#[test]
fn maps_build_only_what_they_call_for() {
    let Some(gpu) = gpu() else { return };
    let environment = Environment::constant([1.0; 3]);
    let pipelines = |prt: &Prt| Renderer::without_window(&gpu, prt, &environment).expect("a sound scene").pipelines();
    let mut hidden = mapped(Basis::H6, &fixed(), 8);
    hidden.maps.as_mut().expect("maps").sheet_of_mesh.fill(None);
    assert_eq!(pipelines(&sphere_on_plane(1, 8)), pipelines(&hidden), "maps that no mesh shows cost nothing");
    let prt = mapped(Basis::H6, &fixed(), 8);
    let mut renderer = Renderer::without_window(&gpu, &prt, &environment).expect("a sound scene");
    assert_eq!(renderer.pipelines(), 6, "one for each kind of material and light");
    renderer.draw(&Frame { functions: Some(4), ..frame() }).expect("a picture");
    assert_eq!(renderer.pipelines(), 10, "four materials with maps once more");
    renderer.draw(&frame()).expect("a picture");
    assert_eq!(renderer.pipelines(), 10, "what is there serves again");
}

#[test]
fn frames_are_the_same_again_after_other_lights_and_bases() {
    let Some(gpu) = gpu() else { return };
    let prt = matte(Basis::Sh9, &RELIGHTABLE);
    let mut renderer = Renderer::without_window(&gpu, &prt, &environment()).expect("a sound scene");
    let first = renderer.draw(&frame()).expect("a picture");
    let turned = renderer.draw(&Frame { rotation: rotation(), ..frame() }).expect("a picture");
    let other = renderer.draw(&Frame { basis: Some(Basis::H4), ..frame() }).expect("a picture");
    assert!(first != turned && first != other && turned != other);
    assert!(first == renderer.draw(&frame()).expect("a picture"), "the first picture again");
    let light = renderer.light().clone();
    renderer.set_light(light.windowed(&[1.0, 0.5]));
    let windowed = renderer.draw(&frame()).expect("a picture");
    assert!(first != windowed, "another light reaches the maps");
    renderer.set_light(light);
    assert!(first == renderer.draw(&frame()).expect("a picture"), "the first light again");
}

#[test]
fn what_maps_cannot_show_is_refused() {
    let Some(gpu) = gpu() else { return };
    let environment = Environment::constant([1.0; 3]);
    let mut prt = matte(Basis::Sh9, &fixed());
    let mut renderer = Renderer::without_window(&gpu, &prt, &environment).expect("a sound scene");
    let frames =
        [("`test`", Frame { rotation: rotation(), ..frame() }), ("ask for 9", Frame { functions: Some(4), ..frame() })];
    for (words, frame) in frames {
        let refused = renderer.draw(&frame).expect_err("a frame that maps cannot show");
        assert!(matches!(refused, Error::Invalid { .. }) && refused.to_string().contains(words), "{refused}");
    }
    let mut plain = Renderer::without_window(&gpu, &sphere_on_plane(1, 8), &environment).expect("a sound scene");
    let refused = plain.draw(&Frame { basis: Some(Basis::H4), ..frame() }).expect_err("no maps, no basis");
    assert!(refused.to_string().contains("no light maps"), "{refused}");
    prt.maps.as_mut().expect("maps").sheets[0].layers.count += 1;
    let refused = Renderer::without_window(&gpu, &prt, &environment).expect_err("a broken map");
    assert!(refused.to_string().contains("layers"), "{refused}");
}
