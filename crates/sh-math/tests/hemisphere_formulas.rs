//! The bases of the hemisphere against the angular forms of the paper, at the border, and in f32.

use glam::{DVec3, Vec3};
use sh_math::hemisphere::Basis;
use std::f64::consts::{FRAC_PI_2, PI, TAU};
use testkit::{assert_close, close};

/// A function of polar angle and longitude.
type Angular = fn(f64, f64) -> f64;

fn at(theta: f64, phi: f64) -> DVec3 {
    DVec3::new(theta.sin() * phi.cos(), theta.sin() * phi.sin(), theta.cos())
}

fn values(basis: Basis, direction: DVec3) -> Vec<f64> {
    let mut out = vec![0.0; basis.count()];
    basis.evaluate_f64(direction, &mut out);
    out
}

/// Angles all over the hemisphere, not next to its border, where `sqrt z` spreads the rounding of `cos theta`.
fn angles() -> impl Iterator<Item = (f64, f64)> {
    (0..40).flat_map(|i| (0..7).map(move |j| (f64::from(i) / 40.0 * 1.55, 0.3 + f64::from(j) / 7.0 * TAU)))
}

/// Whether a function equals its angular form everywhere.
fn agrees(basis: Basis, index: usize, form: Angular) -> bool {
    angles().all(|(theta, phi)| close(values(basis, at(theta, phi))[index], form(theta, phi), 1e-12, 0.0))
}

fn root(x: f64) -> f64 {
    x.sqrt()
}

/// `sqrt((1 - cos) cos)` of eqs. 1.23 to 1.30.
fn shifted_sine(theta: f64) -> f64 {
    root((1.0 - theta.cos()) * theta.cos())
}

/// `1 - (2 cos - 1)^2` of eqs. 1.34 to 1.45.
fn shifted_square(theta: f64) -> f64 {
    1.0 - (2.0 * theta.cos() - 1.0).powi(2)
}

const HSH: [Angular; 9] = [
    |_, _| 1.0 / root(TAU),
    |t, p| root(6.0 / PI) * shifted_sine(t) * p.sin(),
    |t, _| root(1.5 / PI) * (2.0 * t.cos() - 1.0),
    |t, p| root(6.0 / PI) * shifted_sine(t) * p.cos(),
    |t, p| root(30.0 / PI) * (t.cos() - t.cos().powi(2)) * (2.0 * p).sin(),
    |t, p| root(30.0 / PI) * shifted_sine(t) * (2.0 * t.cos() - 1.0) * p.sin(),
    |t, _| root(2.5 / PI) * (6.0 * t.cos().powi(2) - 6.0 * t.cos() + 1.0),
    |t, p| root(30.0 / PI) * shifted_sine(t) * (2.0 * t.cos() - 1.0) * p.cos(),
    |t, p| root(30.0 / PI) * (t.cos() - t.cos().powi(2)) * (2.0 * p).cos(),
];

const MAKHOTKIN: [Angular; 9] = [
    |t, _| root(t.cos() / PI),
    |t, p| root(3.0 / PI * t.cos() * shifted_square(t)) * p.sin(),
    |t, _| root(0.5 / PI * t.cos()) * (3.0 * (2.0 * t.cos() - 1.0) - 1.0),
    |t, p| root(3.0 / PI * t.cos() * shifted_square(t)) * p.cos(),
    |t, p| 0.5 * root(15.0 / PI * t.cos()) * shifted_square(t) * (2.0 * p).sin(),
    |t, p| 0.5 * root(3.0 / PI * t.cos() * shifted_square(t)) * (4.0 + 5.0 * (2.0 * t.cos() - 2.0)) * p.sin(),
    |t, _| {
        let below = 2.0 * t.cos() - 2.0;
        root(3.0 / PI * t.cos()) * (1.0 + 4.0 * below + 2.5 * below * below)
    },
    |t, p| 0.5 * root(3.0 / PI * t.cos() * shifted_square(t)) * (4.0 + 5.0 * (2.0 * t.cos() - 2.0)) * p.cos(),
    |t, p| 0.5 * root(15.0 / PI * t.cos()) * shifted_square(t) * (2.0 * p).cos(),
];

const ZERNIKE: [Angular; 6] = [
    |_, _| 1.0 / root(TAU),
    |t, p| -2.0 / root(PI) * p.sin() * (0.5 * t).sin(),
    |t, p| 2.0 / root(PI) * p.cos() * (0.5 * t).sin(),
    |t, p| -2.0 * root(3.0 / PI) * (2.0 * p).sin() * (0.5 * t).sin().powi(2),
    |t, _| root(1.5 / PI) * (4.0 * (0.5 * t).sin().powi(2) - 1.0),
    |t, p| 2.0 * root(3.0 / PI) * (2.0 * p).cos() * (0.5 * t).sin().powi(2),
];

const H: [Angular; 6] = [
    |_, _| 1.0 / root(TAU),
    |t, p| root(1.5 / PI) * p.sin() * t.sin(),
    |t, _| root(1.5 / PI) * (2.0 * t.cos() - 1.0),
    |t, p| root(1.5 / PI) * p.cos() * t.sin(),
    |t, p| 0.5 * root(7.5 / PI) * (2.0 * p).sin() * t.sin().powi(2),
    |t, p| 0.5 * root(7.5 / PI) * (2.0 * p).cos() * t.sin().powi(2),
];

#[test]
fn functions_equal_their_angular_forms() {
    let families: [(&[Basis], &[Angular]); 4] = [
        (&[Basis::Hsh4, Basis::Hsh9], &HSH),
        (&[Basis::Makhotkin4, Basis::Makhotkin9], &MAKHOTKIN),
        (&[Basis::Zernike3, Basis::Zernike6], &ZERNIKE),
        (&[Basis::H4, Basis::H6], &H),
    ];
    for (bases, forms) in families {
        for basis in bases {
            for (index, form) in forms.iter().take(basis.count()).enumerate() {
                assert!(agrees(*basis, index, *form), "{}, function {index}", basis.name());
            }
        }
    }
    for basis in [Basis::ModifiedH1, Basis::ModifiedH4, Basis::ModifiedH6] {
        for (index, form) in H.iter().take(basis.count()).enumerate().filter(|(index, _)| *index != 2) {
            assert!(agrees(basis, index, *form), "{}, function {index}", basis.name());
        }
    }
    assert!(agrees(Basis::ModifiedH6, 2, |t, _| root(1.5 / PI) * (1.0 - t.cos())));
}

/// Eqs. 1.23, 1.26, 1.32 and 1.48: one of the two printed forms has the other sign. No Gram matrix sees that.
#[test]
fn printed_signs_can_fail() {
    let printed: [(&str, Basis, usize, Angular); 4] = [
        ("1.23", Basis::Hsh9, 1, |t, p| -root(6.0 / PI) * at(t, p).y * root(t.cos() / (1.0 + t.cos()))),
        ("1.26", Basis::Hsh9, 4, |t, p| root(30.0 / PI) * (t.cos().powi(2) - t.cos()) * (2.0 * p).sin()),
        ("1.32", Basis::Hsh9, 8, |t, p| root(30.0 / PI) * (t.cos().powi(2) - t.cos()) * (2.0 * p).cos()),
        ("1.48", Basis::Zernike6, 2, |t, p| -root(2.0 / PI) * at(t, p).x / root(1.0 + t.cos())),
    ];
    for (equation, basis, index, form) in printed {
        assert!(!agrees(basis, index, form), "eq. {equation} as printed must be seen");
    }
}

/// Values at the border, as the files of the bases state them.
#[test]
fn the_border_has_the_documented_values() {
    for phi in [0.0, 0.7, 2.0, 4.5] {
        let border = DVec3::new(f64::cos(phi), f64::sin(phi), 0.0);
        let expect = |basis: Basis, known: &[f64]| {
            let values = values(basis, border);
            values.iter().zip(known).for_each(|(a, b)| assert_close!(*a, *b, 1e-14, 0.0, "{}", basis.name()));
        };
        let (constant, linear, quadratic) = (root(0.5 / PI), root(1.5 / PI), root(2.5 / PI));
        expect(Basis::Hsh9, &[constant, 0.0, -linear, 0.0, 0.0, 0.0, quadratic, 0.0, 0.0]);
        expect(Basis::Makhotkin9, &[0.0; 9]);
        let (x, y) = (border.x, border.y);
        let disc = [constant, -root(2.0 / PI) * y, root(2.0 / PI) * x, -root(12.0 / PI) * x * y, linear];
        expect(Basis::Zernike6, &disc);
        expect(Basis::H4, &[constant, linear * y, -linear, linear * x]);
        expect(Basis::ModifiedH4, &[constant, linear * y, linear, linear * x]);
    }
}

/// A normal that was pushed under the horizon counts as one on it; nothing is infinite, not even at the far pole.
#[test]
fn below_the_horizon_all_is_finite() {
    for basis in Basis::ALL {
        for z in [-1e-7, -0.1, -0.999, -1.0] {
            let side = root(1.0 - z * z);
            let below = values(basis, DVec3::new(0.6 * side, 0.8 * side, z));
            let level = values(basis, DVec3::new(0.6 * side, 0.8 * side, 0.0));
            assert!(below.iter().all(|value| value.is_finite()), "{} at z = {z}: {below:?}", basis.name());
            assert_eq!(below, level, "{} at z = {z}", basis.name());
        }
    }
}

/// The formula without that care gives a NaN one step below the horizon.
#[test]
fn root_below_the_horizon_can_fail() {
    assert!(root(-1e-7_f64 / (1.0 - 1e-7)).is_nan(), "sqrt(z / (1 + z)) of eq. 1.23");
}

/// f32 keeps 6 digits everywhere, also at the border: no function is larger than 1, no step in between larger than 9.
#[test]
fn f32_equals_f64() {
    for basis in Basis::ALL {
        for i in 0..=200 {
            let theta = FRAC_PI_2 * f64::from(i) / 200.0;
            let direction = at(theta, 1.0 + f64::from(i)).as_vec3().max(Vec3::new(-1.0, -1.0, 0.0));
            let mut short = [0.0; Basis::MAX_COUNT];
            basis.evaluate(direction, &mut short);
            for (value, long) in short.iter().zip(values(basis, direction.as_dvec3())) {
                // a few roundings of 6e-8 of numbers up to 9
                assert_close!(*value, long, 1e-6, 0.0, "{} at {direction}", basis.name());
            }
        }
    }
}

/// One texel and many give the same numbers, and they are the sum of coefficient times function.
#[test]
fn reconstruction_is_the_weighted_sum() {
    for basis in Basis::ALL {
        let normals: Vec<Vec3> = angles().map(|(theta, phi)| at(theta, phi).as_vec3()).collect();
        let number = |i: usize| ((i * 37 % 101) as f32 - 50.0) / 50.0;
        let coefficients: Vec<[f32; 3]> =
            (0..normals.len() * basis.count()).map(|i| [number(i), number(i + 7), number(i + 31)]).collect();
        let mut batch = vec![[0.0; 3]; normals.len()];
        basis.reconstruct_batch(&coefficients, &normals, &mut batch);
        for ((normal, texel), result) in normals.iter().zip(coefficients.chunks_exact(basis.count())).zip(batch) {
            assert_eq!(basis.reconstruct(texel, *normal), result, "{}", basis.name());
            let functions = values(basis, normal.as_dvec3());
            for channel in 0..3 {
                let sum: f64 = functions.iter().zip(texel).map(|(f, c)| f * f64::from(c[channel])).sum();
                assert_close!(result[channel], sum, 1e-5, 0.0, "{}, channel {channel}", basis.name());
            }
        }
    }
}
