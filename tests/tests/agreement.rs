//! Baked transfer times light against the path tracer, under the same band-limited light.
//!
//! The tracer sees the light as a picture and walks plain paths from the receivers; the bake sees 25 numbers. The example
//! of the same name prints the figures for whole scenes.

mod support;

use coeff_io::{Bounces, Quality};
use glam::{Quat, Vec3, Vec4};
use probe_io::{Environment, LoadOptions};
use scene::{Material, Mesh, Scene};
use sh_math::{Bands, Rgb};
use support::{BandLight, Subject, measure};

/// Largest mean difference, as a share of the mean radiance.
const AGREE: f64 = 0.015;
/// Noise of the path tracer at which that is asked.
const NOISE: f64 = 0.005;
/// Aimed at, so that the noise reached stays below [`NOISE`].
const AIM: f64 = 0.0045;

/// Five bands of a light.
fn five_bands(environment: &Environment) -> Rgb {
    sh_math::project(Bands::new(5).expect("in range"), environment.samples())
}

/// The same without negative parts: nothing cancels, and the tracer needs a tenth of the paths.
fn windowed(light: &Rgb) -> Rgb {
    light.windowed(&sh_math::window::automatic(light))
}

fn sky() -> Rgb {
    five_bands(&probe_io::builtin("sky").expect("a built-in probe"))
}

/// What the quick checks trace.
const MANY: Quality = Quality::Rays(2048);
/// What the check of a light with negative parts traces: they cancel, so that the bake's own noise weighs more (1.8 % of 16 receivers at
/// 2,048 rays).
const FINE: Quality = Quality::Rays(16_384);

fn cornell_box() -> Scene {
    scene::builtin("cornell-box").expect("a built-in scene")
}

/// Bound of a house full of clutter (panes set into frames, stones run into each other), where one receiver of 24 that is wrong decides. The
/// receiver in the middle keeps [`AGREE`].
const CLUTTER: f64 = 0.03;

fn check(name: &str, scene: Scene, light: &Rgb, bounces: Bounces, quality: Quality, count: usize) {
    check_within([AGREE; 2], name, scene, light, bounces, quality, count);
}

/// [`check`] with bounds of the median, over receivers, and of the difference.
fn check_within(
    [median, difference]: [f64; 2],
    name: &str,
    scene: Scene,
    light: &Rgb,
    bounces: Bounces,
    quality: Quality,
    count: usize,
) {
    let limit = match bounces {
        Bounces::Fixed(n) => Some(n),
        Bounces::Auto => None,
    };
    let subject = Subject::bake(scene, bounces, quality, count);
    let figures = measure(&subject, &BandLight::new(light), limit, AIM);
    assert!(figures.noise <= NOISE, "{name}: the reference is too noisy: {figures}");
    assert!(figures.difference <= difference, "{name}: bake and reference differ: {figures}");
    assert!(median >= difference || figures.relative[0] <= median, "{name}: most receivers differ: {figures}");
}

#[test]
fn direct_light_agrees() {
    check("direct", cornell_box(), &sky(), Bounces::Fixed(0), FINE, 16);
}

#[test]
fn one_bounce_agrees() {
    check("one bounce", cornell_box(), &windowed(&sky()), Bounces::Fixed(1), MANY, 40);
}

#[test]
fn all_bounces_agree() {
    check("all bounces", cornell_box(), &windowed(&sky()), Bounces::Auto, MANY, 40);
}

#[test]
fn all_bounces_agree_can_fail() {
    let light = BandLight::new(&windowed(&sky()));
    let direct = Subject::bake(cornell_box(), Bounces::Fixed(0), Quality::Rays(512), 40);
    let missing = measure(&direct, &light, None, 0.02);
    assert!(missing.difference > 10.0 * AGREE, "bounces are not missed: {missing}");
    let behind = light.coefficients.rotated(Quat::from_rotation_y(std::f32::consts::PI));
    let turned = BandLight { picture: BandLight::new(&behind).picture, ..light };
    let elsewhere = measure(&direct, &turned, Some(0), 0.02);
    assert!(elsewhere.difference > 10.0 * AGREE, "light from the other side is not noticed: {elsewhere}");
}

/// The faces of a block, each of so many cells along x, y and z.
fn block(low: Vec3, high: Vec3, cells: [u32; 3]) -> Mesh {
    let mut mesh = Mesh::default();
    for (axis, front) in [0, 1, 2].into_iter().flat_map(|axis| [(axis, true), (axis, false)]) {
        let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
        let first = mesh.positions.len() as u32;
        let [columns, rows] = [cells[u], cells[v]];
        for (i, j) in (0..=rows).flat_map(|j| (0..=columns).map(move |i| (i, j))) {
            let mut share = [if front { 1.0 } else { 0.0 }; 3];
            (share[u], share[v]) = (i as f32 / columns as f32, j as f32 / rows as f32);
            mesh.positions.push(low + (high - low) * Vec3::from(share));
            mesh.normals.push(Vec3::AXES[axis] * if front { 1.0 } else { -1.0 });
        }
        for a in (0..columns * rows).map(|k| first + k % columns + k / columns * (columns + 1)) {
            let (b, c, d) = (a + 1, a + columns + 2, a + columns + 1);
            mesh.triangles.extend(if front { [[a, b, c], [a, c, d]] } else { [[a, c, b], [a, d, c]] });
        }
    }
    mesh
}

/// A post sunk into a slab, and two plates inside the slab which see each other's fronts and nothing else.
fn sunk() -> Scene {
    let meshes = vec![
        block(Vec3::new(-1.0, -0.5, -1.0), Vec3::new(1.0, 0.0, 1.0), [8, 2, 8]),
        block(Vec3::new(-0.2, -0.1, -0.2), Vec3::new(0.2, 0.6, 0.2), [4, 7, 4]),
        block(Vec3::new(0.4, -0.3, 0.4), Vec3::new(0.8, -0.29, 0.8), [4, 1, 4]),
        block(Vec3::new(0.4, -0.27, 0.4), Vec3::new(0.8, -0.26, 0.8), [4, 1, 4]),
    ];
    let grey = Material { base_color: Vec4::new(0.5, 0.5, 0.5, 1.0), ..Material::default() };
    Scene { meshes, materials: vec![grey], ..Scene::default() }
}

/// Vertices inside a body hold what their surface is like where it shows, and those inside and out of sight are left out.
#[test]
fn what_shows_of_sunk_blocks_agrees() {
    let mut subject = Subject::bake(sunk(), Bounces::Fixed(1), MANY, 3000);
    subject.spots.retain(|spot| spot.places.len() > 1);
    assert!(subject.moved >= 30, "rows inside bodies are compared: {}", subject.moved);
    assert!(subject.buried >= 10, "rows of the plates show nowhere: {}", subject.buried);
    let figures = measure(&subject, &BandLight::new(&windowed(&sky())), Some(1), AIM);
    assert!(figures.difference <= AGREE, "{figures}");
}

/// With rows inside bodies as if they stood in the open.
#[test]
fn what_shows_of_sunk_blocks_agrees_can_fail() {
    let mut subject = Subject::bake(sunk(), Bounces::Fixed(1), Quality::Rays(512), 1000);
    subject.spots.retain(|spot| spot.places.len() > 1);
    let transfer = &mut subject.prt.transfer;
    let size = (transfer.bands * transfer.bands * transfer.channels) as usize;
    let open = transfer.values.chunks(size).max_by(|a, b| a[0].total_cmp(&b[0])).expect("there are rows").to_vec();
    for spot in &subject.spots {
        transfer.values[spot.row * size..][..size].copy_from_slice(&open);
    }
    let figures = measure(&subject, &BandLight::new(&windowed(&sky())), Some(1), 0.02);
    assert!(figures.difference > 2.0 * AGREE, "rows that were wrongly moved are not noticed: {figures}");
}

/// Scenes that others made, under a photographed light.
#[test]
fn real_scenes_agree() {
    let Some(data) = testkit::data_dir() else { return testkit::skip("agreement on real scenes") };
    let probe = data.join("probes/equirect/quarry_02_1k.hdr");
    let (environment, _) = Environment::load(&probe, &LoadOptions::strict()).expect("a good probe");
    let light = windowed(&five_bands(&environment));
    let load = |name: &str| scene::load(&data.join("scenes").join(name)).expect("a good scene");
    let name = "cornell-box/cornell_box.obj";
    check(name, load(name), &light, Bounces::Fixed(1), MANY, 24);
    // The house, with its narrow gaps, as a user would bake it.
    let (name, standard) = ("house-lightmap-uv/house.glb", bake::settings::standard());
    check_within([AGREE, CLUTTER], name, load(name), &light, standard.bounces, standard.quality, 24);
}
