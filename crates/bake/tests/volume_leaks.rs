//! Light that a volume carries through walls.

mod support;

use bake::VolumeSettings;
use coeff_io::{Sampler, Volume};
use glam::Vec3;
use support::fixed;
use support::volume::{Rule, bake_volume, boxed, irradiance, normals, white};

/// Distance of probes: ten times the wall's thickness of 1/16 m.
const STEP: f32 = 0.625;

/// A volume over both rooms whose probes start at an x.
fn two_rooms(x: f32, resolution: u32, levels: u32) -> Volume {
    let scene = scene::builtin("two-rooms").expect("builtin");
    let low = Vec3::new(x, 0.05, -0.95);
    let grid = boxed(low, low + STEP * Vec3::new(6.0, 3.0, 3.0), [7, 4, 4]);
    bake_volume(&scene, &fixed(3, Sampler::OwenSobol, 256, 2), &VolumeSettings { resolution, levels, ..grid })
}

/// Most that points of the sealed room take, at least `gap` metres from its walls, over the mean in the open room; white sky.
fn leak(volume: &Volume, rule: Rule, gap: f32) -> f64 {
    let sealed = [Vec3::new(-2.03125, 0.0, -1.0) + gap, Vec3::new(-0.03125, 2.0, 1.0) - gap];
    let open = [Vec3::new(0.1, 0.1, -0.9), Vec3::new(1.9, 1.9, 0.9)];
    let values = |room| points(room).flat_map(|p| normals().map(move |n| irradiance(volume, p, n, &white(3), rule)[0]));
    let usual = values(open).sum::<f64>() / values(open).count() as f64;
    assert!(usual > 0.2, "the open room is lit: {usual}");
    values(sealed).fold(0.0, f64::max) / usual
}

/// 8 x 8 x 8 points of a box.
fn points([low, high]: [Vec3; 2]) -> impl Iterator<Item = Vec3> {
    (0..512).map(move |i| low + (high - low) * glam::vec3((i % 8) as f32, (i / 8 % 8) as f32, (i / 64) as f32) / 7.0)
}

/// Where the probes stand to the wall: it runs between two, nearer to those of the dark, or through some.
const STARTS: [f32; 3] = [-2.0, -2.2, -1.875];

#[test]
fn a_thin_wall_keeps_light_out() {
    for x in STARTS {
        let volume = two_rooms(x, 16, 0);
        let [seen, place] = [Rule::Visible, Rule::Trilinear].map(|rule| leak(&volume, rule, 0.1));
        println!("from {x}, 0.1 m from the walls: {seen:.5} of the open room; by place alone {place:.3}");
    }
}
