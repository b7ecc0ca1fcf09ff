//! Zonal factors and the unshadowed transfer against quadrature.

use glam::{DVec3, Vec3};
use sh_math::{Bands, project_scalar, zonal};
use std::f64::consts::PI;
use testkit::assert_close;
use testkit::quadrature::{gauss_legendre, sphere_quadrature};

fn legendre(l: usize, z: f64) -> f64 {
    let (mut before, mut value) = (0.0, 1.0);
    for k in 1..=l {
        let k = k as f64;
        (before, value) = (value, ((2.0 * k - 1.0) * z * value - (k - 1.0) * before) / k);
    }
    value
}

/// `int_low^1 f(z) P_l(z) dz`.
fn against_legendre(low: f64, l: usize, f: impl Fn(f64) -> f64) -> f64 {
    let scale = 0.5 * (1.0 - low);
    let point = |(node, weight): (f64, f64)| {
        let z = low + scale * (node + 1.0);
        scale * weight * f(z) * legendre(l, z)
    };
    gauss_legendre(64).into_iter().map(point).sum()
}

#[test]
fn clamped_cosine_equals_quadrature() {
    for l in 0..40 {
        assert_close!(zonal::clamped_cosine(l), 2.0 * against_legendre(0.0, l, |z| z), 1e-14, 0.0, "degree {l}");
    }
}

#[test]
fn clamped_cosine_has_the_known_values() {
    let known = [1.0, 2.0 / 3.0, 0.25, 0.0, -1.0 / 24.0, 0.0, 1.0 / 64.0, 0.0, -1.0 / 128.0];
    for (l, value) in known.into_iter().enumerate() {
        assert_close!(zonal::clamped_cosine(l), value, 1e-16, 0.0, "degree {l}");
    }
}

/// G-E2: without `max(0, .)` only the second band is left, and a white sky lights nothing.
#[test]
fn unclamped_cosine_can_fail() {
    // zonal coefficients of the lobe / pi at albedo 1, as sqrt((2l+1)/(4 pi)) a_l
    let coefficient = |l: usize, a: f64| ((2 * l + 1) as f64 / (4.0 * PI)).sqrt() * a;
    let clamped = [0.2821, 0.3257, 0.1577, 0.0, -0.0352];
    let unclamped = [0.0, 0.6515, 0.0, 0.0, 0.0];
    // four digits, the last one cut off and not rounded
    for l in 0..5 {
        assert_close!(coefficient(l, zonal::clamped_cosine(l)), clamped[l], 1e-4, 0.0, "degree {l}");
        let without = 2.0 * against_legendre(-1.0, l, |z| z);
        assert_close!(coefficient(l, without), unclamped[l], 1e-4, 0.0, "degree {l}");
    }
}

#[test]
fn phong_equals_quadrature() {
    for exponent in [0.0, 1.0, 2.0, 5.0, 10.0, 40.0] {
        for l in 0..20 {
            let expected = (exponent + 1.0) * against_legendre(0.0, l, |z| z.powf(exponent));
            assert_close!(zonal::phong(exponent, l), expected, 1e-13, 0.0, "exponent {exponent}, degree {l}");
        }
    }
}

/// A sharp lobe leaves a function as it is; the factor sqrt(4 pi / (2l+1)) put on top would not.
#[test]
fn phong_of_high_exponent_is_one() {
    for l in 0..6 {
        assert_close!(zonal::phong(1e6, l), 1.0, 1e-4, 0.0, "degree {l}");
    }
    let twice = zonal::phong(1e6, 3) * (4.0 * PI / 7.0).sqrt();
    assert!((twice - 1.0).abs() > 0.1, "the doubled normalisation must be seen, it gives {twice}");
}

/// Against the sum over points of the upper hemisphere; over all points of the sphere it is another.
#[test]
fn hemisphere_mean_equals_quadrature() {
    let bands = Bands::new(7).expect("in range");
    let mut mean = vec![0.0; bands.coefficients()];
    zonal::hemisphere_mean(bands, Vec3::Z, &mut mean);
    let worst = |low: f64| {
        let points = testkit::quadrature::band_quadrature(low, 1.0, 16);
        let weighed = points.into_iter().map(|(d, weight)| (DVec3::from(d), weight / (2.0 * PI)));
        let exact = project_scalar(bands, weighed);
        mean.iter().zip(exact).fold(0.0, |worst: f64, (a, b)| worst.max((f64::from(*a) - b).abs()))
    };
    assert!(worst(0.0) < 1e-6, "{:e}", worst(0.0));
    assert!(worst(-1.0) > 0.1, "the whole sphere must be told from its half");
}

#[test]
fn cosine_transfer_equals_projection() {
    let bands = Bands::new(6).expect("in range");
    for normal in [Vec3::Y, Vec3::new(2.0, -3.0, 6.0) / 7.0] {
        let mut transfer = vec![0.0; bands.coefficients()];
        zonal::cosine_transfer(bands, normal, &mut transfer);
        let lobe = |d: DVec3| d.dot(normal.as_dvec3()).max(0.0) / PI;
        let samples = sphere_quadrature(400).into_iter().map(|(d, w)| (DVec3::from_array(d), w));
        let expected = project_scalar(bands, samples.map(|(d, w)| (d, w * lobe(d))));
        for (value, expected) in transfer.iter().zip(expected) {
            // the lobe's edge limits the quadrature
            assert_close!(*value, expected, 2e-5, 0.0);
        }
    }
}

#[test]
fn white_furnace_returns_one() {
    for n in 1..=8 {
        let bands = Bands::new(n).expect("in range");
        let mut transfer = vec![0.0; bands.coefficients()];
        zonal::cosine_transfer(bands, Vec3::new(0.6, 0.0, 0.8), &mut transfer);
        let white_sky = (4.0 * PI).sqrt();
        let radiance = f64::from(transfer[0]) * white_sky;
        assert_close!(radiance, 1.0, 1e-6, 0.0, "{n} bands");
        // G-E3: without 1 / pi it is 3.14
        assert!((radiance * PI - 1.0).abs() > 2.0, "the missing 1 / pi must be seen");
    }
}
