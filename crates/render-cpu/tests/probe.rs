//! The probe as it is seen: sky directions, and the light's rotation in sky, diffuse light and reflections.

mod handmade;

use glam::{DVec3, Quat, Vec3};
use handmade::{add_triangles, camera, distance, empty, quad, white};
use probe_io::Environment;
use render_cpu::{Frame, Image, render};

/// A smooth light without any symmetry.
fn lopsided(d: DVec3) -> [f64; 3] {
    [1.0 + 0.6 * d.x + 0.3 * d.y, 1.0 + 0.5 * d.z * d.z - 0.4 * d.x, 0.8 + 0.5 * d.y * d.z + 0.2 * d.z]
}

fn probe(light: impl Fn(DVec3) -> [f64; 3]) -> Environment {
    Environment::from_function("lopsided", 256, light)
}

fn look(direction: Vec3) -> Frame {
    let mut frame = Frame::plain(camera([0.0; 3], direction.to_array()), 15, 15);
    frame.camera.vertical_fov = 0.5;
    frame
}

fn draw(prt: &coeff_io::Prt, environment: &Environment, frame: &Frame) -> Image {
    render(prt, environment, frame).expect("a sound scene and frame")
}

fn middle(image: &Image) -> [f32; 3] {
    image.linear[image.linear.len() / 2]
}

#[test]
fn the_sky_along_an_axis_is_the_probe_along_that_axis() {
    for axis in [Vec3::X, Vec3::NEG_X, Vec3::Y, Vec3::NEG_Y, Vec3::Z, Vec3::NEG_Z] {
        let expected = lopsided(axis.as_dvec3()).map(|x| x as f32);
        let seen = middle(&draw(&empty(), &probe(lopsided), &look(axis)));
        assert!(distance(seen, expected) < 5e-3, "{axis}: {seen:?} is not {expected:?}");
    }
}

#[test]
fn the_sky_of_a_mirrored_probe_can_fail() {
    let mirrored = probe(|d| lopsided(DVec3::new(-d.x, d.y, d.z)));
    let expected = lopsided(DVec3::X).map(|x| x as f32);
    assert!(distance(middle(&draw(&empty(), &mirrored, &look(Vec3::X))), expected) > 0.5);
}

#[test]
fn what_lies_to_the_right_of_the_view_is_on_the_right_of_the_picture() {
    // Looking along -z with y up, +x is on the right and +y at the top.
    let image = draw(&empty(), &probe(|d| [d.x.max(0.0), d.y.max(0.0), 0.0]), &look(Vec3::NEG_Z));
    let at = |x: usize, y: usize| image.linear[y * 15 + x];
    assert!(at(14, 7)[0] > 0.1 && at(0, 7)[0] < 0.01, "right");
    assert!(at(7, 0)[1] > 0.1 && at(7, 14)[1] < 0.01, "top");
}

#[test]
fn no_sky_is_black() {
    let mut frame = look(Vec3::X);
    frame.sky = false;
    assert_eq!(middle(&draw(&empty(), &probe(lopsided), &frame)), [0.0; 3]);
}

/// A diffuse quad and a mirroring one, side by side before the sky.
fn showroom() -> (coeff_io::Prt, Frame) {
    let mut prt = empty();
    add_triangles(&mut prt, white(), &quad(Vec3::new(-0.8, 0.0, 0.0), Vec3::X * 0.5, Vec3::new(0.0, 0.6, 0.3)));
    let mut mirror = white();
    (mirror.metallic, mirror.roughness, mirror.specular) = (1.0, 0.1, true);
    add_triangles(&mut prt, mirror, &quad(Vec3::new(0.8, 0.0, 0.0), Vec3::X * 0.5, Vec3::new(0.1, 0.6, -0.3)));
    (prt, Frame::plain(camera([0.2, 0.4, 3.0], [0.0; 3]), 48, 32))
}

fn worst(a: &Image, b: &Image) -> f32 {
    a.linear.iter().zip(&b.linear).map(|(&a, &b)| distance(a, b)).fold(0.0, f32::max)
}

#[test]
fn turning_the_light_is_turning_the_pixels_of_the_probe() {
    let (prt, mut frame) = showroom();
    for rotation in [Quat::from_rotation_y(1.1), Quat::from_axis_angle(Vec3::new(0.6, 0.0, 0.8), 2.0)] {
        let inverse = rotation.as_dquat().inverse();
        frame.rotation = Quat::IDENTITY;
        let turned_pixels = draw(&prt, &probe(|d| lopsided(inverse * d)), &frame);
        frame.rotation = rotation;
        let turned_light = draw(&prt, &probe(lopsided), &frame);
        let difference = worst(&turned_pixels, &turned_light);
        assert!(difference < 0.02, "{rotation}: a pixel differs by {difference}");
    }
}

#[test]
fn turning_the_light_the_other_way_can_fail() {
    let (prt, mut frame) = showroom();
    let rotation = Quat::from_rotation_y(1.1);
    let turned_pixels = draw(&prt, &probe(|d| lopsided(rotation.as_dquat() * d)), &frame);
    frame.rotation = rotation;
    assert!(worst(&turned_pixels, &draw(&prt, &probe(lopsided), &frame)) > 0.2);
}
