//! Ground in the plane of a floor that is turned by an odd angle: rounding, which decides there what lies above what, decides nothing else.

mod support;

use coeff_io::{Prt, Refine, Settings};
use glam::{DQuat, DVec3, Vec3, dvec3, vec4};
use scene::{AlphaMode, Material, Mesh, Scene};
use std::f64::consts::TAU;
use support::{fixed, quiet};

/// Corners and triangles.
type Shape = (Vec<DVec3>, Vec<[u32; 3]>);

/// Triangles that meet in the middle of a disc, and long teeth side by side: all of them slivers.
const GROUND: [fn(u32) -> Shape; 2] = [disc, comb];
const SLIVERS: u32 = 300;

fn disc(n: u32) -> Shape {
    let rim = (0..n).map(|k| TAU * f64::from(k) / f64::from(n)).map(|a| 3.0 * dvec3(a.sin(), 0.0, a.cos()));
    let positions = rim.chain([DVec3::ZERO]).collect();
    (positions, (0..n).map(|k| [n, k, (k + 1) % n]).collect())
}

fn comb(n: u32) -> Shape {
    let x = |k: u32| 8.0 * f64::from(k) / f64::from(n) - 4.0;
    let tooth = |k| [dvec3(x(k), 0.0, -1.0), dvec3(x(k + 1), 0.0, -1.0), dvec3(x(k), 0.0, 1.0)];
    ((0..n).flat_map(tooth).collect(), (0..n).map(|k| [3 * k, 3 * k + 2, 3 * k + 1]).collect())
}

/// Pyramids that stand on the ground.
fn posts() -> Shape {
    let (mut positions, mut triangles) = (Vec::new(), Vec::new());
    for k in 0..10u32 {
        let (angle, radius) = (2.4 * f64::from(k), 10.0 * ((f64::from(k) + 0.5) / 10.0).sqrt());
        let at = radius * dvec3(angle.sin(), 0.0, angle.cos());
        let corners = [[-1.0, -1.0], [-1.0, 1.0], [1.0, 1.0], [1.0, -1.0]];
        positions.extend(corners.map(|[x, z]| at + 0.2 * dvec3(x, 0.0, z)));
        positions.push(at + 0.5 * DVec3::Y);
        triangles.extend((0..4).map(|i| [5 * k + i, 5 * k + (i + 1) % 4, 5 * k + 4]));
    }
    (positions, triangles)
}

fn square(half: f64, height: f64) -> Shape {
    let corners = [[-1.0, -1.0], [-1.0, 1.0], [1.0, 1.0], [1.0, -1.0]];
    (corners.map(|[x, z]| dvec3(half * x, height, half * z)).to_vec(), vec![[0, 1, 2], [0, 2, 3]])
}

/// A scene of these meshes, turned, then rounded; each vertex of the second is moved up first by what `height` gives for its number.
fn scene(meshes: Vec<Shape>, turned: bool, height: impl Fn(u32) -> f64) -> Scene {
    let turn = if turned { DQuat::from_axis_angle(dvec3(0.3, 0.5, 0.7).normalize(), 0.7) } else { DQuat::IDENTITY };
    let mesh = |(m, (positions, triangles)): (usize, Shape)| {
        let up = |v: u32| if m == 1 { height(v) * DVec3::Y } else { DVec3::ZERO };
        let positions = (0..).zip(positions).map(|(v, p)| (turn * (p + up(v))).as_vec3()).collect();
        Mesh { positions, triangles, ..Mesh::default() }
    };
    let meshes = meshes.into_iter().enumerate().map(mesh).collect();
    Scene { meshes, materials: vec![Material::default()], ..Scene::default() }
}

/// Receivers and rays of a bake of ground on a floor with posts.
fn work(ground: fn(u32) -> Shape, turned: bool, height: impl Fn(u32) -> f64) -> [f64; 2] {
    let scene = scene(vec![square(12.0, 0.0), ground(SLIVERS), posts()], turned, height);
    let settings = Settings { refine: Refine::Auto, ..fixed(3, coeff_io::Sampler::OwenSobol, 32, 0) };
    let prt = quiet(&scene, &settings);
    [prt.plan.receivers as f64, prt.achieved.visibility_rays as f64]
}

#[test]
fn turned_ground_takes_the_receivers_and_rays_of_lifted_ground() {
    for ground in GROUND {
        let (flush, lifted) = (work(ground, true, |_| 0.0), work(ground, true, |_| 0.01));
        let straight = work(ground, false, |_| 0.0);
        for k in 0..2 {
            assert!(flush[k] < 2.0 * lifted[k], "{flush:?}, lifted {lifted:?}");
            assert!(flush[k] < 1.2 * straight[k], "{flush:?}, not turned {straight:?}");
        }
    }
}

/// Steps larger than rounding explains are the scene's own: what they hide is hidden, and costs what rounding did.
#[test]
fn turned_ground_takes_the_receivers_and_rays_of_lifted_ground_can_fail() {
    let rough = |v: u32| 1e-3 * (f64::from(v * 7919 % 100) / 50.0 - 1.0);
    let (rough, lifted) = (work(disc, true, rough), work(disc, true, |_| 0.01));
    assert!(rough[0] > 1.2 * lifted[0], "{rough:?}, lifted {lifted:?}");
}

/// The constant coefficients of the ground and of the floor below it, over that of an open receiver: the integral of the cosine over pi, times
/// the function 1 / sqrt(4 pi). The floor is a veil that halves the light that passes it, or opaque.
fn constants(turned: bool, veil: bool, size: f64, height: f64, refine: Refine) -> Vec<f64> {
    let (disc, corners) = disc(60);
    let (mut far, triangles) = square(0.2, 0.0);
    far.iter_mut().for_each(|p| *p = dvec3(11.0, 0.0, 11.0) + dvec3(p.x, p.z + 0.2, 0.0));
    let mut scene = scene(
        vec![square(12.0, 0.0), (disc.into_iter().map(|p| size * p).collect(), corners), (far, triangles)],
        turned,
        |_| height,
    );
    if veil {
        let base_color = vec4(0.8, 0.8, 0.8, 0.5);
        scene.materials.push(Material { alpha: AlphaMode::Blend, base_color, ..Material::default() });
        scene.meshes[0].material = 1;
    }
    let settings = Settings { refine, ..fixed(2, coeff_io::Sampler::OwenSobol, 256, 0) };
    let prt: Prt = quiet(&scene, &settings);
    let turn = if turned { DQuat::from_axis_angle(dvec3(0.3, 0.5, 0.7).normalize(), -0.7) } else { DQuat::IDENTITY };
    let inner = |p: &[f32; 3]| (turn * Vec3::from_array(*p).as_dvec3()).abs().max_element() < 1.9;
    let points = prt.geometry.positions.iter().zip(prt.transfer.values.chunks_exact(4));
    points.filter(|(p, _)| inner(p)).map(|(_, row)| f64::from(row[0]) * (2.0 * TAU).sqrt()).collect()
}

#[test]
fn ground_in_the_plane_of_a_turned_floor_is_open() {
    for (turned, veil) in [(true, false), (false, false), (true, true), (false, true)] {
        let constants = constants(turned, veil, 0.1, 0.0, Refine::Off);
        assert_eq!(constants.len(), 61, "the disc alone");
        assert!(constants.iter().all(|c| (c - 1.0).abs() < 5e-3), "turned: {turned}, veil: {veil}: {constants:?}");
    }
}

/// A gap of a tenth of a millimetre, more than rounding explains, is there: no light comes to the floor below.
#[test]
fn ground_in_the_plane_of_a_turned_floor_is_open_can_fail() {
    for turned in [true, false] {
        let constants = constants(turned, false, 1.0, 1e-4, Refine::Edge(0.5));
        let (dark, open) = (constants.iter().filter(|c| **c < 0.01), constants.iter().filter(|c| **c > 0.99));
        let (dark, open) = (dark.count(), open.count());
        assert!(dark > 40 && open > 40 && dark + open == constants.len(), "{dark} dark, {open} open: {constants:?}");
    }
}
