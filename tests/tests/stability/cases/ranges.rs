//! Eight bits: which range the numbers of a coefficient get.

use super::Case;
use super::baking::{fixed, grey, quiet, radiance};
use super::case::worst;
use coeff_io::Prt;
use sh_math::{Bands, project, zonal};
use std::f64::consts::FRAC_PI_2;

pub(crate) fn transfer_in_8_bit() -> Case {
    Case {
        title: "transfer of the Cornell box in 8 bits, radiance under the clear sky",
        bound: "error over the brightest radiance: half a step, 1/254 of each coefficient's largest, 25 of them at random",
        limit: 0.01,
        ours: || eight_bit_error(from_data),
        naive_method: "the constant in 0 to 1, all others within ±0.75 of that",
        naive: || eight_bit_error(fixed_range),
    }
}

pub(crate) fn clipped_transfer() -> Case {
    Case {
        title: "numbers of that transfer that the range clips",
        bound: "their share: none, as the range is the largest of the data",
        limit: 0.0,
        ours: || clipped_share(from_data),
        naive_method: "the constant in 0 to 1, all others within ±0.75 of that",
        naive: || clipped_share(fixed_range),
    }
}

pub(crate) fn grazing_light() -> Case {
    Case {
        title: "irradiance in the modified H-basis, lights at 0 to 90°, 8 bits",
        bound: "error of a coefficient over the largest constant: half a step, 1/254 of the largest coefficient, which is 0.57 of that constant",
        limit: 0.57 / 254.0,
        ours: || grazing_error(|largest, _| largest),
        naive_method: "±0.75 of each light's constant",
        naive: || grazing_error(|_, constant| 0.75 * constant),
    }
}

/// Largest value of each coefficient that 8 bits can hold, from values of `n` coefficients.
type Ranges = fn(&[f32], usize) -> Vec<f32>;

fn from_data(values: &[f32], n: usize) -> Vec<f32> {
    let largest = |i: usize| values.iter().skip(i).step_by(n).fold(f32::MIN_POSITIVE, |most, v| most.max(v.abs()));
    (0..n).map(largest).collect()
}

fn fixed_range(values: &[f32], n: usize) -> Vec<f32> {
    let constant = from_data(values, n)[0];
    (0..n).map(|i| if i == 0 { constant } else { 0.75 * constant }).collect()
}

/// To 8 bits and back: -range is 0, range is 254, so that 0 stays 0.
fn through_8_bit(value: f32, range: f32) -> f32 {
    let code = ((value / range + 1.0) * 127.0).round().clamp(0.0, 255.0);
    (code / 127.0 - 1.0) * range
}

fn cornell() -> Prt {
    quiet(&grey("cornell-box", 0.6), &fixed(5, 256, 2))
}

fn eight_bit_error(ranges: Ranges) -> f64 {
    let mut prt = cornell();
    let sky = probe_io::builtin("sky").expect("builtin");
    let light = project(Bands::new(5).expect("in range"), sky.samples());
    let before = radiance(&prt, &light);
    let n = 25;
    let ranges = ranges(&prt.transfer.values, n);
    for (i, value) in prt.transfer.values.iter_mut().enumerate() {
        *value = through_8_bit(*value, ranges[i % n]);
    }
    let brightest = before.iter().fold(0.0, |most, &value| f64::max(most, value));
    worst(radiance(&prt, &light).iter().zip(&before).map(|(a, b)| (a - b).abs() / brightest))
}

fn clipped_share(ranges: Ranges) -> f64 {
    let values = cornell().transfer.values;
    let ranges = ranges(&values, 25);
    let clipped = values.iter().enumerate().filter(|(i, value)| value.abs() > ranges[i % 25]);
    clipped.count() as f64 / values.len() as f64
}

/// Worst error of the coefficients of lights from the zenith to the horizon; `range` from the largest of all and the
/// light's own constant.
fn grazing_error(range: fn(f64, f64) -> f64) -> f64 {
    let lights: Vec<[f64; 6]> = (0..=90).map(|degrees| modified_h(FRAC_PI_2 * f64::from(degrees) / 90.0)).collect();
    let largest = |of: fn(&[f64; 6]) -> f64| lights.iter().map(of).fold(0.0, f64::max);
    let rest = largest(|c| c[1..].iter().fold(0.0, |most, v| f64::max(most, v.abs())));
    let constant = largest(|c| c[0]);
    let error = |c: &[f64; 6]| {
        let range = range(rest, c[0]) as f32;
        worst(c[1..].iter().map(|&value| (f64::from(through_8_bit(value as f32, range)) - value).abs() / constant))
    };
    worst(lights.iter().map(error))
}

/// Coefficients of the irradiance of a light at an angle from the normal, by way of nine spherical harmonics.
fn modified_h(angle: f64) -> [f64; 6] {
    let (sin, cos) = libm::sincos(angle);
    let mut s = vec![0.0; 9];
    sh_math::evaluate_f64(Bands::new(3).expect("in range"), glam::DVec3::new(sin, 0.0, cos), &mut s);
    s.iter_mut().enumerate().for_each(|(i, value)| *value *= zonal::clamped_cosine(i.isqrt()));
    let root = f64::sqrt;
    let third = s[2] / root(8.0) + root(15.0 / 32.0) * s[6];
    let slope = 0.375 * root(2.5);
    [
        s[0] / root(2.0) + root(3.0 / 8.0) * s[2] + root(3.0) * third,
        s[1] / root(2.0) + slope * s[5],
        -2.0 * third,
        s[3] / root(2.0) + slope * s[7],
        s[4] / root(2.0),
        s[8] / root(2.0),
    ]
}
