//! Spherical harmonics next to the poles and at high degree.

use super::Case;
use super::case::worst;
use super::listing::{DOUBLE, Listing, PRINTED, SINGLE};
use glam::{DVec3, Vec3};
use sh_math::{Bands, evaluate, evaluate_f64, index, recurrence};
use std::f64::consts::{PI, TAU};
use testkit::quadrature::sphere_quadrature;

pub(crate) fn next_to_the_poles() -> Case {
    Case {
        title: "SH in f32 to degree 128, 1e-8 to 0.01 from the poles",
        bound: "error over sqrt((2l+1)/4π) ε (3 + 2.5 l + 0.5 l²): a rounded direction moves P_l by l(l+1)/2 ε at the pole",
        limit: 1.0,
        ours: || pole_error(|direction| in_f32(129, direction)),
        naive_method: "sin θ = sqrt(1 - z²)",
        naive: || pole_error(|direction| in_f32(129, with_lossy_sine(direction))),
    }
}

pub(crate) fn degree_100_in_f32() -> Case {
    Case {
        title: "SH to degree 100 in f32 against f64 at the same vector, poles and everywhere",
        bound: "difference over sqrt((2l+1)/4π): 1e-4 is asked for; a recurrence of 100 steps and l² ε next to the poles",
        limit: 1e-4,
        ours: || single_error(|direction| in_f32(101, direction)),
        naive_method: "factorials and unnormalised Legendre functions (f32 ends at 35!)",
        naive: || single_error(|direction| SINGLE.evaluate(101, direction.as_dvec3())),
    }
}

pub(crate) fn degree_128() -> Case {
    Case {
        title: "SH in f64 against 20 digits, degrees to 128",
        bound: "error over the same bound as in f32",
        limit: 1.0,
        ours: || golden_error(|direction| in_f64(129, direction)),
        naive_method: "factorials in f64 (171! is infinite)",
        naive: || golden_error(|direction| DOUBLE.evaluate(129, direction)),
    }
}

pub(crate) fn degree_1024() -> Case {
    Case {
        title: "SH in f64 at degree 1024",
        bound: "error of Σ Y² = (2l+1)/4π over m, as a share of twice the bound of one Y times its size",
        limit: 1.0,
        ours: || {
            addition_error(|direction, l| {
                let mut out = vec![0.0; (l + 1) * (l + 1)];
                recurrence::evaluate(l + 1, direction.to_array(), &mut out);
                out
            })
        },
        naive_method: "factorials in f64",
        naive: || addition_error(|direction, l| DOUBLE.evaluate(l + 1, direction)),
    }
}

pub(crate) fn orthonormal_21_bands() -> Case {
    Case {
        title: "Gram matrix of 21 bands",
        bound: "largest entry of G - 1: 441 products summed over 882 directions leave 1e3 ε of an entry of 1",
        limit: 1e-12,
        ours: || gram_defect(|direction| in_f64(21, direction)),
        naive_method: "(1 - z²)^(m/2) with the printed integer division",
        naive: || gram_defect(|direction| Listing::evaluate(&PRINTED, 21, direction)),
    }
}

fn in_f32(n_bands: u32, direction: Vec3) -> Vec<f64> {
    let bands = Bands::new(n_bands).expect("in range");
    let mut out = vec![0.0; bands.coefficients()];
    evaluate(bands, direction, &mut out);
    out.into_iter().map(f64::from).collect()
}

fn in_f64(n_bands: u32, direction: DVec3) -> Vec<f64> {
    let bands = Bands::new(n_bands).expect("in range");
    let mut out = vec![0.0; bands.coefficients()];
    evaluate_f64(bands, direction, &mut out);
    out
}

/// The same longitude and height, the distance from the axis as the listings have it.
fn with_lossy_sine(direction: Vec3) -> Vec3 {
    let sine = (1.0 - direction.z * direction.z).sqrt();
    let scale = sine / direction.x.hypot(direction.y);
    Vec3::new(direction.x * scale, direction.y * scale, direction.z)
}

/// Allowed error of a function of degree `l` in units of eps.
fn bound(l: usize) -> f64 {
    let l = l as f64;
    ((2.0 * l + 1.0) / (4.0 * PI)).sqrt() * (3.0 + 2.5 * l + 0.5 * l * l)
}

fn near_poles() -> Vec<Vec3> {
    let thetas = [1e-8, 1e-6, 1e-5, 1e-4, 3e-4, 1e-3, 3e-3, 1e-2];
    let around = |theta: f64| {
        (0..5).flat_map(move |k| {
            let ((s, c), (sin, cos)) = (libm::sincos(theta), libm::sincos(0.3 + TAU * f64::from(k) / 5.0));
            [1.0, -1.0].map(|side| DVec3::new(s * cos, s * sin, side * c).as_vec3())
        })
    };
    thetas.into_iter().flat_map(around).collect()
}

/// Worst share of the bound over directions next to the poles; the truth is another recurrence in f64.
fn pole_error(functions: impl Fn(Vec3) -> Vec<f64>) -> f64 {
    let share = |direction: Vec3| {
        let truth = by_angles(129, direction.as_dvec3().normalize());
        let values = functions(direction);
        let shares = values
            .iter()
            .zip(&truth)
            .enumerate()
            .map(|(i, (value, truth))| (value - truth).abs() / (f64::from(f32::EPSILON) * bound(i.isqrt())));
        worst(shares)
    };
    worst(near_poles().into_iter().map(share))
}

/// Order by order with `sin^m theta` carried along and cosines of `m phi` from `libm`.
fn by_angles(n_bands: usize, direction: DVec3) -> Vec<f64> {
    let (sine, phi) = (libm::hypot(direction.x, direction.y), libm::atan2(direction.y, direction.x));
    let mut out = vec![0.0; n_bands * n_bands];
    let mut sectoral = (1.0 / (4.0 * PI)).sqrt();
    for m in 0..n_bands {
        if m > 0 {
            sectoral *= sine * ((2 * m + 1) as f64 / (2 * m) as f64).sqrt();
        }
        let scale = if m == 0 { 1.0 } else { std::f64::consts::SQRT_2 };
        let (sin_m, cos_m) = libm::sincos(m as f64 * phi);
        let (mut before, mut p) = (0.0, sectoral);
        for l in m..n_bands {
            if l > m {
                (before, p) = (p, next_legendre(l as f64, m as f64, direction.z, p, before));
            }
            out[index(l, m as isize)] = scale * p * cos_m;
            if m > 0 {
                out[index(l, -(m as isize))] = scale * p * sin_m;
            }
        }
    }
    out
}

/// The normalised Legendre function of degree `l` from those of the two degrees below.
fn next_legendre(l: f64, m: f64, z: f64, below: f64, second: f64) -> f64 {
    let norm = ((2.0 * l + 1.0) / (l * l - m * m)).sqrt();
    let last = if l > m + 1.0 { (((l - 1.0) * (l - 1.0) - m * m) / (2.0 * l - 3.0)).sqrt() } else { 0.0 };
    norm * ((2.0 * l - 1.0).sqrt() * z * below - last * second)
}

/// Worst difference of f32 functions from f64 over sqrt((2l+1)/4π), 101 bands.
fn single_error(functions: impl Fn(Vec3) -> Vec<f64>) -> f64 {
    let even = (0..40).map(|i| {
        let z = 1.0 - (2.0 * f64::from(i) + 1.0) / 40.0;
        let (sin, cos) = libm::sincos(2.4 * f64::from(i));
        let r = (1.0 - z * z).sqrt();
        DVec3::new(r * cos, r * sin, z).as_vec3()
    });
    let all = near_poles().into_iter().chain([Vec3::Z, -Vec3::Z, Vec3::X, Vec3::Y]).chain(even);
    let error = |direction: Vec3| {
        let truth = in_f64(101, direction.as_dvec3());
        let size = |i: usize| ((2 * i.isqrt() + 1) as f64 / (4.0 * PI)).sqrt();
        let values = functions(direction);
        worst(values.iter().zip(&truth).enumerate().map(|(i, (a, b))| (a - b).abs() / size(i)))
    };
    worst(all.map(error))
}

/// Worst share of the bound over values of 20 digits computed elsewhere.
fn golden_error(functions: impl Fn(DVec3) -> Vec<f64>) -> f64 {
    let text = include_str!("../../../../crates/sh-math/tests/golden/golden_sh.json");
    let file: serde_json::Value = serde_json::from_str(text).expect("the golden file is JSON");
    let directions = [
        ("pyth_2_3_6_over_7", DVec3::new(2.0, 3.0, 6.0) / 7.0),
        ("neg_1_4_8_over_9", DVec3::new(-1.0, 4.0, -8.0) / 9.0),
        ("xy_3_4_over_5", DVec3::new(3.0, 4.0, 0.0) / 5.0),
        ("pole", DVec3::Z),
    ];
    let of_direction = |(name, direction): (&str, DVec3)| {
        let values = functions(direction);
        let table = file["values"][name].as_object().expect("each direction is a table");
        let shares = table.iter().map(|(key, golden)| {
            let (l, m) = key.split_once(',').expect("keys are l,m");
            let (l, m): (usize, isize) = (l.parse().expect("l"), m.parse().expect("m"));
            let golden: f64 = golden.as_str().expect("a string").parse().expect("a number");
            (values[index(l, m)] - golden).abs() / (f64::EPSILON * bound(l))
        });
        worst(shares)
    };
    worst(directions.into_iter().map(of_direction))
}

/// Worst residue of the addition theorem at degree 1024, as a share of what rounding may leave.
fn addition_error(functions: impl Fn(DVec3, usize) -> Vec<f64>) -> f64 {
    let l = 1024;
    let expected = (2 * l + 1) as f64 / (4.0 * PI);
    let allowed = f64::EPSILON * bound(l) * 2.0 * expected.sqrt();
    let error = |direction: DVec3| {
        let values = functions(direction, l);
        let sum: f64 = values[l * l..].iter().map(|value| value * value).sum();
        (sum - expected).abs() / allowed
    };
    worst([DVec3::new(2.0, 3.0, 6.0) / 7.0, DVec3::Z, DVec3::new(0.6e-3, 0.8e-3, 1.0).normalize()].map(error))
}

/// Largest entry of `Gram - 1` of 21 bands, by a rule that is exact for products of its functions.
fn gram_defect(functions: impl Fn(DVec3) -> Vec<f64>) -> f64 {
    let n = 21 * 21;
    let mut gram = vec![0.0; n * n];
    for (direction, weight) in sphere_quadrature(21) {
        let values = functions(DVec3::from_array(direction));
        for (row, a) in gram.chunks_exact_mut(n).zip(&values) {
            row.iter_mut().zip(&values).for_each(|(sum, b)| *sum += weight * a * b);
        }
    }
    worst(gram.iter().enumerate().map(|(i, value)| (value - f64::from(u8::from(i / n == i % n))).abs()))
}
