//! Projection and reconstruction: the two lights of the first paper, Monte Carlo, and what a light is worth.

use glam::{DVec3, Vec3};
use sh_math::{Bands, Rgb, evaluate, project, project_scalar};
use std::f64::consts::PI;
use testkit::assert_close;
use testkit::quadrature::sphere_quadrature;

/// Exact coefficients of [`two_lights`] to five digits, three bands, no Condon-Shortley phase.
const KNOWN: [f64; 9] = [0.39880, 0.21052, 0.28653, -0.28182, -0.31499, 0.0, 0.13138, 0.0, 0.09318];

fn bands(count: u32) -> Bands {
    Bands::new(count).expect("in range")
}

/// `max(0, 5 cos theta - 4) + max(0, -4 sin(theta - pi) cos(phi - 2.5) - 3)`, z the axis of theta.
fn two_lights(direction: DVec3) -> f64 {
    let (theta, phi) = (libm::acos(direction.z), libm::atan2(direction.y, direction.x));
    let above = 5.0 * libm::cos(theta) - 4.0;
    let beside = -4.0 * libm::sin(theta - PI) * libm::cos(phi - 2.5) - 3.0;
    above.max(0.0) + beside.max(0.0)
}

#[test]
fn two_lights_have_the_known_coefficients() {
    let samples = sphere_quadrature(800).into_iter().map(|(d, weight)| {
        let direction = DVec3::from_array(d);
        (direction, weight * two_lights(direction))
    });
    for (i, (value, known)) in project_scalar(bands(3), samples).iter().zip(KNOWN).enumerate() {
        assert_close!(*value, known, 1.5e-5, 0.0, "coefficient {i}");
    }
}

/// The paper's own way: 100 x 100 jittered samples, each worth `4 pi / N`.
#[test]
fn monte_carlo_lands_close() {
    let mut state = 1_u64;
    let mut random = || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 11) as f64 / (1_u64 << 53) as f64
    };
    let samples: Vec<(DVec3, f64)> = (0..10_000)
        .map(|i| {
            let (a, b) = ((f64::from(i / 100) + random()) / 100.0, (f64::from(i % 100) + random()) / 100.0);
            let (z, phi) = (1.0 - 2.0 * a, 2.0 * PI * b);
            let radius = (1.0 - z * z).sqrt();
            let direction = DVec3::new(radius * libm::cos(phi), radius * libm::sin(phi), z);
            (direction, two_lights(direction) * 4.0 * PI / 10_000.0)
        })
        .collect();
    let distance = |weight: f64| {
        let own = samples.iter().map(|&(direction, value)| (direction, weight * value));
        let errors = project_scalar(bands(3), own).into_iter().zip(KNOWN).map(|(a, b)| (a - b).abs());
        errors.fold(0.0, f64::max)
    };
    assert!(distance(1.0) < 3e-3, "10,000 samples land {:e} off", distance(1.0));
    assert!(distance(0.5) > 0.1, "half the weight must be seen");
}

#[test]
fn colours_project_like_scalars() {
    let samples = || sphere_quadrature(20).into_iter().map(|(d, weight)| (DVec3::from_array(d), weight));
    let scalar = project_scalar(bands(6), samples().map(|(d, w)| (d, w * (1.0 + d.x * d.y))));
    let rgb = project(bands(6), samples().map(|(d, w)| (d, [1.0, 2.0, 0.0].map(|c| c * w * (1.0 + d.x * d.y)))));
    for (rgb, scalar) in rgb.values.iter().zip(scalar) {
        // one rounding to f32
        assert_close!(rgb[0], scalar, 1e-12, 6e-8);
        assert_close!(rgb[1], 2.0 * scalar, 1e-12, 6e-8);
        assert_eq!(rgb[2], 0.0, "black stays black");
    }
}

/// A function of degree 3 comes back exactly from 4 bands, and not from 3.
#[test]
fn polynomials_come_back() {
    let polynomial = |d: DVec3| 1.0 + d.x * d.y * d.z - 0.5 * d.z;
    let samples = sphere_quadrature(8).into_iter().map(|(d, weight)| {
        let direction = DVec3::from_array(d);
        (direction, [weight * polynomial(direction); 3])
    });
    let light = project(bands(4), samples);
    let direction = Vec3::new(2.0, 3.0, 6.0) / 7.0;
    let expected = polynomial(direction.as_dvec3());
    assert_close!(light.reconstruct(direction)[1], expected, 1e-6, 0.0);
    let short = light.truncated(bands(3));
    assert_eq!(short.values.len(), 9, "three bands hold nine coefficients");
    assert!((f64::from(short.reconstruct(direction)[1]) - expected).abs() > 0.05, "the cubic part must be missed");
    assert_eq!(light.truncated(bands(9)), light, "there is nothing to add");
}

/// G5: each band brings the reconstruction closer, as Parseval says it must.
#[test]
fn more_bands_come_closer() {
    let rule = sphere_quadrature(60);
    let samples = rule.iter().map(|&(d, weight)| {
        let direction = DVec3::from_array(d);
        (direction, [weight * two_lights(direction); 3])
    });
    let light = project(bands(12), samples);
    let error = |light: &Rgb| -> f64 {
        let at = |&(d, weight): &([f64; 3], f64)| {
            let direction = DVec3::from_array(d);
            weight * (f64::from(light.reconstruct(direction.as_vec3())[0]) - two_lights(direction)).powi(2)
        };
        rule.iter().map(at).sum::<f64>().sqrt()
    };
    let errors: Vec<f64> = (1..=12).map(|n| error(&light.truncated(bands(n)))).collect();
    assert!(errors.windows(2).all(|pair| pair[1] <= pair[0] + 1e-6), "errors must fall: {errors:?}");
    assert!(errors[11] < 0.1 * errors[0], "twelve bands are far closer than one: {errors:?}");
}

#[test]
fn black_reconstructs_to_black() {
    assert_eq!(Rgb::black(bands(5)).reconstruct(Vec3::Y), [0.0; 3], "no light is no light");
}

#[test]
fn windows_scale_bands() {
    let mut values = vec![0.0; 9];
    evaluate(bands(3), Vec3::Y, &mut values);
    let light = Rgb { bands: bands(3), values: values.iter().map(|&v| [v; 3]).collect() };
    let windowed = light.windowed(&[1.0, 0.5]);
    assert_eq!(windowed.values[0], light.values[0], "the first band keeps its value");
    assert_eq!(windowed.values[1][0], 0.5 * light.values[1][0], "the second is halved");
    assert!(windowed.values[4..].iter().all(|&value| value == [0.0; 3]), "bands beyond the window vanish");
}
