//! A white sky over grey surfaces: the answer is known for every receiver.

mod support;

use coeff_io::Sampler;
use support::{fixed, grey, quiet, under_white, worst};

const SAMPLERS: [Sampler; 3] = [Sampler::OwenSobol, Sampler::Fibonacci, Sampler::Stratified];
/// The bound that every receiver must meet.
const BOUND: f64 = 1e-3;

/// Albedo 1, light as long as it lives: nothing is lost, so radiance is 1 at every receiver of every open scene.
#[test]
fn nothing_is_lost_on_any_known_scene() {
    for (name, _) in scene::BUILTINS.iter().filter(|(name, _)| *name != "closed-room") {
        for (i, sampler) in SAMPLERS.into_iter().enumerate() {
            let bands = 1 + (i as u32 * 3 + name.len() as u32) % 8;
            let prt = quiet(&grey(name, 1.0), &fixed(bands, sampler, 64, 120));
            let (error, at) = worst(&under_white(&prt), 1.0);
            assert!(error <= BOUND, "{name}, {sampler:?}, {bands} bands: receiver {at} is off by {error}");
        }
    }
}

/// Convex bodies see nothing but sky: radiance is the albedo, whatever the number of bounces, rays or bands.
#[test]
fn convex_bodies_reflect_their_albedo() {
    for name in ["plane", "sphere", "furnace-box"] {
        for bands in 1..=8 {
            for sampler in SAMPLERS {
                let prt = quiet(&grey(name, 0.6), &fixed(bands, sampler, 16, 3));
                let (error, at) = worst(&under_white(&prt), f64::from(0.6f32));
                assert!(error <= 1e-6, "{name}, {bands} bands: receiver {at} is off by {error}");
                assert_eq!(prt.achieved.visibility_rays, 0, "{name} needs no rays");
            }
        }
    }
}

/// No light gets into a closed room.
#[test]
fn closed_room_is_black() {
    for bands in 1..=8 {
        for sampler in SAMPLERS {
            let prt = quiet(&grey("closed-room", 1.0), &fixed(bands, sampler, 64, 2));
            let largest = prt.transfer.values.iter().fold(0.0f32, |m, v| m.max(v.abs()));
            assert!(largest <= 1e-6, "{bands} bands, {sampler:?}: {largest} came in");
        }
    }
}

/// Half a sphere from inside: a (1 - f) sum (a f)^j after each number of bounces.
#[test]
fn bowl_has_its_geometric_series() {
    for (bands, sampler) in (1..=8).zip(SAMPLERS.into_iter().cycle()) {
        for bounces in [0, 1, 2, 5] {
            let scene = grey("bowl", 0.8);
            let prt = quiet(&scene, &fixed(bands, sampler, 4096, bounces));
            let values = under_white(&prt);
            let expected = scene::known::bowl_radiance(bounces);
            let (error, at) = worst(&values, expected);
            assert!(error <= BOUND, "{bands} bands, {sampler:?}, {bounces} bounces: receiver {at} is off by {error}");
        }
    }
}

/// The paper's listings drop 1/pi (G-E3): the furnace then shows 3.1416.
#[test]
fn furnace_can_fail() {
    let prt = quiet(&grey("plane", 1.0), &fixed(3, Sampler::OwenSobol, 16, 0));
    let without_pi: Vec<f64> = under_white(&prt).iter().map(|v| v * std::f64::consts::PI).collect();
    assert!(worst(&without_pi, 1.0).0 > 2.0, "a missing 1/pi must be seen");
}
