//! Drawn radiance is the closed form: transfer times light, nothing added, nothing lost.

mod handmade;

use coeff_io::Transfer;
use glam::{Quat, Vec3};
use handmade::{Y1, add_triangles, camera, distance, empty, open_transfer, quad, wall, white};
use probe_io::Environment;
use render_cpu::{Frame, Image, render};

/// Rounding of f32 sums over the texels of a probe and of the picture.
const ROUNDING: f32 = 2e-4;

/// Radiance 1 + y/2 per channel scale: two bands hold it exactly.
fn slope_light() -> Environment {
    Environment::from_function("slope", 64, |d| [1.0 + 0.5 * d.y, 2.0 + d.y, 0.5 + 0.25 * d.y])
}

fn draw(prt: &coeff_io::Prt, environment: &Environment, frame: &Frame) -> Image {
    render(prt, environment, frame).expect("a sound scene and frame")
}

fn centre(image: &Image) -> [f32; 3] {
    image.linear[(image.height / 2 * image.width + image.width / 2) as usize]
}

/// A quad through the origin with this normal, seen along it.
fn tilted(normal: Vec3) -> (coeff_io::Prt, Frame) {
    let turn = Quat::from_rotation_arc(Vec3::Z, normal);
    let mut prt = empty();
    add_triangles(&mut prt, white(), &quad(Vec3::ZERO, turn * Vec3::X, turn * Vec3::Y));
    let frame = Frame::plain(camera((normal * 2.0).to_array(), [0.0; 3]), 16, 16);
    (prt, frame)
}

/// The cosine lobe over pi keeps constants and shrinks linear parts to 2/3.
fn closed_form(normal: Vec3) -> [f32; 3] {
    [1.0, 2.0, 0.5].map(|scale| scale * (1.0 + normal.y / 3.0))
}

#[test]
fn an_open_quad_shows_the_closed_form_of_the_cosine() {
    for normal in [Vec3::Y, Vec3::NEG_Y, Vec3::X, Vec3::new(0.6, 0.48, -0.64)] {
        let (prt, frame) = tilted(normal);
        let seen = centre(&draw(&prt, &slope_light(), &frame));
        let expected = closed_form(normal);
        assert!(distance(seen, expected) < ROUNDING * 2.0, "{normal}: {seen:?} is not {expected:?}");
    }
}

#[test]
fn an_open_quad_with_an_unclamped_cosine_can_fail() {
    // The cosine without max(0, .) has no constant part: a white sky would light nothing.
    let (mut prt, frame) = tilted(Vec3::Y);
    for values in prt.transfer.values.chunks_exact_mut(4) {
        values.copy_from_slice(&[0.0, Y1 * 4.0 / 3.0, 0.0, 0.0]);
    }
    assert!(distance(centre(&draw(&prt, &slope_light(), &frame)), closed_form(Vec3::Y)) > 0.3);
}

#[test]
fn three_channels_meet_their_own_light() {
    let (mut prt, frame) = tilted(Vec3::Y);
    let grey = prt.transfer.clone();
    let values = grey.values.iter().flat_map(|&t| [t, 0.5 * t, 0.25 * t]).collect();
    prt.transfer = Transfer { channels: 3, values, ..grey };
    let seen = centre(&draw(&prt, &slope_light(), &frame));
    let grey = closed_form(Vec3::Y);
    assert!(distance(seen, [grey[0], 0.5 * grey[1], 0.25 * grey[2]]) < ROUNDING * 2.0, "{seen:?}");
}

#[test]
fn more_bands_are_read_in_their_order() {
    // A light of l = 2 and a transfer that is its own pattern: the dot product is the light's power.
    for bands in [1_u32, 3, 5] {
        let (mut prt, frame) = tilted(Vec3::Y);
        let n = (bands * bands) as usize;
        let environment = Environment::from_function("lobe", 64, |d| [d.y * d.y + d.x.max(0.0); 3]);
        let bands_of = sh_math::Bands::new(bands).expect("few bands");
        let light = sh_math::project(bands_of, environment.samples()).values;
        prt.transfer.bands = bands;
        prt.transfer.values = (0..6).flat_map(|_| (0..n).map(|i| 0.01 * (i as f32 + 1.0))).collect();
        let expected: f64 = (0..n).map(|i| 0.01 * (i as f64 + 1.0) * f64::from(light[i][0])).sum();
        let seen = centre(&draw(&prt, &environment, &frame));
        assert!((f64::from(seen[0]) - expected.max(0.0)).abs() < 1e-4, "{bands} bands: {seen:?} is not {expected}");
    }
}

#[test]
fn a_white_furnace_is_one_everywhere() {
    let mut prt = wall(white());
    add_triangles(
        &mut prt,
        white(),
        &quad(Vec3::new(0.3, 0.2, 1.0), Vec3::new(0.4, 0.1, 0.2), Vec3::new(0.0, 0.5, 0.3)),
    );
    let mut frame = Frame::plain(camera([0.5, 0.3, 3.0], [0.0; 3]), 64, 48);
    frame.supersample = 2;
    frame.bloom = 0.3;
    let image = draw(&prt, &Environment::constant([1.0; 3]), &frame);
    let worst = image.linear.iter().map(|&p| distance(p, [1.0; 3])).fold(0.0, f32::max);
    assert!(worst < ROUNDING, "a pixel is off by {worst}");
}

#[test]
fn a_grey_furnace_can_fail() {
    let mut grey = white();
    grey.base_color = [0.9, 0.9, 0.9, 1.0];
    let frame = Frame::plain(camera([0.0, 0.0, 3.0], [0.0; 3]), 16, 16);
    let image = draw(&wall(grey), &Environment::constant([1.0; 3]), &frame);
    assert!((centre(&image)[0] - 0.9).abs() < ROUNDING);
}

#[test]
fn negative_radiance_is_drawn_as_black() {
    let mut prt = wall(white());
    prt.transfer.values.iter_mut().for_each(|t| *t = -*t);
    let frame = Frame::plain(camera([0.0, 0.0, 3.0], [0.0; 3]), 16, 16);
    assert_eq!(centre(&draw(&prt, &Environment::constant([1.0; 3]), &frame)), [0.0; 3]);
}

#[test]
fn exposure_doubles_per_stop() {
    let mut frame = Frame::plain(camera([0.0, 0.0, 3.0], [0.0; 3]), 16, 16);
    frame.exposure_ev = -2.0;
    let image = draw(&wall(white()), &Environment::constant([1.0; 3]), &frame);
    assert!(distance(centre(&image), [0.25; 3]) < ROUNDING);
}

#[test]
fn dot_products_agree_with_a_plain_loop() {
    let normals = [Vec3::Y, Vec3::new(0.6, 0.0, 0.8), Vec3::new(-0.36, 0.48, -0.8)];
    let light = [[1.0, 0.5, 0.2], [0.3, -0.2, 0.9], [0.0, 0.4, 0.1], [-0.7, 0.6, 0.3]];
    let values: Vec<f32> = normals.iter().flat_map(|&n| open_transfer(n)).collect();
    let transfer = Transfer { bands: 2, channels: 1, values: values.clone(), ..Transfer::default() };
    for (v, seen) in render_cpu::vertex_radiance(&transfer, &light).iter().enumerate() {
        for c in 0..3 {
            let exact: f64 = (0..4).map(|i| f64::from(values[v * 4 + i]) * f64::from(light[i][c])).sum();
            assert!((f64::from(seen[c]) - exact).abs() < 1e-6, "vertex {v}, channel {c}");
        }
    }
}
