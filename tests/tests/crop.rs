//! Around a capital of the atrium, where narrow surfaces run into each other: all receivers and places between them against the path tracer.

mod support;

use coeff_io::{Bounces, Quality, Settings};
use glam::Vec3;
use sh_math::{Bands, Rgb};
use support::{BandLight, Subject, measure};

/// The capital of a column and the arcade on it: the place that was too bright, (-3.5, 2.3, -2.72), is in the middle.
const CROP: [Vec3; 2] = [Vec3::new(-3.75, 1.9, -3.2), Vec3::new(-2.85, 2.75, -2.6)];
/// Bound of the mean difference, as a share of the mean radiance; the noise of bake and paths is most of it.
const AGREE: f64 = 0.03;
/// Noise of the paths, likewise.
const NOISE: f64 = 0.015;
/// Bands, and bounces.
const FEW: (u32, u32) = (3, 2);

fn sky() -> Rgb {
    let sky = probe_io::builtin("sky").expect("a built-in probe");
    let light = sh_math::project(Bands::new(FEW.0).expect("in range"), sky.samples());
    light.windowed(&sh_math::window::automatic(&light))
}

fn crop(rays: u32) -> Subject {
    let scene = scene::builtin("atrium").expect("a built-in scene");
    let (bands, bounces) = FEW;
    let (bounces, quality) = (Bounces::Fixed(bounces), Quality::Rays(rays));
    Subject::bake_within(scene, &Settings { bands, bounces, quality, ..bake::settings::standard() }, CROP)
}

#[test]
fn around_a_capital_all_agree() {
    let figures = measure(&crop(256), &BandLight::new(&sky()), Some(FEW.1), NOISE);
    assert!(figures.receivers > 500 && figures.moved > 5, "{figures}");
    assert!(figures.difference <= AGREE, "{figures}");
}

/// Twin: vertices inside the arcade and the shaft hold the light of the open court, as if they had been moved round an edge.
#[test]
fn around_a_capital_all_agree_can_fail() {
    let mut subject = crop(64);
    let transfer = &mut subject.prt.transfer;
    let size = (transfer.bands * transfer.bands * transfer.channels) as usize;
    let open = transfer.values.chunks(size).max_by(|a, b| a[0].total_cmp(&b[0])).expect("there are rows").to_vec();
    for spot in subject.spots.iter().filter(|spot| spot.places.len() > 1) {
        transfer.values[spot.row * size..][..size].copy_from_slice(&open);
    }
    let figures = measure(&subject, &BandLight::new(&sky()), Some(FEW.1), 2.0 * NOISE);
    assert!(figures.difference > 2.0 * AGREE, "{figures}");
}
