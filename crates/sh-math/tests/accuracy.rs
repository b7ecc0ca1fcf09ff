//! Evaluation next to the poles, on the axes and at high degree; f32 against f64, f64 against angles.

use glam::{DVec3, Vec3};
use sh_math::{Bands, evaluate, evaluate_f64, index, recurrence};
use std::f64::consts::PI;

const MOST: Bands = match Bands::new(Bands::MAX) {
    Some(bands) => bands,
    None => unreachable!(),
};

/// Poles, next to the poles, the equator, axes, diagonals and 60 directions in between.
fn directions() -> Vec<DVec3> {
    let mut all = vec![DVec3::X, -DVec3::X, DVec3::Y, -DVec3::Y, DVec3::Z, -DVec3::Z, DVec3::ONE.normalize()];
    for theta in [1e-8, 1e-4, 1e-3, 1e-2, 0.1, PI / 2.0 - 1e-8, PI - 1e-3, PI - 1e-6] {
        let (sine, cosine) = libm::sincos(theta);
        all.push(DVec3::new(sine * 0.6, sine * -0.8, cosine));
    }
    all.extend((0..60).map(|i| {
        let z = 1.0 - (2.0 * f64::from(i) + 1.0) / 60.0;
        let (sine, cosine) = libm::sincos(2.4 * f64::from(i));
        DVec3::new((1.0 - z * z).sqrt() * cosine, (1.0 - z * z).sqrt() * sine, z)
    }));
    all
}

/// Allowed error at degree `l` in units of eps.
fn bound(l: usize) -> f64 {
    let l = l as f64;
    ((2.0 * l + 1.0) / (4.0 * PI)).sqrt() * (3.0 + 2.5 * l + 0.5 * l * l)
}

/// Another way to the functions: order by order with `sin^m theta` carried along and cosines of `m phi` from `libm`.
fn by_angles(n_bands: usize, direction: DVec3) -> Vec<f64> {
    let sine = libm::hypot(direction.x, direction.y);
    let (cosine, phi) = (direction.z, libm::atan2(direction.y, direction.x));
    let mut out = vec![0.0; n_bands * n_bands];
    let mut sectoral = (1.0 / (4.0 * PI)).sqrt();
    for m in 0..n_bands {
        if m > 0 {
            sectoral *= sine * ((2 * m + 1) as f64 / (2 * m) as f64).sqrt();
        }
        let (mut before, mut p) = (0.0, sectoral);
        for l in m..n_bands {
            let (lf, mf) = (l as f64, m as f64);
            if l > m {
                let norm = ((2.0 * lf + 1.0) / (lf * lf - mf * mf)).sqrt();
                let last =
                    if l > m + 1 { (((lf - 1.0) * (lf - 1.0) - mf * mf) / (2.0 * lf - 3.0)).sqrt() } else { 0.0 };
                (before, p) = (p, norm * ((2.0 * lf - 1.0).sqrt() * cosine * p - last * before));
            }
            let scale = if m == 0 { 1.0 } else { 2.0_f64.sqrt() };
            let (sin_m, cos_m) = libm::sincos(mf * phi);
            out[index(l, m as isize)] = scale * p * cos_m;
            if m > 0 {
                out[index(l, -(m as isize))] = scale * p * sin_m;
            }
        }
    }
    out
}

/// Largest difference as a share of the bound, over all degrees.
fn worst(a: &[f64], b: &[f64], eps: f64) -> f64 {
    let shares = a.iter().zip(b).enumerate().map(|(i, (a, b))| (a - b).abs() / (eps * bound(i.isqrt())));
    shares.fold(0.0, |worst, share| if share <= worst { worst } else { share })
}

fn in_f32(direction: Vec3) -> Vec<f64> {
    let mut out = vec![0.0; MOST.coefficients()];
    evaluate(MOST, direction, &mut out);
    out.into_iter().map(f64::from).collect()
}

fn in_f64(direction: DVec3) -> Vec<f64> {
    let mut out = vec![0.0; MOST.coefficients()];
    evaluate_f64(MOST, direction, &mut out);
    out
}

#[test]
fn f32_agrees_with_f64_to_degree_128() {
    for direction in directions() {
        let rounded = direction.as_vec3();
        let share = worst(&in_f32(rounded), &in_f64(rounded.as_dvec3().normalize()), f32::EPSILON.into());
        assert!(share <= 1.0, "{direction}: {share} of the bound");
    }
}

#[test]
fn f32_bound_can_fail() {
    // s = sqrt(1 - z^2) in f32, as the listings have it, next to the pole
    let direction = directions()[9].as_vec3();
    let sine = (1.0 - direction.z * direction.z).sqrt();
    let scale = sine / direction.x.hypot(direction.y);
    let lossy = Vec3::new(direction.x * scale, direction.y * scale, direction.z);
    let share = worst(&in_f32(lossy), &in_f64(direction.as_dvec3().normalize()), f32::EPSILON.into());
    assert!(share > 1.0, "sqrt(1 - z^2) must not pass, it is at {share} of the bound");
}

#[test]
fn f64_agrees_with_angles_to_degree_128() {
    for direction in directions() {
        let share = worst(&in_f64(direction), &by_angles(129, direction), f64::EPSILON);
        // both sides may be wrong by the bound
        assert!(share <= 2.0, "{direction}: {share} of the bound");
    }
}

/// Beyond the table of constants: 1025 bands.
#[test]
fn f64_obeys_the_addition_theorem_to_degree_1024() {
    let mut out = vec![0.0; 1025 * 1025];
    for direction in [DVec3::new(2.0, 3.0, 6.0) / 7.0, DVec3::Z, DVec3::new(0.6e-3, 0.8e-3, 1.0).normalize()] {
        recurrence::evaluate(1025, direction.to_array(), &mut out);
        for l in [1, 100, 128, 129, 512, 1024] {
            let sum: f64 = out[l * l..(l + 1) * (l + 1)].iter().map(|value| value * value).sum();
            let expected = (2 * l + 1) as f64 / (4.0 * PI);
            let allowed = f64::EPSILON * bound(l) * 2.0 * expected.sqrt();
            assert!((sum - expected).abs() <= allowed, "degree {l} at {direction}: {sum} is not {expected}");
        }
    }
}

#[test]
fn poles_are_exact() {
    for (pole, sign) in [(Vec3::Z, 1.0_f64), (-Vec3::Z, -1.0)] {
        let values = in_f32(pole);
        for l in 0..129 {
            let expected = sign.powi(l) * (f64::from(2 * l + 1) / (4.0 * PI)).sqrt();
            for m in -(l as isize)..=l as isize {
                let value = values[index(l as usize, m)];
                let expected = if m == 0 { expected } else { 0.0 };
                let allowed = f64::from(f32::EPSILON) * bound(l as usize);
                assert!((value - expected).abs() <= allowed, "({l}, {m}) at the pole: {value}, not {expected}");
            }
        }
    }
}
