//! The part of gloss shaders that depends on the number of bands: straight-line WGSL, written for as many as the file has.

use sh_math::{Bands, lobe};
use std::f64::consts::PI;
use std::fmt::Write;

/// `BANDS`, `COUNT`, `harmonics(direction)` and `open_energy(factors, cosine)`.
///
/// The functions follow `Q_mm`, `Q_lm = a (z Q_(l-1)m - b Q_(l-2)m)` with the cosines and sines of the longitude times powers of the sine of
/// the polar angle; constants are folded (conventions: `sh_math`).
pub(crate) fn functions(bands: Bands) -> String {
    let (n, count) = (bands.count(), bands.coefficients());
    let mut text = format!("const BANDS: u32 = {n}u;\nconst COUNT: u32 = {count}u;\n\n");
    text.push_str(&harmonics(n, count));
    text.push_str(&open_energy(n));
    text
}

fn harmonics(n: usize, count: usize) -> String {
    let mut body = String::new();
    let mut values = vec![String::new(); count];
    let mut line = |text: String| body.push_str(&format!("    {text}\n"));
    line("let c0 = 1.0;".into());
    line("let s0 = 0.0;".into());
    let mut diagonal = (0.25 / PI).sqrt();
    for m in 0..n {
        if m > 0 {
            line(format!("let c{m} = d.x * c{} - d.y * s{};", m - 1, m - 1));
            line(format!("let s{m} = d.x * s{} + d.y * c{};", m - 1, m - 1));
            diagonal *= ((2 * m + 1) as f64 / (2 * m) as f64).sqrt();
        }
        for l in m..n {
            let (lf, mf) = (l as f64, m as f64);
            let text = if l == m {
                literal(diagonal)
            } else if l == m + 1 {
                format!("{} * d.z", literal((2.0 * mf + 3.0).sqrt() * diagonal))
            } else {
                let a = ((4.0 * lf * lf - 1.0) / (lf * lf - mf * mf)).sqrt();
                let before = (lf - 1.0) * (lf - 1.0);
                let b = ((before - mf * mf) / (4.0 * before - 1.0)).sqrt();
                format!("{} * (d.z * q{}_{m} - {} * q{}_{m})", literal(a), l - 1, literal(b), l - 2)
            };
            line(format!("let q{l}_{m} = {text};"));
            let middle = l * (l + 1);
            if m == 0 {
                values[middle] = format!("q{l}_0");
            } else {
                let root = literal(std::f64::consts::SQRT_2);
                values[middle + m] = format!("{root} * q{l}_{m} * c{m}");
                values[middle - m] = format!("{root} * q{l}_{m} * s{m}");
            }
        }
    }
    let list = values.join(",\n        ");
    format!(
        "// Every function of the bands in a unit direction.\nfn harmonics(d: vec3<f32>) -> array<f32, COUNT> {{\n{body}    return array<f32, COUNT>(\n        {list},\n    );\n}}\n\n"
    )
}

/// `sh_math::lobe::open_energy`.
fn open_energy(n: usize) -> String {
    let mut text = String::from(
        "// What an open white hemisphere gives a lobe about a direction of that cosine with the normal.\nfn open_energy(b: array<f32, BANDS>, x: f32) -> f32 {\n    let p0 = 1.0;\n    let p1 = x;\n",
    );
    for l in 2..n {
        let (a, b) = (literal((2 * l - 1) as f64 / l as f64), literal((l - 1) as f64 / l as f64));
        let _ = writeln!(text, "    let p{l} = {a} * x * p{} - {b} * p{};", l - 1, l - 2);
    }
    let terms = lobe::hemisphere(n).into_iter().enumerate().filter(|(_, c)| c.abs() > 1e-12);
    let sum: Vec<String> = terms.map(|(l, c)| format!("{} * b[{l}] * p{l}", literal(c))).collect();
    let _ = write!(text, "    return {};\n}}\n\n", sum.join(" + "));
    text
}

/// A number as WGSL reads it.
fn literal(value: f64) -> String {
    format!("{:?}", value as f32)
}
