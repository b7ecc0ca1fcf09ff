//! What cannot be drawn is refused with a sentence; all else is drawn, however odd.

mod handmade;

use coeff_io::Prt;
use glam::{Quat, Vec3};
use handmade::{add_triangles, camera, empty, quad, wall, white};
use probe_io::Environment;
use render_cpu::{Error, Frame, render};

/// What the refusal must say, and what breaks a sound thing.
type Edit<T> = (&'static str, fn(&mut T));

fn frame() -> Frame {
    Frame::plain(camera([0.0, 0.0, 3.0], [0.0; 3]), 20, 10)
}

fn sky() -> Environment {
    Environment::constant([0.5; 3])
}

#[test]
fn frames_out_of_range_are_refused() {
    let edits: [Edit<Frame>; 11] = [
        ("0 x 10", |f| f.width = 0),
        ("20 x 0", |f| f.height = 0),
        ("16385", |f| f.width = 16_385),
        ("supersample 0", |f| f.supersample = 0),
        ("supersample 9", |f| f.supersample = 9),
        ("bloom 1.5", |f| f.bloom = 1.5),
        ("bloom NaN", |f| f.bloom = f32::NAN),
        ("exposure inf", |f| f.exposure_ev = f32::INFINITY),
        ("rotation", |f| f.rotation = Quat::from_xyzw(0.0, 0.0, 0.0, f32::NAN)),
        ("coincide", |f| f.camera.target = f.camera.eye),
        ("angle of view", |f| f.camera.vertical_fov = 4.0),
    ];
    for (word, edit) in edits {
        let mut frame = frame();
        edit(&mut frame);
        match render(&empty(), &sky(), &frame) {
            Err(Error::Frame(what)) => assert!(what.contains(word), "`{what}` does not say `{word}`"),
            other => panic!("{word}: {other:?}"),
        }
    }
    assert!(render(&empty(), &sky(), &frame()).is_ok(), "the frame itself is sound");
}

#[test]
fn scenes_that_contradict_themselves_are_refused() {
    let edits: [Edit<Prt>; 8] = [
        ("transfer values", |p| p.transfer.values.truncate(5)),
        ("channels", |p| p.transfer.channels = 2),
        ("triangle 1", |p| p.geometry.triangles[1][2] = 99),
        ("material 7", |p| p.meshes[0].material = 7),
        ("ends beyond", |p| p.meshes[0].triangles = u32::MAX),
        ("normals", |p| p.geometry.normals.clear()),
        ("uv0", |p| p.geometry.uv0.push([0.0; 2])),
        ("openness", |p| p.transfer.openness.push(1.0)),
    ];
    for (word, edit) in edits {
        let mut prt = wall(white());
        edit(&mut prt);
        match render(&prt, &sky(), &frame()) {
            Err(Error::Prt(what)) => assert!(what.contains(word), "`{what}` does not say `{word}`"),
            other => panic!("{word}: {other:?}"),
        }
    }
}

#[test]
fn an_empty_scene_shows_the_sky() {
    let image = render(&empty(), &sky(), &frame()).expect("nothing to draw is no error");
    assert_eq!((image.width, image.height, image.linear.len(), image.display.len()), (20, 10, 200, 200));
    assert!(image.linear.iter().all(|p| handmade::distance(*p, [0.5; 3]) < 1e-5));
}

#[test]
fn odd_geometry_is_drawn_without_a_fault() {
    let huge = 1e30;
    let triangles = [
        [Vec3::ZERO, Vec3::ZERO, Vec3::ZERO],
        [Vec3::ZERO, Vec3::X, Vec3::X * 2.0],
        [Vec3::new(0.0, 0.0, 3.0), Vec3::new(1.0, 0.0, 3.0), Vec3::new(0.0, 1.0, 3.0)],
        [Vec3::new(-huge, -1.0, -huge), Vec3::new(huge, -1.0, -huge), Vec3::new(0.0, -1.0, huge)],
        [Vec3::splat(f32::MAX), Vec3::splat(-f32::MAX), Vec3::new(f32::MAX, 0.0, -f32::MAX)],
        [Vec3::splat(1e-30), Vec3::X * 1e-30, Vec3::Y * 1e-30],
    ];
    let mut prt = wall(white());
    add_triangles(&mut prt, white(), &triangles);
    prt.geometry.normals[6..].fill([0.0; 3]);
    prt.transfer.values[24..].fill(0.1);
    prt.materials[1].specular = true;
    for (eye, target) in [([0.0, 0.0, 3.0], [0.0; 3]), ([0.0; 3], [0.0, 1.0, 0.0]), ([1e6, 1e6, 1e6], [0.0; 3])] {
        let mut frame = frame();
        (frame.camera.eye, frame.camera.target, frame.supersample) = (eye, target, 3);
        let image = render(&prt, &sky(), &frame).expect("odd, but sound");
        assert!(image.linear.iter().flatten().all(|x| x.is_finite()), "from {eye:?}");
    }
}

#[test]
fn pictures_of_any_size_are_whole() {
    let mut prt = wall(white());
    add_triangles(&mut prt, white(), &quad(Vec3::Z, Vec3::X * 9.0, Vec3::Y * 9.0));
    for (width, height, supersample) in [(1, 1, 8), (1, 200, 1), (200, 1, 5), (65, 63, 1), (9, 22, 7)] {
        let mut frame = frame();
        (frame.width, frame.height, frame.supersample) = (width, height, supersample);
        let image = render(&prt, &Environment::constant([1.0; 3]), &frame).expect("a sound frame");
        assert!(
            image.linear.iter().all(|p| handmade::distance(*p, [1.0; 3]) < 1e-3),
            "{width} x {height} x {supersample}"
        );
    }
}

#[test]
fn the_same_frame_is_the_same_picture_for_any_number_of_threads() {
    let mut prt = wall(white());
    add_triangles(&mut prt, white(), &quad(Vec3::new(0.2, 0.1, 1.0), Vec3::new(0.3, 0.2, 0.1), Vec3::Y * 0.4));
    let mut frame = frame();
    (frame.width, frame.height, frame.bloom) = (150, 130, 0.2);
    let draw = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
        pool.install(|| render(&prt, &Environment::from_function("slope", 16, |d| [1.0 + d.y; 3]), &frame))
    };
    assert_eq!(draw(1), draw(5));
}
