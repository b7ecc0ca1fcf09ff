//! Bounced light beside a narrow surface: it fades within the width of that, however far apart vertices are.

mod support;

use bake::refine;
use coeff_io::{Bounces, Prt, Refine, Sampler, Settings};
use glam::{Vec3, Vec4};
use scene::{Material, Scene};
use support::{drawn, fixed, quiet, rectangle, under_white};

/// Albedo of wall and ledge; the floor is black.
const ALBEDO: f64 = 0.8;
/// Width of the ledge, height of the wall above it, depth of the floor below it, how far the floor goes out, metres.
const LEDGE: [f64; 4] = [0.06, 1.0, 0.5, 10.0];
/// Half the length of all, metres: their ends are too far off to matter.
const HALF: f32 = 10.0;
/// Heights on the wall at which radiance is compared, and up to where, metres.
const HEIGHTS: (usize, f64) = (200, 0.5);
/// Bound of the mean difference over them, as a share of the mean radiance; it may be 1 % of an open receiver's anywhere.
const AGREE: f64 = 0.02;

/// A wall of vertices 25 cm apart on a ledge of 6 cm, above a black floor.
fn wall() -> Scene {
    let [width, height, depth, out] = LEDGE.map(|x| x as f32);
    let corner = Vec3::NEG_X * HALF;
    let along = Vec3::X * 2.0 * HALF;
    let grey = |a: f32| Material { base_color: Vec4::new(a, a, a, 1.0), ..Material::default() };
    let mut meshes = vec![
        rectangle(corner, along, Vec3::Y * height, [80, 4]),
        rectangle(corner + Vec3::Z * width, along, Vec3::NEG_Z * 2.0 * width, [80, 2]),
        rectangle(corner + Vec3::new(0.0, -depth, out), along, Vec3::NEG_Z * out, [20, 10]),
    ];
    // The ledge is the front of a slab that bears the wall: it is no small object.
    meshes[1].positions.iter_mut().filter(|p| p.z < -0.5 * width).for_each(|p| p.z = -1.0);
    meshes[2].material = 1;
    Scene { meshes, materials: vec![grey(ALBEDO as f32), grey(0.0)], ..Scene::default() }
}

fn settings() -> Settings {
    Settings { refine: Refine::Auto, ..fixed(2, Sampler::OwenSobol, 2048, 1) }
}

/// Share of a vertical plane's light that comes from a horizontal strip of a width, at a depth below it and without end on either side.
fn share(depth: f64, width: f64) -> f64 {
    0.5 * (1.0 - depth / depth.hypot(width))
}

/// Radiance of the wall at a height above the ledge under a white sky, with one bounce: what is seen of the sky above the floor, and what
/// strips of the ledge send.
fn expected(height: f64) -> f64 {
    let [width, top, depth, out] = LEDGE;
    let sky = 1.0 - share(height, width).max(share(depth + height, out));
    let strips = 1000;
    let edge = |k: usize| width * k as f64 / f64::from(strips);
    let strip = |k: usize| {
        let z = edge(k) + 0.5 * edge(1);
        // A half of the sky, and what the wall leaves of the other.
        let lit = 1.0 - 0.5 * (1.0 - z / z.hypot(top));
        lit * (share(height, edge(k + 1)) - share(height, edge(k)))
    };
    ALBEDO * (sky + ALBEDO * (0..strips as usize).map(strip).sum::<f64>())
}

/// Mean difference from the closed form over the heights, as a share of its mean.
fn difference(prt: &Prt) -> f64 {
    let radiance = under_white(prt);
    let (count, top) = HEIGHTS;
    let (mut away, mut total) = (0.0, 0.0);
    for k in 0..count {
        let y = top * (k as f64 + 0.5) / count as f64;
        // Over all of a quad's width, so that both of its triangles count.
        let x = 0.25 * (k as f64 * 0.618_034).fract();
        away += (drawn(prt, &radiance, x, y) - expected(y)).abs();
        total += expected(y);
    }
    away / total
}

#[test]
fn light_of_a_ledge_is_not_spread_over_the_wall() {
    let away = difference(&quiet(&wall(), &settings()));
    assert!(away < AGREE, "{away} of the mean");
}

/// Twin: split for the light of the sky alone the wall is too bright.
#[test]
fn light_of_a_ledge_is_not_spread_over_the_wall_can_fail() {
    let scene = wall();
    let split = refine(&scene, &Settings { bounces: Bounces::Fixed(0), ..settings() }).expect("it splits");
    let away = difference(&quiet(&split, &Settings { refine: Refine::Off, ..settings() }));
    assert!(away > 2.0 * AGREE, "{away} of the mean");
}

/// Where no light bounces no edge is split for it.
#[test]
fn a_ledge_costs_nothing_without_bounces() {
    let scene = wall();
    let count = |bounces| {
        let settings = Settings { bounces, ..settings() };
        refine(&scene, &settings).expect("it splits").vertex_count()
    };
    let [none, some] = [count(Bounces::Fixed(0)), count(Bounces::Auto)];
    assert!(none < some && some < none + 2000, "{none} and {some} vertices");
}
