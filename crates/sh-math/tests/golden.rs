//! Evaluation against values of 20 digits computed elsewhere.

use glam::DVec3;
use sh_math::{Bands, evaluate, evaluate_f64, index};

/// `(direction, l, m, value)` of every golden value.
fn golden() -> Vec<(DVec3, usize, isize, f64)> {
    let text = include_str!("golden/golden_sh.json");
    let file: serde_json::Value = serde_json::from_str(text).expect("the golden file is JSON");
    let directions = [
        ("pyth_2_3_6_over_7", DVec3::new(2.0, 3.0, 6.0) / 7.0),
        ("neg_1_4_8_over_9", DVec3::new(-1.0, 4.0, -8.0) / 9.0),
        ("xy_3_4_over_5", DVec3::new(3.0, 4.0, 0.0) / 5.0),
        ("pole", DVec3::Z),
    ];
    let mut rows = Vec::new();
    for (name, direction) in directions {
        for (key, value) in file["values"][name].as_object().expect("each direction is a table") {
            let (l, m) = key.split_once(',').expect("keys are l,m");
            let value = value.as_str().expect("values are strings").parse().expect("values are numbers");
            rows.push((direction, l.parse().expect("l"), m.parse().expect("m"), value));
        }
    }
    assert_eq!(rows.len(), 4 * 94, "the golden file is whole");
    rows
}

/// Bound of the evaluation error at degree `l` in units of `eps`.
fn bound(l: usize) -> f64 {
    let l = l as f64;
    ((2.0 * l + 1.0) / (4.0 * std::f64::consts::PI)).sqrt() * (3.0 + 2.5 * l + 0.5 * l * l)
}

/// Largest error over the golden values as a share of the bound; `phase` is put onto each value first.
fn worst(eps: f64, phase: impl Fn(isize) -> f64, value_at: impl Fn(DVec3, Bands) -> Vec<f64>) -> f64 {
    let error = |&(direction, l, m, expected): &(DVec3, usize, isize, f64)| {
        // few bands where they suffice, so that the straight-line code is tested too
        let bands = Bands::new(if l < 8 { 8 } else { 129 }).expect("in range");
        let value = phase(m) * value_at(direction, bands)[index(l, m)];
        (value - expected).abs() / (eps * bound(l))
    };
    golden().iter().map(error).fold(0.0, f64::max)
}

fn in_f64(direction: DVec3, bands: Bands) -> Vec<f64> {
    let mut out = vec![0.0; bands.coefficients()];
    evaluate_f64(bands, direction, &mut out);
    out
}

fn in_f32(direction: DVec3, bands: Bands) -> Vec<f64> {
    let mut out = vec![0.0; bands.coefficients()];
    evaluate(bands, direction.as_vec3(), &mut out);
    out.into_iter().map(f64::from).collect()
}

#[test]
fn f64_is_within_bound() {
    let worst = worst(f64::EPSILON, |_| 1.0, in_f64);
    assert!(worst <= 1.0, "worst error is {worst} of the bound");
}

#[test]
fn f32_is_within_bound() {
    let worst = worst(f32::EPSILON.into(), |_| 1.0, in_f32);
    assert!(worst <= 1.0, "worst error is {worst} of the bound");
}

/// G-E4: the Condon-Shortley phase flips the odd orders.
#[test]
fn golden_with_phase_can_fail() {
    let phase = |m: isize| if m % 2 == 0 { 1.0 } else { -1.0 };
    let worst = worst(f32::EPSILON.into(), phase, in_f32);
    assert!(worst > 1e3, "a flipped sign must be far outside the bound, not at {worst}");
}
