//! Analytic lights and projections against closed forms and printed numbers.

use glam::Vec3;
use probe_io::reflection::Reflection;
use probe_io::{BUILTINS, Environment, Layout, Probe, builtin};
use sh_math::{Bands, Rgb, index};
use std::f64::consts::PI;

fn coefficients(environment: &Environment, bands: u32) -> Rgb {
    sh_math::project(Bands::new(bands).unwrap(), environment.samples())
}

/// The first nine coefficients of the two-light function by exact quadrature, without the sign convention.
const TWO_LIGHTS: [f64; 9] = [0.39880, 0.21052, 0.28653, -0.28182, -0.31499, 0.0, 0.13138, 0.0, 0.09318];

/// The numbers have five digits; the picture's pixels average the function over a degree.
const PRINTED: f64 = 5e-5;

#[test]
fn two_lights_give_the_printed_coefficients() {
    let light = coefficients(&builtin("two-lights").unwrap(), 3);
    for (i, expected) in TWO_LIGHTS.iter().enumerate() {
        for c in 0..3 {
            let value = f64::from(light.values[i][c]);
            assert!((value - expected).abs() < PRINTED, "{i}: {value} is not {expected}");
        }
    }
}

#[test]
fn two_lights_give_the_printed_coefficients_can_fail() {
    let mut environment = builtin("two-lights").unwrap();
    let width = environment.image.width;
    for line in environment.image.pixels.chunks_exact_mut(width) {
        line.reverse();
    }
    let light = coefficients(&environment, 3);
    let worst = (0..9).map(|i| (f64::from(light.values[i][0]) - TWO_LIGHTS[i]).abs()).fold(0.0, f64::max);
    assert!(worst > 100.0 * PRINTED);
}

#[test]
fn a_constant_has_one_coefficient_in_any_band() {
    let light = coefficients(&Environment::constant([1.0, 2.0, 0.5]), 8);
    for (i, value) in light.values.iter().enumerate() {
        for (c, radiance) in [1.0, 2.0, 0.5].into_iter().enumerate() {
            let expected = if i == 0 { radiance * (4.0 * PI).sqrt() } else { 0.0 };
            assert!((f64::from(value[c]) - expected).abs() < 2e-4, "{i}: {value:?}");
        }
    }
}

#[test]
fn one_pixel_projects_as_a_constant() {
    for (_, layout) in Layout::NAMES {
        let (width, height) = layout.tiles().unwrap_or((1, 1));
        let image = Probe { layout, width, height, pixels: vec![[3.0; 3]; width * height] };
        let light = coefficients(&Environment::from_image("pixel", image), 8);
        for (i, value) in light.values.iter().enumerate() {
            let expected = if i == 0 { 3.0 * (4.0 * PI).sqrt() } else { 0.0 };
            assert!((f64::from(value[1]) - expected).abs() < 6e-4, "{layout} {i}: {value:?}");
        }
    }
}

/// Projection of a disc of radiance 1 around an axis: `2 pi integral of P_l over [cos a, 1]` times `Y_lm(axis)`.
fn disc(l: usize, half_angle: f64) -> f64 {
    let (low, high) = (half_angle.cos(), 1.0);
    let legendre = |x: f64| {
        let (mut a, mut b) = (1.0, x);
        for k in 1..=l {
            (a, b) = (b, ((2 * k + 1) as f64 * x * b - k as f64 * a) / (k + 1) as f64);
        }
        a
    };
    let nodes = testkit::quadrature::gauss_legendre(20);
    let at = |t: f64| 0.5 * (low + high) + 0.5 * (high - low) * t;
    let sum: f64 = nodes.iter().map(|(t, w)| w * legendre(at(*t))).sum();
    2.0 * PI * sum * 0.5 * (high - low)
}

#[test]
fn lamps_project_as_discs_do() {
    for (name, degrees) in [("cone", 20.0f64), ("cone:60,30,-100", 60.0), ("sphere:2", 30.0), ("cone:0.27", 0.27)] {
        let environment = builtin(name).unwrap();
        let lamp = environment.lamps[0];
        let angle = degrees.to_radians();
        assert!((f64::from(lamp.half_angle) - angle).abs() < 1e-6, "{name}");
        // Irradiance pi is radiance 1 / sin^2.
        let radiance = 1.0 / angle.sin().powi(2);
        assert!((f64::from(lamp.radiance()[0]) / radiance - 1.0).abs() < 1e-5);
        let bands = Bands::new(6).unwrap();
        let mut basis = vec![0.0; bands.coefficients()];
        sh_math::evaluate_f64(bands, lamp.direction.as_dvec3(), &mut basis);
        let light = coefficients(&environment, 6);
        for l in 0..6usize {
            for m in -(l as isize)..=l as isize {
                let i = index(l, m);
                let expected = radiance * disc(l, angle) * basis[i];
                let error = (f64::from(light.values[i][1]) - expected).abs();
                assert!(
                    error < 1e-5 * PI * radiance.max(1.0).sqrt(),
                    "{name} {l} {m}: {} is not {expected}",
                    light.values[i][1]
                );
            }
        }
    }
}

#[test]
fn a_directional_light_projects_to_its_irradiance_times_the_basis() {
    let environment = builtin("directional:30,90").unwrap();
    let lamp = environment.lamps[0];
    assert!((lamp.direction - Vec3::new(0.75f32.sqrt(), 0.5, 0.0)).length() < 1e-6);
    let bands = Bands::new(4).unwrap();
    let mut basis = vec![0.0; bands.coefficients()];
    sh_math::evaluate_f64(bands, lamp.direction.as_dvec3(), &mut basis);
    for (value, y) in coefficients(&environment, 4).values.iter().zip(basis) {
        assert!((f64::from(value[2]) - PI * y).abs() < 1e-5);
    }
    assert_eq!(environment.radiance(lamp.direction), [0.0; 3]);
}

#[test]
fn a_hemisphere_projects_to_half_of_everything_odd() {
    let light = coefficients(&builtin("hemisphere").unwrap(), 3);
    // 2 pi Y00 and 2 pi sqrt(3 / 4 pi) / 2 on y.
    let expected = [(0, PI.sqrt()), (1, PI * (3.0 / (4.0 * PI)).sqrt()), (2, 0.0), (6, 0.0)];
    for (i, value) in expected {
        assert!((f64::from(light.values[i][0]) - value).abs() < 1e-3, "{i}: {:?}", light.values[i]);
    }
}

#[test]
fn every_builtin_is_finite_light_and_nonsense_is_none() {
    for (name, _) in BUILTINS {
        let bare = name.split('[').next().unwrap();
        let environment = builtin(bare).unwrap_or_else(|| panic!("{bare}"));
        assert_eq!(environment.name, format!("builtin:{bare}"));
        assert!(environment.image.pixels.iter().flatten().all(|v| v.is_finite() && *v >= 0.0));
        assert!(environment.lamps.iter().all(|l| (l.direction.length() - 1.0).abs() < 1e-5));
        let again = builtin(&format!("builtin:{bare}")).unwrap();
        assert_eq!(again.image.pixels, environment.image.pixels);
    }
    for bad in
        ["", "nosuch", "sky:0", "sky:91", "sky:x", "sky:1,2,3", "cone:91", "sphere:0.5", "constant:-1", "white:2"]
    {
        assert!(builtin(bad).is_none(), "{bad}");
    }
}

#[test]
fn the_sky_is_blue_above_and_its_sun_reddens_as_it_sinks() {
    let high = builtin("sky:50").unwrap();
    let low = builtin("sky:3").unwrap();
    let zenith = high.image.radiance(Vec3::Y);
    assert!(zenith[2] > 1.5 * zenith[0], "{zenith:?}");
    let red = |e: &Environment| e.lamps[0].irradiance[0] / e.lamps[0].irradiance[2];
    assert!(red(&low) > 2.0 * red(&high));
    // Clear days: the sky gives a tenth to a third of the light that falls on flat ground.
    let flat = |samples: &mut dyn Iterator<Item = (glam::DVec3, [f64; 3])>| -> f64 {
        samples.map(|(d, v)| d.y.max(0.0) * v[1]).sum()
    };
    let all = flat(&mut high.samples());
    let sun = f64::from(high.lamps[0].irradiance[1] * high.lamps[0].direction.y);
    let share = (all - sun) / all;
    assert!(share > 0.1 && share < 0.34, "{share}");
}

/// Blurring a constant is the constant, and no level loses a lamp's light.
#[test]
fn reflections_keep_constants_and_flux() {
    let white = Reflection::build(&Environment::constant([1.0, 2.0, 3.0]), 5, 64);
    for level in &white.levels {
        for pixel in level {
            for (value, expected) in pixel.iter().zip([1.0, 2.0, 3.0]) {
                assert!((value / expected - 1.0f32).abs() < 1e-5);
            }
        }
    }
    let mut sun = builtin("cone:0.3,40,10").unwrap();
    sun.lamps[0].irradiance = [1.0; 3];
    let mirrored = Reflection::build(&sun, 5, 128);
    for (k, level) in mirrored.levels.iter().enumerate() {
        let probe =
            Probe { layout: Layout::Equirect, width: mirrored.width, height: mirrored.height, pixels: level.clone() };
        let flux: f64 = probe.texels().map(|t| f64::from(t.radiance[0]) * t.solid_angle).sum();
        assert!((flux - 1.0).abs() < 0.05, "level {k}: {flux}");
    }
}

/// The roughest level in the direction n against the integral of the lobe over the same light, done elsewhere.
#[test]
fn the_roughest_reflection_is_the_lobe_integral() {
    let light = |d: glam::DVec3| [1.0 + d.x + 2.0 * d.y * d.y, 1.0, 1.0];
    let environment = Environment::from_function("smooth", 64, light);
    let mirrored = Reflection::build(&environment, 3, 64);
    let rule = testkit::quadrature::sphere_quadrature(96);
    for n in [Vec3::Y, Vec3::X, Vec3::new(0.6, -0.48, 0.64)] {
        // alpha = 1: D is constant, so the lobe is cos t.
        let (mut sum, mut total) = (0.0, 0.0);
        for (d, w) in &rule {
            let d = glam::DVec3::from_array(*d);
            let weight = w * d.dot(n.as_dvec3()).max(0.0);
            sum += weight * light(d)[0];
            total += weight;
        }
        let value = f64::from(mirrored.sample(n, 1.0)[0]);
        assert!((value / (sum / total) - 1.0).abs() < 0.01, "{n}: {value} is not {}", sum / total);
    }
}
