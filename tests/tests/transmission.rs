//! Blended cards and glass: bakes against the path tracer, which follows rays through them in its own way.

#[path = "support/pine.rs"]
mod pine;
mod support;

use coeff_io::{Bounces, Quality, Refine, Settings};
use pine::pine;
use scene::Scene;
use sh_math::{Bands, Rgb};
use support::{BandLight, Subject, measure};

/// Largest mean difference, as a share of the mean radiance; the noise of the path tracer is half of it.
const AGREE: f64 = 0.02;
const AIM: f64 = 0.01;

fn sky() -> Rgb {
    let sky = probe_io::builtin("sky").expect("a built-in probe");
    let light = sh_math::project(Bands::new(5).expect("in range"), sky.samples());
    light.windowed(&sh_math::window::automatic(&light))
}

/// A quarter of what is around a pine is hidden by it; without its shadow the bake is far too bright.
#[test]
fn a_pine_of_cards_agrees() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let scene = pine(folder.path());
    let light = BandLight::new(&sky());
    let (bounces, quality) = (Bounces::Fixed(1), Quality::Rays(1024));
    let settings = Settings { bounces, quality, refine: Refine::Off, ..bake::settings::standard() };
    let bake = |scene: &Scene| Subject::bake_with(scene.clone(), &settings, 60);
    let figures = measure(&bake(&scene), &light, Some(1), AIM);
    assert!(figures.difference <= AGREE, "bake and reference differ: {figures}");

    let mut clear = scene.clone();
    clear.materials[0].base_color.w = 0.0;
    let mut unshadowed = bake(&clear);
    unshadowed.scene = scene;
    let figures = measure(&unshadowed, &light, Some(1), AIM);
    assert!(figures.bias > 0.2, "a_pine_of_cards_agrees_can_fail: without its shadow {figures}");
}

/// A table of three panes that blend and transmit, from a file that others made.
#[test]
fn a_glass_table_agrees() {
    let Some(data) = testkit::data_dir() else { return testkit::skip("the glass table") };
    let mut scene = scene::load(&data.join("scenes/glass-table/glass-table.glb")).expect("a good scene");
    // Reflections have tests of their own, and take most of the time.
    scene.materials.iter_mut().for_each(|m| (m.metallic, m.roughness) = (0.0, 1.0));
    let subject = Subject::bake(scene, Bounces::Fixed(0), Quality::Rays(512), 30);
    let figures = measure(&subject, &BandLight::new(&sky()), Some(0), AIM);
    assert!(figures.difference <= AGREE, "bake and reference differ: {figures}");
}
