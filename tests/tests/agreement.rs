//! Baked transfer times light against the path tracer, under the same band-limited light.
//!
//! The tracer sees the light as a picture and walks plain paths from the receivers; the bake sees 25 numbers. The example
//! of the same name prints the figures for whole scenes.

mod support;

use coeff_io::{Bounces, Quality};
use glam::Quat;
use probe_io::{Environment, LoadOptions};
use scene::Scene;
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

fn check(name: &str, scene: Scene, light: &Rgb, bounces: Bounces, quality: Quality, count: usize) {
    let limit = match bounces {
        Bounces::Fixed(n) => Some(n),
        Bounces::Auto => None,
    };
    let subject = Subject::bake(scene, bounces, quality, count);
    let figures = measure(&subject, &BandLight::new(light), limit, AIM);
    assert!(figures.noise <= NOISE, "{name}: the reference is too noisy: {figures}");
    assert!(figures.difference <= AGREE, "{name}: bake and reference differ: {figures}");
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

/// Scenes that others made, under a photographed light.
#[test]
fn real_scenes_agree() {
    let Some(data) = testkit::data_dir() else { return testkit::skip("agreement on real scenes") };
    let probe = data.join("probes/equirect/quarry_02_1k.hdr");
    let (environment, _) = Environment::load(&probe, &LoadOptions::strict()).expect("a good probe");
    let light = windowed(&five_bands(&environment));
    // The house, with its narrow gaps, as a user would bake it.
    let standard = bake::settings::standard();
    for (name, bounces, quality) in [
        ("cornell-box/cornell_box.obj", Bounces::Fixed(1), MANY),
        ("house-lightmap-uv/house.glb", standard.bounces, standard.quality),
    ] {
        let scene = scene::load(&data.join("scenes").join(name)).expect("a good scene");
        check(name, scene, &light, bounces, quality, 24);
    }
}
