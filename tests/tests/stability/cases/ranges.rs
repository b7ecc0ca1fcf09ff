//! Eight bits: which range the numbers of a coefficient get.

use super::Case;
use super::baking::{fixed, grey, quiet, radiance};
use super::case::worst;
use coeff_io::{Prt, Transfer};
use glam::DVec3;
use sh_math::hemisphere::Basis;
use sh_math::{Bands, project};
use std::f64::consts::FRAC_PI_2;
use study::cost::Format;

pub(crate) fn transfer_in_8_bit() -> Case {
    Case {
        title: "transfer of the Cornell box in 8 bits, radiance under the clear sky",
        bound: "error over the brightest radiance: half a step, 1/510 of each coefficient's range, 25 of them at random",
        limit: 0.01,
        ours: || eight_bit_error(|transfer| Format::U8.round_trip(transfer)),
        naive_method: "the constant in 0 to 1, all others within ±0.75 of that",
        naive: || eight_bit_error(in_fixed_range),
    }
}

pub(crate) fn clipped_transfer() -> Case {
    Case {
        title: "numbers of that transfer that the range clips",
        bound: "share of numbers off by more than half a step of their range: none, as the range is that of the data",
        limit: 0.0,
        ours: || clipped_share(|transfer| Format::U8.round_trip(transfer), half_steps_of_data),
        naive_method: "the constant in 0 to 1, all others within ±0.75 of that",
        naive: || clipped_share(in_fixed_range, half_steps_of_fixed),
    }
}

pub(crate) fn grazing_light() -> Case {
    Case {
        title: "irradiance in the modified H-basis, lights at 0 to 90°, 8 bits",
        bound: "error of a coefficient over the largest constant: half a step, 1/510 of a range of at most twice the largest coefficient, which is 0.57 of that constant",
        limit: 0.57 / 254.0,
        ours: || grazing_error(|lights| Format::U8.round_trip(lights)),
        naive_method: "±0.75 of each light's constant",
        naive: || grazing_error(by_each_constant),
    }
}

/// Coefficients that were stored in 8 bits and read back.
type Stored = fn(&Transfer) -> Transfer;

/// Range of all coefficients but the first, over the constant, as printed.
const REST: f32 = 0.75;

/// As the paper stores transfer: the same range for all coefficients but the first, whatever they hold.
fn in_fixed_range(transfer: &Transfer) -> Transfer {
    let ranges = fixed_ranges(transfer);
    let n = ranges.len();
    let values = transfer.values.iter().enumerate().map(|(i, &value)| through_8_bit(value, ranges[i % n]));
    Transfer { values: values.collect(), ..transfer.clone() }
}

fn fixed_ranges(transfer: &Transfer) -> Vec<f32> {
    let n = row_len(transfer);
    let constant = column(transfer, 0).fold(f32::MIN_POSITIVE, |most, v| most.max(v.abs()));
    (0..n).map(|i| if i == 0 { constant } else { REST * constant }).collect()
}

/// The same range, from the constant of each row.
fn by_each_constant(transfer: &Transfer) -> Transfer {
    let row = |row: &[f32]| -> Vec<f32> {
        let stored = |(i, &value): (usize, &f32)| if i == 0 { value } else { through_8_bit(value, REST * row[0]) };
        row.iter().enumerate().map(stored).collect()
    };
    Transfer { values: transfer.values.chunks_exact(row_len(transfer)).flat_map(row).collect(), ..transfer.clone() }
}

/// To 8 bits and back: -range is 0, range is 254, so that 0 stays 0.
fn through_8_bit(value: f32, range: f32) -> f32 {
    let code = ((value / range + 1.0) * 127.0).round().clamp(0.0, 255.0);
    (code / 127.0 - 1.0) * range
}

fn row_len(transfer: &Transfer) -> usize {
    (transfer.bands * transfer.bands * transfer.channels) as usize
}

fn column(transfer: &Transfer, i: usize) -> impl Iterator<Item = f32> {
    transfer.values.iter().copied().skip(i).step_by(row_len(transfer))
}

fn cornell() -> Prt {
    quiet(&grey("cornell-box", 0.6), &fixed(5, 256, 2))
}

fn eight_bit_error(stored: Stored) -> f64 {
    let mut prt = cornell();
    let sky = probe_io::builtin("sky").expect("builtin");
    let light = project(Bands::new(5).expect("in range"), sky.samples());
    let before = radiance(&prt, &light);
    prt.transfer = stored(&prt.transfer);
    let brightest = before.iter().fold(0.0, |most, &value| f64::max(most, value));
    worst(radiance(&prt, &light).iter().zip(&before).map(|(a, b)| (a - b).abs() / brightest))
}

/// What a few operations on 32-bit floats lose.
const ROUNDING: f32 = 4.0 * f32::EPSILON;

/// Share of numbers that are off by more than rounding to the nearest step of their range explains.
fn clipped_share(stored: Stored, half_steps: fn(&Transfer) -> Vec<f32>) -> f64 {
    let given = cornell().transfer;
    let (stored, half_steps) = (stored(&given), half_steps(&given));
    assert_eq!(stored.values.len(), given.values.len(), "as many numbers come back");
    let clipped = given.values.iter().zip(&stored.values).enumerate().filter(|(i, (a, b))| {
        let kept = (*a - *b).abs() <= half_steps[i % half_steps.len()];
        !kept
    });
    clipped.count() as f64 / given.values.len() as f64
}

/// Half a step of 255 over what each coefficient holds, and what 32-bit floats lose beside it.
fn half_steps_of_data(transfer: &Transfer) -> Vec<f32> {
    let half = |i: usize| {
        let [low, high] = column(transfer, i).fold([f32::MAX, f32::MIN], |[low, high], v| [low.min(v), high.max(v)]);
        (high - low) / 510.0 + ROUNDING * low.abs().max(high.abs())
    };
    (0..row_len(transfer)).map(half).collect()
}

/// Half a step of 254 over each fixed range, and the same.
fn half_steps_of_fixed(transfer: &Transfer) -> Vec<f32> {
    fixed_ranges(transfer).into_iter().map(|range| range / 254.0 + ROUNDING * range).collect()
}

/// Worst error of the coefficients of lights from the zenith to the horizon, as a share of the largest constant.
fn grazing_error(stored: Stored) -> f64 {
    let light = |degrees: u32| {
        let (sin, cos) = libm::sincos(FRAC_PI_2 * f64::from(degrees) / 90.0);
        Basis::ModifiedH6.project_radiance([(DVec3::new(sin, 0.0, cos), [1.0; 3])]).into_iter().map(|c| c[0])
    };
    // the six functions are stored as six channels of one band
    let lights = Transfer { bands: 1, channels: 6, values: (0..=90).flat_map(light).collect(), ..Transfer::default() };
    let constant = column(&lights, 0).fold(0.0, f32::max);
    let stored = stored(&lights);
    assert_eq!(stored.values.len(), lights.values.len(), "as many numbers come back");
    let error = |(a, b): (&f32, &f32)| f64::from(a - b).abs() / f64::from(constant);
    worst(lights.values.iter().zip(&stored.values).map(error))
}
