//! Sheets cut into strips against whole ones.

use super::gpu;
use crate::strip::Strip;
use crate::{Error, Frame, Gpu, Image, relight};
use coeff_io::{Layers, MapLight, Prt};
use sh_math::hemisphere::Basis;

#[path = "../../tests/handmade/mod.rs"]
mod handmade;

/// The same device with storage for so few bytes that sheets are cut.
fn small(gpu: &Gpu) -> Gpu {
    let mut small = gpu.clone();
    small.limits.max_storage_buffer_binding_size = 1 << 12;
    small
}

fn scene() -> Prt {
    let mut prt = handmade::mapped(Basis::H6, &MapLight::Relightable { bands: 2 }, 8);
    prt.materials.iter_mut().for_each(|material| material.specular = false);
    prt
}

fn draw(gpu: &Gpu, prt: &Prt) -> Image {
    let frame = Frame::plain(handmade::camera(), 96, 64);
    crate::render(gpu, prt, &handmade::environment(), &frame).expect("a sound scene")
}

fn strips(gpu: &Gpu, prt: &Prt) -> usize {
    let maps = prt.maps.as_ref().expect("maps");
    Strip::all(gpu, &relight::pipeline(gpu, 3), maps, &maps.sheets[0]).expect("a small map").len()
}

#[test]
fn strips_are_the_whole_sheet() {
    let Some(gpu) = gpu() else { return };
    let (small, prt) = (small(&gpu), scene());
    assert_eq!((strips(&gpu, &prt), strips(&small, &prt)), (1, 3), "9 rows of 936 bytes, 4 in each strip");
    assert!(draw(&gpu, &prt) == draw(&small, &prt));
}

#[test]
fn strips_can_fail() {
    let Some(gpu) = gpu() else { return };
    let prt = scene();
    let mut other = prt.clone();
    let layers = &mut other.maps.as_mut().expect("maps").sheets[0].layers;
    let mut values = layers.decode();
    let row = (layers.width * layers.channels) as usize;
    values[row * 8..row * 9].fill(0.0);
    *layers = Layers::exact([layers.width, layers.height, layers.count, layers.channels], &values);
    assert!(draw(&gpu, &prt) != draw(&small(&gpu), &other), "the last row of the first layer must be seen");
}

#[test]
fn maps_beyond_the_gpu_are_refused() {
    let Some(mut gpu) = gpu() else { return };
    gpu.limits.max_texture_array_layers = 4;
    let frame = Frame::plain(handmade::camera(), 8, 8);
    let draw = |basis| {
        let frame = Frame { basis, ..frame.clone() };
        crate::render(&gpu, &scene(), &handmade::environment(), &frame)
    };
    let refused = draw(None).expect_err("six layers do not fit four");
    assert!(matches!(&refused, Error::TooLarge { needed: 6, limit: 4, .. }), "{refused}");
    assert!(refused.to_string().contains("light map 0"), "{refused}");
    assert!(draw(Some(Basis::H4)).is_ok(), "four do");
    gpu.limits.max_storage_buffer_binding_size = 900;
    let (prt, pipeline) = (scene(), relight::pipeline(&gpu, 3));
    let maps = prt.maps.as_ref().expect("maps");
    let refused = Strip::all(&gpu, &pipeline, maps, &maps.sheets[0]).expect_err("a row is 936 bytes");
    assert!(matches!(refused, Error::TooLarge { needed: 936, limit: 900, .. }), "{refused}");
}
