//! Bounces that fade slowly: white rooms with a small opening.

mod support;

use coeff_io::{Bounces, Prt, Sampler, Settings};
use glam::{Vec3, Vec4};
use scene::{Material, Mesh, Scene};
use support::{fixed, quiet, under_white, worst};

/// A cube of 2 m whose walls face inwards, 6 x 6 squares each; one square of the ceiling is open.
fn room(albedo: [f32; 3]) -> Scene {
    let mut mesh = Mesh { name: "walls".into(), ..Mesh::default() };
    for axis in 0..6usize {
        let (normal, right) = (Vec3::AXES[axis % 3], Vec3::AXES[(axis + 1) % 3]);
        let normal = if axis < 3 { normal } else { -normal };
        // Right, up and normal turn counter-clockwise as seen from inside.
        let up = normal.cross(right);
        let first = mesh.positions.len() as u32;
        for (i, j) in (0..49).map(|k| (k % 7, k / 7)) {
            mesh.positions.push(-normal + right * (i as f32 / 3.0 - 1.0) + up * (j as f32 / 3.0 - 1.0));
            mesh.normals.push(normal);
        }
        let squares = (0..36u32).map(|k| (k % 6, k / 6)).filter(|&square| axis != 4 || square != (2, 3));
        for (i, j) in squares {
            let at = |i: u32, j: u32| first + j * 7 + i;
            mesh.triangles.push([at(i, j), at(i + 1, j), at(i + 1, j + 1)]);
            mesh.triangles.push([at(i, j), at(i + 1, j + 1), at(i, j + 1)]);
        }
    }
    let [r, g, b] = albedo;
    let wall = Material { name: "wall".into(), base_color: Vec4::new(r, g, b, 1.0), ..Material::default() };
    Scene { name: "room".into(), meshes: vec![mesh], materials: vec![wall], ..Scene::default() }
}

fn settings(bounces: Bounces) -> Settings {
    Settings { bounces, ..fixed(2, Sampler::OwenSobol, 256, 0) }
}

/// Most that a bake under a white sky is off 1.
fn off_white(prt: &Prt) -> f64 {
    worst(&under_white(prt), 1.0).0
}

/// White walls vanish under a white sky, however small the opening: the series of bounces sums to 1 less what comes in straight.
#[test]
fn a_white_room_vanishes() {
    let prt = quiet(&room([1.0; 3]), &settings(Bounces::Auto));
    let left = prt.achieved.remainder.expect("its tail was summed");
    assert!(left <= 2.5e-3, "{left} is still to come");
    assert!(prt.achieved.bounces < 60, "{} bounces", prt.achieved.bounces);
    // The remainder is told against the norm of an open receiver's transfer, whose first coefficient is 0.65 of it.
    let off = off_white(&prt);
    assert!(off < 5e-3, "{off} off");
    let cut = quiet(&room([1.0; 3]), &settings(Bounces::Fixed(prt.achieved.bounces)));
    assert!(off_white(&cut) > 0.5, "a_white_room_vanishes_can_fail: without the tail {} is missing", off_white(&cut));
    assert_eq!(cut.achieved.remainder, None, "bounces that were asked for have no tail");
}

/// Against explicit bounces without end, per channel: each has a ratio of its own.
#[test]
fn a_tail_equals_explicit_bounces() {
    let scene = room([0.999, 0.97, 0.5]);
    let prt = quiet(&scene, &settings(Bounces::Auto));
    assert!(prt.achieved.remainder.is_some_and(|left| left <= 2.5e-3) && prt.achieved.bounces < 60);
    let long = quiet(&scene, &settings(Bounces::Fixed(4000)));
    let largest = long.transfer.values.iter().map(|x| x.abs()).fold(0.0, f32::max);
    let pairs = prt.transfer.values.iter().zip(&long.transfer.values);
    let off = pairs.map(|(a, b)| (a - b).abs()).fold(0.0, f32::max);
    assert!(off < 3e-3 * largest.max(0.28), "{off} off, the largest is {largest}");
    let cut = quiet(&scene, &settings(Bounces::Fixed(60)));
    let pairs = cut.transfer.values.iter().zip(&long.transfer.values);
    let off = pairs.map(|(a, b)| (a - b).abs()).fold(0.0, f32::max);
    assert!(off > 0.02, "can fail: 60 bounces are {off} off");
}

/// Where bounces fade by themselves nothing is added: the bits of that many explicit ones.
#[test]
fn bounces_that_fade_have_no_tail() {
    let scene = room([0.6; 3]);
    let prt = quiet(&scene, &settings(Bounces::Auto));
    assert_eq!(prt.achieved.remainder, None);
    let explicit = quiet(&scene, &settings(Bounces::Fixed(prt.achieved.bounces)));
    assert_eq!(prt.transfer.values, explicit.transfer.values, "to the bit");
}

/// Walls of `Kd 1`, and a lamp's quad below the ceiling between which light goes to and fro.
#[test]
fn the_white_box_of_others_ends() {
    let Some(data) = testkit::data_dir() else { return testkit::skip("bounces of the Cornell box with white walls") };
    let scene = scene::load(&data.join("scenes/cornell-box/cornell_box.obj")).expect("a good scene");
    let prt = quiet(&scene, &settings(Bounces::Auto));
    // Where the light has faded by itself before its tail is summed, nothing is left.
    let (bounces, left) = (prt.achieved.bounces, prt.achieved.remainder.unwrap_or(0.0));
    assert!(bounces < 120 && left <= 2.5e-3, "{bounces} bounces leave {left}");
    let long = quiet(&scene, &settings(Bounces::Fixed(3000)));
    let pairs = prt.transfer.values.iter().zip(&long.transfer.values);
    let off = pairs.map(|(a, b)| (a - b).abs()).fold(0.0, f32::max);
    assert!(off < 3e-3, "{off} off explicit bounces");
}
