//! Texels cover the sphere exactly and lie where look-ups find them, in every layout.

use glam::DVec3;
use probe_io::{Layout, Probe};
use std::f64::consts::{PI, TAU};

/// A probe whose pixels name their own index.
fn numbered(layout: Layout, unit: usize) -> Probe {
    let (columns, rows) = layout.tiles().unwrap_or((2, 1));
    let (width, height) = (columns * unit, rows * unit);
    let pixels = (0..width * height).map(|i| [i as f32, 0.0, 1.0]).collect();
    Probe { layout, width, height, pixels }
}

fn layouts() -> impl Iterator<Item = Layout> {
    Layout::NAMES.iter().map(|(_, layout)| *layout)
}

/// The angular map's rim is integrated numerically; every other layout is a closed form.
fn sum_tolerance(layout: Layout) -> f64 {
    if layout == Layout::Angular { 1e-7 } else { 1e-11 }
}

fn sum_of_solid_angles(probe: &Probe) -> f64 {
    probe.texels().map(|t| t.solid_angle).sum()
}

#[test]
fn solid_angles_sum_to_the_sphere() {
    for layout in layouts() {
        for unit in [1, 2, 3, 4, 7, 16, 64] {
            let sum = sum_of_solid_angles(&numbered(layout, unit));
            let error = (sum / (4.0 * PI) - 1.0).abs();
            assert!(error < sum_tolerance(layout), "{layout} of {unit}: off by {error:e}");
        }
    }
}

#[test]
fn solid_angles_sum_to_the_sphere_can_fail() {
    // The centre rule that the angular map's formula invites: sin(pi r) pi / r du dv, cut at the rim.
    let n = 16;
    let sum: f64 = (0..n * n)
        .map(|i| {
            let u = (2.0 * (i % n) as f64 + 1.0) / n as f64 - 1.0;
            let v = (2.0 * (i / n) as f64 + 1.0) / n as f64 - 1.0;
            let r = u.hypot(v);
            if r > 1.0 { 0.0 } else { (PI * r).sin() * PI / r * 4.0 / (n * n) as f64 }
        })
        .sum();
    assert!((sum / (4.0 * PI) - 1.0).abs() > sum_tolerance(Layout::Angular));
}

/// Solid angle of a set of directions by counting points of a Fibonacci lattice, with the texel that each hits.
fn counted(probe: &Probe, points: usize) -> Vec<f64> {
    let mut area = vec![0.0; probe.pixels.len()];
    let golden = (1.0 + 5f64.sqrt()) / 2.0;
    for i in 0..points {
        let z = 1.0 - (2.0 * i as f64 + 1.0) / points as f64;
        let phi = TAU * (i as f64 / golden).fract();
        let s = (1.0 - z * z).sqrt();
        let d = DVec3::new(s * phi.cos(), z, s * phi.sin());
        area[probe.texel_index(d.as_vec3())] += 4.0 * PI / points as f64;
    }
    area
}

#[test]
fn each_solid_angle_equals_the_share_of_directions_that_hit_the_texel() {
    for layout in layouts() {
        // Small enough that every texel has hundreds of points; angular rims lend their area inwards.
        let unit = 8;
        let probe = numbered(layout, unit);
        let points = 400_000;
        let counts = counted(&probe, points);
        let mut own = vec![0.0; counts.len()];
        for texel in probe.texels() {
            own[texel.radiance[0] as usize] += texel.solid_angle;
        }
        for (i, (a, b)) in counts.iter().zip(&own).enumerate() {
            // 5 sigma of independent points; a lattice does better.
            let sigma = (4.0 * PI * b / points as f64).sqrt();
            assert!((a - b).abs() < 5.0 * sigma + 1e-5, "{layout} pixel {i}: {a} against {b}");
        }
    }
}

#[test]
fn texel_centres_look_themselves_up() {
    for layout in layouts() {
        for unit in [4, 5, 32] {
            let probe = numbered(layout, unit);
            for (n, texel) in probe.texels().enumerate() {
                assert!((texel.direction.length() - 1.0).abs() < 1e-12);
                let seen = probe.texel_radiance(texel.direction.as_vec3());
                // Texels on the cube's edges of OpenEXR's strip, and rims, share their direction with others.
                let shared = layout == Layout::ExrCube || layout == Layout::Angular;
                if !shared {
                    assert_eq!(seen[0], texel.radiance[0], "{layout} {unit}: texel {n}");
                }
            }
        }
    }
}

/// The light's steepest slope (1.32 a radian) over a pixel: 1/64 of a face's 90 degrees at its widest (1/32
/// radian), or, on the rim of the angular map, a pixel of 2 pi / 64 with no neighbour to blend with.
fn jump_tolerance(layout: Layout) -> f64 {
    let pixel = if layout == Layout::Angular { TAU / 64.0 } else { 2.0 / 64.0 };
    1.32 * pixel
}

#[test]
fn bilinear_lookup_of_a_smooth_light_is_close_everywhere() {
    // Poles, edges and corners of cubes, the rim and the seam: a jump there would show as an error of order 1.
    let light = |d: DVec3| 2.0 + d.x + 0.5 * d.y - 0.7 * d.z;
    for layout in layouts() {
        let mut probe = numbered(layout, 64);
        let texels: Vec<_> = probe.texels().collect();
        for texel in texels {
            let value = light(texel.direction) as f32;
            probe.pixels[texel.radiance[0] as usize] = [value; 3];
        }
        for i in 0..20_000 {
            let z = 1.0 - (2.0 * i as f64 + 1.0) / 20_000.0;
            let phi = i as f64 * 2.399_963;
            let s = (1.0 - z * z).sqrt();
            let d = DVec3::new(s * phi.cos(), s * phi.sin(), z);
            let error = (f64::from(probe.radiance(d.as_vec3())[0]) - light(d)).abs();
            assert!(error < jump_tolerance(layout), "{layout} at {d}: off by {error}");
        }
        for d in [DVec3::X, DVec3::Y, DVec3::Z, -DVec3::X, -DVec3::Y, -DVec3::Z] {
            let error = (f64::from(probe.radiance(d.as_vec3())[0]) - light(d)).abs();
            assert!(error < jump_tolerance(layout), "{layout} at {d}: off by {error}");
        }
    }
}
